/* SPDX-License-Identifier: MIT
 * The front of an albedo block: what is seen first along the columns of sub-voxels that a side looks into. A
 * rug on a floor or a poster on a wall lies in the same sub-voxel as what it hides. A word per 2x2 columns
 * keeps the foremost sample, so that it does not depend on the order of samples: height in its upper eight
 * bits, then two that choose among samples of one height, then the colour with 7, 8 and 7 bits. 0: none. */
#ifndef SDFGI_SURFACE_FRONT_GLSL
#define SDFGI_SURFACE_FRONT_GLSL

const uint FRONTS = 16u;        /* words of a side */
const float FRONT_STEPS = 32.0; /* of height, per sub-voxel */
const vec3 FRONT_COLOR_STEPS = vec3(127.0, 255.0, 127.0);

/* The word of a column: 0 to 7 along the next two axes. */
uint front_of_columns(uvec2 column)
{
    return (column.x >> 1u) + 4u * (column.y >> 1u);
}

/* `height` in sub-voxels from the back of the block, 0 to 8; `albedo` 0 to 1. Samples of one height take
 * turns from word to word. */
uint front_pack(float height, uvec2 column, vec3 albedo)
{
    const uint level = uint(clamp(height * FRONT_STEPS, 1.0, 255.0)),
               turn = (column.x & 1u | (column.y & 1u) << 1u) ^ (column.x >> 1u) + (column.y >> 1u) & 3u;
    const uvec3 color = uvec3(albedo * FRONT_COLOR_STEPS + 0.5);
    return level << 24u | turn << 22u | color.r << 15u | color.g << 7u | color.b;
}

vec3 front_color(uint packed)
{
    return vec3(packed >> 15u & 127u, packed >> 7u & 255u, packed & 127u) / FRONT_COLOR_STEPS;
}

#endif
