/* SPDX-License-Identifier: MIT
 * What rough surfaces of a picture reflect: their irradiance, times the answer of the lobe to where that
 * comes from. Answers are made at every fourth pixel along each axis, and interpolated. Metal has none: its
 * lobe at roughness 1 is close to that of a diffuse surface. */
#ifndef SDFGI_PICTURE_LOBES_GLSL
#define SDFGI_PICTURE_LOBES_GLSL

#include "picture_rays.glsl"
#include "picture_tiles.glsl"
#include "../lib/octahedral.glsl"

/* Pixels whose answers around them weigh less do without. */
const float LOBE_LEAST_WEIGHT = 0.02;

/* An answer, and the normal of the surface that it is for. 0: none. */
uint picture_lobe_pack(float answer, vec3 normal)
{
    const uvec2 map = uvec2((sdfgi_octahedral_encode(normal) * 0.5 + 0.5) * 255.0 + 0.5);
    return packHalf2x16(vec2(answer, 0.0)) | map.x << 16u | map.y << 24u;
}

/* The answer, times weight, of the square in a corner around a pixel; and the weight. It is 0 where the
 * surface faces elsewhere. */
vec2 picture_lobe_near(ivec2 square, vec3 normal, float share)
{
    const ivec2 last = ivec2(picture_squares(SDFGI_LOBE_STEP)) - 1;
    const uint packed = sdfgi_tiles[picture_lobe_word(min(square, last))];
    const vec2 map = vec2(packed >> 16u & 255u, packed >> 24u) / 127.5 - 1.0;
    const float facing = max(dot(sdfgi_octahedral_decode(map), normal), 0.0), facing2 = facing * facing,
                facing4 = facing2 * facing2, weight = packed == 0u ? 0.0 : share * facing4 * facing4;
    return weight * vec2(unpackHalf2x16(packed).x, 1.0);
}

/* By what a rough pixel reflects more than its irradiance over pi. */
float picture_lobe_answer(ivec2 pixel, vec3 normal)
{
    if (sdfgi_frame.keeps_low_light == 0u || picture_is_metal(pixel))
        return 1.0;
    const ivec2 square = pixel / SDFGI_LOBE_STEP;
    const vec2 t = vec2(pixel - square * SDFGI_LOBE_STEP) / float(SDFGI_LOBE_STEP);
    const vec2 sum = picture_lobe_near(square, normal, (1.0 - t.x) * (1.0 - t.y)) +
                     picture_lobe_near(square + ivec2(1, 0), normal, t.x * (1.0 - t.y)) +
                     picture_lobe_near(square + ivec2(0, 1), normal, (1.0 - t.x) * t.y) +
                     picture_lobe_near(square + ivec2(1, 1), normal, t.x * t.y);
    return sum.y < LOBE_LEAST_WEIGHT ? 1.0 : sum.x / sum.y;
}

#endif
