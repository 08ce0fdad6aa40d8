/* SPDX-License-Identifier: MIT
 * How rough surfaces of a picture answer to where their light comes from: picture_lobes.glsl. A thread for
 * every fourth pixel along each axis. */
#version 460
#extension GL_GOOGLE_include_directive : require
#include "../lib/on_cpu.glsl"
#include "low_lights.glsl"
#include "../lib/light_pack.glsl"
#include "../lib/rough_lobe.glsl"

/* Of the pixel. */
sdfgi_rough_lobe lobe;

/* What lookups read of a surface, by its number and what arrives there, instead of light: the lobe's answer
 * times luminance, and luminance, times weight; the weight in a. */
vec4 sdfgi_lobe_answer_of_surface(uint surface, uint arriving, uint axis, float weight)
{
    const uint low = sdfgi_seen_at(low_light_word(surface));
    const float known = arriving < SDFGI_SURFACE_UNKNOWN && low != 0u ? weight : 0.0,
                luminance = sdfgi_light_luminance(sdfgi_rgbe_decode_weighted(arriving, known));
    return vec4(sdfgi_rough_lobe_answer(lobe, sdfgi_low_unpack(low), axis) * luminance, luminance, 0.0,
                known);
}

#define SDFGI_ROUGH_LOBES
#include "../include/sdfgi_lookup.glsl"
#include "picture_lobes.glsl"

layout(local_size_x = SDFGI_GROUP_PIXELS, local_size_y = SDFGI_GROUP_PIXELS) in;

/* The lobe's answer times weight, and the weight, of the finest cascade around a point. It asks the light
 * cells at one place alone: pixels that find none there have their neighbours' answers. */
vec2 answer_around(picture_surface s, vec3 to_eye)
{
    const vec3 first = sdfgi_lookup_position(s.pos);
    for (uint c = 0u; c < sdfgi_frame.cascade_count; c++) {
        const vec3 pos = sdfgi_cascade_from_first(c, first);
        bool in_air = false;
        if (sdfgi_lookup_cascade_weight(c, pos) > 0.0)
            return sdfgi_cells_try(c, pos, s.normal, sdfgi_lookup_eye(c, to_eye), SDFGI_CELLS_ARRIVING,
                                   SDFGI_CELLS_MOVING, in_air)
                .xy;
    }
    return vec2(0.0);
}

/* The word of a pixel's answer. 0 where none is asked, or known. */
uint answer_at(ivec2 pixel)
{
    picture_surface s;
    if (!picture_surface_at(pixel, s))
        return 0u;
    const float roughness = picture_roughness(pixel);
    if (roughness <= sdfgi_frame.rays_blend)
        return 0u;
    const vec3 to_eye = sdfgi_lookup_to_eye(s.to_eye, s.normal);
    lobe = sdfgi_rough_lobe_of(s.normal, to_eye, roughness);
    const vec2 answer = answer_around(s, to_eye);
    return answer.y > 0.0 ? picture_lobe_pack(answer.x / answer.y, s.normal) : 0u;
}

void main()
{
    const ivec2 square = ivec2(gl_GlobalInvocationID.xy), pixel = square * SDFGI_LOBE_STEP;
    if (picture_contains(pixel))
        sdfgi_tiles[picture_lobe_word(square)] = answer_at(pixel);
}
