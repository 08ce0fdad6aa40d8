/* SPDX-License-Identifier: MIT
 * A thread searches two lines along y alone, side by side along x: envelope.glsl. */
#ifndef SDFGI_DISTANCE_EXACT_ALONE_GLSL
#define SDFGI_DISTANCE_EXACT_ALONE_GLSL

#include "envelope.glsl"
#include "occupancy.glsl"

layout(local_size_x = SDFGI_LINES) in; /* two along x and four along z */
SDFGI_PUSH(sdfgi_distance_search_args);

/* A bit for each of the four layers at a y of cells that holds a bit within reach along z. */
uint layers_in_reach(uint y, uint z)
{
    const uint low = max(z, uint(SDFGI_DISTANCE_REACH)) - uint(SDFGI_DISTANCE_REACH),
               high = min(z + uint(SDFGI_DISTANCE_REACH), sdfgi_frame.resolution - 1u);
    return (sdfgi_search_at(layers_slot(y, low / SDFGI_GROUP_COLUMNS)) |
            sdfgi_search_at(layers_slot(y, high / SDFGI_GROUP_COLUMNS))) &
           15u;
}

void find_envelopes(uvec2 dirty, uint x, uint z, int common_bits)
{
    uint y = 0u, layers = 0u;
    for (;;) {
        /* Each thread goes on to its next candidate: what follows is run by all of them in any case. */
        for (; layers == 0u && y < sdfgi_frame.resolution; y++)
            layers = dirty_within_reach(dirty, int(y >> 2u)) ? layers_in_reach(y, z) : 0u;
        if (layers == 0u)
            break;
        const uint layer = 4u * (y - 1u) + uint(findLSB(layers));
        const uint planes = sdfgi_scratch_at(plane_slot(layer, x, z));
        for (uint line = SDFGI_ZERO; line < 2u; line++)
            envelope_push(line, layer, int(planes >> 16u * line & 0xffffu) * (16 >> common_bits));
        layers &= layers - 1u;
    }
}

/* Stored form of a result: eight times the sum of (d^2 - 1) / 8, plus the 1 of each axis. */
uint encoded(uint line, uint y, int common_bits)
{
    const uint length2 = uint((8 * envelope_least(line, y) + envelope_weight) << common_bits) + 32u;
    return envelope_is_empty(line) ? sdfgi_distance_reach() : distance_encode(length2);
}

void store_lines(uvec2 dirty, uint x, uint z, int common_bits)
{
    for (uint y = 0u; y < sdfgi_frame.resolution; y++) {
        uint word = 0u;
        for (uint line = SDFGI_ZERO; line < 2u; line++)
            word |= encoded(line, y, common_bits) << 16u * line;
        if ((dirty[y >> 7u] >> (y >> 2u & 31u) & 1u) != 0u)
            sdfgi_distances[sdfgi_cell_index(args.cascade, ivec3(x, y, z)) >> 1u] = word;
    }
}

void search_lines()
{
    const uint thread = gl_LocalInvocationIndex,
               x = args.first_x + 4u * gl_WorkGroupID.y + 2u * (thread & 1u),
               z = 4u * gl_WorkGroupID.x + (thread >> 1u);
    const uvec2 dirty = dirty_blocks(x >> 2u, z >> 2u);
    if (dirty == uvec2(0u))
        return;
    /* Costs leave out the power of 2 that squares along y have in common with those in planes. */
    const int weight = int(distance_y_weight()), common_bits = findLSB(weight);
    envelope_begin(weight >> common_bits);
    find_envelopes(dirty, x, z, common_bits);
    store_lines(dirty, x, z, common_bits);
}

#endif
