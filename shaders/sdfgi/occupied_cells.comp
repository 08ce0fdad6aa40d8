/* SPDX-License-Identifier: MIT
 * Which cells of a cascade hold a set sub-voxel: a bit each, from which empty_cubes finds empty cubes. A
 * thread looks at eight cells along x, and four threads share a word. */
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
#define SDFGI_WRITES_SCRATCH
#include "pass.glsl"
#include "workgroup.glsl"

layout(local_size_x = SDFGI_GROUP_LINEAR) in;
SDFGI_PUSH(sdfgi_cascade_args);

const uint WORDS = uint(SDFGI_GROUP_LINEAR) / 4u;
shared uint occupied[WORDS];

/* A bit per cell, of the eight from a local cell on. Cascades scroll by eight cells, so these are stored side
 * by side. */
uint occupied_run(uint first_cell)
{
    const uint first = sdfgi_cell_index(args.cascade, ivec3(sdfgi_texel_from_index(first_cell)));
    uint bits = 0u;
    [[unroll]] for (uint i = 0u; i < 8u; i++)
    {
        bits |= uint(!sdfgi_is_empty(first + i)) << i;
    }
    return bits;
}

void main()
{
    const uint lane = gl_LocalInvocationIndex, word = workgroup_index() * WORDS;
    if (lane < WORDS)
        occupied[lane] = 0u;
    barrier();
    atomicOr(occupied[lane / 4u], occupied_run(32u * word + 8u * lane) << 8u * (lane & 3u));
    barrier();
    if (lane < WORDS)
        sdfgi_scratch[word + lane] = occupied[lane];
}
