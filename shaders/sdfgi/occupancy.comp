/* SPDX-License-Identifier: MIT
 * Which rows of sub-voxels along x hold bits, see occupancy.glsl. Bits lie side by side along x: a thread reads pairs of runs. */
#version 460
#extension GL_GOOGLE_include_directive : require
#include "occupancy.glsl"

layout(local_size_x = SDFGI_GROUP_LINES) in;
layout(push_constant) uniform sdfgi_push { sdfgi_pass_args args; };

const uint COLUMNS = 32u;

shared uint rows[COLUMNS];

/* A bit per four sub-voxels along x, at the place of the first. */
uint any_of_fours(uint bits)
{
    bits |= bits >> 1u;
    return (bits | bits >> 2u) & 0x11111111u;
}

/* Rows set in the eight cells of a run: z + 4 y. */
uint rows_of_run(uint y, uint z, uint run)
{
    uvec2 bits = uvec2(0u);
    for (uint i = 0u; i < 8u; i++)
        bits |= cell_bits(args.cascade, ivec3(8u * run + i, y, z));
    const uint low = any_of_fours(bits.x), high = any_of_fours(bits.y);
    return (low & 0xffffu) | (low >> 16u) << 1u | (high & 0xffffu) << 2u | (high >> 16u) << 3u;
}

void main()
{
    const uint pairs = sdfgi_frame.size.x >> 4u;
    const uint y = gl_WorkGroupID.y, first_z = COLUMNS * gl_WorkGroupID.x;
    if (gl_LocalInvocationIndex < COLUMNS)
        rows[gl_LocalInvocationIndex] = 0u;
    barrier();
    for (uint i = gl_LocalInvocationIndex; i < COLUMNS * pairs; i += SDFGI_GROUP_LINES) {
        const uint own = i / pairs, run = 2u * (i % pairs);
        const uint two = rows_of_run(y, first_z + own, run) | rows_of_run(y, first_z + own, run + 1u) << 16u;
        sdfgi_scratch[runs_slot(y, first_z + own, run)] = two;
        atomicOr(rows[own], (two | two >> 16u) & 0xffffu);
    }
    barrier();
    if (gl_LocalInvocationIndex < COLUMNS)
        sdfgi_scratch[rows_slot(y, first_z + gl_LocalInvocationIndex)] = rows[gl_LocalInvocationIndex];
}
