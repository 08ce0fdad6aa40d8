/* SPDX-License-Identifier: MIT
 * Which light cells are visited more often than others: those that gathers of pictures read, which are seen,
 * and those that light them, which their rays hit. Together they are watched. The others can wait. */
#ifndef SDFGI_SEEN_GLSL
#define SDFGI_SEEN_GLSL

#include "pass.glsl"

#ifdef SDFGI_WRITES_SEEN
#define SDFGI_ACCESS_SEEN
#else
#define SDFGI_ACCESS_SEEN readonly
#endif

/* shared/seen.h. Its parts: what is seen, and two for what rays hit. Of these one is read and the other
 * written, so that no visit depends on another one of the same frame. */
layout(std430, set = SDFGI_SET_WORK, binding = SDFGI_BINDING_SEEN) SDFGI_ACCESS_SEEN buffer sdfgi_seen_buffer
{
    uint sdfgi_seen[];
};

uint seen_word_of_part(uint part, uint cascade, uint entry)
{
    return (cascade * uint(SDFGI_SEEN_PARTS) + part) * sdfgi_seen_part_words(sdfgi_frame.light_cell_room) +
           entry / uint(SDFGI_SEEN_BITS);
}

uint seen_word(uint cascade, uint entry)
{
    return seen_word_of_part(0u, cascade, entry);
}

/* The word that holds marks on what rays hit: those that are read, or new ones. */
uint hit_word(bool is_new, uint cascade, uint entry)
{
    const uint part = sdfgi_frame.cascades[cascade].hit_part;
    return seen_word_of_part(1u + (is_new ? 1u - part : part), cascade, entry);
}

bool seen_holds(uint cascade, uint entry)
{
    return (sdfgi_seen_at(seen_word(cascade, entry)) >> entry % uint(SDFGI_SEEN_BITS) & 1u) != 0u;
}

/* The watched cells of an entry's word that have their turn in this frame. */
uint watched_bits(uint cascade, uint entry)
{
    return sdfgi_seen_at(seen_word(cascade, entry)) |
           sdfgi_seen_at(hit_word(false, cascade, entry)) & sdfgi_frame.cascades[cascade].hit_bits;
}

bool watched_holds(uint cascade, uint entry)
{
    return (watched_bits(cascade, entry) >> entry % uint(SDFGI_SEEN_BITS) & 1u) != 0u;
}

#endif
