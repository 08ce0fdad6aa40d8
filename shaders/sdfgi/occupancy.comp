/* SPDX-License-Identifier: MIT
 * Masks of occupied cells per block (args.step = 0), then of occupied blocks per group (args.step = 1). One thread per
 * block or group. */
#version 460
#extension GL_GOOGLE_include_directive : require
#include "occupancy.glsl"

layout(local_size_x = SDFGI_GROUP_LINEAR) in;

bool occupied(ivec3 at)
{
    if (args.step == 0u)
        return cell_bits(args.cascade, at) != uvec2(0u);
    return occupancy_mask(occupancy_block_slot(at)) != uvec2(0u);
}

void main()
{
    const uint bits = args.step == 0u ? occupancy_block_bits() : occupancy_group_bits();
    const uint i = gl_GlobalInvocationID.x;
    if (i >= 1u << (3u * bits))
        return;
    const uint side_mask = (1u << bits) - 1u;
    const ivec3 at = ivec3(i & side_mask, i >> bits & side_mask, i >> (2u * bits));
    uvec2 mask = uvec2(0u);
    for (int z = 0; z < 4; z++)
        for (int y = 0; y < 4; y++)
            for (int x = 0; x < 4; x++)
                if (occupied(4 * at + ivec3(x, y, z)))
                    mask[z >> 1] |= 1u << (x + 4 * y + 16 * (z & 1));
    const uint slot = args.step == 0u ? occupancy_block_slot(at) : occupancy_group_slot(at);
    sdfgi_scratch[slot] = mask.x;
    sdfgi_scratch[slot + 1u] = mask.y;
}
