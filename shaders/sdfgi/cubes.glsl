/* SPDX-License-Identifier: MIT
 * Where the scratch buffer tells which cubes are not empty: a bit for each cell at which a cube begins and
 * leads up along all axes, a word for every 32 cells along x. Cubes that begin before the cascade are known,
 * too, up to a tile along each axis. What lies beyond the cascade counts as empty: no step leads there. */
#ifndef SDFGI_CUBES_GLSL
#define SDFGI_CUBES_GLSL

#include "../shared/boxes.h"
#include "../shared/scratch.h"

/* Cells of the tile before a cascade. */
const ivec3 CUBES_TILE = ivec3(32, SDFGI_CUBES_ROWS, SDFGI_CUBES_ROWS);

/* The word of the cells from `cell` on, the first of a word, for cubes of so many cells along a side. */
uint cubes_word(int size, ivec3 cell)
{
    const ivec3 at = (cell + CUBES_TILE) / ivec3(32, 1, 1),
                count = (sdfgi_space_resolution() + CUBES_TILE) / ivec3(32, 1, 1);
    return sdfgi_scratch_cubes(sdfgi_frame.resolution_log2, uint(size)) +
           uint(at.x + count.x * (at.y + count.y * at.z));
}

#endif
