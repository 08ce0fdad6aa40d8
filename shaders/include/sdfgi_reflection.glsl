/* SPDX-License-Identifier: MIT
 * Reflections, beside what sdfgi.glsl gives: include this file instead of that one. Light that arrives from
 * the directions of a reflection comes in three tiers by roughness. Smooth surfaces send a ray and read the
 * light cells that it hits; rough ones show irradiance; between the two, probes answer for a direction.
 * Neighbouring tiers blend. */
#ifndef SDFGI_REFLECTION_GLSL
#define SDFGI_REFLECTION_GLSL

#ifdef SDFGI_GLSL
#error "include sdfgi_reflection.glsl instead of sdfgi.glsl"
#endif
/* Lookups know the light that leaves surfaces, too. */
#define SDFGI_REFLECTIONS
#include "sdfgi.glsl"
#include "sdfgi_emission.glsl"
#include "sdfgi_trace.glsl"

/* Cell widths along the normal from a surface to where its rays start: beyond its own sub-voxels, whose
 * diagonal is sqrt(3) / 4. */
#define SDFGI_REFLECTION_START 0.45
/* Metres: the distance of the sky. */
#define SDFGI_REFLECTION_SKY_M 65504.0
/* Roughness at which sharp reflections begin to blend into medium ones, and medium into rough; and where each
 * blend ends. */
#define SDFGI_REFLECTION_SHARP  vec2(0.2, 0.5)
#define SDFGI_REFLECTION_MEDIUM vec2(0.6, 0.9)

/* ---- Sharp: rays */

/* A surface that a ray hit. */
struct sdfgi_reflection_hit {
    vec3 pos; /* just below the surface, in cell space of cascade 0 */
    uint axis;
    float weight;
};

/* What a ray meets: two surfaces at most, and the rest. */
struct sdfgi_reflection_ray {
    sdfgi_reflection_hit first, second;
    vec3 light; /* that surfaces emit and the sky has, times weight and exposure */
    float distance_m;
};

/* Cell widths to where a ray leaves the part of a cascade in which the cascade alone answers. */
float sdfgi_reflection_handover(uint cascade, vec3 pos, vec3 dir)
{
    const float band = float(SDFGI_PROBE_SPACING) + 1.0;
    const vec3 cells = sdfgi_cells_from_metric(dir),
               inv_dir = 1.0 / mix(cells, vec3(1e-20), lessThan(abs(cells), vec3(1e-20)));
    const vec3 far = (mix(sdfgi_frame.cascades[cascade].blend_low + band,
                          sdfgi_frame.cascades[cascade].blend_high - band, greaterThan(inv_dir, vec3(0.0))) -
                      pos) *
                     inv_dir;
    return max(min(far.x, min(far.y, far.z)), 0.0);
}

void sdfgi_reflection_add(inout sdfgi_reflection_ray ray, uint cascade, vec3 at, sdfgi_trace_hit hit,
                          float weight, float distance_m)
{
    const vec3 below = at - 0.01 * vec3(sdfgi_axis_direction(hit.axis));
    const sdfgi_reflection_hit surface =
        sdfgi_reflection_hit(sdfgi_first_from_cascade(cascade, below), hit.axis, weight);
    if (ray.first.weight <= 0.0)
        ray.first = surface;
    else if (ray.second.weight < weight)
        ray.second = surface;
    if (sdfgi_surfaces_emit())
        ray.light += weight * sdfgi_block_emission(sdfgi_block_index(cascade, hit.solid), hit.axis);
    ray.distance_m += weight * distance_m;
}

/* Sends a ray from a surface point. Where cascades hand over, each sends a ray of its own, and the finer one
 * counts by its weight at what it hit: nothing jumps while cascades move. */
sdfgi_reflection_ray sdfgi_reflection_trace(vec3 pos_first, vec3 normal, vec3 dir)
{
    const sdfgi_reflection_hit none = sdfgi_reflection_hit(vec3(0.0), 0u, 0.0);
    sdfgi_reflection_ray ray = sdfgi_reflection_ray(none, none, vec3(0.0), 0.0);
    float rest = 1.0, start_m = 0.0, off_m = 0.0;
    for (uint c = 0u; c < sdfgi_frame.cascade_count && rest > 1e-3; c++) {
        const float cell_m = sdfgi_frame.cascades[c].cell_m;
        const vec3 surface = sdfgi_cascade_from_first(c, pos_first);
        const float of_surface = sdfgi_lookup_cascade_weight(c, surface);
        if (of_surface <= 0.0)
            continue;
        off_m = start_m > 0.0 ? off_m : SDFGI_REFLECTION_START * cell_m;
        const vec3 from = surface + sdfgi_cells_from_metric(normal * off_m + dir * start_m) / cell_m;
        const sdfgi_trace_hit hit = sdfgi_trace_solid(c, c, from, dir, 1e9);
        const vec3 at = from + sdfgi_cells_from_metric(dir) * hit.distance;
        float weight = 0.0;
        if (hit.hit && !hit.capped)
            weight = rest * of_surface * sdfgi_lookup_cascade_weight(c, at);
        if (weight > 0.0)
            sdfgi_reflection_add(ray, c, at, hit, weight, start_m + hit.distance * cell_m);
        rest -= weight;
        if (of_surface >= 1.0)
            start_m += cell_m * sdfgi_reflection_handover(c, from, dir);
    }
    ray.light += rest * sdfgi_sky_radiance(dir, sdfgi_frame.sky_zenith, sdfgi_frame.sky_horizon,
                                           sdfgi_frame.sky_ground);
    ray.distance_m += rest * SDFGI_REFLECTION_SKY_M;
    return ray;
}

