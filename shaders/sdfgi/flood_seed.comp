/* SPDX-License-Identifier: MIT
 * Points every occupied cell at its own sub-voxel nearest to its centre. One thread per cell. */
#version 460
#extension GL_GOOGLE_include_directive : require
#define SDFGI_WRITES_SCRATCH
#include "../lib/on_cpu.glsl"
#include "flood.glsl"

void main()
{
    const ivec3 cell = ivec3(gl_GlobalInvocationID);
    uint best = NEAREST_NONE;
    float best2 = 1e30;
    nearest_offer(cell, cell, best, best2);
    sdfgi_scratch[flood_slot(0u, cell)] = best;
}
