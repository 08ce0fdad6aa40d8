/* SPDX-License-Identifier: MIT
 * Reads the light where this frame's rays of each probe end and adds it to the running sums of the 25 texels:
 * L max(0, n.w) weight, and the weights apart (each ray weighted by the solid angle its jitter stands for),
 * so that a constant field is exact. Young probes read the rays of the frames before again. One workgroup per
 * probe and cascade. Shared memory: 128 rays of 32 bytes. */
#version 460
#extension GL_GOOGLE_include_directive : require
#include "probe_common.glsl"
#include "ray_cache.glsl"
#include "ray_queue.glsl"
#include "../lib/rgbe.glsl"
#include "../lib/light_pack.glsl"
#include "../lib/sky.glsl"

layout(local_size_x = SDFGI_GROUP_PROBE) in;

const uint MAX_RAYS = 128u;
shared vec4 ray_dir[MAX_RAYS]; /* w: solid angle, 0: light not known */
shared vec3 ray_light[MAX_RAYS];

/* Light at the end of a ray; false where it is not known, since the list of light cells was too short for the
 * cell and has not grown yet: the ring before then speaks for the ray, instead of black. */
bool cache_light(uint code, vec3 dir, out vec3 light)
{
    light = vec3(0.0);
    if (code == SDFGI_RAY_SKY)
        light =
            sdfgi_sky_radiance(dir, sdfgi_frame.sky_zenith, sdfgi_frame.sky_horizon, sdfgi_frame.sky_ground);
    if (code >= SDFGI_RAY_UNLIT)
        return true;
    uint axis;
    const uvec2 cell = sdfgi_light[ray_light_index(code, axis)];
    light = sdfgi_light_unpack_axis(cell, axis);
    return (cell.y & SDFGI_LIGHT_VALID) != 0u;
}

void main()
{
    const uint cascade = gl_WorkGroupID.y;
    const ivec3 probe = probe_from_linear(gl_WorkGroupID.x);
    const uint slot = sdfgi_probe_index(cascade, probe);
    if (gl_GlobalInvocationID == uvec3(0u)) {
        sdfgi_counters[SDFGI_COUNTER_RAYS_TRACED] = ray_queue_count();
        counter_add(SDFGI_COUNTER_TRACE_CAPS, ray_queue_capped());
    }
    if (sdfgi_probe_is_dead(sdfgi_probes[slot]) || !sdfgi_probe_is_valid(cascade, probe))
        return;
    const bool young = probe_is_young(sdfgi_sums[probe_memory(slot)]);
    const uint sent = min(sdfgi_frame.rays_per_frame, MAX_RAYS), samples = sdfgi_frame.cycle_samples;
    const uint rays = young ? min(PROBE_YOUNG_FRAMES * sent, min(MAX_RAYS, samples)) : sent;
    for (uint i = gl_LocalInvocationIndex; i < rays; i += uint(SDFGI_GROUP_PROBE)) {
        /* This frame's, then those of the frames before, backwards. */
        const uint s = i < sent ? sdfgi_frame.first_sample + i
                                : (sdfgi_frame.first_sample + samples + sent - 1u - i) % samples;
        const uint code = sdfgi_rays[slot * samples + s];
        float solid_angle;
        const vec3 dir = probe_sample_direction(cascade, probe, s, solid_angle);
        if (code == SDFGI_RAY_UNLIT && i < sent)
            counter_add(SDFGI_COUNTER_UNLIT_HITS, 1u);
        vec3 light = vec3(0.0);
        const bool known = (i < sent || ray_holds(code)) && cache_light(code, dir, light);
        ray_light[i] = light;
        ray_dir[i] = vec4(dir, known ? solid_angle : 0.0);
    }
    barrier();

    if (gl_LocalInvocationIndex >= uint(SDFGI_IRRADIANCE_COUNT))
        return;
    const vec3 normal = probe_texel_direction(gl_LocalInvocationIndex);
    vec4 sum = vec4(0.0);
    for (uint i = 0u; i < rays; i++) {
        const float weight = max(dot(normal, ray_dir[i].xyz), 0.0) * ray_dir[i].w;
        sum += vec4(ray_light[i], 1.0) * weight;
    }
    sdfgi_sums[probe_sums(slot) + gl_LocalInvocationIndex] += sum;
}
