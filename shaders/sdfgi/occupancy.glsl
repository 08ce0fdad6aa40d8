/* SPDX-License-Identifier: MIT
 * What the passes of the exact distance search share: their part of the scratch buffer, and squared lengths.
 * N is the number of cells along a side of a cascade. Coordinates count from the cascade's low corner.
 *
 *     layer      the sub-voxels of one height y: 4 N layers, four for each y of cells
 *     row        the sub-voxels of a layer at one position along z: they lie along x
 *     run        eight cells that follow one another along x: 32 sub-voxels of a row
 *     column     the light blocks (4^3 cells) above one another, at one x and z
 *
 * The scratch buffer holds, in words (shared/scratch.h):
 *
 *     planes         2 N^3   per layer and cell in x and z the distance within the layer, 16 bits each;
 *                            any distance out of reach stands for all of them
 *
 * and the search buffer
 *
 *     runs           N^3/16  per row a bit for each run in which it holds a bit
 *     layers         N^2/32  per y of cells, a word for every 32 cells along z; its low four bits tell which
 *                            of the four layers hold bits there
 *     dirty blocks   N^2/8   per column two words with a bit for each light block to search
 *
 * Lengths are counted in halves of a sub-voxel. From the centre of a cell to that of a sub-voxel they are odd
 * numbers along each axis. All arithmetic is in integers, so that no order of work changes a result. */
#ifndef SDFGI_OCCUPANCY_GLSL
#define SDFGI_OCCUPANCY_GLSL

#include "pass.glsl"

layout(std430, set = SDFGI_SET_WORK, binding = SDFGI_BINDING_SEARCH) buffer sdfgi_search_buffer
{
    uint sdfgi_search[];
};

uint occupancy_side_bits()
{
    return sdfgi_frame.resolution_log2;
}

/* ---- Planes */

/* Two cells along x share a word. Words of four cells along x and two along z lie side by side, because one
 * workgroup of distance_exact reads these of a layer. */
uint plane_slot(uint layer, uint x, uint z)
{
    const uint bits = occupancy_side_bits();
    const uint tile = ((layer << (bits - 1u) | z >> 1u) << (bits - 2u)) | x >> 2u;
    return tile << 2u | (z & 1u) << 1u | (x >> 1u & 1u);
}

/* ---- Runs */

const uint RUN_BITS = 3u; /* logarithm of the cells of a run */

/* Number of the first bit of a row among the bits of all runs. Rows of a layer follow one another. */
uint runs_bit(uint layer, uint position_z)
{
    const uint bits = occupancy_side_bits();
    return (layer << (bits + 2u) | position_z) << (bits - RUN_BITS);
}

uint runs_slot(uint bit)
{
    return bit >> 5u;
}

/* A bit for each run in which a row holds a bit. */
uint runs_of_row(uint layer, uint position_z)
{
    const uint bit = runs_bit(layer, position_z);
    return bitfieldExtract(sdfgi_search_at(runs_slot(bit)), int(bit & 31u),
                           int(sdfgi_frame.resolution >> RUN_BITS));
}

/* ---- Layers */

/* Words per y of cells. */
uint layers_words()
{
    return sdfgi_frame.resolution / SDFGI_GROUP_COLUMNS;
}

uint layers_slot(uint y, uint word)
{
    return sdfgi_search_layers(occupancy_side_bits()) + y * layers_words() + word;
}

/* A bit for each of the four layers at a y of cells that holds a bit. Reads a constant number of words, some
 * of them twice, so that the reads overlap. */
uint layers_at(uint y)
{
    uint four = 0u;
    [[unroll]] for (uint word = 0u; word < 256u / SDFGI_GROUP_COLUMNS; word++)
    {
        four |= sdfgi_search_at(layers_slot(y, min(word, layers_words() - 1u)));
    }
    return four;
}

/* ---- Dirty blocks */

uint dirty_blocks_slot(uint block_x, uint block_z)
{
    return sdfgi_search_dirty_blocks(occupancy_side_bits()) +
           2u * (block_z << (occupancy_side_bits() - 2u) | block_x);
}

/* A bit for each dirty block of a column. */
uvec2 dirty_blocks(uint block_x, uint block_z)
{
    const uint slot = dirty_blocks_slot(block_x, block_z);
    return uvec2(sdfgi_search_at(slot), sdfgi_search_at(slot + 1u));
}

/* The bits of all blocks of a column from `first` on. */
uvec2 blocks_from(int first)
{
    const uint low = 0xffffffffu << clamp(first, 0, 31), high = 0xffffffffu << clamp(first - 32, 0, 31);
    return uvec2(first < 32 ? low : 0u, first < 64 ? high : 0u);
}

/* True if the sub-voxels of the block at height `block_y` may be within reach of a cell of a dirty block.
 * From the end of its block, the centre of a cell is half a cell away, and that of a sub-voxel an eighth. */
bool dirty_within_reach(uvec2 dirty, int block_y)
{
    const int reach = int((float(SDFGI_DISTANCE_REACH) / sdfgi_space_y_scale() + 3.375) * 0.25);
    return (dirty & blocks_from(block_y - reach) & ~blocks_from(block_y + reach + 1)) != uvec2(0u);
}

/* ---- Squared lengths: 16 per square of half a sub-voxel, so that heights scaled by 1/2 or 3/4 stay whole
 * numbers */

uint distance_y_weight()
{
    const uint quarters = uint(4.0 * sdfgi_space_y_scale() + 0.5);
    return quarters * quarters;
}

/* In squares of the stored unit, N / 32768 cells. A cell is eight halves of a sub-voxel. At most 3 * 2^30. */
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
