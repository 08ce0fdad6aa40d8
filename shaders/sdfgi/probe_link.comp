/* SPDX-License-Identifier: MIT
 * Which of the next probes along the axes each probe sees: lookups extrapolate along such links. Only near something new.
 * One thread per probe and axis. */
#version 460
#extension GL_GOOGLE_include_directive : require
#define SDFGI_WRITES_PROBES
#include "changed.glsl"
#include "probe_common.glsl"
#include "../include/sdfgi_trace.glsl"

layout(local_size_x = SDFGI_GROUP_LINEAR) in;
layout(push_constant) uniform sdfgi_push { sdfgi_pass_args args; };

/* Cells around the way to the next probe that matter: how far probes move, and a ray's longest step. */
const int NEAR = 8;

bool sees(ivec3 probe, uint state, int axis)
{
    ivec3 step = ivec3(0);
    step[axis] = 1;
    if (probe[axis] + 1 >= int(sdfgi_frame.size.z))
        return false;
    const uint other = sdfgi_probes[probe_index(args.cascade, probe + step)];
    return !probe_is_dead(other) && trace_visible_from(args.cascade, probe * SDFGI_PROBE_SPACING,
                                                       probe_position(ivec3(0), state), probe_position(step, other));
}

void main()
{
    const uint side = sdfgi_frame.size.z, index = gl_GlobalInvocationID.x / 3u, axis = gl_GlobalInvocationID.x % 3u;
    if (index >= side * side * side)
        return;
    const ivec3 probe = probe_from_linear(index), corner = probe * SDFGI_PROBE_SPACING;
    if (!changed_near(args.cascade, corner, corner + SDFGI_PROBE_SPACING, NEAR))
        return;
    const uint slot = probe_index(args.cascade, probe), link = 1u << SDFGI_PROBE_LINK_SHIFT + axis;
    const uint state = sdfgi_probes[slot];
    /* Others read where this probe stands meanwhile: those bits are left alone. */
    if (!probe_is_dead(state) && sees(probe, state, int(axis)))
        atomicOr(sdfgi_probes[slot], link);
    else
        atomicAnd(sdfgi_probes[slot], ~link);
}
