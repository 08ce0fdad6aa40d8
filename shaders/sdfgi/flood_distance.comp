/* SPDX-License-Identifier: MIT
 * Turns pointers into distances, rounded down. One thread per pair of cells that share a word. */
#version 460
#extension GL_GOOGLE_include_directive : require
#define SDFGI_WRITES_DISTANCE
#include "../lib/on_cpu.glsl"
#include "flood.glsl"

uint encode_distance(ivec3 cell)
{
    const uint pointer = sdfgi_scratch_at(flood_slot(args.source, cell));
    if (pointer == NEAREST_NONE)
        return sdfgi_distance_reach();
    return encode_nearest(nearest_distance2(cell, nearest_unpack(pointer)));
}

void main()
{
    /* Cascades scroll by multiples of 8 cells, so that the texels of a pair of cells share a word. */
    const ivec3 cell = ivec3(gl_GlobalInvocationID) * ivec3(2, 1, 1);
    if (!sdfgi_cell_is_inside(cell))
        return;
    const uint low = encode_distance(cell), high = encode_distance(cell + ivec3(1, 0, 0));
    sdfgi_distances[sdfgi_cell_index(args.cascade, cell) >> 1u] = low | high << 16u;
}
