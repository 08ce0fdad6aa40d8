/* SPDX-License-Identifier: MIT
 * Traces the rays that ray_list has listed, and caches where they end. One thread per ray. */
#version 460
#extension GL_GOOGLE_include_directive : require
#define SDFGI_WRITES_RAYS
#include "../lib/on_cpu.glsl"
#include "emitter_samples.glsl"
#include "probe_common.glsl"
#include "ray_cache.glsl"
#include "ray_queue.glsl"
#include "../include/sdfgi_trace.glsl"

layout(local_size_x = SDFGI_GROUP_LINEAR) in;

uint hit_pack(sdfgi_trace_hit hit)
{
    if (!hit.hit)
        return SDFGI_RAY_SKY;
    if (!hit.has_cell)
        return hit.capped ? SDFGI_RAY_CAPPED : SDFGI_RAY_UNLIT;
    return ray_pack(hit.cascade, hit.cell, hit.axis);
}

void trace_to_emitter(uint word, uint number, uint cascade, ivec3 probe, vec3 pos)
{
    const vec3 place = sdfgi_random_r3(number, probe_shift(cascade, probe));
    const uvec4 found = emitter_sample_pack(emitter_sample_send(cascade, pos, place));
    for (int i = 0; i < SDFGI_EMITTER_SAMPLE_WORDS; i++)
        sdfgi_rays[word + uint(i)] = found[i];
}

void trace(uint ray)
{
    const uint slot = ray / emitter_cache_stride(), s = ray % emitter_cache_stride();
    uint cascade;
    const ivec3 probe = probe_from_index(slot, cascade);
    const vec3 pos = sdfgi_probe_position(probe, sdfgi_probes_at(slot));
    if (s >= sdfgi_frame.cycle_samples) {
        const uint number = (s - sdfgi_frame.cycle_samples) / uint(SDFGI_EMITTER_SAMPLE_WORDS);
        trace_to_emitter(ray, number, cascade, probe, pos);
        return;
    }
    float solid_angle;
    const vec3 dir = probe_sample_direction(cascade, probe, s, solid_angle);
    const sdfgi_trace_hit hit = sdfgi_trace_ray(cascade, sdfgi_frame.cascade_count - 1u, pos, dir, 1e9);
    sdfgi_rays[ray] = hit_pack(hit);
}

void main()
{
    const uint count = ray_queue_count(), threads = gl_NumWorkGroups.x * SDFGI_GROUP_LINEAR;
    for (uint n = gl_GlobalInvocationID.x; n < count; n += threads)
        trace(sdfgi_scratch_at(n));
}
