/* SPDX-License-Identifier: MIT
 * Writes the list of light cells that light_mark has marked, in the order of their blocks and of the bits in
 * a block; and apart from it the list of those in dirty blocks, with the indirect arguments of the passes
 * that light them. A cell that was a light cell before, with the same surfaces, keeps its light and what it
 * has gathered; outside dirty blocks it keeps its direct light and its visibility bits, too. A new light cell
 * begins dark.
 *
 * The workgroups of a column, which have the same gl_WorkGroupID.x, share the cells of one row of blocks. */
#version 460
#extension GL_GOOGLE_include_directive : require
#define SDFGI_WRITES_DIRECT
#define SDFGI_WRITES_GATHERED
#define SDFGI_WRITES_INDIRECT
#define SDFGI_WRITES_LIGHT
#define SDFGI_WRITES_LIGHT_BLOCKS
#define SDFGI_WRITES_LIGHT_CELLS
#define SDFGI_WRITES_SCRATCH
#define SDFGI_WRITES_SEEN
#define SDFGI_WRITES_SURFACES
#include "../lib/on_cpu.glsl"
#include "gathered.glsl"
#include "light_blocks.glsl"
#include "low_lights.glsl"
#include "../include/sdfgi_cells.glsl"
#include "../lib/nth_bit.glsl"

layout(local_size_x = SDFGI_GROUP_LINEAR) in;
SDFGI_PUSH(sdfgi_cascade_args);

/* The blocks of the row, four words each as in the scratch buffer. */
shared uvec4 blocks[SDFGI_GROUP_LINEAR];
/* Inclusive prefix sums over the threads. x, y: light cells of the row's blocks, and those in dirty blocks.
 * z, w: the same of all earlier rows, complete in the last element. */
shared uvec4 sums[SDFGI_GROUP_LINEAR];

void prefix_sum(uvec4 value)
{
    const uint i = gl_LocalInvocationIndex;
    sums[i] = value;
    barrier();
    for (uint back = 1u; back < SDFGI_GROUP_LINEAR; back *= 2u) {
        const uvec4 earlier = i >= back ? sums[i - back] : uvec4(0u);
        barrier();
        sums[i] += earlier;
        barrier();
    }
}

/* This thread's part of the counts of earlier rows. */
uvec2 part_of_earlier_rows(uint row)
{
    uvec2 sum = uvec2(0u);
    for (uint r = gl_LocalInvocationIndex; r < row; r += SDFGI_GROUP_LINEAR)
        sum += uvec2(sdfgi_scratch_at(light_row_slot(r)), sdfgi_scratch_at(light_row_slot(r) + 1u));
    return sum;
}

/* Writes the arguments of a dispatch with so many cells per workgroup. Workgroups beyond SDFGI_MAX_GROUPS
 * continue along y. */
void write_groups(uint record, uint cells, uint per_group)
{
    const uint groups = (cells + per_group - 1u) / per_group, most = uint(SDFGI_MAX_GROUPS);
    sdfgi_indirect[4u * record] = min(groups, most);
    sdfgi_indirect[4u * record + 1u] = (groups + most - 1u) / most;
    sdfgi_indirect[4u * record + 2u] = 1u;
}

/* total.x: all light cells; total.y: those in dirty blocks. */
void write_totals(uvec2 total)
{
    sdfgi_counters[SDFGI_COUNTER_LIGHT_CELLS + args.cascade] = total.x;
    sdfgi_counters[SDFGI_COUNTER_LIGHT_DIRTY + args.cascade] = total.y;
    const uint dirty = min(total.y, sdfgi_frame.light_cell_room);
    sdfgi_indirect[4u * (uint(SDFGI_INDIRECT_CELLS) + args.cascade) + 3u] = total.x;
    sdfgi_indirect[4u * (uint(SDFGI_INDIRECT_MASKS) + args.cascade) + 3u] = dirty;
    write_groups(uint(SDFGI_INDIRECT_CELLS) + args.cascade, dirty, SDFGI_GROUP_LINEAR);
    write_groups(uint(SDFGI_INDIRECT_MASKS) + args.cascade, dirty, SDFGI_GROUP_LINEAR / 8u);
    write_groups(uint(SDFGI_INDIRECT_DIRECT) + args.cascade, dirty, SDFGI_CELLS_OF_SURFACES);
}

