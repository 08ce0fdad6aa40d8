/* SPDX-License-Identifier: MIT
 * Decides where each probe near a dirty box stands. If the eight cells around its corner are empty, it stands
 * on the corner. Otherwise it moves to the centre of the empty cell with the most room nearby, and where
 * there is none the probe is dead (Hu et al. 2021, SDFDDGI, section 3.4: probes leave geometry along the
 * distance field). Also decides which of the next probes along the three axes it sees, because lookups
 * extrapolate along such links. One workgroup per probe, one thread per cell that the probe may move to. A
 * workgroup places the next probes as well, because it cannot wait for their workgroups. */
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
#define SDFGI_WRITES_PROBES
#include "../lib/on_cpu.glsl"
#include "dirty.glsl"
#include "probe_common.glsl"
#include "../include/sdfgi_trace.glsl"

layout(local_size_x = SDFGI_GROUP_LINEAR) in;
SDFGI_PUSH(sdfgi_cascade_args);

/* Farthest move, in cells: less than half the probe spacing, so that a probe stays the one nearest to its
 * corner. */
const int REACH = 3;
/* Room is a cell's stored distance, in cells. More room than this is no better, and each cell that a probe
 * moves costs this much room. */
const float ENOUGH_ROOM = 2.0;
const float MOVE_COST = 0.25;
/* Of two sides with the same room the upper one is better, because no lookup needs a probe in the ground or
 * in the slab below a floor. The cost exceeds the difference in room that comes from where a surface lies
 * within its cell. */
const float DOWN_COST = 0.5;
/* Cells around a corner on which the place depends: those that the probe may move to, and as far as their
 * distances count. */
const int NEAR_PLACE = REACH + int(ENOUGH_ROOM) + 1;
/* Cells around the segment between two corners on which a link depends: as far as probes move, and as far as
 * the longest step of a ray looks. */
const int NEAR_LINK = 8;
/* Cells. On the far faces of the cascade sight lines run so far inside them: on a face itself they would meet
 * nothing, and connect rooms. */
const float INSIDE = 1.0 / 16.0;
const uint CANDIDATES = uint(8 * REACH * REACH * REACH);
const uint PER_THREAD = (CANDIDATES - 1u) / uint(SDFGI_GROUP_LINEAR) + 1u;
const int NO_ROOM = -0x7fffffff; /* score of a cell that no probe can move to */
/* Bits of a probe's state that say where it stands. */
const uint PLACE_BITS = SDFGI_PROBE_DEAD | SDFGI_PROBE_MOVED | 0x7fffu;

shared uint blocked; /* a bit per probe: this one, and the next along each axis */
shared uint links;   /* bits of a probe's state */
shared int best_score;
shared uint best_candidate;

bool cell_empty(ivec3 cell)
{
    return !sdfgi_cell_is_inside(cell) || sdfgi_cell_bits(args.cascade, cell) == uvec2(0u);
}

ivec3 candidate_offset(uint i)
{
    const uint side = uint(2 * REACH);
    return ivec3(i % side, i / side % side, i / (side * side)) - REACH;
}

/* Bits of the score, changed so that integers have the order of the floats. */
int candidate_score(ivec3 corner, uint i)
{
    const ivec3 offset = candidate_offset(i), cell = corner + offset;
    if (i >= CANDIDATES || !sdfgi_cell_is_inside(cell) || sdfgi_cell_bits(args.cascade, cell) != uvec2(0u))
        return NO_ROOM;
    const float moved = length(sdfgi_metric_from_cells(vec3(offset) + 0.5));
    const float score = min(sdfgi_cell_distance(args.cascade, cell), ENOUGH_ROOM) - MOVE_COST * moved -
                        (offset.y < 0 ? DOWN_COST : 0.0);
    const int bits = floatBitsToInt(score);
    return bits < 0 ? bits ^ 0x7fffffff : bits;
}

/* The candidate with the best score, and of several the first, as PLACE_BITS. Called by the whole
 * workgroup. */
uint place_with_most_room(ivec3 corner)
{
    const uint lane = gl_LocalInvocationIndex;
    int scores[PER_THREAD];
    barrier();
    if (lane == 0u) {
        best_score = NO_ROOM;
        best_candidate = CANDIDATES;
    }
    barrier();
    [[unroll]] for (uint k = 0u; k < PER_THREAD; k++)
    {
        scores[k] = candidate_score(corner, lane + k * uint(SDFGI_GROUP_LINEAR));
    }
    [[unroll]] for (uint k = 0u; k < PER_THREAD; k++)
    {
        atomicMax(best_score, scores[k]);
    }
    barrier();
    if (best_score == NO_ROOM)
        return SDFGI_PROBE_DEAD;
    [[unroll]] for (uint k = 0u; k < PER_THREAD; k++)
    {
        if (scores[k] == best_score)
            atomicMin(best_candidate, lane + k * uint(SDFGI_GROUP_LINEAR));
    }
    barrier();
    return sdfgi_probe_pack_moved(candidate_offset(best_candidate));
}

