/* SPDX-License-Identifier: MIT
 * Distance from each cell's centre to the centre of the nearest set sub-voxel, exact and rounded down. It is
 * the search along y (lines.glsl): candidates are the layers of sub-voxels that hold bits, and the distances
 * that distance_plane found within them are the base costs. The result depends on nothing but the bits. Only
 * dirty blocks are written, from args.first_x to before args.end_x. */
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
#define SDFGI_WRITES_DISTANCE
#include "../lib/on_cpu.glsl"
#ifdef SDFGI_SOFTWARE
#include "distance_exact_alone.glsl"
#else
#include "distance_exact_shared.glsl"
#endif

void main()
{
    search_lines();
}
