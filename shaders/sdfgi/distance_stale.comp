/* SPDX-License-Identifier: MIT
 * Which blocks of 4^3 cells to search: those with a cell that lies in a changed box, or whose nearest sub-voxel may have been
 * in one, or may be in one now. Stored lengths are rounded down and rounding keeps order: a box whose nearest sub-voxel would
 * be stored as further away cannot matter. One workgroup per column of blocks along y, one thread per block. */
#version 460
#extension GL_GOOGLE_include_directive : require
#include "occupancy.glsl"

layout(local_size_x = SDFGI_GROUP_LINEAR) in;
layout(push_constant) uniform sdfgi_push { sdfgi_stale_args args; };

shared uint stale[2];

/* Two's complement, 16 bits each. */
ivec3 box_low(uint i)
{
    return ivec3(args.corners[3u * i], args.corners[3u * i + 1u], args.corners[3u * i + 2u]) << 16 >> 16;
}

ivec3 box_high(uint i)
{
    return ivec3(args.corners[3u * i], args.corners[3u * i + 1u], args.corners[3u * i + 2u]) >> 16;
}

bool box_matters(uint i, ivec3 cell, uint stored)
{
    /* Along each axis, from the cell's centre to the nearest sub-voxel of the box. Further than the cascade is wide is as good
     * as that: nearer than it is only costs a search. */
    const ivec3 way = clamp(max(8 * (box_low(i) - cell) - 3, 8 * (cell - box_high(i)) + 5), 1, 8 * space_resolution() - 1);
    if (way == ivec3(1))
        return true;
    const uvec3 square = uvec3(way * way);
    return distance_encode(16u * (square.x + square.z) + distance_y_weight() * square.y) <= stored;
}

bool cell_is_stale(ivec3 cell, uint stored)
{
    for (uint i = 0u; i < args.box_count; i++)
        if (box_matters(i, cell, stored))
            return true;
    return false;
}

bool block_is_stale(ivec3 block)
{
    if (args.box_count == 0u)
        return true;
    for (int i = 0; i < 32; i++) {
        const ivec3 cell = 4 * block + ivec3(2 * (i & 1), i >> 1 & 3, i >> 3);
        const uint pair = sdfgi_distances[cell_index(args.cascade, cell) >> 1u];
        if (cell_is_stale(cell, pair & 0xffffu) || cell_is_stale(cell + ivec3(1, 0, 0), pair >> 16u))
            return true;
    }
    return false;
}

void main()
{
    const uint y = gl_LocalInvocationIndex, side = sdfgi_frame.size.x >> 2u;
    const uvec3 block = uvec3(gl_WorkGroupID.x, y, args.first + gl_WorkGroupID.y);
    if (y < 2u)
        stale[y] = 0u;
    barrier();
    if (y < side && block_is_stale(ivec3(block)))
        atomicOr(stale[y >> 5u], 1u << (y & 31u));
    barrier();
    if (y < 2u)
        sdfgi_scratch[stale_slot(block.x, block.z) + y] = stale[y];
    if (y == 0u)
        counter_add(SDFGI_COUNTER_DISTANCE_CELLS, 64u * uint(bitCount(stale[0]) + bitCount(stale[1])));
}
