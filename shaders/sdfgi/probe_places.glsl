/* SPDX-License-Identifier: MIT
 * Where a probe stands, and which of the next ones it sees, apart from how threads share the search for a
 * place: probe_place_shared.glsl and probe_place_alone.glsl. Needs SDFGI_ZERO (on_cpu.glsl). */
#ifndef SDFGI_PROBE_PLACES_GLSL
#define SDFGI_PROBE_PLACES_GLSL

#include "dirty.glsl"
#include "probe_common.glsl"
#include "../include/sdfgi_trace.glsl"

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
const int NO_ROOM = -0x7fffffff; /* score of a cell that no probe can move to */
/* Bits of a probe's state that say where it stands. */
const uint PLACE_BITS = SDFGI_PROBE_DEAD | SDFGI_PROBE_MOVED | 0x7fffu;

bool cell_empty(ivec3 cell)
{
    return !sdfgi_cell_is_inside(cell) || sdfgi_cell_is_empty(args.cascade, cell);
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
    if (i >= CANDIDATES || !sdfgi_cell_is_inside(cell) || !sdfgi_cell_is_empty(args.cascade, cell))
        return NO_ROOM;
    const float moved = length(sdfgi_metric_from_cells(vec3(offset) + 0.5));
    const float score = min(sdfgi_cell_distance(args.cascade, cell), ENOUGH_ROOM) - MOVE_COST * moved -
                        (offset.y < 0 ? DOWN_COST : 0.0);
    const int bits = floatBitsToInt(score);
    return bits < 0 ? bits ^ 0x7fffffff : bits;
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

/* Whether a probe that stands at `state` sees one that stands at `next`, the next one along an axis. */
bool sees_next(ivec3 probe, uint axis, uint state, uint next)
{
    const ivec3 to_next = next_probe(ivec3(0), axis + 1u), base = probe * SDFGI_PROBE_SPACING;
    const vec3 last = vec3(sdfgi_space_resolution() - base) - INSIDE;
    return !sdfgi_probe_is_dead(state) && !sdfgi_probe_is_dead(next) &&
           sdfgi_trace_visible_from(args.cascade, base, min(sdfgi_probe_position(ivec3(0), state), last),
                                    min(sdfgi_probe_position(to_next, next), last));
}

/* A change may have moved the probe, or come between it and a next one. */
bool is_dirty(ivec3 probe)
{
    const ivec3 corner = probe * SDFGI_PROBE_SPACING;
    return dirty_near(args.cascade, corner, corner + SDFGI_PROBE_SPACING, NEAR_LINK);
}

/* SDFGI_PROBE_NEW if a probe's light has to begin anew. */
uint new_bit(ivec3 probe, uint before, uint place)
{
    const bool is_new = has_entered(probe * SDFGI_PROBE_SPACING) || ((place ^ before) & PLACE_BITS) != 0u;
    return is_new ? SDFGI_PROBE_NEW : 0u;
}

void probe_store(uint slot, uint state)
{
    sdfgi_probes[slot] = state;
    if (sdfgi_probe_is_dead(state))
        counter_add(SDFGI_COUNTER_DEAD_PROBES, 1u);
}

#endif
