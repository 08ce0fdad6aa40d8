/* SPDX-License-Identifier: MIT
 * The scratch buffer while light cells are listed. Blocks are 4^3 texels, numbered by where they are stored,
 * so that a cascade that scrolled here lists what one built here lists; a block is *renewed* if something new
 * touches its cage. Zero at first, but for direct light and entries. per block  a bit per light cell, x + 4 y
 * + 16 z, in two words; 1 if it is renewed; where its cells began in the list before per row    of
 * SDFGI_GROUP_LINEAR blocks: how many cells it has, and how many in renewed blocks per entry  of the list
 * before, its direct light per cell   in a renewed block, in the order of the list, its entry and its texel
 * index */
#ifndef SDFGI_LIGHT_BLOCKS_GLSL
#define SDFGI_LIGHT_BLOCKS_GLSL

#include "light_cells.glsl"

uint light_block_bits()
{
    return sdfgi_frame.resolution_log2 - 2u;
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
    return sdfgi_scratch_light_rows(sdfgi_frame.resolution_log2) + 2u * row;
}

/* First of the two words of direct light that an entry of the list before had. */
uint light_before_slot(uint entry)
{
    return sdfgi_scratch_light_before(sdfgi_frame.resolution_log2) + 2u * entry;
}

/* The entry of the n-th cell in renewed blocks, then its texel index. */
uint light_dirty_slot(uint n)
{
    return sdfgi_scratch_light_dirty(sdfgi_frame.resolution_log2, sdfgi_frame.light_cell_room) + 2u * n;
}

/* Where there are more workgroups than fit a row. */
uint light_group()
{
    return gl_WorkGroupID.x + gl_NumWorkGroups.x * gl_WorkGroupID.y;
}

/* The n-th entry of the cells in dirty blocks, or of the range [first, end). Returns false if there is none.
 */
bool light_entry(uint cascade, bool only_dirty, uint first, uint end, uint n, out uint entry)
{
    const uint count =
        only_dirty ? min(sdfgi_counters[SDFGI_COUNTER_LIGHT_DIRTY + cascade], sdfgi_frame.light_cell_room)
                   : end - first;
    entry = n;
    if (n < count)
        entry = only_dirty ? sdfgi_scratch[light_dirty_slot(n)] : first + n;
    return n < count && entry < light_cell_count(cascade);
}

#endif
