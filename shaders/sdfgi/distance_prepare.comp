/* SPDX-License-Identifier: MIT
 * What the exact search has to know before it begins (occupancy.glsl): which rows of sub-voxels hold bits,
 * and which blocks of 4^3 cells to search. Neither needs the other, so one dispatch finds both: workgroups
 * share some columns along z, or a column of blocks along y. */
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
#include "dirty_bounds.glsl"
#include "occupancy.glsl"

layout(local_size_x = SDFGI_GROUP_LINES) in;
layout(push_constant) uniform sdfgi_push
{
    sdfgi_distance_prepare_args args;
};

/* ---- Rows: a thread reads eight cells that lie side by side */

const uint COLUMNS = SDFGI_GROUP_COLUMNS;

shared uint runs[16u * COLUMNS]; /* as in the scratch buffer; all of it is used where a row has 32 runs */
shared uint layers;              /* a bit per layer */

uint runs_per_row()
{
    return sdfgi_frame.resolution >> RUN_BITS;
}

/* A bit per four sub-voxels along x, at the place of the first. */
uint any_of_fours(uint bits)
{
    bits |= bits >> 1u;
    return (bits | bits >> 2u) & 0x11111111u;
}

/* Rows set in the eight cells of a run: z + 4 y. Cascades move by whole runs. */
uint rows_of_run(uint y, uint z, uint run)
{
    const uint first = sdfgi_cell_index(args.cascade, ivec3(8u * run, y, z));
    uvec2 bits = uvec2(0u);
    [[unroll]] for (uint i = 0u; i < 8u; i++) bits |= sdfgi_bits[first + i];
    const uint low = any_of_fours(bits.x), high = any_of_fours(bits.y);
    return (low & 0xffffu) | (low >> 16u) << 1u | (high & 0xffffu) << 2u | (high >> 16u) << 3u;
}

void note_rows(uint rows, uint column, uint run)
{
    for (uint row = 0u; row < 16u; row++)
        if ((rows >> row & 1u) != 0u) {
            const uint place = (row >> 2u) * 4u * COLUMNS + 4u * column + (row & 3u);
            const uint bit = place * runs_per_row() + run;
            atomicOr(runs[bit >> 5u], 1u << (bit & 31u));
        }
    if (rows != 0u)
        atomicOr(layers, any_of_fours(rows));
}

void find_rows(uint group)
{
    const uint lane = gl_LocalInvocationIndex, per_row = runs_per_row(),
               groups = sdfgi_frame.resolution / COLUMNS;
    const uint y = group / groups, first_z = COLUMNS * (group % groups),
               words = COLUMNS * per_row / 8u; /* of a layer */
    for (uint i = lane; i < 4u * words; i += SDFGI_GROUP_LINES)
        runs[i] = 0u;
    if (lane == 0u)
        layers = 0u;
    barrier();
    for (uint i = lane; i < COLUMNS * per_row; i += SDFGI_GROUP_LINES) {
        const uint column = i / per_row, run = i % per_row;
        note_rows(rows_of_run(y, first_z + column, run), column, run);
    }
    barrier();
    for (uint i = lane; i < 4u * words; i += SDFGI_GROUP_LINES)
        sdfgi_scratch[runs_slot(runs_bit(4u * y + i / words, 4u * first_z)) + i % words] = runs[i];
    if (lane == 0u)
        sdfgi_scratch[layers_slot(y, first_z / COLUMNS)] =
            (layers & 1u) | (layers >> 3u & 2u) | (layers >> 6u & 4u) | (layers >> 9u & 8u);
}

/* ---- Blocks: those that touch a changed box, and those with a cell whose nearest sub-voxel may have gone,
 * or may be one that came (dirty_bounds.glsl). Stored lengths are rounded down and rounding keeps order: a
 * box whose nearest sub-voxel would be stored as further away cannot matter. Four threads per block. */

const uint BOXES = uint(2 * SDFGI_BOUNDS_STRIPS);
const uint BLOCKS = uint(SDFGI_GROUP_LINES / 4);
const int FAR = 2 * SDFGI_BOUNDS_ORIGIN; /* cells: beyond all boxes */

shared ivec3 bounds_lows[BOXES + 2u],
    bounds_highs[BOXES + 2u]; /* the last two: around all that went, and all that came */