/* The block of the row that holds its n-th light cell: the first whose prefix sum exceeds n. */
uint find_block(uint n)
{
    uint block = 0u;
    for (uint half_width = SDFGI_GROUP_LINEAR / 2u; half_width > 0u; half_width /= 2u)
        if (sums[block + half_width - 1u].x <= n)
            block += half_width;
    return block;
}

/* Position of the n-th set bit, from 0. */
uint find_bit(uvec2 bits, uint n)
{
    const uint low = bitCount(bits.x);
    const bool high = n >= low;
    const uint bit = sdfgi_nth_bit(high ? bits.y : bits.x, high ? n - low : n);
    return high ? bit + 32u : bit;
}

/* Takes over what an entry of the previous list held. */
void take_over(uint entry, uint previous)
{
    for (uint axis = 0u; axis < 6u; axis++) {
        const uint index = sdfgi_surface_index(args.cascade, entry, axis);
        sdfgi_light[index] = sdfgi_scratch_at(light_previous_slot(previous, LIGHT_KEPT_LIGHT + axis));
        sdfgi_surfaces[index] = sdfgi_scratch_at(light_previous_slot(previous, LIGHT_KEPT_SURFACES + axis));
    }
    for (uint axis = 0u; keeps_low_light() && axis < 6u; axis++)
        sdfgi_seen[low_light_word(sdfgi_surface_index(args.cascade, entry, axis))] =
            sdfgi_scratch_at(light_previous_slot(previous, LIGHT_KEPT_LOW + axis));
    for (uint k = 0u; gathers() && k < SDFGI_GATHERED_WORDS; k++)
        sdfgi_gathered[gathered_word(args.cascade, k, entry)] =
            sdfgi_scratch_at(light_previous_slot(previous, LIGHT_KEPT_GATHERED + k));
}

void begin_dark(uint entry)
{
    for (uint axis = 0u; axis < 6u; axis++) {
        const uint index = sdfgi_surface_index(args.cascade, entry, axis);
        sdfgi_light[index] = 0u;
        sdfgi_surfaces[index] = SDFGI_SURFACE_NONE;
    }
    for (uint axis = 0u; keeps_low_light() && axis < 6u; axis++)
        sdfgi_seen[low_light_word(sdfgi_surface_index(args.cascade, entry, axis))] = 0u;
    for (uint k = 0u; gathers() && k < SDFGI_GATHERED_WORDS; k++)
        sdfgi_gathered[gathered_word(args.cascade, k, entry)] = 0u;
}

/* True if surfaces face along the same axes as before: otherwise the cell knows nothing of some of them. */
bool faces_as_before(ivec3 cell, uint previous)
{
    uint before = 0u;
    for (uint axis = 0u; axis < 6u; axis++)
        if (sdfgi_scratch_at(light_previous_slot(previous, LIGHT_KEPT_SURFACES + axis)) != SDFGI_SURFACE_NONE)
            before |= 1u << axis;
    return before == light_cell_facing(args.cascade, cell);
}

/* The entry in the previous list of a cell of a dirty block. False if it was no light cell, or another cell
 * was stored in its texel. */
bool find_previous(uint block, uvec3 texel, out uint previous)
{
    const uint slot = light_block_slot(block);
    const uvec2 bits = uvec2(sdfgi_scratch_at(slot + 4u), sdfgi_scratch_at(slot + 5u));
    const uvec2 before = light_block_half(bits, sdfgi_scratch_at(slot + 3u), (texel.z & 2u) != 0u);
    const ivec3 cell = sdfgi_cell_from_texel(args.cascade, texel);
    return sdfgi_light_block_entry(before, texel, previous) &&
           all(greaterThanEqual(cell, sdfgi_frame.cascades[args.cascade].kept_low)) &&
           all(lessThan(cell, sdfgi_frame.cascades[args.cascade].kept_high));
}

/* Lists the n-th light cell in dirty blocks. A cell for which the list has no room is counted, but nothing
 * lights it. */
