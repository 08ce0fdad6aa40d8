/* SPDX-License-Identifier: MIT
 * Distances within a layer of sub-voxels along y: for each cell's x and z the nearest sub-voxel set in that
 * layer. Along x by scanning the bits, which lie side by side there, then along z (lines.glsl). Squares of
 * odd numbers are stored as (d^2 - 1) / 8, their sums as (d^2 + e^2 - 2) / 8. Cells of columns that hold
 * stale blocks, from args.first_x to before args.end_x along x. One workgroup per layer and run of eight
 * cells along x: eight lines along z. */
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require

const uint BATCH =
    324u; /* 12.3 KiB of shared memory, of the 16 that every device has: a layer of a village in one go */

#include "lines.glsl"

layout(push_constant) uniform sdfgi_push
{
    sdfgi_distance_search_args args;
};

/* Sums are below 2 / 8 (8 N)^2: 20 bits where N is 256. */
const uint NUMBER_BITS = 9u;

uint layer()
{
    return gl_WorkGroupID.y;
}

uint first_x()
{
    return (args.first_x & ~7u) + LINES * gl_WorkGroupID.x;
}

/* The runs within reach in which a row holds bits. */
uint runs_of(uint place)
{
    const int run = int(first_x() >> 3u), runs = SDFGI_DISTANCE_REACH / 8;
    const int low = max(run - runs, 0), high = min(run + runs, 31);
    return runs_of_row(layer(), place) & 0xffffffffu << low & 0xffffffffu >> (31 - high);
}

bool layer_holds_any()
{
    return (four_layers(layer() >> 2u) >> (layer() & 3u) & 1u) != 0u;
}

/* Slots with cells of stale blocks to which this layer may matter. A run has two columns of blocks. */
void mark_wanted()
{
    for (uint i = gl_LocalInvocationIndex; i < sdfgi_frame.resolution >> 1u; i += SDFGI_GROUP_LINES) {
        const uint x = first_x() + 4u * (i & 1u), z = 2u * (i & ~1u), first = z / line_cells_per_slot();
        const uint slots = (2u << (z + 3u) / line_cells_per_slot()) - (1u << first);
        if (x >= args.first_x && x < args.end_x &&
            layer_in_reach(stale_blocks(x >> 2u, z >> 2u), int(layer() >> 4u)))
            atomicOr(line_wanted, slots);
    }
    barrier();
}

/* Slots within reach of those. */
uint slots_in_reach()
{
    const uint reach = (SDFGI_DISTANCE_REACH - 1u) / line_cells_per_slot() + 1u;
    uint slots = line_wanted;
    for (uint i = 0u; i < reach; i++)
        slots |= slots << 1u | slots >> 1u;
    return slots;
}

void mark_rows()
{
    const uint slots = slots_in_reach();
    for (uint z = gl_LocalInvocationIndex; z < sdfgi_frame.resolution; z += SDFGI_GROUP_LINES) {
        if ((slots >> z / line_cells_per_slot() & 1u) == 0u)
            continue;
        uint rows = 0u;
        [[unroll]] for (uint i = 0u; i < 4u; i++) rows |= uint(runs_of(4u * z + i) != 0u) << i;
        line_mark(z, rows);
    }
}

/* ---- Along x: rows are named by their place along z */

/* The sub-voxels of a row in a run: cells that lie side by side, as cascades move by whole runs. */
uint row_of_run(uint place, uint run)
{
    const uint first = sdfgi_cell_index(args.cascade, ivec3(8u * run, layer() >> 2u, place >> 2u));
    const uint word = place >> 1u & 1u, shift = 4u * (layer() & 3u) | 16u * (place & 1u);
    uint row = 0u;
    [[unroll]] for (uint i = 0u; i < 8u; i++) row |= (sdfgi_bits[first + i][word] >> shift & 15u) << 4u * i;
    return row;
}

const int NOTHING = 1 << 16; /* sub-voxels: further than any */

/* Way in sub-voxels from the low end of a run down to the nearest set one below it. */
int way_below(uint place, uint runs, uint run)
{
    const int below = findMSB(runs & ((1u << run) - 1u));
    const int last = findMSB(row_of_run(place, uint(max(below, 0))));
    return below < 0 ? NOTHING : 32 * (int(run) - below) - 1 - last;
}

/* From the high end of a run up to the nearest set one above it. */
int way_above(uint place, uint runs, uint run)
{
    const int above = findLSB(runs & ~1u << run);
    const int first = findLSB(row_of_run(place, uint(max(above, 0))));
    return above < 0 ? NOTHING : 32 * (above - int(run) - 1) + first;
}

/* Steps of a sub-voxel from the one next to a cell's centre to the nearest set one of a row, on either side.
 */
int steps_along_row(uint bits, uint cell, int below, int above)
{
    const uint centre = 4u * cell + 2u;
    const uint low = bits & ((1u << centre) - 1u), high = bits >> centre;
    const int down = int(centre) - 1 - (low != 0u ? findMSB(low) : -1 - below);
    return min(down, high != 0u ? findLSB(high) : 32 - int(centre) + above);
}

/* What the rows of a batch amount to. */
void put_rows(uint count)
{
    const uint run = first_x() >> 3u;
    for (uint at = gl_LocalInvocationIndex; at < count; at += SDFGI_GROUP_LINES) {
        /* Nothing here asks before it reads: all three runs are waited for once. */
        const uint place = line_batch[at], runs = runs_of(place), bits = row_of_run(place, run);
        const int below = way_below(place, runs, run), above = way_above(place, runs, run);
        for (uint own = 0u; own < LINES; own++) {
            const int steps = steps_along_row(bits, own, below, above);
            line_sums[own * BATCH + at] = line_sum(place, steps * (steps + 1) / 2);
        }
    }
    barrier();
}

/* What no row is in reach of is as far as anything can be, or 16 bits hold. */
uint encoded(uint z, uint own)
{
    const uint most = min(16u * sdfgi_frame.resolution * sdfgi_frame.resolution - 1u, 0xffffu);
    return line_candidates() == 0u ? most : min(uint(line_result(z, own)), most);
}

/* In the order in which the words lie: four cells along x, two along z, then along x again. */
void store_lines()
{
    for (uint i = gl_LocalInvocationIndex; i < LINES / 2u * sdfgi_frame.resolution; i += SDFGI_GROUP_LINES) {
        const uint own = i << 1u & 2u | i & 4u, z = i >> 1u & 1u | i >> 3u << 1u, x = first_x() + own;
        if (line_slot_wanted(z / line_cells_per_slot()) && x >= args.first_x && x < args.end_x)
            sdfgi_scratch[plane_slot(layer(), x, z)] = encoded(z, own) | encoded(z, own + 1u) << 16u;
    }
}

void main()
{
    if (!layer_holds_any())
        return;
    line_begin(1, NUMBER_BITS);
    mark_wanted();
    if (line_wanted == 0u)
        return;
    mark_rows();
    line_count();
    const uint count = line_candidates();
    for (uint first = 0u; first < count; first += line_room()) {
        line_put_batch(first);
        put_rows(min(line_room(), count - first));
        line_search(min(line_room(), count - first));
        barrier();
    }
    line_publish();
    store_lines();
}
