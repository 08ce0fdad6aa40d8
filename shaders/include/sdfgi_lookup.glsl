/* SPDX-License-Identifier: MIT
 * Irradiance at a surface point: the cage of the finest cascade around it (sdfgi_cage.glsl), rays where the
 * point sees no probe of that cage, and a blend into the next coarser cascade near the cascade's edge. */
#ifndef SDFGI_LOOKUP_GLSL
#define SDFGI_LOOKUP_GLSL

#include "sdfgi_cage.glsl"
#include "sdfgi_trace.glsl"
#include "../lib/light_pack.glsl"
#include "../lib/rgbe.glsl"
#include "../lib/sky.glsl"

/* Radiance at the end of a ray: that of the sky, or of the light cell in front of the surface. */
vec3 sdfgi_lookup_ray_radiance(sdfgi_trace_hit hit, vec3 dir)
{
    if (!hit.hit)
        return sdfgi_sky_radiance(dir, sdfgi_frame.sky_zenith, sdfgi_frame.sky_horizon,
                                  sdfgi_frame.sky_ground);
    if (!hit.has_cell)
        return vec3(0.0);
    return sdfgi_light_unpack_axis(sdfgi_light[sdfgi_cell_index(hit.cascade, hit.cell)], hit.axis);
}

/* Irradiance / pi * exposure by rays in a spiral around the normal, distributed by the cosine. It serves the
 * few points that see none of the eight probes, behind a pillar or in a niche. `pos` must be in the open. */
vec4 sdfgi_lookup_by_rays(uint cascade, vec3 pos, vec3 normal)
{
    const int RAYS = 16;
    const vec3 side =
        normalize(abs(normal.y) < 0.9 ? vec3(-normal.z, 0.0, normal.x) : vec3(0.0, normal.z, -normal.y));
    const vec3 up = cross(normal, side);
    vec3 sum = vec3(0.0);
    for (int i = 0; i < RAYS; i++) {
        const float r2 = (float(i) + 0.5) / float(RAYS), turn = float(i) * 2.39996323; /* golden angle */
        const vec3 dir = sqrt(r2) * (cos(turn) * side + sin(turn) * up) + sqrt(1.0 - r2) * normal;
        const sdfgi_trace_hit hit = sdfgi_trace_ray(cascade, sdfgi_frame.cascade_count - 1u, pos, dir, 1e9);
        sum += sdfgi_lookup_ray_radiance(hit, dir);
    }
    return vec4(sum / float(RAYS), 1.0);
}

/* Irradiance / pi * exposure in rgb, 1 in a, from one cascade. The point is biased off the surface along its
 * normal and, half as far, towards the viewer, who is known to be on the open side of the surface (Majercik
 * et al. 2021, "Scaling Probe-Based Real-Time Dynamic Global Illumination", section 3.2). `to_eye` is in cell
 * widths. */
vec4 sdfgi_lookup_surface(uint cascade, vec3 pos, vec3 normal, vec3 to_eye)
{
    const float range = length(to_eye);
    const vec3 eye = to_eye / max(range, 1e-6);
    const vec3 biased = pos + sdfgi_cells_from_metric(normal + 0.5 * eye) * sdfgi_frame.normal_bias;
    const vec3 open = sdfgi_visibility_open_point(cascade, pos, normal, eye, range);
    const ivec3 cage = sdfgi_cage_of(cascade, biased);
    const uint method = sdfgi_frame.visibility;
    sdfgi_visibility visibility;
    ivec3 light_cell;
    vec3 rays_from = open;
    if (method == SDFGI_SHADER_VISIBILITY_NONE)
        visibility = sdfgi_visibility_from_bits(0xffu);
    else if (method == SDFGI_SHADER_VISIBILITY_PROBE_DEPTH)
        visibility = sdfgi_visibility_from_depths(cascade, cage, biased);
    else if (method == SDFGI_SHADER_VISIBILITY_CELL_MASK &&
             sdfgi_visibility_find_light_cell(cascade, pos, biased, normal, open, light_cell)) {
        visibility = sdfgi_visibility_from_cells(cascade, cage, light_cell, biased);
        rays_from = clamp(biased, vec3(light_cell) + 0.05, vec3(light_cell) + 0.95);
    } else /* the method is TRACED, or there is no light cell near the point */
        visibility =
            sdfgi_visibility_traced(cascade, cage, pos + sdfgi_cells_from_metric(normal + eye) * 0.25);
    const float height = dot(sdfgi_metric_from_cells(biased - pos), normal);
    const vec4 light = sdfgi_cage_irradiance(cascade, cage, biased, normal, height, visibility);
    return light.a > 0.0 ? light : sdfgi_lookup_by_rays(cascade, rays_from, normal);
}

/* The weight of a cascade at a position. It falls from 1 to 0 across the cascade blend: a band along the edge
 * of the blend region, one probe spacing wide, that ends one cell before that edge. The region moves smoothly
 * while the cascade scrolls, so the weight does not jump. */
float sdfgi_lookup_cascade_weight(uint cascade, vec3 pos)
{
    const vec3 to_edge =
        min(pos - sdfgi_frame.cascades[cascade].blend_low, sdfgi_frame.cascades[cascade].blend_high - pos);
    return clamp((min(to_edge.x, min(to_edge.y, to_edge.z)) - 1.0) / float(SDFGI_PROBE_SPACING), 0.0, 1.0);
}

/* Irradiance / pi * exposure at a position in cell space of cascade 0. `to_eye` leads to the viewer, in
 * metres. The finest cascade answers. In its cascade blend the next coarser one takes over, and beyond the
 * last cascade the sky does. */
vec3 sdfgi_lookup_irradiance(vec3 pos_first, vec3 normal, vec3 to_eye)
{
    const vec3 eye_first = to_eye / sdfgi_frame.cascades[0].cell_m;
    vec3 result = vec3(0.0);
    float rest = 1.0; /* weight that the cascades so far have left */
    for (uint c = 0u; c < sdfgi_frame.cascade_count && rest > 0.0; c++) {
        const vec3 pos = sdfgi_cascade_from_first(c, pos_first);
        const float weight = sdfgi_lookup_cascade_weight(c, pos);
        if (weight <= 0.0)
            continue;
        const vec4 light =
            sdfgi_lookup_surface(c, pos, normal, eye_first * sdfgi_frame.cascades[c].from_first_scale);
        result += rest * weight * light.rgb / light.a;
        rest *= 1.0 - weight;
    }
    const vec3 sky =
        sdfgi_sky_irradiance(normal, sdfgi_frame.sky_zenith, sdfgi_frame.sky_horizon, sdfgi_frame.sky_ground);
    return result + rest * sky;
}

#endif