/* True for a corner that was outside the valid region before this frame. */
bool has_entered(ivec3 corner)
{
    const ivec3 low = sdfgi_frame.cascades[args.cascade].kept_low;
    const ivec3 high = sdfgi_frame.cascades[args.cascade].kept_high;
    return any(greaterThanEqual(low, high)) || any(lessThan(corner, low)) || any(greaterThan(corner, high));
}

bool needs_placing(ivec3 corner)
{
    return has_entered(corner) || dirty_near(args.cascade, corner, corner, NEAR_PLACE);
}

/* This probe, or the next one along an axis. */
ivec3 next_probe(ivec3 probe, uint i)
{
    return probe + ivec3(i == 1u, i == 2u, i == 3u);
}

bool exists(ivec3 probe)
{
    return all(lessThan(probe, ivec3(sdfgi_frame.probes_per_side)));
}

/* Fills `blocked`: a bit per probe that has an occupied cell among the eight around its corner. Called by the
 * whole workgroup. */
void find_blocked(ivec3 probe)
{
    const uint lane = gl_LocalInvocationIndex, i = lane >> 3u;
    if (lane == 0u)
        blocked = links = 0u;
    barrier();
    const ivec3 corner = next_probe(probe, i) * SDFGI_PROBE_SPACING;
    if (i < 4u && !cell_empty(corner - ivec3(lane & 1u, lane >> 1u & 1u, lane >> 2u & 1u)))
        atomicOr(blocked, 1u << i);
    barrier();
}

/* Where this probe (i = 0) or one of the next stands, as PLACE_BITS. Called by the whole workgroup. */
uint place(ivec3 probe, uint i)
{
    const ivec3 other = next_probe(probe, i), corner = other * SDFGI_PROBE_SPACING;
    if (!exists(other))
        return SDFGI_PROBE_DEAD;
    if (!needs_placing(corner))
        return sdfgi_probes_at(sdfgi_probe_index(args.cascade, other)) & PLACE_BITS;
    return (blocked >> i & 1u) != 0u ? place_with_most_room(corner) : 0u;
}

/* Where this probe stands, and the next one along the axis of each of the first three threads, as PLACE_BITS.
 * Called by the whole workgroup. */
uint place_all(ivec3 probe, out uint next)
{
    uint state = SDFGI_PROBE_DEAD;
    next = SDFGI_PROBE_DEAD;
    [[dont_unroll]] for (uint i = SDFGI_FIRST; i < 4u; i++)
    {
        const uint placed = place(probe, i);
        state = i == 0u ? placed : state;
        next = gl_LocalInvocationIndex + 1u == i ? placed : next;
    }
    return state;
}

/* Which of the next probes a probe that stands at `state` sees, as bits of its state. The first three threads
 * trace a ray each to where their next probe stands. Called by the whole workgroup. */
uint find_links(ivec3 probe, uint state, uint next)
{
    const ivec3 to_next = next_probe(ivec3(0), gl_LocalInvocationIndex + 1u),
                base = probe * SDFGI_PROBE_SPACING;
    const vec3 last = vec3(sdfgi_space_resolution() - base) - INSIDE;
    if (!sdfgi_probe_is_dead(state) && !sdfgi_probe_is_dead(next) &&
        sdfgi_trace_visible_from(args.cascade, base, min(sdfgi_probe_position(ivec3(0), state), last),
                                 min(sdfgi_probe_position(to_next, next), last)))
        atomicOr(links, 1u << SDFGI_PROBE_LINK_SHIFT + gl_LocalInvocationIndex);
    barrier();
    return links;
}

void main()
{
    const ivec3 probe = probe_from_linear(gl_WorkGroupID.x), corner = probe * SDFGI_PROBE_SPACING;
    const uint lane = gl_LocalInvocationIndex, slot = sdfgi_probe_index(args.cascade, probe);
    const uint before = sdfgi_probes_at(slot) & ~SDFGI_PROBE_NEW;
    uint state = before;
    if (dirty_near(args.cascade, corner, corner + SDFGI_PROBE_SPACING, NEAR_LINK)) {
        find_blocked(probe);
        uint next;
        state = place_all(probe, next);
        const uint seen_next = find_links(probe, state, next);
        const bool is_new = has_entered(corner) || ((state ^ before) & PLACE_BITS) != 0u;
        state |= seen_next | (is_new ? SDFGI_PROBE_NEW : 0u);
    }
    if (lane > 0u)
        return;
    sdfgi_probes[slot] = state;
    if (sdfgi_probe_is_dead(state))
        counter_add(SDFGI_COUNTER_DEAD_PROBES, 1u);
}
