/* SPDX-License-Identifier: MIT
 * What the exact distance search keeps in the scratch buffer, N cells a side, in words:
 *   planes    2 N^3   distance within a layer of sub-voxels, 16 bits each: more than distances reach is as
 * good as any runs      N^3/16  per row of sub-voxels along x a bit per eight cells in which it holds any
 *   layers    N^2/32  per layer of cells along y and 32 columns a bit per layer of sub-voxels that holds any
 *   stale     N^2/8   a bit per block of 4^3 cells to search, along y: two words each
 * Coordinates are local, and lengths odd numbers of half a sub-voxel, so that all arithmetic is in integers
 * and no order of work changes a result. */
#ifndef SDFGI_OCCUPANCY_GLSL
#define SDFGI_OCCUPANCY_GLSL

#include "pass.glsl"

uint occupancy_side_bits()
{
    return sdfgi_frame.resolution_log2;
}

/* Two cells along x share a word. Four cells along x times two along z lie side by side: what one workgroup
 * of distance_exact reads of a layer. */
uint plane_slot(uint layer, uint x, uint z)
{
    const uint bits = occupancy_side_bits();
    const uint tile = ((layer << (bits - 1u) | z >> 1u) << (bits - 2u)) | x >> 2u;
    return tile << 2u | (z & 1u) << 1u | (x >> 1u & 1u);
}

const uint RUN_BITS = 3u; /* a run is eight cells */

/* The bit where the runs of a row begin; rows lie side by side along z. */
uint runs_bit(uint layer, uint place)
{
    const uint bits = occupancy_side_bits();
    return (layer << (bits + 2u) | place) << (bits - RUN_BITS);
}

uint runs_slot(uint bit)
{
    return sdfgi_scratch_runs(occupancy_side_bits()) + (bit >> 5u);
}

/* The runs in which a row holds bits. */
uint runs_of_row(uint layer, uint place)
{
    const uint bit = runs_bit(layer, place);
    return bitfieldExtract(sdfgi_scratch[runs_slot(bit)], int(bit & 31u),
                           int(sdfgi_frame.resolution >> RUN_BITS));
}

uint layer_parts()
{
    return sdfgi_frame.resolution / SDFGI_GROUP_COLUMNS;
}

uint layers_slot(uint y, uint part)
{
    return sdfgi_scratch_layers(occupancy_side_bits()) + y * layer_parts() + part;
}

/* A bit per layer of sub-voxels of a layer of cells. All parts are read at once. */
uint four_layers(uint y)
{
    uint four = 0u;
    [[unroll]] for (uint part = 0u; part < 256u / SDFGI_GROUP_COLUMNS; part++) four |=
        sdfgi_scratch[layers_slot(y, min(part, layer_parts() - 1u))];
    return four;
}

uint stale_slot(uint block_x, uint block_z)
{
    return sdfgi_scratch_dirty_blocks(occupancy_side_bits()) +
           2u * (block_z << (occupancy_side_bits() - 2u) | block_x);
}

/* A bit per block of a column. */
uvec2 stale_blocks(uint block_x, uint block_z)
{
    const uint slot = stale_slot(block_x, block_z);
    return uvec2(sdfgi_scratch[slot], sdfgi_scratch[slot + 1u]);
}

/* Bits from one on. */
uvec2 blocks_from(int first)
{
    const uint low = 0xffffffffu << clamp(first, 0, 31), high = 0xffffffffu << clamp(first - 32, 0, 31);
    return uvec2(first < 32 ? low : 0u, first < 64 ? high : 0u);
}

/* Whether a layer of blocks lies within reach of a stale block of a column. Cells' centres are half a cell
 * away from the end of their block, sub-voxels' an eighth. */
bool layer_in_reach(uvec2 stale, int layer)
{
    const int reach = int((float(SDFGI_DISTANCE_REACH) / sdfgi_space_y_scale() + 3.375) * 0.25);
    return (stale & blocks_from(layer - reach) & ~blocks_from(layer + reach + 1)) != uvec2(0u);
}

/* ---- Squared lengths: 16 per square of half a sub-voxel, so that heights scaled by 1/2 or 3/4 stay whole
 * numbers */

uint distance_y_weight()
{
    const uint quarters = uint(4.0 * sdfgi_space_y_scale() + 0.5);
    return quarters * quarters;
}

/* In squares of the stored step, N / 32768 cells; a cell is 8 half sub-voxels. At most 3 * 2^30. */
uint distance_square(uint length2)
{
    return length2 << (20u - 2u * occupancy_side_bits());
}

/* Stored form, rounded down. */
uint distance_encode(uint length2)
{
    const uint square = distance_square(length2);
    uint root = uint(sqrt(float(square)));
    root -= uint(root * root > square);
    return min(root + uint((root + 1u) * (root + 1u) <= square), sdfgi_distance_reach());
}

#endif
