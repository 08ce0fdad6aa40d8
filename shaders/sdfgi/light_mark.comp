/* SPDX-License-Identifier: MIT
 * Marks the light cells, empty ones with an occupied face neighbour. In renewed blocks they are looked for, and all others
 * forget their light; elsewhere they are those that were listed before. Besides, takes the direct light out of the list
 * before. One workgroup per block of 4^3 texels, one thread per cell, and per entry of the list before. */
#version 460
#extension GL_GOOGLE_include_directive : require
#define SDFGI_WRITES_LIGHT
#define SDFGI_WRITES_MASKS
#include "changed.glsl"
#include "light_blocks.glsl"

layout(local_size_x = SDFGI_GROUP_CELLS, local_size_y = SDFGI_GROUP_CELLS, local_size_z = SDFGI_GROUP_CELLS) in;
layout(push_constant) uniform sdfgi_push { sdfgi_pass_args args; };

shared uint mask[2];
shared uint renewed;

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

bool touches_new(ivec3 cell)
{
    const ivec3 cage = cell / SDFGI_PROBE_SPACING;
    return args.fresh != 0u ||
           changed_near(args.cascade, cage * SDFGI_PROBE_SPACING, (cage + 1) * SDFGI_PROBE_SPACING, 0);
}

uint block_of_entry(uint entry)
{
    const uint packed = sdfgi_light_cells[light_cell_slot(args.cascade, entry)];
    return light_block_from_coords(texel_from_index(packed & 0xffffffu) / SDFGI_GROUP_CELLS);
}

void take_direct(uint entry)
{
    if (args.fresh != 0u || entry >= light_cell_count(args.cascade))
        return;
    const uvec2 direct = light_cell_direct(light_cell_slot(args.cascade, entry));
    const uint before = light_before_slot(entry), block = block_of_entry(entry);
    sdfgi_scratch[before] = direct.x;
    sdfgi_scratch[before + 1u] = direct.y;
    if (entry == 0u || block_of_entry(entry - 1u) != block)
        sdfgi_scratch[light_block_slot(block) + 3u] = entry;
}

void main()
{
    const uint bit = gl_LocalInvocationIndex, block = light_block_from_coords(gl_WorkGroupID);
    const ivec3 cell = cell_from_texel(args.cascade, gl_GlobalInvocationID);
    const uint index = cell_index(args.cascade, cell);
    const uvec2 light = sdfgi_light[index];
    take_direct(64u * block + bit);
    if (bit == 0u) {
        mask[0] = mask[1] = 0u;
        renewed = touches_new(cell) ? 1u : 0u;
    }
    barrier();
    /* There may be room for it this time. */
    if ((light.y & SDFGI_LIGHT_NO_ROOM) != 0u)
        renewed = 1u;
    barrier();
    if (renewed != 0u ? is_light_cell(cell) : (light.y & SDFGI_LIGHT_VALID) != 0u)
        atomicOr(mask[bit >> 5u], 1u << (bit & 31u));
    else if (light != uvec2(0u))
        forget(index);
    barrier();
    if (bit > 0u)
        return;
    const uint slot = light_block_slot(block), row = light_row_slot(block / SDFGI_GROUP_LINEAR);
    sdfgi_scratch[slot] = mask[0];
    sdfgi_scratch[slot + 1u] = mask[1];
    sdfgi_scratch[slot + 2u] = renewed;
    const uint count = bitCount(mask[0]) + bitCount(mask[1]);
    if (count == 0u)
        return;
    atomicAdd(sdfgi_scratch[row], count);
    if (renewed != 0u)
        atomicAdd(sdfgi_scratch[row + 1u], count);
}
