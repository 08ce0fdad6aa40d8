/* SPDX-License-Identifier: MIT
 * From which cells on cubes of 1 to SDFGI_BOX_SIZES cells along a side are not empty: cubes.glsl. A workgroup
 * has a tile: a word of 32 cells along x in each of SDFGI_CUBES_ROWS^2 rows. A larger cube is not empty where
 * one of the eight smaller ones in its corners is not. */
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
#define SDFGI_WRITES_SCRATCH
#include "pass.glsl"
#include "cubes.glsl"

layout(local_size_x = SDFGI_GROUP_CUBES) in;
SDFGI_PUSH(sdfgi_cascade_args);

const int ROWS = SDFGI_CUBES_ROWS;
const int SIDE = ROWS + SDFGI_BOX_SIZES - 1;  /* rows that cubes of the tile touch along y, and along z */
const int NEXT_Y = 2, NEXT_Z = NEXT_Y * SIDE; /* a row has its word, and the one after it */
const int WORDS = NEXT_Z * SIDE;
const int PER_THREAD = (WORDS - 1) / SDFGI_GROUP_CUBES + 1;

/* Rounds read zeros behind the end, and what they make beyond their reach is not stored. */
shared uint region[WORDS + NEXT_Z + NEXT_Y + 1];

/* The word of the region at `i`. */
uint load_word(int i, ivec3 first)
{
    const ivec3 cell = first + ivec3(32 * (i % NEXT_Y), i / NEXT_Y % SIDE, i / NEXT_Z);
    return i < WORDS && sdfgi_cell_is_inside(cell) ? sdfgi_scratch_at(sdfgi_texel_index(uvec3(cell)) >> 5u)
                                                   : 0u;
}

/* To cubes that are one cell larger. */
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

void store_cubes(int size, ivec3 first)
{
    for (int i = int(gl_LocalInvocationIndex); i < ROWS * ROWS; i += SDFGI_GROUP_CUBES) {
        const ivec2 row = ivec2(i % ROWS, i / ROWS);
        sdfgi_scratch[cubes_word(size, first + ivec3(0, row))] = region[NEXT_Y * row.x + NEXT_Z * row.y];
    }
}

void main()
{
    const ivec3 first = (ivec3(gl_WorkGroupID) - 1) * CUBES_TILE;
    for (int i = int(gl_LocalInvocationIndex); i < region.length(); i += SDFGI_GROUP_CUBES)
        region[i] = load_word(i, first);
    barrier();
    store_cubes(1, first);
    for (int size = 2; size <= SDFGI_BOX_SIZES; size++) {
        enlarge_cubes();
        store_cubes(size, first);
    }
}
