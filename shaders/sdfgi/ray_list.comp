/* SPDX-License-Identifier: MIT
 * Lists those rays of this frame that must be traced: all that are not remembered, or whose cell has left its
 * cascade. After the first ring most are remembered, here one and there one not: threads of a probe that
 * trace would wait for each other. One thread per ray, in the cascade gl_WorkGroupID.y. Nothing depends on
 * the order of the list. */
#version 460
#extension GL_GOOGLE_include_directive : require
#include "probe_common.glsl"
#include "ray_cache.glsl"
#include "ray_queue.glsl"

layout(local_size_x = SDFGI_GROUP_RAYS) in;

shared uint group_count, group_first;

bool is_missing(uint cascade, uint n, out uint ray)
{
    const uint side = sdfgi_frame.probes_per_side, rays = sdfgi_frame.rays_per_frame, i = n / rays;
    ray = 0u;
    if (i >= side * side * side)
        return false;
    const ivec3 probe = probe_from_linear(i);
    const uint slot = sdfgi_probe_index(cascade, probe);
    if (sdfgi_probe_is_dead(sdfgi_probes[slot]) || !sdfgi_probe_is_valid(cascade, probe))
        return false;
    ray = slot * sdfgi_frame.cycle_samples + sdfgi_frame.first_sample + n % rays;
    return !ray_holds(sdfgi_rays[ray]);
}

void main()
{
    if (gl_LocalInvocationIndex == 0u)
        group_count = 0u;
    barrier();
    uint ray, place = 0u;
    const bool missing = is_missing(gl_WorkGroupID.y, gl_GlobalInvocationID.x, ray);
    if (missing)
        place = atomicAdd(group_count, 1u);
    barrier();
    if (group_count == 0u)
        return;
    if (gl_LocalInvocationIndex == 0u)
        group_first = ray_queue_extend(group_count);
    barrier();
    if (missing)
        sdfgi_scratch[group_first + place] = ray;
}
