/* SPDX-License-Identifier: MIT
 * A workgroup places a probe: one thread per cell that the probe may move to. It places the next probes as
 * well, because it cannot wait for their workgroups. */
#ifndef SDFGI_PROBE_PLACE_SHARED_GLSL
#define SDFGI_PROBE_PLACE_SHARED_GLSL

#include "probe_places.glsl"

layout(local_size_x = SDFGI_GROUP_LINEAR) in;

const uint PER_THREAD = (CANDIDATES - 1u) / uint(SDFGI_GROUP_LINEAR) + 1u;

shared uint blocked; /* a bit per probe: this one, and the next along each axis */
shared uint links;   /* bits of a probe's state */
shared int best_score;
shared uint best_candidate;

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
    [[dont_unroll]] for (uint i = SDFGI_ZERO; i < 4u; i++)
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
    const uint axis = gl_LocalInvocationIndex;
    if (axis < 3u && sees_next(probe, axis, state, next))
        atomicOr(links, 1u << SDFGI_PROBE_LINK_SHIFT + axis);
    barrier();
    return links;
}

void place_probe()
{
    const ivec3 probe = probe_from_linear(gl_WorkGroupID.x);
    const uint slot = sdfgi_probe_index(args.cascade, probe),
               before = sdfgi_probes_at(slot) & ~SDFGI_PROBE_NEW;
    uint state = before;
    if (is_dirty(probe)) {
        uint next;
        find_blocked(probe);
        const uint placed = place_all(probe, next);
        state = placed | find_links(probe, placed, next) | new_bit(probe, before, placed);
    }
    if (gl_LocalInvocationIndex == 0u)
        probe_store(slot, state);
}

#endif
