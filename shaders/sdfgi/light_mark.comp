/* SPDX-License-Identifier: MIT
 * Marks the empty cells with an occupied face neighbour, and forgets the light of all others. One workgroup per block of
 * 4^3 texels, one thread per cell. */
#version 460
#extension GL_GOOGLE_include_directive : require
#define SDFGI_WRITES_LIGHT
#define SDFGI_WRITES_MASKS
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

void main()
{
    const uint bit = gl_LocalInvocationIndex;
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
    if (bit > 0u)
        return;
    const uint block = light_block_from_coords(gl_WorkGroupID), slot = light_block_slot(block);
    sdfgi_scratch[slot] = mask[0];
    sdfgi_scratch[slot + 1u] = mask[1];
    const uint count = bitCount(mask[0]) + bitCount(mask[1]);
    if (count > 0u)
        atomicAdd(sdfgi_scratch[light_row_slot(block / SDFGI_GROUP_LINEAR)], count);
}
