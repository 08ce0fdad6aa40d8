/* SPDX-License-Identifier: MIT
 * Marks the light cells, empty ones with an occupied face neighbour. In renewed blocks they are looked for,
 * and all others forget their light; in other blocks they are those of the list before, whose direct light is
 * taken out of it here. A thread per entry of the list before; workgroups share the blocks of 4^3 texels that
 * may be renewed, a thread per cell. */
#version 460
#extension GL_GOOGLE_include_directive : require
#define SDFGI_WRITES_LIGHT
#define SDFGI_WRITES_MASKS
#include "dirty.glsl"
#include "light_blocks.glsl"

layout(local_size_x = SDFGI_GROUP_LINEAR) in;
layout(push_constant) uniform sdfgi_push
{
    sdfgi_light_mark_args args;
};

layout(std430, set = SDFGI_SET_WORK, binding = SDFGI_BINDING_INDIRECT) readonly buffer sdfgi_indirect_buffer
{
    uint sdfgi_indirect[];
};

shared uint mask[2];

/* In the list before, unclamped. */
uint count_before()
{
    return sdfgi_indirect[4u * (uint(SDFGI_INDIRECT_CELLS) + args.cascade) + 3u];
}

bool is_light_cell(ivec3 cell)
{
    const float distance = sdfgi_cell_distance(args.cascade, cell);
    /* Further than this no face neighbour can hold a sub-voxel: sqrt(1.375^2 + 2 * 0.375^2) and the flood's
     * 0.1. */
    return distance < 1.6 && sdfgi_cell_bits(args.cascade, cell) == uvec2(0u) &&
           light_cell_facing(args.cascade, cell) != 0u;
}

void forget(uint index)
{
    sdfgi_light[index] = uvec2(0u);
    atomicAnd(sdfgi_masks[index >> 2u], ~(0xffu << (8u * (index & 3u))));
}

uint block_of_entry(uint entry)
{
    const uint index = sdfgi_light_cells[light_cell_slot(args.cascade, entry)];
    return light_block_from_coords(sdfgi_texel_from_index(index) / SDFGI_GROUP_CELLS);
}

/* Where the list was too short, blocks from its last entry on may hold cells that have room this time. */
bool lacked_room(uint block)
{
    const uint room = sdfgi_frame.light_cell_room;
    return count_before() > room && block >= block_of_entry(room - 1u);
}

bool is_dirty(uint block)
{
    const ivec3 cage =
        sdfgi_cell_from_texel(args.cascade, 4u * light_block_coords(block)) / SDFGI_PROBE_SPACING;
    return args.rebuild != 0u ||
           dirty_near(args.cascade, cage * SDFGI_PROBE_SPACING, (cage + 1) * SDFGI_PROBE_SPACING, 0) ||
           lacked_room(block);
}

uint row_of(uint block)
{
    return light_row_slot(block / SDFGI_GROUP_LINEAR);
}

void keep_entry(uint entry)
{
    const uint count = min(count_before(), sdfgi_frame.light_cell_room);
    if (args.rebuild != 0u || entry >= count)
        return;
    const uint block = block_of_entry(entry);
    if (is_dirty(block))
        return;
    const uint slot = light_cell_slot(args.cascade, entry), before = light_before_slot(entry);
    sdfgi_scratch[before] = sdfgi_light_cells[slot + 1u];
    sdfgi_scratch[before + 1u] = sdfgi_light_cells[slot + 2u];
    const uvec3 inside = sdfgi_texel_from_index(sdfgi_light_cells[slot]) & 3u;
    const uint bit = inside.x | inside.y << 2u | inside.z << 4u;
    atomicOr(sdfgi_scratch[light_block_slot(block) + (bit >> 5u)], 1u << (bit & 31u));
    /* Its block's cells are one after another: their number is the last one's place less the first one's. */
    if (entry == 0u || block_of_entry(entry - 1u) != block) {
        sdfgi_scratch[light_block_slot(block) + 3u] = entry;
        atomicAdd(sdfgi_scratch[row_of(block)], 0u - entry);
    }
    if (entry + 1u == count || block_of_entry(entry + 1u) != block)
        atomicAdd(sdfgi_scratch[row_of(block)], entry + 1u);
}

