/* SPDX-License-Identifier: MIT
 * Reflections, beside what sdfgi.glsl gives: include this file instead of that one. Smooth surfaces send a
 * ray and read the light cells that it hits, rough ones show irradiance as their lobe answers to where it
 * comes from, and the two blend between. */
#ifndef SDFGI_REFLECTION_GLSL
#define SDFGI_REFLECTION_GLSL

#define SDFGI_ROUGH_LOBES
#include "sdfgi_reflection_rays.glsl"
#include "../lib/random.glsl"
/* From where the surface of a light cell gets its light; 0: nothing is known. */
layout(set = SDFGI_SET, binding = SDFGI_BINDING_LOW_LIGHT) uniform usamplerBuffer sdfgi_low_light_view;
#define sdfgi_low_light_at(surface)                                                                          \
    texelFetch(sdfgi_low_light_view, int(sdfgi_frame.low_light_begin + (surface))).x
#include "sdfgi_rough_lobes.glsl"

struct sdfgi_surface_light {
    vec3 irradiance;  /* as sdfgi_irradiance has it */
    vec3 reflection;  /* radiance, W/(m^2 sr): the mean over the specular lobe */
    float distance_m; /* to what rays meet; SDFGI_REFLECTION_SKY_M: the sky; 0: no ray */
};

/* Rays that sdfgi_lighting sends over the lobe of a surface that is no mirror. One goes along the middle of
 * the lobe: what it meets has sharp edges, however rough the surface is. Many come near to what a view makes
 * of the rays of neighbouring pixels, and cost as many times as much. Hosts may define it as any uint. */
#ifndef SDFGI_REFLECTION_RAYS
#define SDFGI_REFLECTION_RAYS 1u
#endif
/* Which directions of the lobe they take. With the same number everywhere edges show as copies side by side;
 * where neighbouring pixels differ, as noise. Hosts may define it as any uint. */
#ifndef SDFGI_REFLECTION_SHIFT
#define SDFGI_REFLECTION_SHIFT 0u
#endif

/* The direction of one of `rays` rays, and how much its light counts. */
vec3 sdfgi_reflection_lobe_direction(vec3 normal, vec3 to_eye, float roughness, bool is_metal, uint i,
                                     uint rays, out float counts)
{
    counts = 1.0;
    if (rays == 1u)
        return sdfgi_reflection_direction(normal, to_eye, roughness);
    const vec3 of_facet = sdfgi_reflection_of_facet(normal, to_eye, roughness,
                                                    sdfgi_random_r2(i, SDFGI_REFLECTION_SHIFT)),
               dir = sdfgi_ggx_above(of_facet, normal);
    if (!is_metal)
        counts = sdfgi_reflection_facet_share(normal, to_eye, roughness, dir, dot(of_facet, normal) <= 0.0);
    return dir;
}

/* Light that arrives at a surface point with unit normal, and what of it the surface reflects towards the
 * viewer: the mean over the lobe of the microfacet distribution GGX with alpha = roughness^2, roughness in
 * [0, 1]; that of metal is given below 0, as a view's roughness picture has it. Times the directional albedo
 * of the specular BRDF it is reflected radiance. It comes from surfaces and sky, not from the host's own
 * lights. `to_eye` as for sdfgi_irradiance, and not 0. */
sdfgi_surface_light sdfgi_lighting(vec3 position, vec3 normal, vec3 to_eye, float roughness)
{
    sdfgi_surface_light result = sdfgi_surface_light(vec3(0.0), vec3(0.0), 0.0);
    if (sdfgi_frame.cascade_count == 0u)
        return result;
    const vec3 pos = sdfgi_lookup_position(position), unit = sdfgi_lookup_unit(normal),
               eye = sdfgi_lookup_to_eye(to_eye, unit);
    const float size = abs(roughness), rough_or_1 = size < 1.0 ? size : 1.0;
    const float share = sdfgi_reflection_ray_share(rough_or_1);
    const uint rays = share > 0.0 && rough_or_1 * rough_or_1 > SDFGI_REFLECTION_MIRROR_ALPHA
                          ? max(SDFGI_REFLECTION_RAYS, 1u)
                          : 1u;
    const sdfgi_reflection_hit none = sdfgi_reflection_hit(vec3(0.0), 0u, 0u, 0.0, 0.0);
    const sdfgi_lookup_query surface = sdfgi_lookup_query(SDFGI_LOOKUP_SURFACE, 0u, pos, unit, eye);
    vec3 rough = vec3(0.0), light = vec3(0.0);
    float answers = 1.0; /* of the lobe, over that to even light */
    for (uint k = 0u; k < rays; k++) {
        float counts;
        const vec3 dir =
            sdfgi_reflection_lobe_direction(unit, eye, rough_or_1, roughness < 0.0, k, rays, counts);
        sdfgi_reflection_ray ray = sdfgi_reflection_ray(none, none, vec3(0.0), 0.0);
        if (share > 0.0)
            ray = sdfgi_reflection_trace(pos, unit, dir);
        sdfgi_lookup_query query = k == 0u ? surface : sdfgi_reflection_leaving(ray.first, dir);
        float weight = k == 0u ? 1.0 : ray.first.weight;
        /* The surface first, then what the ray hit. One loop, so that drivers compile the lookup once. */
        for (uint i = min(k, 1u); i < 3u && weight > 0.0; i++) {
            const vec4 found = sdfgi_lookup(query);
            if (i == 0u)
                rough = found.rgb;
            else
                ray.light += weight * found.rgb;
            const sdfgi_reflection_hit hit = i == 0u ? ray.first : ray.second;
            weight = hit.weight;
            query = sdfgi_reflection_leaving(hit, dir);
        }
        light += counts / float(rays) * ray.light;
        result.distance_m += ray.distance_m / float(rays);
    }
    if (share < 1.0 && roughness >= 0.0 && sdfgi_frame.low_light_begin > 0u) {
        const float answer = sdfgi_lobe_answer(pos, unit, eye, rough_or_1);
        answers = answer > 0.0 ? answer : 1.0;
    }
    const float scale = sdfgi_frame.exposure_inverse * sdfgi_frame.energy;
    result.irradiance = rough * (scale * 3.14159265);
    result.reflection = mix(rough * answers, light, share) * scale;
    return result;
}

#endif
