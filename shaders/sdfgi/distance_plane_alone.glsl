/* SPDX-License-Identifier: MIT
 * A thread searches two lines along z alone, side by side along x: envelope.glsl. */
#ifndef SDFGI_DISTANCE_PLANE_ALONE_GLSL
#define SDFGI_DISTANCE_PLANE_ALONE_GLSL

#include "envelope.glsl"
#include "rows.glsl"

layout(local_size_x = SDFGI_LINES) in;

/* A bit for each four cells along z where this layer may be near to a cell of a dirty block. */
uvec2 find_needed(uint x)
{
    uvec2 needed = uvec2(0u);
    for (uint i = 0u; i < sdfgi_frame.resolution >> 2u; i++)
        if (dirty_within_reach(dirty_blocks(x >> 2u, i), int(layer() >> 4u)))
            needed |= uvec2(i < 32u ? 1u << i : 0u, i < 32u ? 0u : 1u << (i & 31u));
    return needed;
}

/* Cells along z from the first needed one to before the last, as far as candidates reach. */
uvec2 cells_in_reach(uvec2 needed)
{
    const int low = needed.x != 0u ? findLSB(needed.x) : 32 + findLSB(needed.y),
              high = needed.y != 0u ? 32 + findMSB(needed.y) : findMSB(needed.x);
    return uvec2(max(4 * low - SDFGI_DISTANCE_REACH, 0),
                 min(4 * high + 4 + SDFGI_DISTANCE_REACH, int(sdfgi_frame.resolution)));
}

void find_envelopes(uint x, uvec2 cells)
{
    const uint run = x >> 3u, end = 4u * cells.y;
    uint position = 4u * cells.x, runs = 0u;
    for (;; position++) {
        /* Each thread goes on to its next candidate: what follows is run by all of them in any case. */
        while (position < end && (runs = runs_near(run, position)) == 0u)
            position++;
        if (position >= end)
            break;
        const uint bits = row_bits(position, run);
        const int below = gap_below(position, runs, run), above = gap_above(position, runs, run);
        for (uint line = SDFGI_ZERO; line < 2u; line++) {
            const int gap = gap_in_row(bits, (x & 7u) + line, below, above);
            envelope_push(line, position, gap * (gap + 1) / 2);
        }
    }
}

/* At most what is out of any reach, or what 16 bits hold. Without candidates it is that. */
uint encoded(uint line, uint z)
{
    const uint most = min(16u * sdfgi_frame.resolution * sdfgi_frame.resolution - 1u, 0xffffu);
    return envelope_is_empty(line) ? most : min(uint(envelope_least(line, z)), most);
}

void store_lines(uint x, uvec2 needed)
{
    for (uint z = 0u; z < sdfgi_frame.resolution; z++) {
        uint word = 0u;
        for (uint line = SDFGI_ZERO; line < 2u; line++)
            word |= encoded(line, z) << 16u * line;
        if ((needed[z >> 7u] >> (z >> 2u & 31u) & 1u) != 0u)
            sdfgi_scratch[plane_slot(layer(), x, z)] = word;
    }
}

void search_layer()
{
    const uint x = (args.first_x & ~15u) + 16u * gl_WorkGroupID.x + 2u * gl_LocalInvocationIndex;
    if (x < args.first_x || x >= args.end_x)
        return;
    const uvec2 needed = find_needed(x);
    if (needed == uvec2(0u))
        return;
    envelope_begin(1);
    find_envelopes(x, cells_in_reach(needed));
    store_lines(x, needed);
}

#endif
