/* SPDX-License-Identifier: MIT
 * Reflections, beside what sdfgi.glsl gives: include this file instead of that one. Smooth surfaces send a
 * ray and read the light cells that it hits, rough ones show irradiance as their lobe answers to where it
 * comes from, and the two blend between. */
#ifndef SDFGI_REFLECTION_GLSL
#define SDFGI_REFLECTION_GLSL

#define SDFGI_ROUGH_LOBES
#include "sdfgi_reflection_rays.glsl"
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
    const vec3 dir = sdfgi_reflection_direction(unit, eye, rough_or_1);
    const float share = sdfgi_reflection_ray_share(rough_or_1);
    const sdfgi_reflection_hit none = sdfgi_reflection_hit(vec3(0.0), 0u, 0u, 0.0, 0.0);
    sdfgi_reflection_ray ray = sdfgi_reflection_ray(none, none, vec3(0.0), 0.0);
    if (share > 0.0)
        ray = sdfgi_reflection_trace(pos, unit, dir);
    vec3 rough = vec3(0.0), light = ray.light;
    float answers = 1.0; /* of the lobe, over that to even light */
    sdfgi_lookup_query query = sdfgi_lookup_query(SDFGI_LOOKUP_SURFACE, 0u, pos, unit, eye);
    float weight = 1.0;
    /* The surface first, then what the ray hit. One loop, so that drivers compile the lookup once. */
    for (uint i = 0u; i < 3u && weight > 0.0; i++) {
        const vec4 found = sdfgi_lookup(query);
        if (i == 0u)
            rough = found.rgb;
        else
            light += weight * found.rgb;
        const sdfgi_reflection_hit hit = i == 0u ? ray.first : ray.second;
        weight = hit.weight;
        query = sdfgi_reflection_leaving(hit, dir);
    }
    if (share < 1.0 && roughness >= 0.0 && sdfgi_frame.low_light_begin > 0u) {
        const float answer = sdfgi_lobe_answer(pos, unit, eye, rough_or_1);
        answers = answer > 0.0 ? answer : 1.0;
    }
    const float scale = sdfgi_frame.exposure_inverse * sdfgi_frame.energy;
    result.irradiance = rough * (scale * 3.14159265);
    result.reflection = mix(rough * answers, light, share) * scale;
    result.distance_m = ray.distance_m;
    return result;
}

#endif
