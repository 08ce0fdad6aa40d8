/* SPDX-License-Identifier: MIT
 * The list of light cells that a frame visits, of all cascades: visit_list writes it, and passes over light
 * cells have their workgroups from its records. Most watched cells are scattered over the light lists. If
 * workgroups looked for them there, most would find few or none. */
#ifndef SDFGI_VISITS_GLSL
#define SDFGI_VISITS_GLSL

#include "light_cells.glsl"
#include "seen.glsl"
#include "workgroup.glsl"

const uint VISIT_NOTHING = ~0u; /* fills up what a workgroup takes */
const uint VISIT_ENTRY_BITS = 28u;

uint visit_record(uint record)
{
    return sdfgi_seen_records(sdfgi_frame.light_cell_room, sdfgi_frame.cascade_count) + 4u * record;
}

uint visit_slot(uint n)
{
    return sdfgi_seen_visits(sdfgi_frame.light_cell_room, sdfgi_frame.cascade_count) + n;
}

uint visit_pack(uint cascade, uint entry)
{
    return cascade << VISIT_ENTRY_BITS | entry;
}

/* The n-th visit, packed. */
uint visit_word(uint n)
{
    return n < sdfgi_seen_at(visit_record(0u) + 3u) ? sdfgi_seen_at(visit_slot(n)) : VISIT_NOTHING;
}

uint visit_cascade(uint word)
{
    return word >> VISIT_ENTRY_BITS;
}

/* Cascade and entry of the n-th visit. False if there is none. */
bool visit_find(uint n, out uint cascade, out uint entry)
{
    const uint word = visit_word(n);
    cascade = visit_cascade(word);
    entry = word & (1u << VISIT_ENTRY_BITS) - 1u;
    return word != VISIT_NOTHING && entry < light_cell_count(cascade);
}

#endif
