/* SPDX-License-Identifier: MIT
 * Finds what the exact distance search has to know before it begins (occupancy.glsl): the runs and layers
 * that hold bits, and the light blocks whose distances are dirty. The two do not depend on each other, so one
 * dispatch finds both: the first workgroups find runs and layers, and the others find blocks. Where runs and
 * layers are known from an earlier part of the same change, it finds blocks alone. */
#version 460
#extension GL_GOOGLE_include_directive : require
#define SDFGI_WRITES_SEARCH
#extension GL_EXT_control_flow_attributes : require
#include "../lib/on_cpu.glsl"
#include "dirty_bounds.glsl"
#include "occupancy.glsl"

layout(local_size_x = SDFGI_GROUP_LINES) in;
SDFGI_PUSH(sdfgi_distance_prepare_args);

/* ---- Runs and layers: one workgroup per y of cells and CELLS_Z cells along z, one run per thread. A run has
 * 16 rows: four layers of four positions along z each. */

const uint CELLS_Z = SDFGI_GROUP_COLUMNS;

shared uint runs[16u * CELLS_Z]; /* as in the scratch buffer; all of it is used where a row has 32 runs */
shared uint layers;              /* any bit set in bits 4 i to 4 i + 3: layer i holds bits */

uint runs_per_row()
{
    return sdfgi_frame.resolution >> RUN_BITS;
}

/* For every four bits, the lowest one: whether any of the four is set. */
uint any_of_fours(uint bits)
{
    bits |= bits >> 1u;
    return (bits | bits >> 2u) & 0x11111111u;
}

/* The rows of a run that hold bits: bit z + 4 y, of sub-voxels in a cell. Cascades scroll by whole runs, so a
 * run is stored side by side. */
uint rows_of_run(uint y, uint z, uint run)
{
    const uint first = sdfgi_cell_index(args.cascade, ivec3(8u * run, y, z));
    uvec2 bits = uvec2(0u);
    [[unroll]] for (uint i = 0u; i < 8u; i++)
    {
        bits |= sdfgi_subvoxels(first + i);
    }
    const uint low = any_of_fours(bits.x), high = any_of_fours(bits.y);
    return (low & 0xffffu) | (low >> 16u) << 1u | (high & 0xffffu) << 2u | (high >> 16u) << 3u;
}

void add_rows(uint rows, uint cell_z, uint run)
{
    for (uint row = 0u; row < 16u; row++)
        if ((rows >> row & 1u) != 0u) {
            const uint local_row = (row >> 2u) * 4u * CELLS_Z + 4u * cell_z + (row & 3u);
            const uint bit = local_row * runs_per_row() + run;
            atomicOr(runs[bit >> 5u], 1u << (bit & 31u));
        }
    if (rows != 0u)
        atomicOr(layers, any_of_fours(rows));
}

void find_rows(uint group)
{
    const uint lane = gl_LocalInvocationIndex, per_row = runs_per_row(),
               groups = sdfgi_frame.resolution / CELLS_Z;
    const uint y = group / groups, first_z = CELLS_Z * (group % groups),
               words = CELLS_Z * per_row / 8u; /* of a layer */
    for (uint i = lane; i < 4u * words; i += SDFGI_GROUP_LINES)
        runs[i] = 0u;
    if (lane == 0u)
        layers = 0u;
    barrier();
    for (uint i = lane; i < CELLS_Z * per_row; i += SDFGI_GROUP_LINES) {
        const uint cell_z = i / per_row, run = i % per_row;
        add_rows(rows_of_run(y, first_z + cell_z, run), cell_z, run);
    }
    barrier();
    for (uint i = lane; i < 4u * words; i += SDFGI_GROUP_LINES)
        sdfgi_search[runs_slot(runs_bit(4u * y + i / words, 4u * first_z)) + i % words] = runs[i];
    if (lane == 0u)
        sdfgi_search[layers_slot(y, first_z / CELLS_Z)] =
            (layers & 1u) | (layers >> 3u & 2u) | (layers >> 6u & 4u) | (layers >> 9u & 8u);
}

/* ---- Dirty blocks: one workgroup per column, four threads per light block. A block is dirty if it touches a
 * dirty box, or if it has a cell whose stored distance reaches the dirty bounds (dirty_bounds.glsl): its
 * nearest sub-voxel may have been removed, or a nearer one added. Stored distances are rounded down, and
 * rounding keeps their order. So bounds whose nearest point would be stored as further away cannot matter. */

const uint BOXES = uint(2 * SDFGI_BOUNDS_STRIPS);
const uint BLOCKS = uint(SDFGI_GROUP_LINES / 4);
const int FAR = 2 * SDFGI_BOUNDS_ORIGIN; /* cells: beyond all boxes */

/* The dirty bounds that are not empty; the last two lie around all of what was removed and added. */
shared ivec3 bounds_lows[BOXES + 2u], bounds_highs[BOXES + 2u];
shared uint bounds_count;
shared uint dirty[2]; /* a bit per block of the column */

