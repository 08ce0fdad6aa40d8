/* SPDX-License-Identifier: MIT
 * One jump: every cell looks at its own pointer and at those of 26 neighbours, args.jump cells away. One
 * thread per cell. */
#version 460
#extension GL_GOOGLE_include_directive : require
#define SDFGI_WRITES_SCRATCH
#include "../lib/on_cpu.glsl"
#include "flood.glsl"

/* Pointer of a neighbour; none outside the cascade. */
uint neighbour(ivec3 cell, ivec3 offset)
{
    const ivec3 other = cell + offset * int(args.jump);
    return sdfgi_cell_is_inside(other) ? sdfgi_scratch_at(flood_slot(args.source, other)) : NEAREST_NONE;
}

/* The nearest of the sub-voxels that the cell and its neighbours point at. */
uint nearest_pointer(ivec3 cell, out float best2)
{
    uint best = NEAREST_NONE;
    best2 = 1e30;
    for (int z = -1; z <= 1; z++)
        for (int y = -1; y <= 1; y++)
            for (int x = -1; x <= 1; x++) {
                const uint pointer = neighbour(cell, ivec3(x, y, z));
                const float d2 =
                    pointer == NEAREST_NONE ? 1e30 : nearest_distance2(cell, nearest_unpack(pointer));
                best = d2 < best2 ? pointer : best;
                best2 = min(best2, d2);
            }
    return best;
}

void main()
{
    const ivec3 cell = ivec3(gl_GlobalInvocationID);
    /* First one distance per pointer, because that rules out most cells before their bits are read. */
    float best2;
    uint best = nearest_pointer(cell, best2);
    uint tested = NEAREST_NONE; /* the cell that was tested last */
    if (best != NEAREST_NONE)
        for (int z = -1; z <= 1; z++)
            for (int y = -1; y <= 1; y++)
                for (int x = -1; x <= 1; x++) {
                    const uint pointer = neighbour(cell, ivec3(x, y, z));
                    const uint other = pointer & NEAREST_CELL_MASK;
                    if (pointer == NEAREST_NONE || other == tested)
                        continue;
                    tested = other;
                    nearest_offer(cell, nearest_unpack(pointer) >> 2, best, best2);
                }
    sdfgi_scratch[flood_slot(1u - args.source, cell)] = best;
}
