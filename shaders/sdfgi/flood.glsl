/* SPDX-License-Identifier: MIT
 * Jump flooding (Rong and Tan 2006, "Jump flooding in GPU") of pointers to the nearest set sub-voxel. A
 * pointer is its coordinate, 10 bits per axis. Distances are measured to the nearest of a candidate cell's 64
 * sub-voxels, not to one that stands for them: the worst error of one bit per cell is 0.74 cell, of this 0.09
 * with a closing pair of passes (HARD_CASES, jump flood facts). */
#ifndef SDFGI_FLOOD_GLSL
#define SDFGI_FLOOD_GLSL

#include "nearest.glsl"

layout(local_size_x = SDFGI_GROUP_CELLS, local_size_y = SDFGI_GROUP_CELLS,
       local_size_z = SDFGI_GROUP_CELLS) in;

uint flood_slot(uint half_index, ivec3 cell)
{
    const uint n = sdfgi_frame.resolution_log2;
    return (uint(cell.x) | uint(cell.y) << n | uint(cell.z) << (2u * n)) + half_index * (1u << (3u * n));
}

#endif