/* Without a list before, or with one that was too short, any block may be renewed. */
bool searches_all()
{
    return args.rebuild != 0u || count_before() > sdfgi_frame.light_cell_room;
}

/* Cells whose cages touch a box that changed. */
void dirty_cells(int box, out ivec3 low, out ivec3 high)
{
    const ivec3 end = ivec3(sdfgi_space_resolution());
    low = clamp(sdfgi_frame.cascades[args.cascade].dirty[box].low - SDFGI_PROBE_SPACING, ivec3(0), end);
    high = clamp(sdfgi_frame.cascades[args.cascade].dirty[box].high + SDFGI_PROBE_SPACING, ivec3(0), end);
}

bool in_earlier_box(int box, ivec3 cell)
{
    for (int i = 0; i < box; i++) {
        ivec3 low, high;
        dirty_cells(i, low, high);
        if (all(greaterThanEqual(cell, low)) && all(lessThan(cell, high)))
            return true;
    }
    return false;
}

/* The n-th of the blocks in question: those that boxes which changed name, box by box. False if it is not
 * renewed, or an earlier box has it; `more` is false beyond the last one. */
bool dirty_block(uint n, out uint block, out bool more)
{
    block = n;
    more = false;
    if (searches_all()) {
        more = n < light_block_count();
        return more && is_dirty(n);
    }
    for (int i = 0; i < dirty_count(args.cascade); i++) {
        ivec3 low, high;
        dirty_cells(i, low, high);
        const uvec3 size = uvec3(max(high - low, ivec3(0))) / 4u;
        const uint blocks = size.x * size.y * size.z;
        if (n < blocks) {
            const ivec3 cell = low + 4 * ivec3(n % size.x, n / size.x % size.y, n / (size.x * size.y));
            block = light_block_from_coords(sdfgi_cell_texel(args.cascade, cell) / 4u);
            more = true;
            return !in_earlier_box(i, cell);
        }
        n -= blocks;
    }
    return false;
}

/* Called by the whole workgroup. */
void mark_block(uint block)
{
    const uint bit = gl_LocalInvocationIndex;
    if (bit < 2u)
        mask[bit] = 0u;
    barrier();
    const uvec3 inside = uvec3(bit, bit >> 2u, bit >> 4u) & 3u;
    const ivec3 cell = sdfgi_cell_from_texel(args.cascade, 4u * light_block_coords(block) + inside);
    const uint index = sdfgi_cell_index(args.cascade, cell);
    if (is_light_cell(cell))
        atomicOr(mask[bit >> 5u], 1u << (bit & 31u));
    else if (sdfgi_light[index] != uvec2(0u))
        forget(index);
    barrier();
    const uint count = bitCount(mask[0]) + bitCount(mask[1]);
    if (bit > 0u || count == 0u)
        return;
    const uint slot = light_block_slot(block);
    sdfgi_scratch[slot] = mask[0];
    sdfgi_scratch[slot + 1u] = mask[1];
    sdfgi_scratch[slot + 2u] = 1u;
    atomicAdd(sdfgi_scratch[row_of(block)], count);
    atomicAdd(sdfgi_scratch[row_of(block) + 1u], count);
}

void main()
{
    for (uint entry = gl_GlobalInvocationID.x; entry < sdfgi_frame.light_cell_room;
         entry += gl_NumWorkGroups.x * SDFGI_GROUP_LINEAR)
        keep_entry(entry);
    bool more = true;
    for (uint n = gl_WorkGroupID.x; more; n += gl_NumWorkGroups.x) {
        uint block;
        if (dirty_block(n, block, more))
            mark_block(block);
        barrier();
    }
}
