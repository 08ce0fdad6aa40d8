/* SPDX-License-Identifier: MIT
 * Rays of reflections, and how much they count by roughness. */
#ifndef SDFGI_REFLECTION_RAYS_GLSL
#define SDFGI_REFLECTION_RAYS_GLSL

#ifdef SDFGI_GLSL
#error "include sdfgi_reflection.glsl instead of sdfgi.glsl"
#endif
/* Lookups know the light that leaves surfaces, too. */
#define SDFGI_REFLECTIONS
#include "sdfgi.glsl"
#include "sdfgi_emission.glsl"
#include "sdfgi_trace.glsl"
#include "../lib/ggx.glsl"

/* Cell widths along the normal from a surface to where its rays start: beyond its own sub-voxels, whose
 * diagonal is sqrt(3) / 4. */
#define SDFGI_REFLECTION_START 0.45
/* Metres: the distance of the sky. */
#define SDFGI_REFLECTION_SKY_M 65504.0

/* ---- Rays */

/* A surface that a ray hit. */
struct sdfgi_reflection_hit {
    vec3 pos; /* just below the surface, in cell space of cascade 0 */
    uint cascade, axis;
    float distance_m;
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
    const vec3 inv_dir = 1.0 / sdfgi_trace_cells_direction(dir);
    const vec3 far = (mix(sdfgi_frame.cascades[cascade].blend_low + band,
                          sdfgi_frame.cascades[cascade].blend_high - band, greaterThan(inv_dir, vec3(0.0))) -
                      pos) *
                     inv_dir;
    return max(min(far.x, min(far.y, far.z)), 0.0);
}

/* What is left of a ray while cascades trace it, one after another. */
struct sdfgi_reflection_rest {
    uint cascade;   /* the next one */
    float share;    /* that no surface has taken yet */
    float start_m;  /* from the surface to where the next cascade takes over */
    float off_m;    /* along the normal to where the ray starts */
    float surface;  /* weight of the last cascade at the surface */
    float length_m; /* to all surfaces that were hit, by their shares */
};

sdfgi_reflection_rest sdfgi_reflection_begin()
{
    return sdfgi_reflection_rest(0u, 1.0, 0.0, 0.0, 0.0, 0.0);
}

bool sdfgi_reflection_goes_on(sdfgi_reflection_rest rest)
{
    return rest.cascade < sdfgi_frame.cascade_count && rest.share > 1e-3;
}

/* Where the ray of the next cascade begins, in its cell space. The cascade does not count if `surface` is 0
 * then.
 */
vec3 sdfgi_reflection_start(vec3 pos_first, vec3 normal, vec3 dir, inout sdfgi_reflection_rest rest)
{
    const uint c = rest.cascade++;
    const float cell_m = sdfgi_frame.cascades[c].cell_m;
    const vec3 surface = sdfgi_cascade_from_first(c, pos_first);
    rest.surface = sdfgi_lookup_cascade_weight(c, surface);
    rest.off_m = rest.start_m > 0.0 ? rest.off_m : SDFGI_REFLECTION_START * cell_m;
    return surface + sdfgi_cells_from_metric(normal * rest.off_m + dir * rest.start_m) / cell_m;
}

/* How much the surface counts that such a ray has hit after `length_m`: by the weight of its cascade there.
 */
float sdfgi_reflection_share(uint cascade, vec3 from, vec3 dir, sdfgi_trace_hit hit, float length_m,
                             inout sdfgi_reflection_rest rest)
{
    const vec3 at = from + sdfgi_cells_from_metric(dir) * hit.distance;
    float share = 0.0;
    if (hit.hit && !hit.capped)
        share = rest.share * rest.surface * sdfgi_lookup_cascade_weight(cascade, at);
    rest.share -= share;
    rest.length_m += share > 0.0 ? share * length_m : 0.0;
    if (rest.surface >= 1.0)
        rest.start_m += sdfgi_frame.cascades[cascade].cell_m * sdfgi_reflection_handover(cascade, from, dir);
    return share;
}

void sdfgi_reflection_add(inout sdfgi_reflection_ray ray, uint cascade, vec3 at, sdfgi_trace_hit hit,
                          float weight, float distance_m)
{
    const vec3 below = at - 0.01 * vec3(sdfgi_axis_direction(hit.axis));
    const sdfgi_reflection_hit surface =
        sdfgi_reflection_hit(sdfgi_first_from_cascade(cascade, below), cascade, hit.axis, distance_m, weight);
    if (ray.first.weight <= 0.0)
        ray.first = surface;
    else if (ray.second.weight < weight)
        ray.second = surface;
    if (sdfgi_surfaces_emit())
        ray.light += weight * sdfgi_block_emission(sdfgi_block_index(cascade, hit.solid), hit.axis);
}

/* Sends a ray from a surface point. Where cascades hand over, each sends a ray of its own, and the finer one
 * counts by its weight at what it hit: nothing jumps while cascades move. */
