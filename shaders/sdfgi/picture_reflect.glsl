/* SPDX-License-Identifier: MIT
 * What passes over the reflections of a picture share: its images, and a list of the tiles that show
 * something smooth. A tile has 8 x 8 pixels. */
#ifndef SDFGI_PICTURE_REFLECT_GLSL
#define SDFGI_PICTURE_REFLECT_GLSL

#include "picture.glsl"

/* Radiance times the scale in rgb, and metres to what is reflected in a. Rays, and at last the result; and
 * what the filter's first run has made of the rays, in listed tiles. */
layout(set = SDFGI_SET_VIEW, binding = SDFGI_BINDING_VIEW_REFLECTION,
       rgba16f) uniform image2D reflection_image;
layout(set = SDFGI_SET_VIEW, binding = SDFGI_BINDING_VIEW_FILTERED, rgba16f) uniform image2D filtered_image;
layout(set = SDFGI_SET_VIEW, binding = SDFGI_BINDING_VIEW_ROUGHNESS) uniform sampler2D roughness_image;

/* Three words of indirect arguments, the count of listed tiles, and the tiles: x | y << 16. */
layout(std430, set = SDFGI_SET_VIEW, binding = SDFGI_BINDING_VIEW_TILES) buffer sdfgi_tiles_buffer
{
    uint sdfgi_tiles[];
};

const uint TILES_COUNT = 3u;

float picture_roughness(ivec2 pixel)
{
    const float roughness = texelFetch(roughness_image, pixel, 0).r;
    return roughness >= 0.0 && roughness <= 1.0 ? roughness : 1.0;
}

/* The pixel of this thread in the tile of a number of the list. */
ivec2 picture_listed(uint i)
{
    const uint tile = sdfgi_tiles[uint(SDFGI_TILES_HEADER) + i];
    return ivec2(tile & 0xffffu, tile >> 16u) * SDFGI_GROUP_PIXELS + ivec2(gl_LocalInvocationID.xy);
}

/* What a pixel shows, if it reflects by rays. */
bool picture_reflects(ivec2 pixel, out picture_surface s, out float roughness)
{
    roughness = 1.0;
    if (pixel.x < 0 || pixel.y < 0 || pixel.x >= int(args.width) || pixel.y >= int(args.height) ||
        !picture_surface_at(pixel, s))
        return false;
    roughness = picture_roughness(pixel);
    return sdfgi_reflection_ray_share(roughness) > 0.0;
}

#endif
