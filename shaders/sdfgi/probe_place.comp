/* SPDX-License-Identifier: MIT
 * Decides where each probe stands: on its lattice corner if the eight cells around are empty, else in the centre of the
 * nearest roomy empty cell, else nowhere (Hu et al. 2021, SDFDDGI, section 3.4: probes leave geometry along the distance
 * field). Only probes near something new are placed again. One workgroup per probe, one thread per cell that it may move to. */
#version 460
#extension GL_GOOGLE_include_directive : require
#define SDFGI_WRITES_PROBES
#include "changed.glsl"
#include "probe_common.glsl"

layout(local_size_x = SDFGI_GROUP_LINEAR) in;
layout(push_constant) uniform sdfgi_push { sdfgi_pass_args args; };

/* Farthest move, in cells: less than half the probe spacing, so that a probe stays the nearest of its lattice point. */
const int REACH = 3;
/* Room beyond this buys nothing; each cell moved costs this much of it. */
const float ENOUGH_ROOM = 2.0;
const float MOVE_COST = 0.25;
/* Of two sides alike the upper one: below a floor there is a slab or the ground, and probes there help nobody. Covers what a
 * surface inside its cell makes of the room on either side. */
const float DOWN_COST = 0.5;
/* Cells that matter to a place: those it may move to, and those whose distance tells how roomy they are. */
const int NEAR = REACH + int(ENOUGH_ROOM) + 1;
const uint CANDIDATES = uint(8 * REACH * REACH * REACH);
const uint PLACE_BITS = SDFGI_PROBE_DEAD | SDFGI_PROBE_MOVED | 0x7fffu;

shared uint corner_blocked;
shared int best_score; /* ordered as the floats are */
shared uint best_candidate;

bool cell_empty(ivec3 cell)
{
    return !cell_inside(cell) || cell_bits(args.cascade, cell) == uvec2(0u);
}

ivec3 candidate_offset(uint i)
{
    const uint side = uint(2 * REACH);
    return ivec3(i % side, i / side % side, i / (side * side)) - REACH;
}

int candidate_score(ivec3 corner, uint i)
{
    const ivec3 offset = candidate_offset(i), cell = corner + offset;
    if (!cell_inside(cell) || cell_bits(args.cascade, cell) != uvec2(0u))
        return -0x7fffffff;
    const float moved = length(metric_from_cells(vec3(offset) + 0.5));
    const float score = min(cell_distance(args.cascade, cell), ENOUGH_ROOM) - MOVE_COST * moved -
                        (offset.y < 0 ? DOWN_COST : 0.0);
    const int bits = floatBitsToInt(score);
    return bits < 0 ? bits ^ 0x7fffffff : bits;
}

/* Called by the whole workgroup. */
uint place(ivec3 corner)
{
    const uint lane = gl_LocalInvocationIndex;
    if (lane == 0u) {
        corner_blocked = 0u;
        best_score = -0x7fffffff;
        best_candidate = CANDIDATES;
    }
    barrier();
    if (lane < 8u && !cell_empty(corner - ivec3(lane & 1u, lane >> 1u & 1u, lane >> 2u)))
        corner_blocked = 1u;
    barrier();
    if (corner_blocked == 0u)
        return 0u;
    for (uint i = lane; i < CANDIDATES; i += uint(SDFGI_GROUP_LINEAR))
        atomicMax(best_score, candidate_score(corner, i));
    barrier();
    if (best_score == -0x7fffffff)
        return SDFGI_PROBE_DEAD;
    for (uint i = lane; i < CANDIDATES; i += uint(SDFGI_GROUP_LINEAR))
        if (candidate_score(corner, i) == best_score)
            atomicMin(best_candidate, i);
    barrier();
    return probe_pack_moved(candidate_offset(best_candidate));
}

void main()
{
    const ivec3 probe = probe_from_linear(gl_WorkGroupID.x);
    const ivec3 corner = probe * SDFGI_PROBE_SPACING;
    const uint slot = probe_index(args.cascade, probe);
    const ivec3 low = sdfgi_frame.cascades[args.cascade].kept_low.xyz;
    const ivec3 high = sdfgi_frame.cascades[args.cascade].kept_high.xyz;
    const bool entered =
        any(greaterThanEqual(low, high)) || any(lessThan(corner, low)) || any(greaterThan(corner, high));
    const uint before = sdfgi_probes[slot] & ~SDFGI_PROBE_NEW;
    uint state = before;
    if (entered || changed_near(args.cascade, corner, corner, NEAR))
        state = place(corner);
    if (gl_LocalInvocationIndex > 0u)
        return;
    const bool is_new = entered || ((state ^ before) & PLACE_BITS) != 0u;
    sdfgi_probes[slot] = is_new ? state | SDFGI_PROBE_NEW : before;
    if (probe_is_dead(state))
        counter_add(SDFGI_COUNTER_DEAD_PROBES, 1u);
}
