/* SPDX-License-Identifier: MIT
 * The largest cube of empty cells that begins at an empty cell, for each of the eight ways in which a ray may
 * lead: the chessboard distance per octant of Es and Isler 2007, "Accelerated regular grid traversals using
 * extended anisotropic chessboard distance fields on a parallel stream processor". What lies beyond the
 * cascade counts as empty: no step leads there. An empty cell holds them in the place of its sub-voxels, four
 * bits for each octant, numbered by a bit for each axis along which it leads down.
 *
 * A workgroup has a word of 32 cells along x in each of SDFGI_CUBES_ROWS^2 rows. Round k knows of all cells
 * from which on a cube of k cells along a side is not empty, a bit each. A larger cube is not empty where
 * one of the eight smaller ones in its corners is not. Each cell counts the rounds in which its cubes were
 * empty; counters of 32 cells are four words, one per digit. */
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
#define SDFGI_WRITES_BITS
#include "pass.glsl"
#include "workgroup.glsl"

layout(local_size_x = SDFGI_GROUP_CUBES) in;
SDFGI_PUSH(sdfgi_cascade_args);

const int ROWS = SDFGI_CUBES_ROWS;
const int REACH = SDFGI_LARGEST_CUBE - 1;     /* cells around the rows that cubes may touch */
const int SIDE = ROWS + 2 * REACH;            /* rows of the region along y, and along z */
const int NEXT_Y = 3, NEXT_Z = NEXT_Y * SIDE; /* a row has its word, and the words before and after it */
const int WORDS = NEXT_Z * SIDE;
const int PER_THREAD = (WORDS - 1) / SDFGI_GROUP_CUBES + 1;
const uint OCTANTS = 8u, DIGITS = 4u;
/* A thread counts for an octant in several rows. */
const uint THREADS_PER_OCTANT = uint(SDFGI_GROUP_CUBES) / OCTANTS;
const uint ROWS_PER_THREAD = uint(ROWS * ROWS) / THREADS_PER_OCTANT;

/* The rounds write what is beyond their reach, and read zeros behind the end. In the end it holds counters: a
 * word per row, octant and digit. */
shared uint region[WORDS + NEXT_Z + NEXT_Y + 1];
shared bool any_occupied;

uvec3 first_cell()
{
    const uint words = sdfgi_frame.resolution / 32u, rows = sdfgi_frame.resolution / uint(ROWS),
               n = workgroup_index();
    return uvec3(32u, ROWS, ROWS) * uvec3(n % words, n / words % rows, n / words / rows);
}

/* The word of the region at `i`: 0 beyond the cascade. */
uint load_word(int i, ivec3 first)
{
    const ivec3 cell = first + ivec3(32 * (i % NEXT_Y - 1), i / NEXT_Y % SIDE - REACH, i / NEXT_Z - REACH);
    if (!sdfgi_cell_is_inside(cell))
        return 0u;
    return sdfgi_scratch_at(sdfgi_texel_index(uvec3(cell)) >> 5u);
}

/* False if the whole region is empty. */
bool load_region(ivec3 first)
{
    const int lane = int(gl_LocalInvocationIndex);
    if (lane == 0)
        any_occupied = false;
    barrier();
    for (int i = lane; i < region.length(); i += SDFGI_GROUP_CUBES) {
        const uint word = i < WORDS ? load_word(i, first) : 0u;
        region[i] = word;
        if (word != 0u)
            any_occupied = true;
    }
    barrier();
    return any_occupied;
}

/* From cubes to those that are one cell larger. */
void enlarge_cubes()
{
    const int lane = int(gl_LocalInvocationIndex);
    uint larger[PER_THREAD];
    [[unroll]] for (int k = 0; k < PER_THREAD; k++)
    {
        const int i = min(lane + SDFGI_GROUP_CUBES * k, WORDS - 1);
        const uint here = region[i] | region[i + NEXT_Y] | region[i + NEXT_Z] | region[i + NEXT_Y + NEXT_Z],
                   after = region[i + 1] | region[i + NEXT_Y + 1] | region[i + NEXT_Z + 1] |
                           region[i + NEXT_Y + NEXT_Z + 1];
        larger[k] = here | here >> 1u | after << 31u;
    }
    barrier();
    [[unroll]] for (int k = 0; k < PER_THREAD; k++)
    {
        if (lane + SDFGI_GROUP_CUBES * k < WORDS)
            region[lane + SDFGI_GROUP_CUBES * k] = larger[k];
    }
    barrier();
}

/* A bit for each of the 32 cells of a row whose cube in an octant is not empty. `reach`: cells from a cube's
 * first to its last. */
uint row_occupied(uint row, uint octant, int reach)
{
    const int y = int(row) % ROWS + REACH - ((octant & 2u) != 0u ? reach : 0),
              z = int(row) / ROWS + REACH - ((octant & 4u) != 0u ? reach : 0),
              i = NEXT_Z * z + NEXT_Y * y + 1;
    if ((octant & 1u) == 0u || reach == 0)
        return region[i];
    return region[i] << reach | region[i - 1] >> (32 - reach);
}

/* Adds 1 to the counters of cells. */
void count_cells(uint cells, inout uint digits[DIGITS])
{
    [[unroll]] for (uint d = 0u; d < DIGITS; d++)
    {
        const uint carry = digits[d] & cells;
        digits[d] ^= cells;
        cells = carry;
    }
}

/* Stores the counters of the eight octants of each cell. All are 0 where the cell is occupied. */
void store_cubes(uvec3 first)
{
    for (uint n = gl_LocalInvocationIndex; n < uint(32 * ROWS * ROWS); n += uint(SDFGI_GROUP_CUBES)) {
        const uint row = n / 32u, x = n % 32u;
        uint cubes = 0u;
        for (uint k = 0u; k < OCTANTS * DIGITS; k++)
            cubes |= (region[OCTANTS * DIGITS * row + k] >> x & 1u) << k;
        const uvec3 cell = first + uvec3(x, row % uint(ROWS), row / uint(ROWS));
        if (cubes != 0u)
            sdfgi_bits[sdfgi_cell_index(args.cascade, ivec3(cell))] = uvec2(cubes, SDFGI_CUBES_MARK);
    }
}

void main()
{
    const uint lane = gl_LocalInvocationIndex, octant = lane / THREADS_PER_OCTANT;
    const uvec3 first = first_cell();
    const bool any = load_region(ivec3(first));
    uint digits[ROWS_PER_THREAD][DIGITS];
    [[unroll]] for (uint k = 0u; k < ROWS_PER_THREAD; k++)
    {
        for (uint d = 0u; d < DIGITS; d++)
            digits[k][d] = any ? 0u : 0xffffffffu;
    }
    for (int reach = 0; any && reach <= REACH; reach++) {
        if (reach > 0)
            enlarge_cubes();
        [[unroll]] for (uint k = 0u; k < ROWS_PER_THREAD; k++)
        {
            const uint row = lane % THREADS_PER_OCTANT + THREADS_PER_OCTANT * k;
            count_cells(~row_occupied(row, octant, reach), digits[k]);
        }
    }
    barrier();
    [[unroll]] for (uint k = 0u; k < ROWS_PER_THREAD; k++)
    {
        const uint row = lane % THREADS_PER_OCTANT + THREADS_PER_OCTANT * k;
        for (uint d = 0u; d < DIGITS; d++)
            region[OCTANTS * DIGITS * row + DIGITS * octant + d] = digits[k][d];
    }
    barrier();
    store_cubes(first);
}
