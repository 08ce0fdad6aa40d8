/* SPDX-License-Identifier: MIT
 * Finds the sub-voxel of a cell that is nearest to another cell's centre. A pointer to a sub-voxel is its
 * coordinate, 10 bits per axis. */
#ifndef SDFGI_NEAREST_GLSL
#define SDFGI_NEAREST_GLSL

#include "pass.glsl"

SDFGI_PUSH(sdfgi_flood_args);

const uint NEAREST_NONE = 0xffffffffu;
const uint NEAREST_CELL_MASK = 0x3fcff3fcu; /* clears the two low bits of each coordinate */

uint nearest_pack(ivec3 sub)
{
    return uint(sub.x) | uint(sub.y) << 10u | uint(sub.z) << 20u;
}

ivec3 nearest_unpack(uint pointer)
{
    return ivec3(uvec3(pointer, pointer >> 10u, pointer >> 20u) & 1023u);
}

/* Squared distance in cell widths from the centre of `cell` to a sub-voxel's centre. */
float nearest_distance2(ivec3 cell, ivec3 sub)
{
    const vec3 offset = sdfgi_metric_from_cells((vec3(sub - cell * SDFGI_SUBVOXELS) - 1.5) * 0.25);
    return dot(offset, offset);
}

/* Lower bound of nearest_distance2 over the sub-voxels of another cell that lie in [low, high]. */
float nearest_bound2(ivec3 cell, ivec3 other, vec3 low, vec3 high)
{
    const vec3 centre = vec3((cell - other) * SDFGI_SUBVOXELS) + 1.5;
    const vec3 gap = sdfgi_metric_from_cells(max(max(low - centre, centre - high), 0.0) * 0.25);
    return dot(gap, gap);
}

/* Per axis a bit for each of the cell's four slices that holds a set bit. */
uvec3 nearest_slices(uvec2 bits)
{
    const uint all_z = bits.x | bits.y;
    const uint layer = (all_z | all_z >> 16u) & 0xffffu;
    const uint column = layer | layer >> 8u;
    const uint rows = layer | layer >> 1u | layer >> 2u | layer >> 3u; /* bit 4 y: any of row y */
    const uint y = (rows & 1u) | (rows >> 3u & 2u) | (rows >> 6u & 4u) | (rows >> 9u & 8u);
    const uint z = uint((bits.x & 0xffffu) != 0u) | uint(bits.x >> 16u != 0u) << 1u |
                   uint((bits.y & 0xffffu) != 0u) << 2u | uint(bits.y >> 16u != 0u) << 3u;
    return uvec3((column | column >> 4u) & 15u, y, z);
}

/* Replaces the nearest sub-voxel to `cell` if one in the cell `other` is nearer. Tests a box around `other`
 * first, then a box around its set bits, and last the bits. A box rules out most cells, so it is cheap to
 * measure to each of 64 sub-voxels. */
void nearest_offer(ivec3 cell, ivec3 other, inout uint best, inout float best2)
{
    if (nearest_bound2(cell, other, vec3(0.0), vec3(3.0)) >= best2)
        return;
    const uvec2 bits = sdfgi_cell_bits(args.cascade, other);
    const uvec3 slices = nearest_slices(bits);
    if (nearest_bound2(cell, other, vec3(findLSB(slices)), vec3(findMSB(slices))) >= best2)
        return;
    const ivec3 low = other * SDFGI_SUBVOXELS;
    for (int word = 0; word < 2; word++) {
        uint rest = bits[word];
        for (int i = 0; i < 32 && rest != 0u; i++) {
            const int bit = findLSB(rest);
            rest &= rest - 1u;
            const ivec3 sub = low + ivec3(bit & 3, bit >> 2 & 3, (bit >> 4) + 2 * word);
            const float d2 = nearest_distance2(cell, sub);
            if (d2 < best2) {
                best2 = d2;
                best = nearest_pack(sub);
            }
        }
    }
}

/* Stored form of a squared distance, rounded down. The factor is a little more than floats may have rounded
 * up. */
uint encode_nearest(float d2)
{
    return d2 < 1e29 ? min(uint(sqrt(d2) * (1.0 - 1e-6) * sdfgi_distance_units()), sdfgi_distance_reach())
                     : sdfgi_distance_reach();
}

#endif
