/* SPDX-License-Identifier: MIT
 * Jump flooding (Rong and Tan 2006, "Jump flooding in GPU") of pointers to the nearest set sub-voxel.
 * Distances are measured to the nearest of the 64 sub-voxels of a cell. With a closing pair of passes the
 * worst error is 0.09 cells; with one point for all sub-voxels of a cell it is 0.74 (HARD_CASES, jump flood
 * facts). */
#ifndef SDFGI_FLOOD_GLSL
#define SDFGI_FLOOD_GLSL

#include "nearest.glsl"

layout(local_size_x = SDFGI_GROUP_CELLS, local_size_y = SDFGI_GROUP_CELLS,
       local_size_z = SDFGI_GROUP_CELLS) in;

/* Place of a cell's pointer in one of the two halves of the scratch buffer. */
uint flood_slot(uint half_index, ivec3 cell)
{
    const uint n = sdfgi_frame.resolution_log2;
    return (uint(cell.x) | uint(cell.y) << n | uint(cell.z) << (2u * n)) + half_index * (1u << (3u * n));
}

#endif
