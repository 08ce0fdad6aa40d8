/* SPDX-License-Identifier: MIT
 * Which of the eight probes of a cage a point sees. Three methods answer: the visibility bits of the light
 * cells around the point, depths that are stored per probe, and rays. */
#ifndef SDFGI_VISIBILITY_GLSL
#define SDFGI_VISIBILITY_GLSL

#include "sdfgi_space.glsl"
#include "sdfgi_trace.glsl"
#include "../lib/octahedral.glsl"

/* How far each probe of a cage is visible, 0 to 1, in the order of sdfgi_cage_corner. */
struct sdfgi_visibility {
    float of_probe[8];
};

sdfgi_visibility sdfgi_visibility_from_bits(uint bits)
{
    sdfgi_visibility v;
    for (int k = 0; k < 8; k++)
        v.of_probe[k] = float(bits >> k & 1u);
    return v;
}

/* ---- Rays */

sdfgi_visibility sdfgi_visibility_traced(uint cascade, ivec3 cage, vec3 pos)
{
    sdfgi_visibility v;
    for (int k = 0; k < 8; k++) {
        const ivec3 probe = cage + sdfgi_cage_corner(k);
        const uint state = sdfgi_probes[sdfgi_probe_index(cascade, probe)];
        v.of_probe[k] = !sdfgi_probe_is_dead(state) &&
                                sdfgi_trace_visible(cascade, pos, sdfgi_probe_position(probe, state))
                            ? 1.0
                            : 0.0;
    }
    return v;
}

/* ---- Visibility bits of light cells */

/* Finds the light cell that stands for a surface point: the cell of its biased position or, if that is no
 * light cell, the nearest neighbour that is one and sees `open`. That is a point between the surface and the
 * viewer; it tells the two sides of a thin wall apart, which the surface point cannot, because it lies in the
 * wall's sub-voxels. */
bool sdfgi_visibility_find_light_cell(uint cascade, vec3 pos, vec3 biased, vec3 normal, vec3 open,
                                      out ivec3 light_cell)
{
    const ivec3 own = ivec3(floor(biased));
    light_cell = own;
    if (sdfgi_trace_is_light_cell(cascade, own))
        return true;
    float nearest = 1e30;
    for (int i = 0; i < 64; i++) {
        /* Two bits per axis count to 3, so one of four values is skipped. */
        const ivec3 offset = ivec3(i & 3, i >> 2 & 3, i >> 4) - 1;
        const ivec3 cell = own + offset;
        if (any(greaterThan(offset, ivec3(1))))
            continue;
        const vec3 centre = vec3(cell) + 0.5;
        const vec3 gap = sdfgi_metric_from_cells(centre - biased);
        if (dot(gap, gap) >= nearest || dot(sdfgi_metric_from_cells(centre - pos), normal) <= 0.0 ||
            !sdfgi_trace_is_light_cell(cascade, cell) || !sdfgi_trace_visible(cascade, centre, open))
            continue;
        nearest = dot(gap, gap);
        light_cell = cell;
    }
    return nearest < 1e30;
}

/* Interpolates the visibility bits of the up to eight light cells around a position. Only cells that empty
 * cells connect with `light_cell` take part, because others may be behind a wall. A cell in a neighbouring
 * cage has bits for the probes that both cages share, and only those count. */
sdfgi_visibility sdfgi_visibility_from_cells(uint cascade, ivec3 cage, ivec3 light_cell, vec3 biased)
{
    sdfgi_visibility v;
    float total[8];
    for (int k = 0; k < 8; k++) {
        v.of_probe[k] = 0.0;
        total[k] = 0.0;
    }
    const vec3 p = clamp(biased, vec3(light_cell), vec3(light_cell) + 1.0) - 0.5;
    const ivec3 base = ivec3(floor(p));
    const vec3 f = p - vec3(base);
    const ivec3 side = 2 * base + 1 - 2 * light_cell; /* -1 or 1 per axis: to the other cells of the eight */
    const bvec3 open = bvec3(sdfgi_trace_is_empty(cascade, light_cell + ivec3(side.x, 0, 0)),
                             sdfgi_trace_is_empty(cascade, light_cell + ivec3(0, side.y, 0)),
                             sdfgi_trace_is_empty(cascade, light_cell + ivec3(0, 0, side.z)));
    for (int i = 0; i < 8; i++) {
        const ivec3 cell = base + sdfgi_cage_corner(i);
        const bvec3 moved = notEqual(cell, light_cell);
        const bool reachable =
            !any(moved) || (moved.x && open.x) || (moved.y && open.y) || (moved.z && open.z);
        if (!reachable || !sdfgi_trace_is_light_cell(cascade, cell))
            continue;
        const uint bits = sdfgi_cell_visibility_bits(cascade, cell);
        const vec3 t = mix(1.0 - f, f, vec3(sdfgi_cage_corner(i)));
        const float weight = t.x * t.y * t.z;
        const ivec3 cages_apart = cage - cell / SDFGI_PROBE_SPACING;
        for (int k = 0; k < 8; k++) {
            const ivec3 corner = sdfgi_cage_corner(k) + cages_apart;
            if (any(lessThan(corner, ivec3(0))) || any(greaterThan(corner, ivec3(1))))
                continue;
            total[k] += weight;
            v.of_probe[k] += weight * float(bits >> (corner.x + 2 * corner.y + 4 * corner.z) & 1u);
        }
    }
    for (int k = 0; k < 8; k++)
        v.of_probe[k] = total[k] > 0.0 ? v.of_probe[k] / total[k] : 0.0;
    return v;
}

