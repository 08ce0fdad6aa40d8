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
    const uint bits = uint(SDFGI_SEEN_BITS);
    return cascade * ((sdfgi_frame.light_cell_room + bits - 1u) / bits) + entry / bits;
}

bool seen_holds(uint cascade, uint entry)
{
    return (sdfgi_seen_at(seen_word(cascade, entry)) >> entry % uint(SDFGI_SEEN_BITS) & 1u) != 0u;
}

#endif
