/* SPDX-License-Identifier: MIT
 * Distances within each layer of sub-voxels: for each x and z of cells the nearest sub-voxel of the layer.
 * Along x each row is scanned, because its bits lie side by side. The distances in the rows are the base
 * costs of the search along z (lines.glsl): candidates are the rows within reach that hold bits. Squares of
 * odd numbers are stored as (d^2 - 1) / 8, so their sums are (d^2 + e^2 - 2) / 8.
 *
 * Written for cells in columns that hold dirty blocks, from args.first_x to before args.end_x. One workgroup
 * per layer and run: eight lines along z, one for each cell of the run. */
#version 460
#extension GL_GOOGLE_include_directive : require
#define SDFGI_WRITES_SCRATCH
#extension GL_EXT_control_flow_attributes : require

/* 12.3 KiB of shared memory, of the 16 that every device has. A layer of a village takes one batch. */
const uint BATCH = 324u;

#include "../lib/on_cpu.glsl"
#include "lines.glsl"

SDFGI_PUSH(sdfgi_distance_search_args);

/* For the ranks of a batch. Costs are below 2 / 8 (8 N)^2, so 20 bits where N is 256. */
const uint RANK_BITS = 9u;

uint layer()
{
    return gl_WorkGroupID.y;
}

uint first_x()
{
    return (args.first_x & ~7u) + LINES * gl_WorkGroupID.x;
}

/* ---- Candidates */

/* The runs within reach in which a row holds bits. */
uint runs_in_reach(uint position)
{
    const int run = int(first_x() >> 3u), runs = SDFGI_DISTANCE_REACH / 8;
    const int low = max(run - runs, 0), high = min(run + runs, 31);
    return runs_of_row(layer(), position) & 0xffffffffu << low & 0xffffffffu >> (31 - high);
}

bool layer_is_empty()
{
    return (layers_at(layer() >> 2u) >> (layer() & 3u) & 1u) == 0u;
}

/* Marks the segments with cells of dirty blocks that this layer may be near to. A run crosses two columns. */
void mark_needed()
{
    for (uint i = gl_LocalInvocationIndex; i < sdfgi_frame.resolution >> 1u; i += SDFGI_GROUP_LINES) {
        const uint x = first_x() + 4u * (i & 1u), z = 2u * (i & ~1u), first = z / line_segment_cells();
        const uint segments = (2u << (z + 3u) / line_segment_cells()) - (1u << first);
        if (x >= args.first_x && x < args.end_x &&
            dirty_within_reach(dirty_blocks(x >> 2u, z >> 2u), int(layer() >> 4u)))
            atomicOr(line_needed, segments);
    }
    barrier();
}

/* The needed segments, and those within reach of one. */
uint segments_in_reach()
{
    const uint reach = (SDFGI_DISTANCE_REACH - 1u) / line_segment_cells() + 1u;
    uint segments = line_needed;
    for (uint i = 0u; i < reach; i++)
        segments |= segments << 1u | segments >> 1u;
    return segments;
}

void mark_rows()
{
    const uint segments = segments_in_reach();
    for (uint z = gl_LocalInvocationIndex; z < sdfgi_frame.resolution; z += SDFGI_GROUP_LINES) {
        if ((segments >> z / line_segment_cells() & 1u) == 0u)
            continue;
        uint rows = 0u;
        [[unroll]] for (uint i = 0u; i < 4u; i++)
        {
            rows |= uint(runs_in_reach(4u * z + i) != 0u) << i;
        }
        line_mark(z, rows);
    }
}

/* ---- Along x: a row is named by its position along z */

/* The 32 sub-voxels of a row in a run. Its cells are stored side by side, because cascades scroll by whole
 * runs. */
