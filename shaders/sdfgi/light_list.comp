/* SPDX-License-Identifier: MIT
 * Writes the list of light cells in the order of blocks and of bits in them. Cells that were light cells before keep their
 * light, new ones begin dark. One workgroup per row of blocks; a thread takes every SDFGI_GROUP_LINEAR-th cell of it. */
#version 460
#extension GL_GOOGLE_include_directive : require
#define SDFGI_WRITES_LIGHT
#include "light_blocks.glsl"

layout(local_size_x = SDFGI_GROUP_LINEAR) in;
layout(push_constant) uniform sdfgi_push { sdfgi_pass_args args; };

shared uvec2 masks[SDFGI_GROUP_LINEAR];

/* First block of the row whose running sum exceeds `n`. */
uint block_of(uint n)
{
    uint block = 0u;
    for (uint step = SDFGI_GROUP_LINEAR / 2u; step > 0u; step /= 2u)
        if (light_sums[block + step - 1u] <= n)
            block += step;
    return block;
}

/* Position of the n-th set bit, from 0. */
uint bit_of(uvec2 mask, uint n)
{
    const uint low = bitCount(mask.x);
    const bool high = n >= low;
    const uint word = high ? mask.y : mask.x;
    uint rest = high ? n - low : n, bit = 0u;
    for (uint width = 16u; width > 0u; width /= 2u) {
        const uint count = bitCount(bitfieldExtract(word, int(bit), int(width)));
        if (rest >= count) {
            rest -= count;
            bit += width;
        }
    }
    return high ? bit + 32u : bit;
}

void write_cell(uint entry, uvec3 texel)
{
    const uint index = texel_index(texel), cell = index | args.cascade << (3u * sdfgi_frame.size.y);
    if (entry >= sdfgi_frame.light.y) {
        sdfgi_light[cell] = uvec2(0u); /* counted, but without room nobody lights it */
        return;
    }
    const uint slot = light_cell_slot(args.cascade, entry);
    sdfgi_light_cells[slot] = index;
    light_cell_store_direct(slot, uvec2(0u, SDFGI_LIGHT_VALID));
    if ((sdfgi_light[cell].y & SDFGI_LIGHT_VALID) == 0u)
        sdfgi_light[cell] = uvec2(0u, SDFGI_LIGHT_VALID);
}

void main()
{
    const uint i = gl_LocalInvocationIndex, row = gl_WorkGroupID.x;
    const uint slot = light_block_slot(row * SDFGI_GROUP_LINEAR + i);
    masks[i] = uvec2(sdfgi_scratch[slot], sdfgi_scratch[slot + 1u]);
    light_running_sum(bitCount(masks[i].x) + bitCount(masks[i].y));
    const uint start = sdfgi_scratch[light_row_slot(row)], count = light_sums[SDFGI_GROUP_LINEAR - 1];
    for (uint n = i; n < count; n += SDFGI_GROUP_LINEAR) {
        const uint block = block_of(n), before = block > 0u ? light_sums[block - 1u] : 0u;
        const uint bit = bit_of(masks[block], n - before);
        const uvec3 inside = uvec3(bit, bit >> 2u, bit >> 4u) & 3u;
        write_cell(start + n, 4u * light_block_coords(row * SDFGI_GROUP_LINEAR + block) + inside);
    }
}
