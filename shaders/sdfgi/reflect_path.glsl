/* SPDX-License-Identifier: MIT
 * What a ray from a surface brings: light of the surfaces that it hits, of what lies beyond metal, and of the
 * sky. */
#ifndef SDFGI_REFLECT_PATH_GLSL
#define SDFGI_REFLECT_PATH_GLSL

#include "metal.glsl"
#include "../include/sdfgi_reflection.glsl"

/* A piece of a ray's way, in a straight line. */
struct reflect_leg {
    uint cascade, last_cascade; /* in which it is traced */
    vec3 from, dir;             /* in cell space of the first; metric, of length 1 */
    vec3 share;                 /* of light at its end that counts, once it is known */
    bool beyond_metal;
};

/* Where a leg ends: just below the surface that it hit. In cell space of the cascade of the hit. */
vec3 leg_end(reflect_leg leg, sdfgi_trace_hit hit)
{
    const vec3 at =
        sdfgi_first_from_cascade(leg.cascade, leg.from + sdfgi_cells_from_metric(leg.dir) * hit.distance);
    return sdfgi_cascade_from_first(hit.cascade, at) - 0.01 * vec3(sdfgi_axis_direction(hit.axis));
}

/* The leg that goes on from metal, after `length_m`. `point` chooses its direction: see metal_direction. */
reflect_leg leg_beyond(reflect_leg leg, sdfgi_trace_hit hit, uint block, float length_m, vec2 point)
{
    const float cells = length_m / sdfgi_frame.cascades[hit.cascade].cell_m;
    return reflect_leg(hit.cascade, sdfgi_frame.cascade_count - 1u,
                       metal_start(block, hit.axis, leg_end(leg, hit), leg.dir, cells),
                       metal_direction(block, hit.axis, leg.dir, point),
                       leg.share * surface_albedo(block, hit.axis), true);
}

/* A surface whose light a ray brings. */
struct reflect_end {
    vec3 pos, way; /* in cell space of cascade 0; from the leg's beginning, in metres */
    uint axis;
    vec3 share; /* of its light; 0: there is no surface */
};

/* The next leg that begins at the surface: through one cascade. */
reflect_leg leg_from_surface(vec3 pos_first, vec3 normal, vec3 dir, inout sdfgi_reflection_rest rest)
{
    const uint c = rest.cascade;
    return reflect_leg(c, c, sdfgi_reflection_start(pos_first, normal, dir, rest), dir, vec3(0.0), false);
}

/* What a ray meets. */
struct reflect_found {
    reflect_end first, second; /* the nearest surface, and of the others the one that counts most */
    vec3 light;                /* that surfaces emit and the sky has, by their shares, times exposure */
    float length_m;
};

void add_end(reflect_leg leg, sdfgi_trace_hit hit, float length_m, inout reflect_found found)
{
    const reflect_end end = reflect_end(sdfgi_first_from_cascade(hit.cascade, leg_end(leg, hit)),
                                        leg.dir * length_m, hit.axis, leg.share);
    if (found.first.share == vec3(0.0))
        found.first = end;
    else if (dot(found.second.share, vec3(1.0)) < dot(end.share, vec3(1.0)))
        found.second = end;
}

/* Sends a ray from a surface point, as sdfgi_reflection_trace does, and on from metal. One loop for all legs,
 * so that drivers compile the ray once. `point` is that of leg_beyond. */
reflect_found reflect_trace(vec3 pos_first, vec3 normal, vec3 dir, vec2 point)
{
    const reflect_end none = reflect_end(vec3(0.0), vec3(0.0), 0u, vec3(0.0));
    reflect_found found = reflect_found(none, none, vec3(0.0), 0.0);
    sdfgi_reflection_rest rest = sdfgi_reflection_begin();
    reflect_leg leg;
    bool goes_on = false;
    do {
        if (!goes_on)
            leg = leg_from_surface(pos_first, normal, dir, rest);
        goes_on = false;
        if (!leg.beyond_metal && rest.surface <= 0.0)
            continue;
        const sdfgi_trace_hit hit = sdfgi_trace_solid(leg.cascade, leg.last_cascade, leg.from, leg.dir, 1e9);
        float length_m = hit.distance * sdfgi_frame.cascades[leg.cascade].cell_m;
        if (leg.beyond_metal && !hit.hit)
            found.light += leg.share * sdfgi_sky_towards(leg.dir);
        if (!leg.beyond_metal) {
            length_m += rest.start_m;
            leg.share = vec3(sdfgi_reflection_share(leg.cascade, leg.from, dir, hit, length_m, rest));
        }
        if (!hit.hit || hit.capped || leg.share == vec3(0.0))
            continue;
        const uint block = sdfgi_block_index(hit.cascade, hit.solid);
        if (sdfgi_surfaces_emit())
            found.light += leg.share * sdfgi_block_emission(block, hit.axis);
        goes_on = !leg.beyond_metal && surface_metal(block) != 0u;
        if (goes_on)
            leg = leg_beyond(leg, hit, block, length_m, point);
        else
            add_end(leg, hit, length_m, found);
    } while (goes_on || sdfgi_reflection_goes_on(rest));
    found.light += rest.share * sdfgi_sky_towards(dir);
    found.length_m = rest.length_m + rest.share * SDFGI_REFLECTION_SKY_M;
    return found;
}

/* All light that a ray brings. `rough` stands for that of surfaces of which nothing is known. One loop, so
 * that drivers compile the lookup once. */
vec3 reflect_light(reflect_found found, vec3 rough)
{
    vec3 light = found.light;
    reflect_end end = found.first;
    for (uint i = 0u; i < 2u && end.share != vec3(0.0); i++) {
        const vec3 normal = vec3(sdfgi_axis_direction(end.axis));
        const vec4 leaving =
            sdfgi_lookup(sdfgi_lookup_query(SDFGI_LOOKUP_LEAVING, end.pos, normal, -end.way));
        light += end.share * (leaving.a > 0.0 ? leaving.rgb : rough);
        end = found.second;
    }
    return light;
}

#endif
