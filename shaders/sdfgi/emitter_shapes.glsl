/* SPDX-License-Identifier: MIT
 * Where emitters are in their albedo blocks, and how much of what lies there emits. */
#ifndef SDFGI_EMITTER_SHAPES_GLSL
#define SDFGI_EMITTER_SHAPES_GLSL

#include "surface.glsl"

#ifdef SDFGI_WRITES_EMITTERS
#define SDFGI_ACCESS_EMITTERS
#else
#define SDFGI_ACCESS_EMITTERS readonly
#endif

/* Per cascade: the number of listed emitters, and 1 if these are all; from word 8 on the list,
 * SDFGI_EMITTER_WORDS each, in the order of their blocks; from word SDFGI_EMITTERS_STRIDE on two words for
 * each block that emits: its shape, and what its sides show of that. */
layout(std430, set = SDFGI_SET_WORK,
       binding = SDFGI_BINDING_EMITTERS) SDFGI_ACCESS_EMITTERS buffer sdfgi_emitters_buffer
{
    uint sdfgi_emitters[];
};

/* Word of the number of a cascade's emitters. */
uint emitter_count_word(uint cascade)
{
    return cascade * (uint(SDFGI_EMITTERS_STRIDE) + 2u * sdfgi_albedo_block_count());
}

uint emitter_shape_word(uint cascade, uint block)
{
    return emitter_count_word(cascade) + uint(SDFGI_EMITTERS_STRIDE) + 2u * block;
}

/* Sub-voxels of a block, both included. */
struct emitter_bounds {
    uvec3 low, high;
};

/* Bounds in 3 bits per axis, and `fill` in 14 bits: the emitters' own area over the sum of the areas that the
 * block's six sides see. It is 1 for a level square or for a box, and 2/3 for a sphere; more belongs to what
 * no side sees. 0 stands for an emitter that its box does not describe, and that is not to be listed. */
uint emitter_shape_pack(emitter_bounds bounds, float fill)
{
    const uvec3 low = bounds.low, high = bounds.high;
    return low.x | low.y << 3u | low.z << 6u | high.x << 9u | high.y << 12u | high.z << 15u |
           uint(round(clamp(fill, 0.0, 1.0) * 16383.0)) << 18u;
}

float emitter_shape_fill(uint shape)
{
    return float(shape >> 18u) / 16383.0;
}

emitter_bounds emitter_shape_bounds(uint shape)
{
    return emitter_bounds(uvec3(shape, shape >> 3u, shape >> 6u) & 7u,
                          uvec3(shape >> 9u, shape >> 12u, shape >> 15u) & 7u);
}

/* A side of a block shows surfaces within the bounds of what emits, and others beyond them, which emit
 * nothing. `share` is that of the former: what the block's side emits over what these emit. It is stored as a
 * square root, in 5 bits. */
uint emitter_share_pack(float share, uint side)
{
    return uint(round(31.0 * sqrt(clamp(share, 0.0, 1.0)))) << (5u * side);
}

/* What a sub-voxel of a block emits, over what the block's side does. `word` is that of the block's shape. */
float emitter_gain(uint word, uvec3 subvoxel, uint side)
{
    const emitter_bounds bounds = emitter_shape_bounds(sdfgi_emitters_at(word));
    const bool inside =
        all(greaterThanEqual(subvoxel, bounds.low)) && all(lessThanEqual(subvoxel, bounds.high));
    const float root = float(sdfgi_emitters_at(word + 1u) >> (5u * side) & 31u);
    return inside ? 31.0 * 31.0 / max(root * root, 1.0) : 0.0;
}

#endif