sdfgi_reflection_ray sdfgi_reflection_trace(vec3 pos_first, vec3 normal, vec3 dir)
{
    const sdfgi_reflection_hit none = sdfgi_reflection_hit(vec3(0.0), 0u, 0u, 0.0, 0.0);
    sdfgi_reflection_ray ray = sdfgi_reflection_ray(none, none, vec3(0.0), 0.0);
    sdfgi_reflection_rest rest = sdfgi_reflection_begin();
    while (sdfgi_reflection_goes_on(rest)) {
        const uint c = rest.cascade;
        const vec3 from = sdfgi_reflection_start(pos_first, normal, dir, rest);
        if (rest.surface <= 0.0)
            continue;
        const sdfgi_trace_hit hit = sdfgi_trace_solid(c, c, from, dir, 1e9);
        const float length_m = rest.start_m + hit.distance * sdfgi_frame.cascades[c].cell_m,
                    share = sdfgi_reflection_share(c, from, dir, hit, length_m, rest);
        if (share > 0.0)
            sdfgi_reflection_add(ray, c, from + sdfgi_cells_from_metric(dir) * hit.distance, hit, share,
                                 length_m);
    }
    ray.light += rest.share * sdfgi_sky_towards(dir);
    ray.distance_m = rest.length_m + rest.share * SDFGI_REFLECTION_SKY_M;
    return ray;
}

/* ---- By roughness */

/* The direction about which the lobe of a rough surface gathers most of its light: between mirror direction
 * and normal (Lagarde and de Rousiers 2014, "Moving Frostbite to Physically Based Rendering", section
 * 4.9.3). */
vec3 sdfgi_reflection_direction(vec3 normal, vec3 to_eye, float roughness)
{
    const vec3 mirror = reflect(-normalize(to_eye), normal);
    const float smoothness = 1.0 - roughness * roughness;
    return normalize(mix(normal, mirror, smoothness * (sqrt(smoothness) + roughness * roughness)));
}

/* How much rays count at a roughness; the rest of a reflection is irradiance over pi. */
float sdfgi_reflection_ray_share(float roughness)
{
    return 1.0 - smoothstep(sdfgi_frame.rays_blend, sdfgi_frame.rays_end, roughness);
}

/* ---- Over a lobe */

/* Roughness from which on lobes are wide in part, and wholly: a view's filter takes squares of squares then.
 */
const vec2 SDFGI_REFLECTION_WIDE_LOBES = vec2(0.15, 0.3);
/* The share of a narrow lobe to which rays keep, from its middle on. In the tail one ray of many meets a
 * lamp, and few rays would show it as a dot. */
const float SDFGI_REFLECTION_NARROW_SHARE = 0.9;
/* Facets of smoother surfaces count as those of a mirror, which face one way: the fits are not as exact. */
const float SDFGI_REFLECTION_MIRROR_ALPHA = 0.0025;

/* What a facet of the surface reflects towards the viewer; it may lie below the surface. `point` in the unit
 * square chooses the facet. */
vec3 sdfgi_reflection_of_facet(vec3 normal, vec3 to_eye, float roughness, vec2 point)
{
    const float wide = smoothstep(SDFGI_REFLECTION_WIDE_LOBES.x, SDFGI_REFLECTION_WIDE_LOBES.y, roughness);
    return sdfgi_ggx_reflected(normal, to_eye, roughness * roughness,
                               point * vec2(1.0, mix(SDFGI_REFLECTION_NARROW_SHARE, 1.0, wide)));
}

/* How much the facet of a dielectric that sends light from `dir` to the viewer reflects, over the mean of the
 * lobe, which is what hosts multiply reflections by. At a small angle water mirrors lamps far off better than
 * the sky above, and facets that lean hide each other: `is_hidden` says that they hide all of it. What metal
 * reflects depends little on the angle. */
float sdfgi_reflection_facet_share(vec3 normal, vec3 to_eye, float roughness, vec3 dir, bool is_hidden)
{
    const vec3 eye = normalize(to_eye);
    const float alpha = roughness * roughness, n_v = clamp(dot(normal, eye), 0.01, 1.0),
                n_l = clamp(dot(normal, dir), 0.001, 1.0),
                of_facet = sqrt(clamp(0.5 + 0.5 * dot(eye, dir), 0.0, 1.0));
    const float sent = sdfgi_ggx_dielectric(sdfgi_ggx_fresnel_weight(of_facet)) *
                       sdfgi_ggx_unhidden(n_v, n_l, alpha),
                mean = sdfgi_ggx_dielectric(sdfgi_ggx_mean_fresnel_weight(n_v, alpha)) *
                       (1.0 - sdfgi_ggx_lost(n_v, alpha));
    const float share = is_hidden ? 0.0 : sent / mean * sdfgi_ggx_kept(n_v, alpha);
    return mix(1.0, share, min(alpha / SDFGI_REFLECTION_MIRROR_ALPHA, 1.0));
}

/* ---- What they meet */

/* The query for the light that leaves a surface that a ray hit. Metal counts as diffuse: hosts do not bind
 * what tells it. */
sdfgi_lookup_query sdfgi_reflection_leaving(sdfgi_reflection_hit hit, vec3 dir)
{
    return sdfgi_lookup_query(SDFGI_LOOKUP_LEAVING, hit.cascade, hit.pos,
                              vec3(sdfgi_axis_direction(hit.axis)), -dir * hit.distance_m);
}

#endif
