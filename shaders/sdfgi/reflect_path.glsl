/* SPDX-License-Identifier: MIT
 * What a ray from a surface brings: light of the surfaces that it hits, of what lies beyond metal, and of the
 * sky. */
#ifndef SDFGI_REFLECT_PATH_GLSL
#define SDFGI_REFLECT_PATH_GLSL

#include "emitter_shapes.glsl"
#include "metal.glsl"
#include "../include/sdfgi_reflection_rays.glsl"

/* Albedo in the upper bits of a word: ten a channel, but nine of blue. */
const vec3 ALBEDO_STEPS = vec3(1023.0, 1023.0, 511.0);
const uint ALBEDO_WHITE = ~7u;

uint albedo_pack(vec3 albedo)
{
    const uvec3 steps = uvec3(clamp(albedo, 0.0, 1.0) * ALBEDO_STEPS + 0.5) << uvec3(3u, 13u, 23u);
    return steps.x | steps.y | steps.z;
}

vec3 albedo_unpack(uint word)
{
    return vec3(uvec3(word) >> uvec3(3u, 13u, 23u) & uvec3(ALBEDO_STEPS)) / ALBEDO_STEPS;
}

/* A piece of a ray's way, in a straight line. */
struct reflect_leg {
    uint cascade, last_cascade; /* in which it is traced */
    vec3 from, dir;             /* in cell space of the first; metric, of length 1 */
    float share;                /* of light at its end that counts, once it is known */
    uint albedo;                /* of metal on the way: see albedo_pack */
    bool beyond_metal;
};

/* Where a leg ends: just below the surface that it hit. In cell space of the cascade of the hit. */
vec3 leg_end(reflect_leg leg, sdfgi_trace_hit hit)
{
    const vec3 at =
        sdfgi_first_from_cascade(leg.cascade, leg.from + sdfgi_cells_from_metric(leg.dir) * hit.distance);
    return sdfgi_cascade_from_first(hit.cascade, at) - 0.01 * vec3(sdfgi_axis_direction(hit.axis));
}

/* What the surface at the end of a leg emits: it alone, where the side of a block shows others as well. */
vec3 end_emission(reflect_leg leg, sdfgi_trace_hit hit, uint block)
{
    const vec3 emission = sdfgi_block_emission(block, hit.axis);
    if (sdfgi_frame.emitter_samples == 0u || emission == vec3(0.0))
        return emission;
    const vec3 from_corner = leg_end(leg, hit) - vec3(hit.solid & ~1);
    const uvec3 subvoxel = uvec3(clamp(from_corner * float(SDFGI_SUBVOXELS), 0.0, 7.0));
    const uint word = emitter_shape_word(hit.cascade, block - hit.cascade * sdfgi_albedo_block_count());
    return emission * emitter_gain(word, subvoxel, hit.axis);
}

/* The leg that goes on from metal, after `length_m`. `point` chooses its direction: see metal_direction. */
reflect_leg leg_beyond(reflect_leg leg, sdfgi_trace_hit hit, uint block, float length_m, uint point)
{
    const float cells = length_m / sdfgi_frame.cascades[hit.cascade].cell_m;
    return reflect_leg(hit.cascade, sdfgi_frame.cascade_count - 1u,
                       metal_start(block, hit.axis, leg_end(leg, hit), leg.dir, cells),
                       metal_direction(block, hit.axis, leg.dir, unpackUnorm2x16(point)), leg.share,
                       albedo_pack(surface_albedo(block, hit.axis)), true);
}

/* A surface whose light a ray brings. In few words, because a ray keeps it while it is traced. */
struct reflect_end {
    vec3 pos;         /* in cell space of cascade 0 */
    uvec2 way_share;  /* half floats: from the leg's beginning, see end_way; and the share of the light */
    uint albedo_axis; /* albedo of metal on the way, and the axis of the face */
};

/* Cell widths of cascade 0: no way needs to be longer. Beyond SDFGI_CELLS_REACH of any cascade only its
 * direction counts. */
const float LONGEST_WAY = 1000.0;

reflect_end end_pack(vec3 pos, vec3 way, float share, uint albedo, uint axis)
{
    const float longest_m = LONGEST_WAY * sdfgi_frame.cascades[0].cell_m;
    const vec3 near = way * (LONGEST_WAY / max(length(way), longest_m));
    return reflect_end(pos, uvec2(packHalf2x16(near.xy), packHalf2x16(vec2(near.z, share))), axis | albedo);
}

/* In metres. */
vec3 end_way(reflect_end end)
{
    return vec3(unpackHalf2x16(end.way_share.x), unpackHalf2x16(end.way_share.y).x) *
           sdfgi_frame.cascades[0].cell_m;
}

/* 0: there is no surface. */
float end_share(reflect_end end)
{
    return unpackHalf2x16(end.way_share.y).y;
}

