/* SPDX-License-Identifier: MIT
 * Empties a box of cells before it is voxelised. Visibility bits stay: light cells read them until the change
 * completes. Adds the cells that held bits to the dirty bounds. One thread per four cells along y. Threads
 * follow one another along x, because cells are stored side by side along x. The box begins and ends at
 * multiples of 8 cells.
 */
#version 460
#extension GL_GOOGLE_include_directive : require
#define SDFGI_WRITES_BITS
#include "../lib/on_cpu.glsl"
#include "dirty_bounds.glsl"
#include "workgroup.glsl"

layout(local_size_x = SDFGI_GROUP_LINEAR) in;
SDFGI_PUSH(sdfgi_region_args);

/* Adds those of four cells that hold bits to the dirty bounds; `held` has a bit per cell. Volumes are
 * toroidal, so before a scroll the bits belonged to other cells: those whose storage the box takes over. */
void add_removed(ivec3 first, int held)
{
    const ivec3 low = args.before, removed = low + (first - low & sdfgi_space_resolution() - 1);
    if (held != 0)
        bounds_add(args.cascade, BOUNDS_REMOVED, args.bounds_axis, removed + ivec3(0, findLSB(held), 0),
                   removed + ivec3(1, findMSB(held) + 1, 1));
}

void main()
{
    const uvec3 size = uvec3(args.high - args.low) / uvec3(8u, 4u, 1u);
    const uint i = workgroup_index() * gl_WorkGroupSize.x + gl_LocalInvocationIndex, row = i >> 3u;
    if (row >= size.x * size.y * size.z)
        return;
    const ivec3 first =
        args.low + ivec3(row % size.x * 8u | i & 7u, row / size.x % size.y * 4u, row / (size.x * size.y));
    int held = 0;
    for (int k = 0; k < 4; k++)
        held |= int(!sdfgi_cell_is_empty(args.cascade, first + ivec3(0, k, 0))) << k;
    if (args.bounds_axis >= 0)
        add_removed(first, held);
    for (int k = 0; k < 4; k++)
        sdfgi_bits[sdfgi_cell_index(args.cascade, first + ivec3(0, k, 0))] = uvec2(0u);
}
