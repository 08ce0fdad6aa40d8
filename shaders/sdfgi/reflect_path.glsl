/* SPDX-License-Identifier: MIT
 * What a ray from a surface brings: light of the surfaces that it hits, of what lies beyond metal, and of the
 * sky. */
#ifndef SDFGI_REFLECT_PATH_GLSL
#define SDFGI_REFLECT_PATH_GLSL

#include "emitter_shapes.glsl"
#include "metal.glsl"
#include "../include/sdfgi_reflection_rays.glsl"

/* Albedo in the upper bits of a word: nine a channel, but eight of blue. */
const vec3 ALBEDO_STEPS = vec3(511.0, 511.0, 255.0);
const uvec3 ALBEDO_SHIFTS = uvec3(6u, 15u, 24u);
const uint ALBEDO_WHITE = ~63u;

uint albedo_pack(vec3 albedo)
{
    const uvec3 steps = uvec3(clamp(albedo, 0.0, 1.0) * ALBEDO_STEPS + 0.5) << ALBEDO_SHIFTS;
    return steps.x | steps.y | steps.z;
}

vec3 albedo_unpack(uint word)
{
    return vec3(uvec3(word) >> ALBEDO_SHIFTS & uvec3(ALBEDO_STEPS)) / ALBEDO_STEPS;
}

/* Just below a surface that was hit at `at`. */
vec3 end_below(vec3 at, uint axis)
{
    return at - 0.01 * vec3(sdfgi_axis_direction(axis));
}

/* What the surface emits that was hit, `at` below it: it alone, where the side of a block shows others as
 * well. */
vec3 end_emission(vec3 at, sdfgi_trace_hit hit, uint block)
{
    if (!sdfgi_surfaces_emit())
        return vec3(0.0);
    const vec3 emission = sdfgi_block_emission(block, hit.axis);
    if (sdfgi_frame.emitter_samples == 0u || emission == vec3(0.0))
        return emission;
    const vec3 from_corner = at - vec3(hit.solid & ~1);
    const uvec3 subvoxel = uvec3(clamp(from_corner * float(SDFGI_SUBVOXELS), 0.0, 7.0));
    const uint word = emitter_shape_word(hit.cascade, block - hit.cascade * sdfgi_albedo_block_count());
    return emission * emitter_gain(word, subvoxel, hit.axis);
}

/* A surface whose light a ray brings. In few words, because a ray keeps it while it is traced. */
struct reflect_end {
    vec3 pos;         /* in cell space of cascade 0 */
    uvec2 way_share;  /* half floats: from the ray's beginning, see end_way; and the share of the light */
    uint albedo_face; /* albedo of metal on the way; three bits each: the cascade, and the axis of the face */
};

/* Cell widths of cascade 0: no way needs to be longer. Beyond SDFGI_CELLS_REACH of any cascade only its
 * direction counts. */
const float LONGEST_WAY = 1000.0;

