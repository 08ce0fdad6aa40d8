/* SPDX-License-Identifier: MIT
 * Light blocks, and the scratch buffer while the list of light cells is made again. Light blocks are 4^3
 * texels. They are numbered by where they are stored, so that the list of a cascade that has scrolled to a
 * place is the same as that of one built there. A block is dirty if its cage touches a dirty box.
 *
 * In the scratch buffer (shared/scratch.h has the offsets):
 *
 * - per block six words, of eight: two with a bit per light cell, x + 4 y + 16 z; 1 if the block is dirty;
 * the first entry of its cells in the previous list; and, of dirty blocks, two with the bits of that list;
 * - per row of SDFGI_GROUP_LINEAR blocks two words: how many light cells it has, and how many in dirty
 * blocks;
 * - per entry of the previous list sdfgi_scratch_light_words: its direct light, its outgoing light and its
 *   irradiance along six axes, what it has gathered, and from where;
 * - per light cell in a dirty block, in the order of the list, two words: its entry and its texel index.
 *
 * The host clears blocks and rows to 0 before light_mark. */
#ifndef SDFGI_LIGHT_BLOCKS_GLSL
#define SDFGI_LIGHT_BLOCKS_GLSL

#include "light_cells.glsl"

uint light_block_side_bits()
{
    return sdfgi_frame.resolution_log2 - 2u;
}

uint light_block_from_coords(uvec3 block)
{
    const uint bits = light_block_side_bits();
    return block.x | block.y << bits | block.z << (2u * bits);
}

uvec3 light_block_coords(uint block)
{
    const uint bits = light_block_side_bits(), mask = (1u << bits) - 1u;
    return uvec3(block & mask, block >> bits & mask, block >> (2u * bits));
}

/* First of a block's words. */
uint light_block_slot(uint block)
{
    return 8u * block;
}

/* Index in sdfgi_light_blocks of a block's first half; the other one follows. */
uint light_block_record(uint cascade, uint block)
{
    return 2u * (block | cascade << (3u * light_block_side_bits()));
}

/* What sdfgi_light_blocks holds for half a block: `bits` are those of the block, and `first` is the entry of
 * its first light cell. */
uvec2 light_block_half(uvec2 bits, uint first, bool is_upper)
{
    return is_upper ? uvec2(bits.y, first + uint(bitCount(bits.x))) : uvec2(bits.x, first);
}

uint light_block_count()
{
    return 1u << (3u * light_block_side_bits());
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

const uint LIGHT_KEPT_DIRECT = 0u, LIGHT_KEPT_LIGHT = uint(SDFGI_DIRECT_WORDS),
           LIGHT_KEPT_SURFACES = LIGHT_KEPT_LIGHT + 6u, LIGHT_KEPT_GATHERED = LIGHT_KEPT_SURFACES + 6u,
           LIGHT_KEPT_LOW = LIGHT_KEPT_GATHERED + uint(SDFGI_GATHERED_WORDS);

/* Word `k` of what an entry of the previous list held, from LIGHT_KEPT_* on. Threads that follow one another
 * take entries that do. */
uint light_previous_slot(uint entry, uint k)
{
    return sdfgi_scratch_light_before(sdfgi_frame.resolution_log2) + k * sdfgi_frame.light_cell_room + entry;
}

/* First of the two words of the n-th light cell in dirty blocks. */
uint light_dirty_slot(uint n)
{
    return sdfgi_scratch_light_dirty(sdfgi_frame.resolution_log2, sdfgi_frame.light_cell_room,
                                     sdfgi_frame.keeps_low_light != 0u) +
           2u * n;
}

/* Finds the n-th entry to light: of the light cells in dirty blocks, or of the range [first, end). False if
 * there is none. */
bool light_entry(uint cascade, bool only_dirty, uint first, uint end, uint n, out uint entry)
{
    const uint count = only_dirty ? indirect_number(uint(SDFGI_INDIRECT_MASKS) + cascade) : end - first;
    entry = n;
    if (n < count)
        entry = only_dirty ? sdfgi_scratch_at(light_dirty_slot(n)) : first + n;
    return n < count && entry < light_cell_count(cascade);
}

#endif
