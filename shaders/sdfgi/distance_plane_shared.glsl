/* SPDX-License-Identifier: MIT
 * A workgroup searches eight lines along z, one for each cell of a run (lines.glsl). */
#ifndef SDFGI_DISTANCE_PLANE_SHARED_GLSL
#define SDFGI_DISTANCE_PLANE_SHARED_GLSL

/* 12.3 KiB of shared memory, of the 16 that every device has. A layer of a village takes one batch. */
const uint BATCH = 324u;

#include "lines.glsl"
#include "rows.glsl"

/* For the ranks of a batch. Costs are below 2 / 8 (8 N)^2, so 20 bits where N is 256. */
const uint RANK_BITS = 9u;

uint first_x()
{
    return (args.first_x & ~7u) + LINES * gl_WorkGroupID.x;
}

/* ---- Candidates */

uint runs_in_reach(uint position)
{
    return runs_near(first_x() >> 3u, position);
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

/* ---- Costs */

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

void search_layer()
{
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

#endif