shared uint bounds_count;
shared uint stale[2];

void bounds_keep(ivec3 low, ivec3 high, uint all)
{
    const uint i = atomicAdd(bounds_count, 1u);
    bounds_lows[i] = low;
    bounds_highs[i] = high;
    for (int axis = 0; axis < 3; axis++) {
        atomicMin(bounds_lows[all][axis], low[axis]);
        atomicMax(bounds_highs[all][axis], high[axis]);
    }
}

/* Brings boxes that hold anything to the front, in any order. */
void fetch_bounds()
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
            bounds_keep(low, high, BOXES + uint(lane >= BOUNDS_ADDED));
    }
    barrier();
}

/* Two's complement, 16 bits each. */
bool block_changed(ivec3 block)
{
    for (uint i = 0u; i < args.box_count; i++) {
        const ivec3 corners =
            ivec3(args.corners[3u * i], args.corners[3u * i + 1u], args.corners[3u * i + 2u]);
        if (all(lessThan(corners << 16 >> 16, 4 * block + 4)) && all(greaterThan(corners >> 16, 4 * block)))
            return true;
    }
    return false;
}

/* Whether a sub-voxel of a box may be as near to the centre of a cell of [first, last] as `stored` says, and
 * within reach. Further than the cascade is wide is as good as that: nearer than it is only costs a search.
 */
bool bounds_reaches(uint box, ivec3 first, ivec3 last, uint stored)
{
    const ivec3 way = clamp(max(8 * (bounds_lows[box] - last) - 3, 8 * (first - bounds_highs[box]) + 5), 1,
                            8 * sdfgi_space_resolution() - 1);
    const uvec3 square = uvec3(way * way);
    const uint most = min(stored, sdfgi_distance_reach() - 1u);
    return distance_square(16u * (square.x + square.z) + distance_y_weight() * square.y) <=
           most * (most + 2u);
}

/* A layer of 4x4 cells. */
bool layer_is_stale(ivec3 first)
{
    uint pairs[8], most = 0u;
    for (int i = 0; i < 8; i++)
        pairs[i] =
            sdfgi_distances[sdfgi_cell_index(args.cascade, first + ivec3(2 * (i & 1), i >> 1, 0)) >> 1u];
    for (int i = 0; i < 8; i++)
        most = max(most, max(pairs[i] & 0xffffu, pairs[i] >> 16u));
    /* Two boxes rule out most layers, and with them up to 32. */
    if (!bounds_reaches(BOXES, first, first + ivec3(3, 3, 0), most) &&
        !bounds_reaches(BOXES + 1u, first, first + ivec3(3, 3, 0), most))
        return false;
    for (uint box = 0u; box < bounds_count; box++) {
        if (!bounds_reaches(box, first, first + ivec3(3, 3, 0), most))
            continue;
        for (int i = 0; i < 8; i++) {
            const ivec3 cell = first + ivec3(2 * (i & 1), i >> 1, 0);
            if (bounds_reaches(box, cell, cell, pairs[i] & 0xffffu) ||
                bounds_reaches(box, cell + ivec3(1, 0, 0), cell + ivec3(1, 0, 0), pairs[i] >> 16u))
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
        stale[lane] = 0u;
    fetch_bounds();
    for (uint y = lane / 4u; y < side; y += BLOCKS) {
        const ivec3 block = ivec3(x, y, z);
        if (args.box_count == 0u || block_changed(block) ||
            layer_is_stale(4 * block + ivec3(0, 0, lane & 3u)))
            atomicOr(stale[y >> 5u], 1u << (y & 31u));
    }
    barrier();
    if (lane < 2u)
        sdfgi_scratch[stale_slot(x, z) + lane] = stale[lane];
    if (lane == 0u && (stale[0] | stale[1]) != 0u)
        counter_add(SDFGI_COUNTER_DISTANCE_CELLS, 64u * uint(bitCount(stale[0]) + bitCount(stale[1])));
}

void main()
{
    const uint n = sdfgi_frame.resolution, row_groups = n * n / COLUMNS;
    if (gl_WorkGroupID.x < row_groups)
        find_rows(gl_WorkGroupID.x);
    else
        find_blocks(gl_WorkGroupID.x - row_groups);
}
