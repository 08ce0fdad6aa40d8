/* SPDX-License-Identifier: MIT
 * The scratch buffer while light cells are listed. Blocks are 4^3 texels, numbered by where they are stored, so that a
 * cascade that scrolled here lists what one built here lists; a block is *renewed* if something new touches its cage. Zero at
 * first, but for direct light and entries.
 *   per block  a bit per light cell, x + 4 y + 16 z, in two words; 1 if it is renewed; where its cells began in the list before
 *   per row    of SDFGI_GROUP_LINEAR blocks: how many cells it has, and how many in renewed blocks
 *   per entry  of the list before, its direct light
 *   per cell   in a renewed block, in the order of the list, its entry and its texel index */
#ifndef SDFGI_LIGHT_BLOCKS_GLSL
#define SDFGI_LIGHT_BLOCKS_GLSL

#include "light_cells.glsl"

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

/* First of a block's four words. */
uint light_block_slot(uint block)
{
    return 4u * block;
}

uint light_block_count()
{
    return 1u << (3u * light_block_bits());
}

uint light_row_count()
{
    return light_block_count() / SDFGI_GROUP_LINEAR;
}

/* First of a row's two words. */
uint light_row_slot(uint row)
{
    return light_block_slot(SDFGI_GROUP_LINEAR * light_row_count()) + 2u * row;
}

/* First of the two words of direct light that an entry of the list before had. */
uint light_before_slot(uint entry)
{
    return light_row_slot(light_row_count()) + 2u * entry;
}

/* The entry of the n-th cell in renewed blocks, then its texel index. */
uint light_renewed_slot(uint n)
{
    return light_before_slot(sdfgi_frame.light.y) + 2u * n;
}

/* Where there are more workgroups than fit a row. */
uint light_group()
{
    return gl_WorkGroupID.x + gl_NumWorkGroups.x * gl_WorkGroupID.y;
}

/* The entry that is a pass's n-th: of the cells in renewed blocks where args.step = 1, else of those from args.low.x up to
 * args.high.x. False if there is none. */
bool light_entry(sdfgi_pass_args args, uint cascade, uint n, out uint entry)
{
    const bool renewed = args.step != 0u;
    const uint end = renewed ? min(sdfgi_counters[SDFGI_COUNTER_LIGHT_RENEWED + cascade], sdfgi_frame.light.y)
                             : uint(args.high.x - args.low.x);
    entry = n;
    if (n < end)
        entry = renewed ? sdfgi_scratch[light_renewed_slot(n)] : uint(args.low.x) + n;
    return n < end && entry < light_cell_count(cascade);
}

#endif
