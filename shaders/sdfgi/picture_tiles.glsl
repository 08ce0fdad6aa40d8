/* SPDX-License-Identifier: MIT
 * The lists of a picture, and what its rough surfaces reflect: the words of one buffer. */
#ifndef SDFGI_PICTURE_TILES_GLSL
#define SDFGI_PICTURE_TILES_GLSL

#include "picture.glsl"

/* The counts and indirect arguments of two lists; all tiles, and all pixels, as x | y << 16; and the answers
 * of rough lobes, one for each square of SDFGI_LOBE_STEP pixels a side. */
layout(std430, set = SDFGI_SET_VIEW, binding = SDFGI_BINDING_VIEW_TILES) buffer sdfgi_tiles_buffer
{
    uint sdfgi_tiles[];
};

uvec2 picture_squares(int side)
{
    return (uvec2(args.width, args.height) + uint(side) - 1u) / uint(side);
}

/* The word of a tile of the list, that of a ray, and that of the lobe of a square. */
uint picture_tile_word(uint i)
{
    return uint(SDFGI_TILES_HEADER) + i;
}

uint picture_ray_word(uint i)
{
    const uvec2 tiles = picture_squares(SDFGI_GROUP_PIXELS);
    return picture_tile_word(tiles.x * tiles.y) + i;
}

uint picture_lobe_word(ivec2 square)
{
    return picture_ray_word(args.width * args.height) + uint(square.x) +
           picture_squares(SDFGI_LOBE_STEP).x * uint(square.y);
}

#endif
