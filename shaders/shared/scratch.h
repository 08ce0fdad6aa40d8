/* SPDX-License-Identifier: MIT
 * The scratch buffer. Its tenants use it in turn within a frame. Each begins at word 0, and none keeps
 * anything for a later one. Offsets are in words (4 bytes); `bits` is the logarithm of the resolution N.
 *
 * - Accumulators (voxelize, voxel_resolve; a fill empties them): words per albedo block of the part that is
 *   voxelised, and, if something emits, the emissive bits of each of its cells: see accumulators.glsl.
 * - Distance search (distance_plane, _exact): planes, see occupancy.glsl.
 * - Flood (flood_seed, _step, _distance): two halves of a pointer per cell.
 * - Empty boxes (occupied_cells, empty_cubes, empty_boxes): a bit per cell, a word for every 32 cells along
 *   x; then the same for cubes of each size, see cubes.glsl.
 * - Light list (light_mark, _list, _direct, _bounce, cell_mask): light blocks, rows and entries, see
 *   light_blocks.glsl.
 * - Emitters (emitter_mark, _list): their number, and from word SDFGI_SCRATCH_EMITTERS on the indices of
 *   their blocks, in any order.
 * - Ray queue (ray_list, probe_trace): a word per ray of the frame. */
#ifndef SDFGI_SHARED_SCRATCH_H
#define SDFGI_SHARED_SCRATCH_H

#include "types.h"
#include "boxes.h"
#include "constants.h"

/* Cells of the largest part that is voxelised at once. */
SDFGI_FUNCTION uint sdfgi_scratch_part_cells(uint bits)
{
    const uint cells = 1u << (3u * bits), least = SDFGI_VOXEL_PART_CELLS, part = cells / SDFGI_VOXEL_PARTS;
    return cells < least ? cells : part > least ? part : least;
}

/* Words that a part needs: accumulators of its albedo blocks (2^3 cells) from word 0, plane after plane, then
 * per axis two words of emissive bits per cell. Where nothing emits, the accumulators of surfaces are all. */
SDFGI_FUNCTION uint sdfgi_scratch_part_words(uint part_cells, bool emits)
{
    const uint blocks = part_cells / 8u;
    return emits ? SDFGI_ACCUM_PLANES * blocks + 6u * part_cells : SDFGI_ACCUM_EMISSION * blocks;
}

/* Distance search: planes from word 0. Two cells share a word, four layers of sub-voxels per cell. */
SDFGI_FUNCTION uint sdfgi_scratch_distance_end(uint bits)
{
    return 2u << (3u * bits);
}

SDFGI_FUNCTION uint sdfgi_scratch_flood_end(uint bits)
{
    return 2u << (3u * bits);
}

/* Empty boxes: occupied cells from word 0, then cubes of 1 to SDFGI_BOX_SIZES cells along a side. */
SDFGI_FUNCTION uint sdfgi_scratch_cubes(uint bits, uint size)
{
    const uint rows = (1u << bits) + SDFGI_CUBES_ROWS, words = (1u << bits) / 32u + 1u;
    return (1u << (3u * bits - 5u)) + (size - 1u) * words * rows * rows;
}

SDFGI_FUNCTION uint sdfgi_scratch_cubes_end(uint bits)
{
    return sdfgi_scratch_cubes(bits, SDFGI_BOX_SIZES + 1u);
}

#define SDFGI_SCRATCH_EMITTERS 4

/* The ray queue: how many rays towards emitters a probe sends in a frame beside those at random, which are
 * the samples from `first` on of its cycle. Each sample towards an emitter belongs to a run of those at
 * random. */
SDFGI_FUNCTION uint sdfgi_scratch_emitter_rays(uint first, uint rays)
{
    return (first + rays - 1u) / SDFGI_SAMPLES_PER_EMITTER_SAMPLE - first / SDFGI_SAMPLES_PER_EMITTER_SAMPLE +
           1u;
}

/* The search buffer, beside the planes: a bit per run of eight cells and row of sub-voxels from word 0, then
 * a word per layer of cells and SDFGI_GROUP_COLUMNS columns, */
SDFGI_FUNCTION uint sdfgi_search_layers(uint bits)
{
    return 1u << (3u * bits - 4u);
}

/* then two words per column of light blocks (4^3 cells). */
SDFGI_FUNCTION uint sdfgi_search_dirty_blocks(uint bits)
{
    return sdfgi_search_layers(bits) + (1u << (2u * bits)) / SDFGI_GROUP_COLUMNS;
}

SDFGI_FUNCTION uint sdfgi_search_end(uint bits)
{
    return sdfgi_search_dirty_blocks(bits) + (2u << (2u * bits - 4u));
}

/* Light list: eight words per light block (4^3 cells) from word 0, then two per row of SDFGI_GROUP_LINEAR
 * blocks. */
SDFGI_FUNCTION uint sdfgi_scratch_light_rows(uint bits)
{
    return 8u << (3u * bits - 6u);
}

/* sdfgi_scratch_light_words times `room` words of what the previous list held, */
SDFGI_FUNCTION uint sdfgi_scratch_light_before(uint bits)
{
    return sdfgi_scratch_light_rows(bits) + (2u << (3u * bits - 6u)) / SDFGI_GROUP_LINEAR;
}

SDFGI_FUNCTION uint sdfgi_scratch_light_words(bool keeps_low_light)
{
    return SDFGI_LIGHT_KEPT_WORDS + (keeps_low_light ? 6u : 0u);
}

/* then two words per dirty light cell. `room` is the number of entries that a list has room for. */
SDFGI_FUNCTION uint sdfgi_scratch_light_dirty(uint bits, uint room, bool keeps_low_light)
{
    return sdfgi_scratch_light_before(bits) + sdfgi_scratch_light_words(keeps_low_light) * room;
}

SDFGI_FUNCTION uint sdfgi_scratch_light_end(uint bits, uint room, bool keeps_low_light)
{
    return sdfgi_scratch_light_dirty(bits, room, keeps_low_light) + 2u * room;
}

#endif
