/* SPDX-License-Identifier: MIT
 * Where the sums of the part of a cascade that is voxelised are (shared/scratch.h). A part is a box of cells
 * that begins and ends at multiples of 8 cells. */
#ifndef SDFGI_ACCUMULATORS_GLSL
#define SDFGI_ACCUMULATORS_GLSL

#include "pass.glsl"

struct voxel_part {
    ivec3 low, high; /* cells [low, high) */
};

/* Albedo blocks of the part. */
uint part_blocks(voxel_part part)
{
    const uvec3 size = uvec3(part.high - part.low) >> 1u;
    return size.x * size.y * size.z;
}

/* Number of a cell's albedo block in the part. */
uint part_block(voxel_part part, ivec3 cell)
{
    const uvec3 at = uvec3(cell - part.low) >> 1u, size = uvec3(part.high - part.low) >> 1u;
    return at.x + size.x * (at.y + size.y * at.z);
}

/* The word of a block in a plane, SDFGI_ACCUM_*. */
uint accumulator(voxel_part part, uint plane, uint block)
{
    return plane * part_blocks(part) + block;
}

/* The first plane of what faces a side of a block, in the lower or the upper of its two layers of cells. */
uint accumulator_albedo(uint side, uint layer)
{
    return SDFGI_ACCUM_ALBEDO + 4u * (2u * side + layer);
}

/* False if nothing has emitted yet, or there was no memory for emission: its accumulators are not there. */
bool emission_is_kept()
{
    return sdfgi_frame.emitter_samples != 0u;
}

/* The first of two words with the bits of a cell's sub-voxels that emit along an axis. */
uint emissive_word(voxel_part part, int axis, ivec3 cell)
{
    const uvec3 at = uvec3(cell - part.low), size = uvec3(part.high - part.low);
    const uint first = accumulator(part, uint(SDFGI_ACCUM_PLANES), 0u), cells = 8u * part_blocks(part);
    return first + 2u * (uint(axis) * cells + at.x + size.x * (at.y + size.y * at.z));
}

#endif
