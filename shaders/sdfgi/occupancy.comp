/* SPDX-License-Identifier: MIT
 * Which rows of sub-voxels along z hold bits, see occupancy.glsl. Four threads per column of cells along z. */
#version 460
#extension GL_GOOGLE_include_directive : require
#include "occupancy.glsl"

layout(local_size_x = SDFGI_GROUP_LINES) in;
layout(push_constant) uniform sdfgi_push { sdfgi_pass_args args; };

const uint COLUMNS = 32u;

shared uint rows[COLUMNS];

/* Rows set in the eight cells of a run. */
uint rows_of_run(uint x, uint y, uint run)
{
    uvec2 bits = uvec2(0u);
    for (uint i = 0u; i < 8u; i++)
        bits |= cell_bits(args.cascade, ivec3(x, y, 8u * run + i));
    const uint any_half = bits.x | bits.y;
    return (any_half | any_half >> 16u) & 0xffffu;
}

void main()
{
    const uint own = gl_LocalInvocationIndex % COLUMNS, part = gl_LocalInvocationIndex / COLUMNS;
    const uint x = COLUMNS * gl_WorkGroupID.x + own, y = gl_WorkGroupID.y;
    if (part == 0u)
        rows[own] = 0u;
    barrier();
    uint found = 0u;
    for (uint run = 2u * part; run < sdfgi_frame.size.x >> 3u; run += 2u * SDFGI_GROUP_LINES / COLUMNS) {
        const uint two = rows_of_run(x, y, run) | rows_of_run(x, y, run + 1u) << 16u;
        sdfgi_scratch[runs_slot(x, y, run)] = two;
        found |= two;
    }
    atomicOr(rows[own], (found | found >> 16u) & 0xffffu);
    barrier();
    if (part == 0u)
        sdfgi_scratch[rows_slot(x, y)] = rows[own];
}
