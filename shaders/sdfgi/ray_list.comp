/* SPDX-License-Identifier: MIT
 * Lists those rays of this frame that must be traced, because their hit is not cached. After the first sample
 * cycle few rays are left, and they are scattered. If each probe traced its own, its threads would wait for
 * each other. A thread looks at SDFGI_LISTED_RAYS rays, in the cascade gl_WorkGroupID.y; on software drivers,
 * at those of whole probes. Nothing depends on the order of the list. */
#version 460
#extension GL_GOOGLE_include_directive : require
#define SDFGI_WRITES_INDIRECT
#define SDFGI_WRITES_SCRATCH
#include "../lib/on_cpu.glsl"
#include "probe_common.glsl"
#include "emitter_samples.glsl"
#include "ray_cache.glsl"
#include "ray_queue.glsl"
#include "../include/sdfgi_trace.glsl"

layout(local_size_x = SDFGI_GROUP_RAYS) in;

/* True if a ray meets nothing, as probe_trace would find. */
bool misses_content(uint cascade, ivec3 probe, uint slot, uint s)
{
    float solid_angle;
    const vec3 pos = sdfgi_probe_position(probe, sdfgi_probes_at(slot)),
               dir = probe_sample_direction(cascade, probe, s, solid_angle);
    return sdfgi_trace_content_of(cascade, ivec3(0), pos, 1.0 / sdfgi_trace_cells_direction(dir)).misses;
}

uint probe_rays()
{
    return sdfgi_frame.rays_per_frame +
           (emitters_are_complete(gl_WorkGroupID.y) ? emitter_rays_of_frame() : 0u);
}

/* The i-th probe of a cascade. False if it sends no rays. */
bool probe_sends(uint cascade, uint i, out ivec3 probe, out uint slot)
{
    const uint side = sdfgi_frame.probes_per_side;
    probe = probe_from_linear(i);
    slot = sdfgi_probe_index(cascade, probe);
    return i < side * side * side && !sdfgi_probe_is_dead(sdfgi_probes_at(slot)) &&
           sdfgi_probe_is_valid(cascade, probe);
}

/* Whether the k-th ray of a probe must be traced; its index in the ray cache. */
bool needs_tracing(uint cascade, ivec3 probe, uint slot, uint k, out uint ray)
{
    const uint at_random = sdfgi_frame.rays_per_frame;
    if (k >= at_random) {
        ray = emitter_sample_word(slot, emitter_first_of_frame() + k - at_random);
        return !emitter_sample_is_known(ray);
    }
    const uint s = sdfgi_frame.first_sample + k;
    ray = slot * emitter_cache_stride() + s;
    bool traced = !ray_is_cached(sdfgi_rays_at(ray)), unknown = traced;
    /* A loop, which software drivers leave out where no thread needs it. */
    while (unknown) {
        unknown = false;
        traced = !misses_content(cascade, probe, slot, s);
        if (!traced)
            sdfgi_rays[ray] = SDFGI_RAY_SKY;
    }
    return traced;
}

#ifdef SDFGI_SOFTWARE

/* Each thread lists the rays of a probe alone: where threads wait for one another, software drivers keep all
 * variables in memory. */
void main()
{
    const uint side = sdfgi_frame.probes_per_side, count = side * side * side, rays = probe_rays(),
               threads = gl_NumWorkGroups.x * uint(SDFGI_GROUP_RAYS);
    for (uint i = gl_GlobalInvocationID.x; i < count; i += threads) {
        ivec3 probe;
        uint slot, ray;
        const uint sent = probe_sends(gl_WorkGroupID.y, i, probe, slot) ? rays : 0u;
        for (uint k = SDFGI_ZERO; k < sent; k++)
            if (needs_tracing(gl_WorkGroupID.y, probe, slot, k, ray))
                sdfgi_scratch[ray_queue_extend(1u)] = ray;
    }
}

#else

shared uint group_count; /* rays that the workgroup lists */
shared uint group_first; /* index of the first of them in the queue */

const uint RAYS = uint(SDFGI_LISTED_RAYS); /* that a thread looks at: loads overlap */

void main()
{
    if (gl_LocalInvocationIndex == 0u)
        group_count = 0u;
    barrier();
    uint rays[RAYS], offsets[RAYS];
    bool listed[RAYS];
    const uint of_probe = probe_rays();
    for (uint k = 0u; k < RAYS; k++) {
        const uint n = (gl_WorkGroupID.x * RAYS + k) * gl_WorkGroupSize.x + gl_LocalInvocationIndex;
        ivec3 probe;
        uint slot;
        rays[k] = 0u;
        listed[k] = probe_sends(gl_WorkGroupID.y, n / of_probe, probe, slot) &&
                    needs_tracing(gl_WorkGroupID.y, probe, slot, n % of_probe, rays[k]);
    }
    for (uint k = 0u; k < RAYS; k++)
        if (listed[k])
            offsets[k] = atomicAdd(group_count, 1u);
    barrier();
    if (group_count == 0u)
        return;
    if (gl_LocalInvocationIndex == 0u)
        group_first = ray_queue_extend(group_count);
    barrier();
    for (uint k = 0u; k < RAYS; k++)
        if (listed[k])
            sdfgi_scratch[group_first + offsets[k]] = rays[k];
}

#endif
