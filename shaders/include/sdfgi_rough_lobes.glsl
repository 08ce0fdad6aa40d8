/* SPDX-License-Identifier: MIT
 * What rough surfaces reflect more than their irradiance over pi: the answer of their lobes to where that
 * comes from, which light cells keep. Whoever includes this file defines SDFGI_ROUGH_LOBES first, and
 * sdfgi_low_light_at(surface): the word of a surface by its number, as lib/low_light.glsl packs it. */
#ifndef SDFGI_ROUGH_LOBES_GLSL
#define SDFGI_ROUGH_LOBES_GLSL

#include "sdfgi_lookup.glsl"
#include "../lib/light_pack.glsl"
#include "../lib/rough_lobe.glsl"

/* A lobe's answer is within these. */
const float SDFGI_LOBE_LEAST_ANSWER = 1e-3;
const float SDFGI_LOBE_MOST_ANSWER = 64.0;

/* That is asked. */
sdfgi_rough_lobe sdfgi_lobe;

/* What lookups read of a surface, by its number and what arrives there, instead of light: the lobe's answer
 * times luminance, and luminance, times weight; the weight in a. */
vec4 sdfgi_lobe_answer_of_surface(uint surface, uint arriving, uint axis, float weight)
{
    const uint low = sdfgi_low_light_at(surface);
    const float known = arriving < SDFGI_SURFACE_UNKNOWN && low != 0u ? weight : 0.0,
                luminance = sdfgi_light_luminance(sdfgi_rgbe_decode_weighted(arriving, known));
    return vec4(sdfgi_rough_lobe_answer(sdfgi_lobe, sdfgi_low_unpack(low), axis) * luminance, luminance, 0.0,
                known);
}

/* The lobe's answer to light at a point, over its answer to as much even light; 0: none is known. It asks the
 * light cells at one place of the finest cascade alone: others would take long, and mostly tell the same.
 * `to_eye` has a length. */
float sdfgi_lobe_answer(vec3 pos_first, vec3 normal, vec3 to_eye, float roughness)
{
    sdfgi_lobe = sdfgi_rough_lobe_of(normal, to_eye, roughness);
    vec2 answer = vec2(0.0);
    for (uint c = 0u; c < sdfgi_frame.cascade_count; c++) {
        const vec3 pos = sdfgi_cascade_from_first(c, pos_first);
        bool in_air = false;
        if (sdfgi_lookup_cascade_weight(c, pos) > 0.0) {
            answer = sdfgi_cells_try(c, pos, normal, sdfgi_lookup_eye(c, to_eye), SDFGI_CELLS_ANSWER,
                                     SDFGI_CELLS_MOVING, in_air)
                         .xy;
            break;
        }
    }
    return answer.y > 0.0 && answer.x >= 0.0
               ? clamp(answer.x / answer.y, SDFGI_LOBE_LEAST_ANSWER, SDFGI_LOBE_MOST_ANSWER)
               : 0.0;
}

#endif
