/* SPDX-License-Identifier: MIT
 * What the rays of a surface find in a visit of cell_gather: their light, and from where it comes. */
#ifndef SDFGI_VISIT_LIGHT_GLSL
#define SDFGI_VISIT_LIGHT_GLSL

#include "low_lights.glsl"
#include "../lib/irradiance_pack.glsl"

#ifdef SDFGI_LOBES
const bool VISITS_KEEP_LOW_LIGHT = true;
#else
const bool VISITS_KEEP_LOW_LIGHT = false;
#endif

/* ---- A ray */

/* What is kept of a ray: radiance, and in the high half of the second word where it came from, if that is
 * asked for: how far along the surface, in two directions. 0 there: its light is not known. */
const float RAY_ALONG = 127.0, RAY_ZERO = 128.0;

uint ray_pack_way(vec3 normal, uint axis, vec3 dir)
{
    const uvec2 along = uvec2(dir * sdfgi_low_frame(normal, axis) * RAY_ALONG + (RAY_ZERO + 0.5));
    return along.x | along.y << 8u;
}

uvec2 ray_pack(vec3 normal, uint axis, vec3 dir, vec4 light)
{
    const uvec2 halves = sdfgi_half4_encode(sdfgi_half4_round(min(light, vec4(65504.0))));
    const uint way = VISITS_KEEP_LOW_LIGHT ? ray_pack_way(normal, axis, dir) : 1u;
    return uvec2(halves.x, halves.y & 0xffffu | (light.a > 0.0 ? way << 16u : 0u));
}

/* ---- All rays */

/* Variance of the mean of so many values: from their sum, and from that of their squares. */
float variance_of_mean(float sum, float squares, float count)
{
    const float mean = sum / count;
    return max(squares / count - mean * mean, 0.0) / count;
}

/* What rays of a surface have found, of one kind. */
struct ray_sums {
    vec3 light;
    float count;
    float squares; /* of luminances */
    float low;     /* luminance, as far as it is low: sdfgi_low_light */
    vec4 around;
};

const ray_sums NO_RAYS = ray_sums(vec3(0.0), 0.0, 0.0, 0.0, vec4(0.0));

/* `counts`: rays whose light is not known count, too. */
void ray_add(inout ray_sums sums, uvec2 ray, bool counts)
{
    const float known = ray.y >> 16u == 0u ? 0.0 : 1.0;
    const vec3 light = known * sdfgi_half4_decode(uvec2(ray.x, ray.y & 0xffffu)).rgb;
    const float luminance = sdfgi_light_luminance(light);
    sums.light += light;
    sums.count += counts ? 1.0 : known;
    sums.squares += luminance * luminance;
    if (!VISITS_KEEP_LOW_LIGHT)
        return;
    const vec2 along = (vec2(ray.y >> 16u & 255u, ray.y >> 24u) - RAY_ZERO) / RAY_ALONG;
    const float low = luminance * sdfgi_low_share(dot(along, along));
    sums.low += low;
    sums.around += low * sdfgi_low_around(along);
}

/* The light of a visit to a surface. */
struct visit_light {
    vec3 mean;
    float variance;      /* of the mean's luminance */
    sdfgi_low_light low; /* luminance instead of a part of it */
};

/* From rays at random and those towards emitters. */
visit_light visit_mean(ray_sums at_random, ray_sums to_emitters)
{
    const float count = max(at_random.count, 1.0), emitters = max(to_emitters.count, 1.0);
    return visit_light(
        at_random.light / count + to_emitters.light / emitters,
        variance_of_mean(sdfgi_light_luminance(at_random.light), at_random.squares, count) +
            variance_of_mean(sdfgi_light_luminance(to_emitters.light), to_emitters.squares, emitters),
        sdfgi_low_light(at_random.low / count + to_emitters.low / emitters,
                        at_random.around / count + to_emitters.around / emitters));
}

#endif
