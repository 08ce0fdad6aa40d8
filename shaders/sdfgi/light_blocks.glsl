/* SPDX-License-Identifier: MIT
 * The scratch buffer while light cells are listed: per block of 4^3 texels a bit per light cell, x + 4 y + 16 z, then per
 * row of SDFGI_GROUP_LINEAR blocks how many cells it has, from light_args on where they begin in the list. Blocks are
 * numbered by where they are stored, so that a cascade that scrolled here lists what one built here lists. */
#ifndef SDFGI_LIGHT_BLOCKS_GLSL
#define SDFGI_LIGHT_BLOCKS_GLSL

#include "light_cells.glsl"

shared uint light_sums[SDFGI_GROUP_LINEAR];

uint light_block_bits()
{
    return sdfgi_frame.size.y - 2u;
}

uint light_block_from_coords(uvec3 block)
{
    const uint bits = light_block_bits();
    return block.x | block.y << bits | block.z << (2u * bits);
}

uvec3 light_block_coords(uint block)
{
    const uint bits = light_block_bits(), mask = (1u << bits) - 1u;
    return uvec3(block & mask, block >> bits & mask, block >> (2u * bits));
}

/* First word of a block's mask. */
uint light_block_slot(uint block)
{
    return 2u * block;
}

uint light_row_count()
{
    return (1u << (3u * light_block_bits())) / SDFGI_GROUP_LINEAR;
}

uint light_row_slot(uint row)
{
    return light_block_slot(SDFGI_GROUP_LINEAR * light_row_count()) + row;
}

/* Sum of `value` over this thread and those before it in the workgroup, left in light_sums too. */
uint light_running_sum(uint value)
{
    const uint i = gl_LocalInvocationIndex;
    light_sums[i] = value;
    barrier();
    for (uint step = 1u; step < SDFGI_GROUP_LINEAR; step *= 2u) {
        const uint before = i >= step ? light_sums[i - step] : 0u;
        barrier();
        light_sums[i] += before;
        barrier();
    }
    return light_sums[i];
}

#endif
