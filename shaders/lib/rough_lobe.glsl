/* SPDX-License-Identifier: MIT
 * What the lobe of a rough dielectric reflects of light whose directions are known by low_light.glsl. */
#ifndef SDFGI_ROUGH_LOBE_GLSL
#define SDFGI_ROUGH_LOBE_GLSL

#include "ggx.glsl"
#include "low_light.glsl"

/* Cosine to the normal of the low light at which the lobe is asked, and how low that is. */
const float SDFGI_LOBE_LOW_COSINE = 0.2236;
const float SDFGI_LOBE_LOW_SHARE = 0.774;
/* Azimuths at which it is asked, on one of two sides that are alike. */
const int SDFGI_LOBE_AZIMUTHS = 8;
/* So many do not tell narrower lobes. */
const float SDFGI_LOBE_LEAST_ROUGHNESS = 0.4;
/* The fit of the directional albedo does not reach smaller cosines to the viewer. */
const float SDFGI_LOBE_LEAST_COSINE = 0.1;

/* A lobe's answer to light, over its answer to as much even light. */
struct sdfgi_rough_lobe {
    vec3 normal, forward; /* forward: along the surface, away from the viewer */
    float high;           /* to light that is not low */
    vec3 low;             /* to low light, more than that: from all azimuths, and its cosine series about
                             `forward`, of one and two turns; */
    vec2 beam;            /* and of three and four, which light from one azimuth alone has */
};

/* The lobe towards a direction, times pi, without the cosine of the light. */
float sdfgi_lobe_towards(vec3 normal, vec3 view, vec3 light, float n_v, float alpha)
{
    const vec3 half_way = normalize(view + light);
    const float fresnel = sdfgi_ggx_dielectric(sdfgi_ggx_fresnel_weight(dot(view, half_way)));
    return 3.14159265 * fresnel *
           sdfgi_ggx_facets(normal, half_way, n_v, max(dot(normal, light), 1e-3), alpha);
}

/* Cosines of three and of four times an angle, from its cosine. */
vec2 sdfgi_lobe_turns(float c)
{
    const float c2 = c * c;
    return vec2((4.0 * c2 - 3.0) * c, 8.0 * c2 * (c2 - 1.0) + 1.0);
}

/* `to_eye` leads to the viewer, and has a length. */
sdfgi_rough_lobe sdfgi_rough_lobe_of(vec3 normal, vec3 to_eye, float roughness)
{
    const vec3 view = normalize(to_eye), along = normal * dot(normal, view) - view;
    const vec3 forward =
        dot(along, along) > 1e-8 ? normalize(along) : normalize(cross(normal, vec3(0.36, 0.48, 0.8)));
    const vec3 side = cross(normal, forward);
    const float rough = max(roughness, SDFGI_LOBE_LEAST_ROUGHNESS), alpha = rough * rough,
                n_v = clamp(dot(normal, view), SDFGI_LOBE_LEAST_COSINE, 1.0),
                albedo = sdfgi_ggx_dielectric(sdfgi_ggx_mean_fresnel_weight(n_v, alpha)) *
                         (1.0 - sdfgi_ggx_lost(n_v, alpha)),
                out_of_normal = sqrt(1.0 - SDFGI_LOBE_LOW_COSINE * SDFGI_LOBE_LOW_COSINE);
    vec3 series = vec3(0.0);
    vec2 beam = vec2(0.0);
    for (int i = 0; i < SDFGI_LOBE_AZIMUTHS; i++) {
        const float azimuth = (float(i) + 0.5) * (3.14159265 / float(SDFGI_LOBE_AZIMUTHS)), c = cos(azimuth);
        const vec3 light =
            out_of_normal * (c * forward + sin(azimuth) * side) + SDFGI_LOBE_LOW_COSINE * normal;
        const float towards = sdfgi_lobe_towards(normal, view, light, n_v, alpha);
        series += towards * vec3(1.0, c, 2.0 * c * c - 1.0);
        beam += towards * sdfgi_lobe_turns(c);
    }
    series /= albedo * float(SDFGI_LOBE_AZIMUTHS);
    beam /= albedo * float(SDFGI_LOBE_AZIMUTHS);
    /* Even light has its own answer: high + low.x * SDFGI_LOW_OF_EVEN = 1. */
    const float even = SDFGI_LOW_OF_EVEN / SDFGI_LOBE_LOW_SHARE,
                high = max((1.0 - series.x * even) / (1.0 - even), 0.0);
    return sdfgi_rough_lobe(normal, forward, high,
                            vec3(series.x - high, 2.0 * series.yz) / SDFGI_LOBE_LOW_SHARE,
                            beam * (2.0 / SDFGI_LOBE_LOW_SHARE));
}

/* The answer to light at a surface of a light cell that faces `axis`. Where two moments of its azimuth are as
 * large as those of a beam, it is one, which has all others as well. */
float sdfgi_rough_lobe_answer(sdfgi_rough_lobe lobe, sdfgi_low_light light, uint axis)
{
    const vec4 around = sdfgi_low_around(lobe.forward * sdfgi_low_frame(lobe.normal, axis));
    const float first = length(light.around.xy), second = length(light.around.zw),
                towards = dot(around.xy, light.around.xy),
                beam = first * first * second / max(light.low * light.low, 1e-9);
    const float answer =
        lobe.high + lobe.low.x * light.low + lobe.low.y * towards +
        lobe.low.z * dot(around.zw, light.around.zw) +
        beam * dot(lobe.beam, sdfgi_lobe_turns(clamp(towards / max(first, 1e-6), -1.0, 1.0)));
    return max(answer, 0.0);
}

#endif