/* ---- Tiers */

/* The direction about which the lobe of a rough surface gathers most of its light: between mirror direction
 * and normal (Lagarde and de Rousiers 2014, "Moving Frostbite to Physically Based Rendering", section
 * 4.9.3). */
vec3 sdfgi_reflection_direction(vec3 normal, vec3 to_eye, float roughness)
{
    const vec3 mirror = reflect(-normalize(to_eye), normal);
    const float smoothness = 1.0 - roughness * roughness;
    return normalize(mix(normal, mirror, smoothness * (sqrt(smoothness) + roughness * roughness)));
}

/* Weights of the tiers at a roughness: sharp, medium, rough. They add up to 1. */
vec3 sdfgi_reflection_tiers(float roughness)
{
    const float below_sharp = smoothstep(SDFGI_REFLECTION_SHARP.x, SDFGI_REFLECTION_SHARP.y, roughness),
                below_medium = smoothstep(SDFGI_REFLECTION_MEDIUM.x, SDFGI_REFLECTION_MEDIUM.y, roughness);
    return vec3(1.0 - below_sharp, below_sharp * (1.0 - below_medium), below_sharp * below_medium);
}

struct sdfgi_surface_light {
    vec3 irradiance;  /* as sdfgi_irradiance has it */
    vec3 reflection;  /* radiance, W/(m^2 sr): the mean over the specular lobe */
    float distance_m; /* to what is reflected sharply; SDFGI_REFLECTION_SKY_M: the sky */
};

/* The query of a number at a surface point, and its weight in the reflection. */
sdfgi_lookup_query sdfgi_reflection_query(uint i, sdfgi_lookup_query surface, vec3 dir,
                                          sdfgi_reflection_ray ray)
{
    if (i == 0u)
        return surface;
    if (i == 1u)
        return sdfgi_lookup_query(SDFGI_LOOKUP_AIR, surface.pos, surface.normal, dir, surface.to_eye);
    const vec3 pos = i == 2u ? ray.first.pos : ray.second.pos;
    const vec3 normal = vec3(sdfgi_axis_direction(i == 2u ? ray.first.axis : ray.second.axis));
    return sdfgi_lookup_query(SDFGI_LOOKUP_LEAVING, pos, normal, normal, -dir * ray.distance_m);
}

/* Light that arrives at a surface point with unit normal, and what of it the surface reflects towards the
 * viewer: the mean over the lobe of the microfacet distribution GGX with alpha = roughness^2, roughness in
 * [0, 1]. Times the directional albedo of the specular BRDF it is reflected radiance. It comes from surfaces
 * and sky, not from the host's own lights. `to_eye` as for sdfgi_irradiance, and not 0. */
sdfgi_surface_light sdfgi_lighting(vec3 position, vec3 normal, vec3 to_eye, float roughness)
{
    sdfgi_surface_light result = sdfgi_surface_light(vec3(0.0), vec3(0.0), 0.0);
    if (sdfgi_frame.cascade_count == 0u)
        return result;
    const sdfgi_lookup_query surface =
        sdfgi_lookup_query(SDFGI_LOOKUP_SURFACE, sdfgi_first_from_position(position), normal, normal, to_eye);
    const vec3 dir = sdfgi_reflection_direction(normal, to_eye, roughness),
               tiers = sdfgi_reflection_tiers(roughness);
    const sdfgi_reflection_hit none = sdfgi_reflection_hit(vec3(0.0), 0u, 0.0);
    sdfgi_reflection_ray ray = sdfgi_reflection_ray(none, none, vec3(0.0), 0.0);
    if (tiers.x > 0.0)
        ray = sdfgi_reflection_trace(surface.pos, normal, dir);
    result.reflection = tiers.x * ray.light;
    result.distance_m = ray.distance_m;
    const vec4 weights = vec4(tiers.z, tiers.y, tiers.x * ray.first.weight, tiers.x * ray.second.weight);
    /* One loop, so that drivers compile the lookup once. */
    for (uint i = 0u; i < 4u; i++) {
        const float weight = weights[i];
        if (weight <= 0.0 && i > 0u)
            continue;
        const vec3 light = sdfgi_lookup(sdfgi_reflection_query(i, surface, dir, ray));
        result.reflection += weight * light;
        if (i == 0u)
            result.irradiance = light * 3.14159265;
    }
    const float scale = sdfgi_frame.exposure_inverse * sdfgi_frame.energy;
    result.irradiance *= scale;
    result.reflection *= scale;
    return result;
}

#endif
