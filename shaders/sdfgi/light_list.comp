/* SPDX-License-Identifier: MIT
 * Writes the list of light cells in the order of blocks and of bits in them, and apart those in renewed
 * blocks; their numbers, and the indirect arguments of passes over the latter. Cells that were light cells
 * before keep their light, outside renewed blocks their direct light and masks too; new ones begin dark. A
 * row of blocks is shared by the workgroups of a column, a cell to a thread in turn. */
#version 460
#extension GL_GOOGLE_include_directive : require
#define SDFGI_WRITES_LIGHT
#include "light_blocks.glsl"

layout(local_size_x = SDFGI_GROUP_LINEAR) in;
layout(push_constant) uniform sdfgi_push
{
    sdfgi_cascade_args args;
};
layout(std430, set = SDFGI_SET_WORK, binding = SDFGI_BINDING_INDIRECT) buffer sdfgi_indirect_buffer
{
    uint sdfgi_indirect[];
};

shared uvec4 blocks[SDFGI_GROUP_LINEAR]; /* as in the scratch buffer */
/* Running sums over the threads: cells of the row, those in renewed blocks; the same of earlier rows. */
shared uvec4 sums[SDFGI_GROUP_LINEAR];

void sum_up(uvec4 value)
{
    const uint i = gl_LocalInvocationIndex;
    sums[i] = value;
    barrier();
    for (uint step = 1u; step < SDFGI_GROUP_LINEAR; step *= 2u) {
        const uvec4 before = i >= step ? sums[i - step] : uvec4(0u);
        barrier();
        sums[i] += before;
        barrier();
    }
}

/* This thread's share of the cells in earlier rows. */
uvec2 count_before(uint row)
{
    uvec2 sum = uvec2(0u);
    for (uint r = gl_LocalInvocationIndex; r < row; r += SDFGI_GROUP_LINEAR)
        sum += uvec2(sdfgi_scratch[light_row_slot(r)], sdfgi_scratch[light_row_slot(r) + 1u]);
    return sum;
}

/* Workgroups that take so many cells each, in rows of as many as every device takes. */
void write_groups(uint record, uint cells, uint per_group)
{
    const uint groups = (cells + per_group - 1u) / per_group, most = uint(SDFGI_MAX_GROUPS);
    sdfgi_indirect[4u * record] = min(groups, most);
    sdfgi_indirect[4u * record + 1u] = (groups + most - 1u) / most;
    sdfgi_indirect[4u * record + 2u] = 1u;
}

void write_totals(uvec2 total)
{
    sdfgi_counters[SDFGI_COUNTER_LIGHT_CELLS + args.cascade] = total.x;
    sdfgi_counters[SDFGI_COUNTER_LIGHT_DIRTY + args.cascade] = total.y;
    const uint renewed = min(total.y, sdfgi_frame.light_cell_room);
    sdfgi_indirect[4u * (uint(SDFGI_INDIRECT_CELLS) + args.cascade) + 3u] = total.x;
    sdfgi_indirect[4u * (uint(SDFGI_INDIRECT_MASKS) + args.cascade) + 3u] = renewed;
    write_groups(uint(SDFGI_INDIRECT_CELLS) + args.cascade, renewed, SDFGI_GROUP_LINEAR);
    write_groups(uint(SDFGI_INDIRECT_MASKS) + args.cascade, renewed, SDFGI_GROUP_LINEAR / 8u);
    write_groups(uint(SDFGI_INDIRECT_DIRECT) + args.cascade, renewed, SDFGI_CELLS_OF_SURFACES);
}

/* First block of the row whose running sum exceeds `n`. */
uint block_of(uint n)
{
    uint block = 0u;
    for (uint step = SDFGI_GROUP_LINEAR / 2u; step > 0u; step /= 2u)
        if (sums[block + step - 1u].x <= n)
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

/* Index of a cell in its cascade, then in all. */
uvec2 cell_at(uvec3 texel)
{
    const uint index = sdfgi_texel_index(texel);
    return uvec2(index, index | args.cascade << (3u * sdfgi_frame.resolution_log2));
}

bool has_room(uint entry, uint cell)
{
    const bool room = entry < sdfgi_frame.light_cell_room;
    if (!room)
        sdfgi_light[cell] = uvec2(0u); /* counted, but without room nobody lights it */
    return room;
}

/* A cell in a renewed block, the n-th of those. */
void dirty_cell(uint entry, uint n, uvec3 texel)
{
    const uvec2 at = cell_at(texel);
    if (n < sdfgi_frame.light_cell_room) {
        sdfgi_scratch[light_dirty_slot(n)] = entry;
        sdfgi_scratch[light_dirty_slot(n) + 1u] = at.x;
    }
    if (!has_room(entry, at.y))
        return;
    const uint slot = light_cell_slot(args.cascade, entry);
    sdfgi_light_cells[slot] = at.x;
    light_cell_store_direct(slot, uvec2(0u, SDFGI_LIGHT_VALID));
    if ((sdfgi_light[at.y].y & SDFGI_LIGHT_VALID) == 0u)
        sdfgi_light[at.y] = uvec2(0u, SDFGI_LIGHT_VALID);
}

/* A cell that was entry `before` of the list before. */
void keep_cell(uint entry, uint before, uvec3 texel)
{
    const uvec2 at = cell_at(texel);
    if (!has_room(entry, at.y))
        return;
    const uint slot = light_cell_slot(args.cascade, entry), from = light_before_slot(before);
    sdfgi_light_cells[slot] = at.x;
    light_cell_store_direct(slot, uvec2(sdfgi_scratch[from], sdfgi_scratch[from + 1u]));
}

void main()
{
    const uint i = gl_LocalInvocationIndex, row = gl_WorkGroupID.x;
    const bool last = row + 1u == light_row_count();
    if (sdfgi_scratch[light_row_slot(row)] == 0u && !last)
        return;
    const uint slot = light_block_slot(row * SDFGI_GROUP_LINEAR + i);
    blocks[i] = uvec4(sdfgi_scratch[slot], sdfgi_scratch[slot + 1u], sdfgi_scratch[slot + 2u],
                      sdfgi_scratch[slot + 3u]);
    const uint own = bitCount(blocks[i].x) + bitCount(blocks[i].y);
    sum_up(uvec4(own, own * blocks[i].z, count_before(row)));
    const uvec2 start = sums[SDFGI_GROUP_LINEAR - 1].zw, count = sums[SDFGI_GROUP_LINEAR - 1].xy;
    if (last && i == 0u && gl_WorkGroupID.y == 0u)
        write_totals(start + count);
    for (uint n = i + SDFGI_GROUP_LINEAR * gl_WorkGroupID.y; n < count.x;
         n += SDFGI_GROUP_LINEAR * gl_NumWorkGroups.y) {
        const uint block = block_of(n);
        const uvec2 before = block > 0u ? sums[block - 1u].xy : uvec2(0u);
        const uint rank = n - before.x, bit = bit_of(blocks[block].xy, rank);
        const uvec3 inside = uvec3(bit, bit >> 2u, bit >> 4u) & 3u;
        const uvec3 texel = 4u * light_block_coords(row * SDFGI_GROUP_LINEAR + block) + inside;
        if (blocks[block].z != 0u)
            dirty_cell(start.x + n, start.y + before.y + rank, texel);
        else
            keep_cell(start.x + n, blocks[block].w + rank, texel);
    }
}