/* `around` is the box around all of its kind. */
void bounds_insert(ivec3 low, ivec3 high, uint around)
{
    const uint i = atomicAdd(bounds_count, 1u);
    bounds_lows[i] = low;
    bounds_highs[i] = high;
    for (int axis = 0; axis < 3; axis++) {
        atomicMin(bounds_lows[around][axis], low[axis]);
        atomicMax(bounds_highs[around][axis], high[axis]);
    }
}

/* Loads the boxes that are not empty, in any order. Called by the whole workgroup. */
void load_bounds()
{
    const uint lane = gl_LocalInvocationIndex;
    if (lane == 0u)
        bounds_count = 0u;
    if (lane < 2u) {
        bounds_lows[BOXES + lane] = ivec3(FAR);
        bounds_highs[BOXES + lane] = ivec3(-FAR);
    }
    barrier();
    if (lane < BOXES) {
        const ivec3 low = bounds_low(args.cascade, lane), high = bounds_high(args.cascade, lane);
        if (bounds_any(args.cascade, lane))
            bounds_insert(low, high, BOXES + uint(lane >= BOUNDS_ADDED));
    }
    barrier();
}

/* True if a block touches a dirty box. The box's corners are 16-bit numbers in two's complement. */
bool block_touches_box(ivec3 block)
{
    for (uint i = 0u; i < args.box_count; i++) {
        const ivec3 corners =
            ivec3(args.corners[3u * i], args.corners[3u * i + 1u], args.corners[3u * i + 2u]);
        if (all(lessThan(corners << 16 >> 16, 4 * block + 4)) && all(greaterThan(corners >> 16, 4 * block)))
            return true;
    }
    return false;
}

/* True if a sub-voxel in a box of the bounds may be as near to the centre of a cell of [first, last] as the
 * distance `stored`, and within reach. The gap along each axis is clamped to the cascade's width, so that its
 * square does not overflow: a gap that is too small is safe, because it only causes a search without need. */
bool stored_reaches(uint stored, uint box, ivec3 first, ivec3 last)
{
    const ivec3 gap = clamp(max(8 * (bounds_lows[box] - last) - 3, 8 * (first - bounds_highs[box]) + 5), 1,
                            8 * sdfgi_space_resolution() - 1);
    const uvec3 square = uvec3(gap * gap);
    const uint most = min(stored, sdfgi_distance_reach() - 1u);
    return distance_square(16u * (square.x + square.z) + distance_y_weight() * square.y) <=
           most * (most + 2u);
}

/* True if any of the 16 cells from `first` on, 4x4 along x and y, has a dirty distance. */
bool cells_are_dirty(ivec3 first)
{
    const ivec3 last = first + ivec3(3, 3, 0);
    uint pairs[8], most = 0u;
    for (int i = 0; i < 8; i++)
        pairs[i] =
            sdfgi_distances_at(sdfgi_cell_index(args.cascade, first + ivec3(2 * (i & 1), i >> 1, 0)) >> 1u);
    for (int i = 0; i < 8; i++)
        most = max(most, max(pairs[i] & 0xffffu, pairs[i] >> 16u));
    /* For most cells the two boxes around all others rule out up to 32 boxes. */
    if (!stored_reaches(most, BOXES, first, last) && !stored_reaches(most, BOXES + 1u, first, last))
        return false;
    for (uint box = 0u; box < bounds_count; box++) {
        if (!stored_reaches(most, box, first, last))
            continue;
        for (int i = 0; i < 8; i++) {
            const ivec3 cell = first + ivec3(2 * (i & 1), i >> 1, 0), next = cell + ivec3(1, 0, 0);
            if (stored_reaches(pairs[i] & 0xffffu, box, cell, cell) ||
                stored_reaches(pairs[i] >> 16u, box, next, next))
                return true;
        }
    }
    return false;
}

void find_blocks(uint group)
{
    const uint lane = gl_LocalInvocationIndex, side = sdfgi_frame.resolution >> 2u;
    const uint x = args.first_block + group / side, z = group % side;
    if (lane < 2u)
        dirty[lane] = 0u;
    load_bounds();
    for (uint y = lane / 4u; y < side; y += BLOCKS) {
        const ivec3 block = ivec3(x, y, z);
        if (args.box_count == 0u || block_touches_box(block) ||
            cells_are_dirty(4 * block + ivec3(0, 0, lane & 3u)))
            atomicOr(dirty[y >> 5u], 1u << (y & 31u));
    }
    barrier();
    if (lane < 2u)
        sdfgi_search[dirty_blocks_slot(x, z) + lane] = dirty[lane];
    if (lane == 0u && (dirty[0] | dirty[1]) != 0u)
        counter_add(SDFGI_COUNTER_DISTANCE_CELLS, 64u * uint(bitCount(dirty[0]) + bitCount(dirty[1])));
}

void main()
{
    if (gl_WorkGroupID.x < args.row_groups)
        find_rows(gl_WorkGroupID.x);
    else
        find_blocks(gl_WorkGroupID.x - args.row_groups);
}
