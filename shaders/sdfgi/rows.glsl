/* SPDX-License-Identifier: MIT
 * Along x: gaps between the cells of a run and the nearest bits of a row, for distance_plane. A row is named
 * by its position along z. */
#ifndef SDFGI_ROWS_GLSL
#define SDFGI_ROWS_GLSL

#include "occupancy.glsl"

SDFGI_PUSH(sdfgi_distance_search_args);

uint layer()
{
    return gl_WorkGroupID.y;
}

/* The runs within reach of a run in which a row holds bits. */
uint runs_near(uint run, uint position)
{
    const int reach = SDFGI_DISTANCE_REACH / 8, low = max(int(run) - reach, 0),
              high = min(int(run) + reach, 31);
    return runs_of_row(layer(), position) & 0xffffffffu << low & 0xffffffffu >> (31 - high);
}

bool layer_is_empty()
{
    return (layers_at(layer() >> 2u) >> (layer() & 3u) & 1u) == 0u;
}

/* The 32 sub-voxels of a row in a run. Its cells are stored side by side, because cascades scroll by whole
 * runs. */
uint row_bits(uint position, uint run)
{
    const uint first = sdfgi_cell_index(args.cascade, ivec3(8u * run, layer() >> 2u, position >> 2u));
    const uint word = position >> 1u & 1u, shift = 4u * (layer() & 3u) | 16u * (position & 1u);
    uint row = 0u;
    [[unroll]] for (uint i = 0u; i < 8u; i++)
    {
        row |= (sdfgi_subvoxels(first + i)[word] >> shift & 15u) << 4u * i;
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

#endif