reflect_end end_pack(vec3 pos, vec3 way, float share, uint albedo, sdfgi_trace_hit hit)
{
    const float longest_m = LONGEST_WAY * sdfgi_frame.cascades[0].cell_m;
    const vec3 near = way * (LONGEST_WAY / max(length(way), longest_m));
    return reflect_end(pos, uvec2(packHalf2x16(near.xy), packHalf2x16(vec2(near.z, share))),
                       albedo | hit.cascade << 3u | hit.axis);
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

/* Metal from which a ray goes on, in few words. */
struct reflect_metal {
    uint block, axis;
    float off_m, length_m; /* from the surface along its normal to where the ray began, and from there */
    float share;
};

/* What a ray meets. */
struct reflect_found {
    reflect_end first, second; /* the nearest surface, and of the others the one that counts most */
    reflect_metal metal;       /* the one that counts most, with the shares of all */
    vec3 light;                /* that surfaces emit and the sky has, by their shares, times exposure */
    float length_m;
};

void add_end(reflect_end end, inout reflect_found found)
{
    if (end_share(found.first) <= 0.0)
        found.first = end;
    else if (end_share(found.second) < end_share(end))
        found.second = end;
}

void add_metal(reflect_metal metal, inout reflect_found found)
{
    const float share = found.metal.share;
    if (metal.share > share)
        found.metal = metal;
    found.metal.share = share + metal.share;
}

/* A ray through the cascades. */
struct reflect_ray {
    uint cascade, last_cascade; /* where it begins, and the coarsest one that it may enter */
    vec3 from, dir;             /* in cell space of the first; metric, of length 1 */
    float range;                /* in its cell widths */
    uint albedo;                /* of metal on the way: see albedo_pack */
};

/* The next one from a surface: through one cascade, and at most as long as `end_m`. */
reflect_ray ray_from_surface(vec3 pos_first, vec3 normal, vec3 dir, float end_m,
                             inout sdfgi_reflection_rest rest)
{
    const uint c = rest.cascade;
    const float start_m = rest.start_m;
    return reflect_ray(c, c, sdfgi_reflection_start(pos_first, normal, dir, rest), dir,
                       (end_m - start_m) / sdfgi_frame.cascades[c].cell_m, ALBEDO_WHITE);
}

/* The ray that goes on from metal that another one, from a surface, has met. `point` chooses its direction:
 * see metal_direction. */
reflect_ray ray_beyond(reflect_metal metal, vec3 pos_first, vec3 normal, vec3 dir, uint point)
{
    const uint c = metal.block / sdfgi_albedo_block_count();
    const vec3 way = normal * metal.off_m + dir * metal.length_m,
               at = pos_first + sdfgi_cells_from_metric(way) / sdfgi_frame.cascades[0].cell_m;
    return reflect_ray(c, sdfgi_frame.cascade_count - 1u,
                       metal_start(metal.block, metal.axis,
                                   end_below(sdfgi_cascade_from_first(c, at), metal.axis), dir,
                                   metal.length_m / sdfgi_frame.cascades[c].cell_m),
                       metal_direction(metal.block, metal.axis, dir, unpackUnorm2x16(point)), 1e9,
                       albedo_pack(surface_albedo(metal.block, metal.axis)));
}

/* Metres to where a ray leaves the box around all geometry, in the coarsest cascade: there it is widest. */
float content_end_m(vec3 pos_first, vec3 dir)
{
    const uint c = sdfgi_frame.cascade_count - 1u;
    const vec3 inv_dir = 1.0 / sdfgi_trace_cells_direction(dir);
    return sdfgi_trace_content_of(c, ivec3(0), sdfgi_cascade_from_first(c, pos_first), inv_dir).leaves *
           sdfgi_frame.cascades[c].cell_m;
}

/* Adds a surface that a ray has hit. */
void add_hit(reflect_ray ray, sdfgi_trace_hit hit, bool beyond, float off_m, float length_m, float share,
             inout reflect_found found)
{
    const uint block = sdfgi_block_index(hit.cascade, hit.solid);
    const vec3 first = sdfgi_first_from_cascade(ray.cascade,
                                                ray.from + sdfgi_cells_from_metric(ray.dir) * hit.distance),
               at = end_below(sdfgi_cascade_from_first(hit.cascade, first), hit.axis);
    found.light += share * albedo_unpack(ray.albedo) * end_emission(at, hit, block);
    if (!beyond && is_metal(block))
        add_metal(reflect_metal(block, hit.axis, off_m, length_m, share), found);
    else
        add_end(
            end_pack(sdfgi_first_from_cascade(hit.cascade, at), ray.dir * length_m, share, ray.albedo, hit),
            found);
}

/* Sends a ray from a surface point, as sdfgi_reflection_trace does, and then on from metal. One loop, so that
 * drivers compile the ray once. `point` is that of ray_beyond. */
reflect_found reflect_trace(vec3 pos_first, vec3 normal, vec3 dir, uint point)
{
    const reflect_end none = reflect_end(vec3(0.0), uvec2(0u), 0u);
    reflect_found found = reflect_found(none, none, reflect_metal(0u, 0u, 0.0, 0.0, 0.0), vec3(0.0), 0.0);
    sdfgi_reflection_rest rest = sdfgi_reflection_begin();
    const float end_m = content_end_m(pos_first, dir);
    bool beyond = false, more = false;
    do {
        const float start_m = beyond ? 0.0 : rest.start_m;
        reflect_ray ray;
        if (beyond)
            ray = ray_beyond(found.metal, pos_first, normal, dir, point);
        else
            ray = ray_from_surface(pos_first, normal, dir, end_m, rest);
        float share = beyond ? found.metal.share : rest.surface;
        if (share > 0.0) {
            const sdfgi_trace_hit hit =
                sdfgi_trace_solid(ray.cascade, ray.last_cascade, ray.from, ray.dir, ray.range);
            const float length_m = start_m + hit.distance * sdfgi_frame.cascades[ray.cascade].cell_m;
            if (!beyond)
                share = sdfgi_reflection_share(ray.cascade, ray.from, dir, hit, length_m, rest);
            else if (!hit.hit)
                found.light += share * albedo_unpack(ray.albedo) * sdfgi_sky_towards(ray.dir);
            if (hit.hit && !hit.capped && share > 0.0)
                add_hit(ray, hit, beyond, rest.off_m, length_m, share, found);
        }
        const bool goes_on = !beyond && rest.start_m < end_m && sdfgi_reflection_goes_on(rest);
        more = goes_on || (METAL && !beyond && found.metal.share > 0.0);
        beyond = METAL && !goes_on;
    } while (more);
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
        const vec3 normal = vec3(sdfgi_axis_direction(end.albedo_face & 7u));
        const sdfgi_lookup_query query = sdfgi_lookup_query(SDFGI_LOOKUP_LEAVING, end.albedo_face >> 3u & 7u,
                                                            end.pos, normal, -end_way(end));
        light += end_share(end) * albedo_unpack(end.albedo_face) * sdfgi_lookup(query).rgb;
        end = found.second;
    }
    return light;
}

#endif