void list_dirty_cell(uint block, uint entry, uint n, uvec3 texel)
{
    const uint index = sdfgi_texel_index(texel);
    if (n < sdfgi_frame.light_cell_room) {
        sdfgi_scratch[light_dirty_slot(n)] = entry;
        sdfgi_scratch[light_dirty_slot(n) + 1u] = index;
    }
    if (entry >= sdfgi_frame.light_cell_room)
        return;
    const uint slot = light_cell_slot(args.cascade, entry);
    sdfgi_light_cells[slot] = index;
    direct_store(args.cascade, entry, uvec2(0u, SDFGI_LIGHT_VALID), direct_lights_pack(0u, 0u));
    uint previous;
    if (find_previous(block, texel, previous) &&
        faces_as_before(sdfgi_cell_from_texel(args.cascade, texel), previous))
        take_over(entry, previous);
    else
        begin_dark(entry);
}

/* Lists a light cell that was entry `previous` of the previous list. */
void list_kept_cell(uint entry, uint previous, uvec3 texel)
{
    if (entry >= sdfgi_frame.light_cell_room)
        return;
    const uint slot = light_cell_slot(args.cascade, entry);
    sdfgi_light_cells[slot] = sdfgi_texel_index(texel);
    for (uint k = 0u; k < uint(SDFGI_DIRECT_WORDS); k++)
        sdfgi_direct[direct_word(args.cascade, k, entry)] =
            sdfgi_scratch_at(light_previous_slot(previous, LIGHT_KEPT_DIRECT + k));
    take_over(entry, previous);
}

/* Tells lookups which cells of a block are light cells, and the entry of the first. */
void publish_block(uint block, uvec2 bits, uint first)
{
    const uint record = light_block_record(args.cascade, block);
    sdfgi_light_blocks[record] = light_block_half(bits, first, false);
    sdfgi_light_blocks[record + 1u] = light_block_half(bits, first, true);
}

void main()
{
    const uint i = gl_LocalInvocationIndex, row = gl_WorkGroupID.x;
    const bool is_last_row = row + 1u == light_row_count();
    if (sdfgi_scratch_at(light_row_slot(row)) == 0u && !is_last_row)
        return;
    const uint slot = light_block_slot(row * SDFGI_GROUP_LINEAR + i);
    blocks[i] = uvec4(sdfgi_scratch_at(slot), sdfgi_scratch_at(slot + 1u), sdfgi_scratch_at(slot + 2u),
                      sdfgi_scratch_at(slot + 3u));
    const uint own = bitCount(blocks[i].x) + bitCount(blocks[i].y);
    prefix_sum(uvec4(own, own * blocks[i].z, part_of_earlier_rows(row)));
    const uvec2 start = sums[SDFGI_GROUP_LINEAR - 1].zw, count = sums[SDFGI_GROUP_LINEAR - 1].xy;
    if (is_last_row && i == 0u && gl_WorkGroupID.y == 0u)
        write_totals(start + count);
    if (gl_WorkGroupID.y == 0u)
        publish_block(row * SDFGI_GROUP_LINEAR + i, blocks[i].xy, start.x + sums[i].x - own);
    for (uint n = i + SDFGI_GROUP_LINEAR * gl_WorkGroupID.y; n < count.x;
         n += SDFGI_GROUP_LINEAR * gl_NumWorkGroups.y) {
        const uint block = find_block(n);
        const uvec2 earlier = block > 0u ? sums[block - 1u].xy : uvec2(0u);
        const uint rank = n - earlier.x; /* of the cell in its block */
        const uint bit = find_bit(blocks[block].xy, rank);
        const uvec3 inside = uvec3(bit, bit >> 2u, bit >> 4u) & 3u;
        const uvec3 texel = 4u * light_block_coords(row * SDFGI_GROUP_LINEAR + block) + inside;
        if (blocks[block].z != 0u)
            list_dirty_cell(row * SDFGI_GROUP_LINEAR + block, start.x + n, start.y + earlier.y + rank, texel);
        else
            list_kept_cell(start.x + n, blocks[block].w + rank, texel);
    }
}
