/* SPDX-License-Identifier: MIT
 * The scratch buffer. Its tenants use it in turn within a frame. Each begins at word 0, and none keeps
 * anything for a later one. Offsets are in words (4 bytes); `bits` is the logarithm of the resolution N.
 *
 * - Accumulators (region_clear, voxelize, voxel_resolve): SDFGI_ACCUM_PLANES words per albedo block, and the
 *   emissive bits of each cell.
 * - Distance search (distance_prepare, _plane, _exact): planes, runs, layers and dirty blocks, see
 *   occupancy.glsl.
 * - Flood (flood_seed, _step, _distance): two halves of a pointer per cell.
 * - Light list (light_mark, _list, _direct, _bounce, cell_mask): light blocks, rows and entries, see
 *   light_blocks.glsl.
 * - Emitters (emitter_mark, _list): their number, and from word SDFGI_SCRATCH_EMITTERS on the indices of
 *   their blocks, in any order.
 * - Ray queue (ray_list, probe_trace): a word per ray of the frame. */
#ifndef SDFGI_SHARED_SCRATCH_H
#define SDFGI_SHARED_SCRATCH_H

#include "types.h"
#include "constants.h"

/* Accumulators of albedo blocks (2^3 cells). */
SDFGI_FUNCTION uint sdfgi_scratch_emissive_bits(uint bits)
{
    return SDFGI_ACCUM_PLANES << (3u * bits - 3u);
}

/* Emissive bits: two words per cell. */
SDFGI_FUNCTION uint sdfgi_scratch_accumulators_end(uint bits)
{
    return sdfgi_scratch_emissive_bits(bits) + (2u << (3u * bits));
}

/* Distance search: planes from word 0. Two cells share a word, four layers of sub-voxels per cell. */
SDFGI_FUNCTION uint sdfgi_scratch_runs(uint bits)
{
    return 2u << (3u * bits);
}

/* A bit per run of eight cells and row of sub-voxels. */
SDFGI_FUNCTION uint sdfgi_scratch_layers(uint bits)
{
    return sdfgi_scratch_runs(bits) + (1u << (3u * bits - 4u));
}

/* A word per layer of cells and SDFGI_GROUP_COLUMNS columns. */
SDFGI_FUNCTION uint sdfgi_scratch_dirty_blocks(uint bits)
{
    return sdfgi_scratch_layers(bits) + (1u << (2u * bits)) / SDFGI_GROUP_COLUMNS;
}

/* Two words per column of light blocks (4^3 cells). */
SDFGI_FUNCTION uint sdfgi_scratch_distance_end(uint bits)
{
    return sdfgi_scratch_dirty_blocks(bits) + (2u << (2u * bits - 4u));
}

SDFGI_FUNCTION uint sdfgi_scratch_flood_end(uint bits)
{
    return 2u << (3u * bits);
}

#define SDFGI_SCRATCH_EMITTERS 4

/* Light list: eight words per light block (4^3 cells) from word 0, then two per row of SDFGI_GROUP_LINEAR
 * blocks. */
SDFGI_FUNCTION uint sdfgi_scratch_light_rows(uint bits)
{
    return 8u << (3u * bits - 6u);
}

/* SDFGI_LIGHT_KEPT_WORDS times `room` words of what the previous list held, */
SDFGI_FUNCTION uint sdfgi_scratch_light_before(uint bits)
{
    return sdfgi_scratch_light_rows(bits) + (2u << (3u * bits - 6u)) / SDFGI_GROUP_LINEAR;
}

/* then two words per dirty light cell. `room` is the number of entries that a list has room for. */
SDFGI_FUNCTION uint sdfgi_scratch_light_dirty(uint bits, uint room)
{
    return sdfgi_scratch_light_before(bits) + SDFGI_LIGHT_KEPT_WORDS * room;
}

SDFGI_FUNCTION uint sdfgi_scratch_light_end(uint bits, uint room)
{
    return sdfgi_scratch_light_dirty(bits, room) + 2u * room;
}

#endif
