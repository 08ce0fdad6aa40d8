/* SPDX-License-Identifier: MIT
 * Which light cells gathers of pictures read. These cells are visited more often than others: what nobody
 * looks at can wait. */
#ifndef SDFGI_SEEN_GLSL
#define SDFGI_SEEN_GLSL

#include "pass.glsl"

#ifdef SDFGI_WRITES_SEEN
#define SDFGI_ACCESS_SEEN
#else
#define SDFGI_ACCESS_SEEN readonly
#endif

/* A bit per entry of the light lists. */
layout(std430, set = SDFGI_SET_WORK, binding = SDFGI_BINDING_SEEN) SDFGI_ACCESS_SEEN buffer sdfgi_seen_buffer
{
    uint sdfgi_seen[];
};

uint seen_word(uint cascade, uint entry)
{
    return cascade * ((sdfgi_frame.light_cell_room + 31u) / 32u) + entry / 32u;
}

bool seen_holds(uint cascade, uint entry)
{
    return (sdfgi_seen_at(seen_word(cascade, entry)) >> (entry & 31u) & 1u) != 0u;
}

/* The cascade of row y of a dispatch. Rows of the ranges come first, and then those of the seen cells. */
uint visited_cascade(uint row)
{
    return row % sdfgi_frame.cascade_count;
}

/* Finds the n-th entry of a row: of the range [first, end), or of the seen cells outside of it. False if it
 * is not to be visited. `count` is the length of the list. */
bool visited_entry(uint row, uint n, uint first, uint end, uint count, out uint entry)
{
    entry = first + n;
    if (row < sdfgi_frame.cascade_count)
        return entry < min(end, count);
    const uint cascade = visited_cascade(row);
    entry = sdfgi_frame.cascades[cascade].seen_first + n;
    return entry < min(sdfgi_frame.cascades[cascade].seen_end, count) && (entry < first || entry >= end) &&
           seen_holds(cascade, entry);
}

#endif
