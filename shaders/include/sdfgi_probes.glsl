/* SPDX-License-Identifier: MIT
 * Irradiance in the air, from the eight probes of the cage around a point. A probe's weight is the product of
 * a trilinear weight and a facing weight (Majercik et al. 2019, "Dynamic Diffuse Global Illumination",
 * section 3), normalised over the cage.
 *
 * No ray is sent. The distance field tells how far around a point and around a probe there is nothing; where
 * the two spheres overlap, the point sees the probe. Other probes count if sight lines along the edges of the
 * cage connect them with one that is seen: they may be hidden, but not in another room. */
#ifndef SDFGI_PROBES_GLSL
#define SDFGI_PROBES_GLSL

#include "sdfgi_cells.glsl"
#include "sdfgi_irradiance.glsl"
#include "sdfgi_trace_cell.glsl"

/* Places that are tried. */
#define SDFGI_PROBES_STEPS 8

/* A probe's weight, without its visibility: trilinear, and less if the probe is behind the surface. Such
 * probes keep a little weight because there may be no others. `trilinear` has a factor per axis. `offset` is
 * metric and leads to the probe; where it is 0 its direction is undefined, and the probe counts as straight
 * above the surface. */
float sdfgi_probe_weight(vec3 trilinear, vec3 offset, vec3 normal)
{
    const float range = length(offset);
    const float facing = range > 1e-4 ? 0.5 + 0.5 * dot(offset, normal) / range : 1.0;
    return (trilinear.x * trilinear.y * trilinear.z + 1e-4) * max(facing * facing, 1e-2);
}

/* The trilinear weight of probe k of a cage at a position in cell space, a factor per axis. */
vec3 sdfgi_probe_trilinear(ivec3 cage, int k, vec3 pos)
{
    const vec3 f = sdfgi_cage_coords(cage, pos);
    return mix(1.0 - f, f, vec3(sdfgi_cage_corner(k)));
}

/* The weight of probe k of a cage at a position in cell space. */
float sdfgi_probe_weight_at(uint cascade, ivec3 cage, int k, vec3 pos, vec3 normal)
{
    const ivec3 probe = cage + sdfgi_cage_corner(k);
    const uint state = sdfgi_probes_at(sdfgi_probe_index(cascade, probe));
    const vec3 offset = sdfgi_metric_from_cells(sdfgi_probe_position(probe, state) - pos);
    return sdfgi_probe_weight(sdfgi_probe_trilinear(cage, k, pos), offset, normal);
}

/* The cell that holds a position, or the nearest in the valid region. */
ivec3 sdfgi_valid_cell(uint cascade, vec3 pos)
{
    return clamp(ivec3(floor(pos)), sdfgi_frame.cascades[cascade].valid_low,
                 sdfgi_frame.cascades[cascade].valid_high - 1);
}

/* The radius, in cell widths, of a sphere around a point of the cell space that holds no set sub-voxel. */
float sdfgi_free_radius(uint cascade, vec3 pos)
{
    const ivec3 cell = sdfgi_valid_cell(cascade, pos);
    const float off_centre = length(sdfgi_metric_from_cells(pos - vec3(cell) - 0.5));
    return sdfgi_cell_distance(cascade, cell) - off_centre - SDFGI_TRACE_MARGIN;
}

/* Adds the probes of a cage that sight lines along its edges connect with those in `reached`; a bit each.
 * `links` has three groups of eight bits, one per axis: whether probe k sees the next one along it. */
uint sdfgi_probes_connected(uint reached, uint links)
{
    for (int i = 0; i < 3; i++)
        for (int axis = 0; axis < 3; axis++) {
            const uint linked = links >> (8 * axis) & 0xffu, step = 1u << axis;
            reached |= (reached & linked) << step | (reached >> step & linked);
        }
    return reached;
}

/* The probes of a cage that a position surely sees, a bit each. */
uint sdfgi_probes_seen(uint cascade, ivec3 cage, vec3 pos, float free)
{
    uint seen = 0u;
    for (int k = int(SDFGI_FIRST); k < 8; k++) {
        const ivec3 probe = cage + sdfgi_cage_corner(k);
        const uint state = sdfgi_probes_at(sdfgi_probe_index(cascade, probe));
        const vec3 at = sdfgi_probe_position(probe, state);
        if (!sdfgi_probe_is_dead(state) &&
            free + sdfgi_free_radius(cascade, at) > length(sdfgi_metric_from_cells(at - pos)))
            seen |= 1u << k;
    }
    return seen;
}

