/* SPDX-License-Identifier: MIT
 * Forgets remembered rays that passed through what became new in this frame, in their own cascade or in one they go on
 * into: they may end elsewhere now. One workgroup per probe and cascade. */
#version 460
#extension GL_GOOGLE_include_directive : require
#include "changed.glsl"
#include "probe_common.glsl"
#include "ray_cache.glsl"

layout(local_size_x = SDFGI_GROUP_PROBE) in;

/* A light cell is up to two cells before its surface; besides, rounding. */
const float MARGIN = 2.5;

/* Of the probe, which is in the cascade gl_WorkGroupID.y. */
uint own_cascade()
{
    return gl_WorkGroupID.y;
}

/* How far a remembered ray reached from `pos`, in cells of its probe's cascade. */
float reach(uint code, vec3 pos)
{
    if (code >= SDFGI_RAY_UNLIT)
        return 1e9;
    uint cascade;
    const ivec3 cell = ray_cell(code, cascade);
    const vec3 end = cascade_from_first(own_cascade(), first_from_cascade(cascade, vec3(cell) + 0.5));
    return length(metric_from_cells(end - pos)) + MARGIN * exp2(float(cascade - own_cascade()));
}

/* Rays that end before this, in cells of the probe's cascade, reach nothing new. */
float nearest_change(vec3 pos)
{
    const vec3 first = first_from_cascade(own_cascade(), pos);
    float nearest = 1e10;
    for (uint c = own_cascade(); c < sdfgi_frame.size.w; c++) {
        const float away = changed_distance(c, cascade_from_first(c, first), MARGIN);
        nearest = min(nearest, away * exp2(float(c - own_cascade())));
    }
    return nearest;
}

bool passes_changes(vec3 pos, vec3 dir, float end)
{
    const vec3 first = first_from_cascade(own_cascade(), pos);
    for (uint c = own_cascade(); c < sdfgi_frame.size.w; c++) {
        const float scale = exp2(float(own_cascade()) - float(c));
        if (changed_crosses(c, cascade_from_first(c, first), dir * scale, end, MARGIN))
            return true;
    }
    return false;
}

/* The texel that a code names holds another cell now. */
bool names_new_cell(uint code)
{
    if (code >= SDFGI_RAY_UNLIT)
        return false;
    uint cascade;
    const ivec3 cell = ray_cell(code, cascade);
    return changed_near(cascade, cell, cell, 0);
}

void main()
{
    const ivec3 probe = probe_from_linear(gl_WorkGroupID.x);
    const uint slot = probe_index(own_cascade(), probe);
    const uint state = sdfgi_probes[slot];
    if (probe_is_dead(state))
        return;
    const bool is_new = (state & SDFGI_PROBE_NEW) != 0u;
    const vec3 pos = probe_position(probe, state);
    const float nearest = nearest_change(pos);
    for (uint s = gl_LocalInvocationIndex; s < sdfgi_frame.ring.z; s += uint(SDFGI_GROUP_PROBE)) {
        const uint at = slot * sdfgi_frame.ring.z + s;
        const uint code = sdfgi_rays[at];
        if (code == SDFGI_RAY_UNKNOWN)
            continue;
        const float end = reach(code, pos);
        if (!is_new && end < nearest)
            continue;
        float solid_angle;
        const vec3 dir = cells_from_metric(probe_sample_direction(own_cascade(), probe, s, solid_angle));
        if (is_new || names_new_cell(code) || passes_changes(pos, dir, end))
            sdfgi_rays[at] = SDFGI_RAY_UNKNOWN;
    }
}
