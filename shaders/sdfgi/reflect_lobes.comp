/* SPDX-License-Identifier: MIT
 * How rough surfaces of a picture answer to where their light comes from: picture_lobes.glsl. A thread for
 * every fourth pixel along each axis. */
#version 460
#extension GL_GOOGLE_include_directive : require
#include "../lib/on_cpu.glsl"
#include "low_lights.glsl"
#define SDFGI_ROUGH_LOBES
#define sdfgi_low_light_at(surface) sdfgi_seen_at(low_light_word(surface))
#include "../include/sdfgi_rough_lobes.glsl"
#include "picture_lobes.glsl"

layout(local_size_x = SDFGI_GROUP_PIXELS, local_size_y = SDFGI_GROUP_PIXELS) in;

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
    const float answer = sdfgi_lobe_answer(sdfgi_lookup_position(s.pos), s.normal, to_eye, roughness);
    return answer > 0.0 ? picture_lobe_pack(answer, s.normal) : 0u;
}

void main()
{
    const ivec2 square = ivec2(gl_GlobalInvocationID.xy), pixel = square * SDFGI_LOBE_STEP;
    if (picture_contains(pixel))
        sdfgi_tiles[picture_lobe_word(square)] = answer_at(pixel);
}
