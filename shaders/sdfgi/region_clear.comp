/* SPDX-License-Identifier: MIT
 * Empties a box of cells before it is voxelised: solid bits, light, masks and the accumulators of its blocks; notes where there
 * were bits. One thread per four cells along x, which share a word of masks; boxes begin and end at multiples of 8 cells. */
#version 460
#extension GL_GOOGLE_include_directive : require
#define SDFGI_WRITES_BITS
#define SDFGI_WRITES_LIGHT
#define SDFGI_WRITES_MASKS
#include "content.glsl"

layout(local_size_x = SDFGI_GROUP_LINEAR) in;
layout(push_constant) uniform sdfgi_push { sdfgi_pass_args args; };

void clear_accumulators(ivec3 cell)
{
    const uint block = block_index(args.cascade, cell);
    for (uint plane = 0u; plane < uint(SDFGI_ACCUM_PLANES); plane++)
        sdfgi_scratch[plane * block_count() + block] = 0u;
}

/* The cells that hold bits were elsewhere before the cascade moved: volumes are toroidal. */
void note_bits(ivec3 first, uint index)
{
    const ivec3 low = args.before.xyz, was = low + (first - low & space_resolution() - 1);
    int held = 0;
    for (int k = 0; k < 4; k++)
        held |= int(sdfgi_bits[index + uint(k)] != uvec2(0u)) << k;
    if (held != 0)
        content_add(args.cascade, CONTENT_WENT, args.before.w, was + ivec3(findLSB(held), 0, 0),
                    was + ivec3(findMSB(held) + 1, 1, 1));
}

void main()
{
    const uvec3 size = uvec3(args.high.xyz - args.low.xyz) / uvec3(4u, 1u, 1u);
    const uint i = gl_GlobalInvocationID.x;
    if (i >= size.x * size.y * size.z)
        return;
    const ivec3 first =
        args.low.xyz + ivec3(4u * (i % size.x), i / size.x % size.y, i / (size.x * size.y));
    const uint index = cell_index(args.cascade, first);
    if (args.before.w >= 0)
        note_bits(first, index);
    for (uint k = 0u; k < 4u; k++)
        sdfgi_bits[index + k] = sdfgi_light[index + k] = uvec2(0u);
    sdfgi_masks[index >> 2u] = 0u;
    if (((first.y | first.z) & 1) == 0) {
        clear_accumulators(first);
        clear_accumulators(first + ivec3(2, 0, 0));
    }
}
