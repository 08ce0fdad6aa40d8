/* SPDX-License-Identifier: MIT
 * Which cells are occupied, as masks in the scratch buffer while distances are made: per block of 4^3 cells a bit per
 * cell, then per group of 4^3 blocks a bit per block; bit x + 4 y + 16 z as in the solid bits. Local coordinates. */
#ifndef SDFGI_OCCUPANCY_GLSL
#define SDFGI_OCCUPANCY_GLSL

#include "nearest.glsl"

uint occupancy_index(ivec3 at, uint side_bits)
{
    return uint(at.x) | uint(at.y) << side_bits | uint(at.z) << (2u * side_bits);
}

uint occupancy_block_bits()
{
    return sdfgi_frame.size.y - 2u;
}

uint occupancy_group_bits()
{
    return sdfgi_frame.size.y - 4u;
}

/* First word of a block's mask and of a group's. */
uint occupancy_block_slot(ivec3 block)
{
    return 2u * occupancy_index(block, occupancy_block_bits());
}

uint occupancy_group_slot(ivec3 group)
{
    return 2u * ((1u << (3u * occupancy_block_bits())) + occupancy_index(group, occupancy_group_bits()));
}

uvec2 occupancy_mask(uint slot)
{
    return uvec2(sdfgi_scratch[slot], sdfgi_scratch[slot + 1u]);
}

#endif