/* ---- Depths per probe */

vec2 sdfgi_visibility_depth_texel(uint probe_index, ivec2 coord)
{
    const uint stride = uint(SDFGI_OCCLUSION_STRIDE);
    return unpackUnorm2x16(
        sdfgi_occlusion[probe_index * stride * stride + uint(coord.y + 1) * stride + uint(coord.x + 1)]);
}

/* An upper bound of the fraction of depths beyond the receiver: Chebyshev's inequality on mean and mean of
 * squares (Donnelly and Lauritzen 2006, "Variance shadow maps"), cubed for contrast as in DDGI. `dir` leads
 * from the probe to the receiver, `range` is its distance in cell widths. */
float sdfgi_visibility_chebyshev(uint probe_index, vec3 dir, float range)
{
    const vec2 t = (sdfgi_octahedral_encode(dir) * 0.5 + 0.5) * float(SDFGI_OCCLUSION_TEXELS) - 0.5;
    const ivec2 base = ivec2(floor(t));
    const vec2 f = t - vec2(base);
    const vec2 low = mix(sdfgi_visibility_depth_texel(probe_index, base),
                         sdfgi_visibility_depth_texel(probe_index, base + ivec2(1, 0)), f.x);
    const vec2 high = mix(sdfgi_visibility_depth_texel(probe_index, base + ivec2(0, 1)),
                          sdfgi_visibility_depth_texel(probe_index, base + ivec2(1)), f.x);
    const vec2 moments =
        mix(low, high, f.y) * vec2(SDFGI_OCCLUSION_RANGE, SDFGI_OCCLUSION_RANGE * SDFGI_OCCLUSION_RANGE);
    const float gap = range - sdfgi_frame.probe_bias - moments.x;
    if (gap <= 0.0)
        return 1.0;
    /* unorm16 of the range resolves variances of 0.02 cells^2 (HARD_CASES row 43). */
    const float variance = max(moments.y - moments.x * moments.x, 0.02);
    const float p = variance / (variance + gap * gap);
    return p * p * p;
}

sdfgi_visibility sdfgi_visibility_from_depths(uint cascade, ivec3 cage, vec3 pos)
{
    sdfgi_visibility v;
    for (int k = 0; k < 8; k++) {
        const ivec3 probe = cage + sdfgi_cage_corner(k);
        const uint index = sdfgi_probe_index(cascade, probe);
        const vec3 offset = sdfgi_metric_from_cells(pos - sdfgi_probe_position(probe, sdfgi_probes[index]));
        const float range = length(offset);
        v.of_probe[k] = range > 1e-4 ? sdfgi_visibility_chebyshev(index, offset / range, range) : 1.0;
    }
    return v;
}

/* ---- A point in the open */

/* A point so many cells from the surface, towards the viewer, is usually in the open. */
#define SDFGI_VISIBILITY_OPEN_CELLS 4.0

bool sdfgi_visibility_is_solid(uint cascade, vec3 pos)
{
    const ivec3 cell = ivec3(floor(pos));
    return sdfgi_cell_is_valid(cascade, cell) &&
           sdfgi_trace_is_set(sdfgi_cell_bits(cascade, cell),
                              sdfgi_trace_pack_subvoxel(ivec3(floor(pos * 4.0)) & 3));
}

/* A point in the open between a surface point and the viewer, who is `range` cell widths away in the
 * direction `eye`. It may have to be farther than usual: a point in an edge, seen along a wall, has that
 * wall's sub-voxels before it. */
vec3 sdfgi_visibility_open_point(uint cascade, vec3 pos, vec3 normal, vec3 eye, float range)
{
    vec3 open;
    float reach = SDFGI_VISIBILITY_OPEN_CELLS;
    do {
        open = pos + sdfgi_cells_from_metric(eye * min(range, reach) + 0.25 * normal);
        reach *= 2.0;
    } while (sdfgi_visibility_is_solid(cascade, open) && reach < 2.0 * range);
    return open;
}

#endif
