/* SPDX-License-Identifier: MIT
 * A thread places a probe, for software drivers: where threads wait for one another, these drivers keep all
 * variables in memory, and a thread without work takes as long as its neighbours. */
#ifndef SDFGI_PROBE_PLACE_ALONE_GLSL
#define SDFGI_PROBE_PLACE_ALONE_GLSL

#include "probe_places.glsl"

layout(local_size_x = SDFGI_GROUP_PROBE) in;

/* Whether one of the eight cells around a corner is occupied. */
bool is_blocked(ivec3 corner)
{
    bool blocked = false;
    for (uint i = SDFGI_ZERO; i < 8u; i++)
        blocked = blocked || !cell_empty(corner - ivec3(i & 1u, i >> 1u & 1u, i >> 2u & 1u));
    return blocked;
}

/* The candidate with the best score, and of several the first, as PLACE_BITS. */
uint place_with_most_room(ivec3 corner)
{
    int best = NO_ROOM;
    ivec3 offset = ivec3(0);
    for (uint i = 0u; i < CANDIDATES; i++) {
        const int score = candidate_score(corner, i);
        offset = score > best ? candidate_offset(i) : offset;
        best = max(best, score);
    }
    return best == NO_ROOM ? SDFGI_PROBE_DEAD : sdfgi_probe_pack_moved(offset);
}

/* Where a probe stands, as PLACE_BITS. */
uint place(ivec3 probe)
{
    const ivec3 corner = probe * SDFGI_PROBE_SPACING;
    if (!exists(probe))
        return SDFGI_PROBE_DEAD;
    if (!needs_placing(corner))
        return sdfgi_probes_at(sdfgi_probe_index(args.cascade, probe)) & PLACE_BITS;
    return is_blocked(corner) ? place_with_most_room(corner) : 0u;
}

void place_probe()
{
    const uint linear = gl_GlobalInvocationID.x, side = sdfgi_frame.probes_per_side;
    if (linear >= side * side * side)
        return;
    const ivec3 probe = probe_from_linear(linear);
    const uint slot = sdfgi_probe_index(args.cascade, probe),
               before = sdfgi_probes_at(slot) & ~SDFGI_PROBE_NEW;
    uint state = before;
    if (is_dirty(probe)) {
        uint placed = 0u, links = 0u;
        for (uint i = SDFGI_ZERO; i < 4u; i++) {
            const uint at = place(next_probe(probe, i));
            placed = i == 0u ? at : placed;
            if (i > 0u && sees_next(probe, i - 1u, placed, at))
                links |= 1u << SDFGI_PROBE_LINK_SHIFT + (i - 1u);
        }
        state = placed | links | new_bit(probe, before, placed);
    }
    probe_store(slot, state);
}

#endif