uint row_bits(uint position, uint run)
{
    const uint first = sdfgi_cell_index(args.cascade, ivec3(8u * run, layer() >> 2u, position >> 2u));
    const uint word = position >> 1u & 1u, shift = 4u * (layer() & 3u) | 16u * (position & 1u);
    uint row = 0u;
    [[unroll]] for (uint i = 0u; i < 8u; i++)
    {
        row |= (sdfgi_bits_at(first + i)[word] >> shift & 15u) << 4u * i;
    }
    return row;
}

const int NO_BIT = 1 << 16; /* sub-voxels: further than any distance */

/* Unset sub-voxels between the low end of a run and the nearest set one below it. */
int gap_below(uint position, uint runs, uint run)
{
    const int below = findMSB(runs & ((1u << run) - 1u));
    const int last = findMSB(row_bits(position, uint(max(below, 0))));
    return below < 0 ? NO_BIT : 32 * (int(run) - below) - 1 - last;
}

/* Unset sub-voxels between the high end of a run and the nearest set one above it. */
int gap_above(uint position, uint runs, uint run)
{
    const int above = findLSB(runs & ~1u << run);
    const int first = findLSB(row_bits(position, uint(max(above, 0))));
    return above < 0 ? NO_BIT : 32 * (above - int(run) - 1) + first;
}

/* Sub-voxels between the centre of a cell of the run and the nearest set sub-voxel of the row, on either side
 * of the centre. `bits` are those of the run. */
int gap_in_row(uint bits, uint cell, int below, int above)
{
    const uint centre = 4u * cell + 2u;
    const uint low = bits & ((1u << centre) - 1u), high = bits >> centre;
    const int down = int(centre) - 1 - (low != 0u ? findMSB(low) : -1 - below);
    return min(down, high != 0u ? findLSB(high) : 32 - int(centre) + above);
}

/* Costs of a batch. With a gap of g sub-voxels the offset along x is 2 g + 1 halves, and (offset^2 - 1) / 8
 * is g (g + 1) / 2. */
void find_costs(uint count)
{
    const uint run = first_x() >> 3u;
    for (uint i = gl_LocalInvocationIndex; i < count; i += SDFGI_GROUP_LINES) {
        /* No read depends on a test, so that the reads of all three runs overlap. */
        const uint position = line_batch[i], runs = runs_in_reach(position), bits = row_bits(position, run);
        const int below = gap_below(position, runs, run), above = gap_above(position, runs, run);
        for (uint line = 0u; line < LINES; line++) {
            const int gap = gap_in_row(bits, line, below, above);
            line_costs[line * BATCH + i] = line_cost(position, gap * (gap + 1) / 2);
        }
    }
    barrier();
}

/* ---- Results */

/* At most what is out of any reach, or what 16 bits hold. Without candidates it is that. */
uint encoded(uint z, uint line)
{
    const uint most = min(16u * sdfgi_frame.resolution * sdfgi_frame.resolution - 1u, 0xffffu);
    return line_candidates() == 0u ? most : min(uint(line_result(z, line)), most);
}

/* In the order of the words of a plane: four cells along x, two along z, then along x again. */
void store_lines()
{
    for (uint i = gl_LocalInvocationIndex; i < LINES / 2u * sdfgi_frame.resolution; i += SDFGI_GROUP_LINES) {
        const uint line = i << 1u & 2u | i & 4u, z = i >> 1u & 1u | i >> 3u << 1u, x = first_x() + line;
        if (line_segment_needed(z / line_segment_cells()) && x >= args.first_x && x < args.end_x)
            sdfgi_scratch[plane_slot(layer(), x, z)] = encoded(z, line) | encoded(z, line + 1u) << 16u;
    }
}

void main()
{
    if (layer_is_empty())
        return;
    line_begin(1, RANK_BITS);
    mark_needed();
    if (line_needed == 0u)
        return;
    mark_rows();
    line_count();
    const uint count = line_candidates();
    for (uint first = 0u; first < count; first += line_batch_room()) {
        line_begin_batch(first);
        find_costs(min(line_batch_room(), count - first));
        line_search(min(line_batch_room(), count - first));
        barrier();
    }
    line_share_results();
    store_lines();
}
