/* SPDX-License-Identifier: MIT
 * Distances within each layer of sub-voxels: for each x and z of cells the nearest sub-voxel of the layer.
 * Along x each row is scanned, because its bits lie side by side. The distances in the rows are the base
 * costs of the search along z (lines.glsl): candidates are the rows within reach that hold bits. Squares of
 * odd numbers are stored as (d^2 - 1) / 8, so their sums are (d^2 + e^2 - 2) / 8.
 *
 * Written for cells in columns that hold dirty blocks, from args.first_x to before args.end_x. */
#version 460
#extension GL_GOOGLE_include_directive : require
#define SDFGI_WRITES_SCRATCH
#extension GL_EXT_control_flow_attributes : require
#include "../lib/on_cpu.glsl"
#ifdef SDFGI_SOFTWARE
#include "distance_plane_alone.glsl"
#else
#include "distance_plane_shared.glsl"
#endif

void main()
{
    if (!layer_is_empty())
        search_layer();
}