bool sdfgi_is_in_empty_cell(uint cascade, vec3 pos)
{
    return sdfgi_cell_is_empty(cascade, sdfgi_valid_cell(cascade, pos));
}

/* The place with the most room around it, of six that a position sees: within the free sphere around it, or,
 * where that is small, in the middle of an empty cell next to its own empty one. */
vec3 sdfgi_probes_step_out(uint cascade, vec3 pos, inout float free)
{
    vec3 best = pos;
    float most = free;
    const bool by_cells = free < 1.0 && sdfgi_is_in_empty_cell(cascade, pos);
    for (int side = int(SDFGI_FIRST); side < 6; side++) {
        const vec3 unit =
            vec3(side >> 1 == 0, side >> 1 == 1, side >> 1 == 2) * ((side & 1) == 0 ? 1.0 : -1.0);
        const vec3 next = floor(pos) + unit + 0.5;
        const vec3 at = by_cells && sdfgi_is_in_empty_cell(cascade, next)
                            ? next
                            : pos + sdfgi_cells_from_metric(unit * max(free, 0.0));
        const float radius = sdfgi_free_radius(cascade, at);
        best = radius > most ? at : best;
        most = max(most, radius);
    }
    free = most;
    return best;
}

/* The probes that count at a position, a bit each. A position close to a wall has little room around it, and
 * may see no probe for sure. It then sees what a place with more room sees, within its own sphere. */
uint sdfgi_probes_around(uint cascade, ivec3 cage, vec3 pos)
{
    float free = sdfgi_free_radius(cascade, pos);
    uint links = 0u, seen = 0u;
    for (int k = int(SDFGI_FIRST); k < 8; k++) {
        const uint state = sdfgi_probes_at(sdfgi_probe_index(cascade, cage + sdfgi_cage_corner(k)));
        for (int axis = 0; axis < 3; axis++)
            if ((k >> axis & 1) == 0 && !sdfgi_probe_is_dead(state) && sdfgi_probe_is_linked(state, axis))
                links |= 1u << (8 * axis + k);
    }
    const bool has_room = free > 0.0 || sdfgi_is_in_empty_cell(cascade, pos);
    for (int i = 0; i < SDFGI_PROBES_STEPS && has_room && seen == 0u; i++) {
        seen = sdfgi_probes_seen(cascade, cage, pos, free);
        if (seen == 0u)
            pos = sdfgi_probes_step_out(cascade, pos, free);
    }
    return sdfgi_probes_connected(seen, links);
}

/* Irradiance over pi times exposure, times weight, in rgb, and its weight in a; all 0 if no probe is
 * seen. A point at a surface is moved off it along its normal and, half as far, towards the viewer, who is
 * known to be on the open side (Majercik et al. 2021, "Scaling Probe-Based Real-Time Dynamic Global
 * Illumination", section 3.2). */
vec4 sdfgi_probes_lookup(uint cascade, vec3 surface, vec3 normal, vec3 eye)
{
    vec3 pos = surface;
    if (!sdfgi_is_in_empty_cell(cascade, pos) && sdfgi_free_radius(cascade, pos) <= 0.0)
        pos += sdfgi_cells_from_metric(normal * sdfgi_frame.normal_bias + SDFGI_CELLS_TOWARDS_EYE * eye);
    const ivec3 cage = sdfgi_cage_of(cascade, pos);
    const uint around = sdfgi_probes_around(cascade, cage, pos);
    vec4 sum = vec4(0.0);
    for (int k = int(SDFGI_FIRST); k < 8; k++) {
        if ((around >> k & 1u) == 0u)
            continue;
        const float weight = sdfgi_probe_weight_at(cascade, cage, k, pos, normal);
        const sdfgi_irradiance_texel texel =
            sdfgi_irradiance_of_probe(cascade, cage + sdfgi_cage_corner(k), normal);
        sum += vec4(texel.light, 1.0) * (weight * texel.confidence);
    }
    return sum.a > 1e-6 ? sum : vec4(0.0);
}

#endif
