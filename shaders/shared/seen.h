/* SPDX-License-Identifier: MIT
 * The buffer SEEN, in words:
 *
 * - for each cascade SDFGI_SEEN_PARTS parts, with a bit for each entry of its light list: sdfgi/seen.glsl;
 * - records of indirect arguments as in counters.h, one for each pass over the light cells that a frame
 * visits. The number of the first is that of the visits;
 * - these visits: sdfgi/visits.glsl;
 * - where a view has reflections, a word for each axis of each entry, as surfaces are numbered: from where
 *   its light comes. It is here because some drivers allow no more buffers: sdfgi/low_lights.glsl. */
#ifndef SDFGI_SHARED_SEEN_H
#define SDFGI_SHARED_SEEN_H

#include "constants.h"
#include "types.h"

#define SDFGI_VISITS_GATHER  0 /* cell_gather */
#define SDFGI_VISITS_BOUNCE  1 /* light_bounce */
#define SDFGI_VISITS_FILTER  2 /* cell_filter, cell_filter_far */
#define SDFGI_VISITS_RECORDS 3

/* Words of a part. `room` is the number of entries that a light list has room for. */
SDFGI_FUNCTION uint sdfgi_seen_part_words(uint room)
{
    return (room + SDFGI_SEEN_BITS - 1u) / SDFGI_SEEN_BITS;
}

SDFGI_FUNCTION uint sdfgi_seen_records(uint room, uint cascades)
{
    return SDFGI_SEEN_PARTS * sdfgi_seen_part_words(room) * cascades;
}

SDFGI_FUNCTION uint sdfgi_seen_visits(uint room, uint cascades)
{
    return sdfgi_seen_records(room, cascades) + 4u * SDFGI_VISITS_RECORDS;
}

/* A frame visits all entries of a cascade at most, in workgroups of SDFGI_VISIT_CELLS. */
SDFGI_FUNCTION uint sdfgi_seen_low_light(uint room, uint cascades)
{
    return sdfgi_seen_visits(room, cascades) +
           (room + SDFGI_VISIT_CELLS - 1u) / SDFGI_VISIT_CELLS * SDFGI_VISIT_CELLS * cascades;
}

SDFGI_FUNCTION uint sdfgi_seen_end(uint room, uint cascades, bool keeps_low_light)
{
    return sdfgi_seen_low_light(room, cascades) + (keeps_low_light ? 6u * room * cascades : 0u);
}

#endif
