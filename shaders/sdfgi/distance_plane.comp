/* SPDX-License-Identifier: MIT
 * Distances within a layer of sub-voxels along y: for each cell's x and z the nearest sub-voxel set in that layer. Along x by
 * scanning the bits, which lie side by side there, then along z (lines.glsl). Squares of odd numbers are stored as (d^2 - 1) / 8, their sums as
 * (d^2 + e^2 - 2) / 8, which fits above a place. Cells of the stale blocks, where their columns hold any, from args.step to
 * before args.source along x.
 * One workgroup per layer and run of eight cells along x: eight lines along z. */
#version 460
#extension GL_GOOGLE_include_directive : require

const uint BATCH = 184u; /* as many as shared memory has room for: 16 KiB are all that every device has */

#include "lines.glsl"

layout(push_constant) uniform sdfgi_push { sdfgi_pass_args args; };

uvec4 line_values(ivec4 way, uint brought)
{
    return (uvec4(way * way) >> 3u) + brought;
}

uint layer()
{
    return gl_WorkGroupID.y;
}

uint first_x()
{
    return (args.step & ~7u) + LINES * gl_WorkGroupID.x;
}

/* Which of the four rows of a column lie in this layer and hold bits. */
uint rows_of(uint z)
{
    return sdfgi_scratch[rows_slot(layer() >> 2u, z)] >> 4u * (layer() & 3u) & 15u;
}

bool column_is_stale(uint x, uint block_z)
{
    const uint slot = stale_slot(x >> 2u, block_z);
    return x >= args.step && x < args.source && (sdfgi_scratch[slot] | sdfgi_scratch[slot + 1u]) != 0u;
}

void mark_rows()
{
    for (uint z = gl_LocalInvocationIndex; z < sdfgi_frame.size.x; z += SDFGI_GROUP_LINES)
        line_mark(z, rows_of(z));
}

void mark_wanted()
{
    for (uint z = gl_LocalInvocationIndex; z < sdfgi_frame.size.x >> 2u; z += SDFGI_GROUP_LINES)
        if (column_is_stale(first_x(), z) || column_is_stale(first_x() + 4u, z))
            for (uint i = 0u; i < 4u; i++)
                atomicOr(line_wanted, 1u << (4u * z + i) / line_cells_per_slot());
}

/* ---- Along x: rows are named by their place along z */

/* The sub-voxels of a row in a run. */
uint row_of_run(uint place, uint run)
{
    const uint shift = 4u * (layer() & 3u) | 16u * (place & 1u);
    uint row = 0u;
    for (uint i = 0u; i < 8u; i++) {
        const uvec2 bits = cell_bits(args.cascade, ivec3(8u * run + i, layer() >> 2u, place >> 2u));
        row |= (((place & 2u) != 0u ? bits.y : bits.x) >> shift & 15u) << 4u * i;
    }
    return row;
}

/* A bit per run in which a row holds bits. All are read at once: one wait. */
uint runs_of_row(uint place)
{
    const uint shift = (place & 3u) | 4u * (layer() & 3u);
    uint runs = 0u;
    for (uint run = 0u; run < sdfgi_frame.size.x >> 3u; run += 2u) {
        const uint two = sdfgi_scratch[runs_slot(layer() >> 2u, place >> 2u, run)] >> shift;
        runs |= ((two & 1u) | (two >> 15u & 2u)) << run;
    }
    return runs;
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

/* Steps of a sub-voxel from the one next to a cell's centre to the nearest set one of a row, on either side. */
uint steps_along_row(uint bits, uint cell, int below, int above)
{
    const uint centre = 4u * cell + 2u;
    const uint low = bits & ((1u << centre) - 1u), high = bits >> centre;
    const int down = int(centre) - 1 - (low != 0u ? findMSB(low) : -1 - below);
    return uint(min(down, high != 0u ? findLSB(high) : 32 - int(centre) + above));
}

/* What the rows of a batch bring along. Threads start at different lines, which are in different banks. */
void put_rows(uint count)
{
    const uint run = first_x() >> 3u;
    for (uint at = gl_LocalInvocationIndex; at < count; at += SDFGI_GROUP_LINES) {
        /* Nothing here asks before it reads: all three runs are waited for once. */
        const uint place = line_batch[at], runs = runs_of_row(place), bits = row_of_run(place, run);
        const int below = way_below(place, runs, run), above = way_above(place, runs, run);
        for (uint i = 0u; i < LINES; i++) {
            const uint own = i + (at >> 2u) & (LINES - 1u), steps = steps_along_row(bits, own, below, above);
            line_entries[at * LINES + own] = (steps * (steps + 1u) / 2u) << PLACE_BITS | place;
        }
    }
    barrier();
}

void store_lines()
{
    const uint count = line_cells_per_slot(), x = first_x() + line_own();
    if (!line_slots_wanted(line_slot(), 1u) || x < args.step || x >= args.source)
        return;
    for (uint z = line_slot() * count; z < (line_slot() + 1u) * count; z++)
        sdfgi_scratch[plane_slot(layer(), x - args.step, z)] = line_least[z * LINES + line_own()];
}

void main()
{
    line_begin();
    mark_rows();
    mark_wanted();
    barrier();
    if (gl_LocalInvocationIndex == 0u && gl_WorkGroupID.x == 0u)
        sdfgi_scratch[layers_slot(layer())] = line_any;
    if (line_any == 0u || line_wanted == 0u)
        return;
    line_count();
    line_clear();
    const uint count = line_candidates();
    for (uint first = 0u; first < count; first += BATCH) {
        line_put_batch(first);
        put_rows(min(BATCH, count - first));
        line_search(min(BATCH, count - first));
        barrier();
    }
    store_lines();
}
