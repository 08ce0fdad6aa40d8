/* SPDX-License-Identifier: MIT
 * Marks the light cells, empty ones with an occupied face neighbour. In renewed blocks they are looked for, and all others
 * forget their light; in other blocks they are those of the list before, whose direct light is taken out of it here. One
 * workgroup per block of 4^3 texels; a thread per cell, and per entry of the list before. */
#version 460
#extension GL_GOOGLE_include_directive : require
#define SDFGI_WRITES_LIGHT
#define SDFGI_WRITES_MASKS
#include "changed.glsl"
#include "light_blocks.glsl"

layout(local_size_x = SDFGI_GROUP_CELLS, local_size_y = SDFGI_GROUP_CELLS, local_size_z = SDFGI_GROUP_CELLS) in;
layout(push_constant) uniform sdfgi_push { sdfgi_pass_args args; };

shared uint mask[2];

bool is_light_cell(ivec3 cell)
{
    const float distance = cell_distance(args.cascade, cell);
    /* Further than this no face neighbour can hold a sub-voxel: sqrt(1.375^2 + 2 * 0.375^2) and the flood's 0.1. */
    return distance < 1.6 && cell_bits(args.cascade, cell) == uvec2(0u) && light_cell_facing(args.cascade, cell) != 0u;
}

void forget(uint index)
{
    sdfgi_light[index] = uvec2(0u);
    atomicAnd(sdfgi_masks[index >> 2u], ~(0xffu << (8u * (index & 3u))));
}

uint block_of_entry(uint entry)
{
    const uint packed = sdfgi_light_cells[light_cell_slot(args.cascade, entry)];
    return light_block_from_coords(texel_from_index(packed & 0xffffffu) / SDFGI_GROUP_CELLS);
}

/* Where the list was too short, blocks from its last entry on may hold cells that have room this time. */
bool lacked_room(uint block)
{
    const uint room = sdfgi_frame.light.y;
    return sdfgi_counters[SDFGI_COUNTER_LIGHT_CELLS + args.cascade] > room && block >= block_of_entry(room - 1u);
}

bool is_renewed(uint block)
{
    const ivec3 cage = cell_from_texel(args.cascade, 4u * light_block_coords(block)) / SDFGI_PROBE_SPACING;
    return args.fresh != 0u ||
           changed_near(args.cascade, cage * SDFGI_PROBE_SPACING, (cage + 1) * SDFGI_PROBE_SPACING, 0) ||
           lacked_room(block);
}

uint row_of(uint block)
{
    return light_row_slot(block / SDFGI_GROUP_LINEAR);
}

void keep_entry(uint entry)
{
    const uint count = light_cell_count(args.cascade);
    if (args.fresh != 0u || entry >= count)
        return;
    const uint block = block_of_entry(entry);
    if (is_renewed(block))
        return;
    const uint slot = light_cell_slot(args.cascade, entry), before = light_before_slot(entry);
    sdfgi_scratch[before] = sdfgi_light_cells[slot + 1u];
    sdfgi_scratch[before + 1u] = sdfgi_light_cells[slot + 2u];
    const uvec3 inside = texel_from_index(sdfgi_light_cells[slot] & 0xffffffu) & 3u;
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

void main()
{
    const uint bit = gl_LocalInvocationIndex, block = light_block_from_coords(gl_WorkGroupID);
    keep_entry(64u * block + bit);
    if (!is_renewed(block))
        return;
    if (bit < 2u)
        mask[bit] = 0u;
    barrier();
    const ivec3 cell = cell_from_texel(args.cascade, gl_GlobalInvocationID);
    const uint index = cell_index(args.cascade, cell);
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