/* The next leg that begins at the surface: through one cascade. */
reflect_leg leg_from_surface(vec3 pos_first, vec3 normal, vec3 dir, inout sdfgi_reflection_rest rest)
{
    const uint c = rest.cascade;
    return reflect_leg(c, c, sdfgi_reflection_start(pos_first, normal, dir, rest), dir, 0.0, ALBEDO_WHITE,
                       false);
}

/* What a ray meets. */
struct reflect_found {
    reflect_end first, second; /* the nearest surface, and of the others the one that counts most */
    vec3 light;                /* that surfaces emit and the sky has, by their shares, times exposure */
    float length_m;
};

void add_end(reflect_leg leg, sdfgi_trace_hit hit, float length_m, inout reflect_found found)
{
    const reflect_end end = end_pack(sdfgi_first_from_cascade(hit.cascade, leg_end(leg, hit)),
                                     leg.dir * length_m, leg.share, leg.albedo, hit.axis);
    if (end_share(found.first) <= 0.0)
        found.first = end;
    else if (end_share(found.second) < end_share(end))
        found.second = end;
}

/* Metres to where a ray leaves the box around all geometry, in the coarsest cascade: there it is widest. */
float content_end_m(vec3 pos_first, vec3 dir)
{
    const uint c = sdfgi_frame.cascade_count - 1u;
    const vec3 inv_dir = 1.0 / sdfgi_trace_cells_direction(dir);
    return sdfgi_trace_content_of(c, ivec3(0), sdfgi_cascade_from_first(c, pos_first), inv_dir).leaves *
           sdfgi_frame.cascades[c].cell_m;
}

/* Sends a ray from a surface point, as sdfgi_reflection_trace does, and on from metal. One loop for all legs,
 * so that drivers compile the ray once. `point` is that of leg_beyond. */
reflect_found reflect_trace(vec3 pos_first, vec3 normal, vec3 dir, uint point)
{
    const reflect_end none = reflect_end(vec3(0.0), uvec2(0u), 0u);
    reflect_found found = reflect_found(none, none, vec3(0.0), 0.0);
    sdfgi_reflection_rest rest = sdfgi_reflection_begin();
    const float end_m = content_end_m(pos_first, dir);
    reflect_leg leg;
    bool goes_on = false;
    do {
        const float start_m = rest.start_m;
        if (!goes_on)
            leg = leg_from_surface(pos_first, normal, dir, rest);
        goes_on = false;
        if (!leg.beyond_metal && rest.surface <= 0.0)
            continue;
        const float cell_m = sdfgi_frame.cascades[leg.cascade].cell_m,
                    range = leg.beyond_metal ? 1e9 : (end_m - start_m) / cell_m;
        const sdfgi_trace_hit hit =
            sdfgi_trace_solid(leg.cascade, leg.last_cascade, leg.from, leg.dir, range);
        float length_m = hit.distance * cell_m;
        if (leg.beyond_metal && !hit.hit)
            found.light += leg.share * albedo_unpack(leg.albedo) * sdfgi_sky_towards(leg.dir);
        if (!leg.beyond_metal) {
            length_m += start_m;
            leg.share = sdfgi_reflection_share(leg.cascade, leg.from, dir, hit, length_m, rest);
        }
        if (!hit.hit || hit.capped || leg.share == 0.0)
            continue;
        const uint block = sdfgi_block_index(hit.cascade, hit.solid);
        if (sdfgi_surfaces_emit())
            found.light += leg.share * albedo_unpack(leg.albedo) * end_emission(leg, hit, block);
        goes_on = !leg.beyond_metal && surface_metal(block) != 0u;
        if (goes_on)
            leg = leg_beyond(leg, hit, block, length_m, point);
        else
            add_end(leg, hit, length_m, found);
    } while (goes_on || (rest.start_m < end_m && sdfgi_reflection_goes_on(rest)));
    found.light += rest.share * sdfgi_sky_towards(dir);
    found.length_m = rest.length_m + rest.share * SDFGI_REFLECTION_SKY_M;
    return found;
}

/* All light that a ray brings. Surfaces that no light cell faces bring none: they lie deep in what is
 * crowded, where little light comes. One loop, so that drivers compile the lookup once. */
vec3 reflect_light(reflect_found found)
{
    vec3 light = found.light;
    reflect_end end = found.first;
    for (uint i = 0u; i < 2u && end_share(end) > 0.0; i++) {
        const vec3 normal = vec3(sdfgi_axis_direction(end.albedo_axis & 7u));
        light += end_share(end) * albedo_unpack(end.albedo_axis) *
                 sdfgi_lookup(sdfgi_lookup_query(SDFGI_LOOKUP_LEAVING, end.pos, normal, -end_way(end))).rgb;
        end = found.second;
    }
    return light;
}

#endif
