/* SPDX-License-Identifier: MIT
 * Irradiance from the eight probes around a point: trilinear, facing and visibility weights (Majercik et al.
 * 2019, "Dynamic Diffuse Global Illumination", section 3), normalised after visibility. Light cells read the
 * mean, surfaces the mean carried along slopes; both return a constant field exactly however few probes are
 * visible. */
#ifndef SDFGI_LOOKUP_GLSL
#define SDFGI_LOOKUP_GLSL

#include "sdfgi_space.glsl"
#include "sdfgi_trace.glsl"
#include "../lib/octahedral.glsl"
#include "../lib/sky.glsl"
#include "../lib/rgbe.glsl"
#include "../lib/light_pack.glsl"

/* Squared cells: pairs of little weight or length say little of how light changes. At 0.25 pictures came out
 * worse (FLIP of two_rooms_lit 0.097 instead of 0.095), walls beside probes the same (2.5 % at most instead
 * of 2.3 %). */
#define SDFGI_LOOKUP_LEVER 1.0

/* On a plane of the lattice the next plane keeps this share: probes that have moved off the lattice need a
 * slope there, too. */
#define SDFGI_LOOKUP_LEAST_SHARE 0.03125

/* Weight shares of the eight probes of a cage; probe k stands at offset (k & 1, k >> 1 & 1, k >> 2). */
struct sdfgi_visibility {
    float of_probe[8];
};

ivec3 sdfgi_cage_corner(int k)
{
    return ivec3(k & 1, k >> 1 & 1, k >> 2);
}

/* The cage that holds a position, or the nearest one that is complete. */
ivec3 sdfgi_cage_of(uint cascade, vec3 pos)
{
    const ivec3 low = sdfgi_frame.cascades[cascade].valid_low / SDFGI_PROBE_SPACING;
    const ivec3 high = sdfgi_frame.cascades[cascade].valid_high / SDFGI_PROBE_SPACING - 1;
    return clamp(ivec3(floor(pos / float(SDFGI_PROBE_SPACING))), low, max(low, high));
}

/* The four texels around a direction, as they are stored. */
struct sdfgi_lookup_texels {
    uvec2 texels[4]; /* x + 2 y */
};

/* Where a direction lies between texels of a probe's map: the first of the four texels in xy, fractions in
 * zw. */
vec4 sdfgi_lookup_between(vec3 normal)
{
    const vec2 at = (sdfgi_octahedral_encode(normal) * 0.5 + 0.5) * float(SDFGI_IRRADIANCE_TEXELS - 1);
    const vec2 low = min(floor(at), vec2(SDFGI_IRRADIANCE_TEXELS - 2));
    return vec4(low, at - low);
}

sdfgi_lookup_texels sdfgi_lookup_load(uint index, vec4 between)
{
    const uint side = uint(SDFGI_IRRADIANCE_TEXELS);
    const uint first = index * uint(SDFGI_IRRADIANCE_COUNT) + uint(between.x) + side * uint(between.y);
    return sdfgi_lookup_texels(uvec2[4](sdfgi_irradiance_texels[first], sdfgi_irradiance_texels[first + 1u],
                                        sdfgi_irradiance_texels[first + side],
                                        sdfgi_irradiance_texels[first + side + 1u]));
}

vec4 sdfgi_lookup_unpack(uvec2 halves)
{
    return vec4(unpackHalf2x16(halves.x), unpackHalf2x16(halves.y));
}

vec4 sdfgi_lookup_interpolate(sdfgi_lookup_texels t, vec4 between)
{
    return mix(mix(sdfgi_lookup_unpack(t.texels[0]), sdfgi_lookup_unpack(t.texels[1]), between.z),
               mix(sdfgi_lookup_unpack(t.texels[2]), sdfgi_lookup_unpack(t.texels[3]), between.z), between.w);
}

/* Irradiance as stored; a says more: up to 0, of a new probe, less how far it is to be trusted; above, what
 * light cells read over what is shown. */
vec4 sdfgi_lookup_stored(uint cascade, ivec3 probe, vec3 normal)
{
    const vec4 between = sdfgi_lookup_between(normal);
    return sdfgi_lookup_interpolate(sdfgi_lookup_load(sdfgi_probe_index(cascade, probe), between), between);
}

/* What is shown in rgb, a probe's share of its weight in a. */
vec4 sdfgi_lookup_shown(uint cascade, ivec3 probe, vec3 normal)
{
    const vec4 light = sdfgi_lookup_stored(cascade, probe, normal);
    return vec4(light.rgb, light.a > 0.0 ? 1.0 : -light.a);
}

/* A probe's weight at a position, its visibility apart: trilinear, less where it is behind the surface. Those
 * count little, but not nothing: they may be all there is. On a probe the direction is undefined and its
 * facing weight is that of a probe straight above. `way` is metric and leads to the probe. */
float sdfgi_lookup_weight(vec3 share, vec3 way, vec3 normal)
{
    const float range = length(way);
    const float facing = range > 1e-4 ? 0.5 + 0.5 * dot(way, normal) / range : 1.0;
    return (share.x * share.y * share.z + 1e-4) * max(facing * facing, 1e-2);
}

/* Place of a position in its cage, in [0, 1]^3. */
vec3 sdfgi_cage_coords(ivec3 cage, vec3 pos)
{
    return clamp(pos / float(SDFGI_PROBE_SPACING) - vec3(cage), 0.0, 1.0);
}

/* The probes that a surface point sees, and how light changes along each axis. Places are metric, in cell
 * widths, relative to the point. */
struct sdfgi_lookup_probes {
    float weight[8]; /* 0: not visible */
    vec3 way[8];
    vec3 light[8];
    mat3 rise;  /* column per axis: weighted sum of change of light times length, over pairs of neighbours */
    vec3 lever; /* of squared lengths */
};

/* A pair of neighbours along an axis says how light changes there; `b` is the second one's way. */
void sdfgi_lookup_add_pair(inout sdfgi_lookup_probes probes, int k, int axis, float weight, vec3 b,
                           vec3 light)
{
    const float span = b[axis] - probes.way[k][axis];
    probes.rise[axis] += weight * span * (light - probes.light[k]);
    probes.lever[axis] += weight * span * span;
}

/* Where a probe's partner across the cage is hidden, the pair is made of the probe and the one beyond it, if
 * they see each other. */
void sdfgi_lookup_add_beyond(inout sdfgi_lookup_probes probes, uint cascade, ivec3 cage, int k, int axis,
                             float weight, vec3 pos, vec3 normal)
{
    const ivec3 probe = cage + sdfgi_cage_corner(k);
    ivec3 beyond = probe;
    const bool forward = (k >> axis & 1) != 0;
    beyond[axis] += forward ? 1 : -1;
    if (!sdfgi_probe_is_valid(cascade, beyond))
        return;
    const uint other = sdfgi_probes[sdfgi_probe_index(cascade, beyond)];
    const uint lower = forward ? sdfgi_probes[sdfgi_probe_index(cascade, probe)] : other;
    if (sdfgi_probe_is_dead(other) || !sdfgi_probe_is_linked(lower, axis))
        return;
    const vec4 light = sdfgi_lookup_shown(cascade, beyond, normal);
    sdfgi_lookup_add_pair(probes, k, axis, weight * light.a,
                          sdfgi_metric_from_cells(sdfgi_probe_position(beyond, other) - pos), light.rgb);
}

/* Across the surface pairs count only as far as both are in front of it, and nothing is extrapolated: what
 * hides a probe there stands in no light's way. `height` is that of the point above its surface. */
void sdfgi_lookup_find_slopes(inout sdfgi_lookup_probes probes, uint cascade, ivec3 cage, vec3 pos,
                              vec3 normal, float height, sdfgi_visibility visibility)
{
    const vec3 along = 1.0 - normal * normal;
    for (int k = 0; k < 8; k++) {
        if (probes.weight[k] <= 0.0)
            continue;
        for (int axis = 0; axis < 3; axis++) {
            const int partner = k ^ 1 << axis;
            const float both = probes.weight[k] + probes.weight[partner];
            if (probes.weight[partner] > 0.0 && k < partner) {
                const float lower = min(dot(probes.way[k], normal), dot(probes.way[partner], normal));
                const float weight = probes.weight[k] * probes.weight[partner] / both;
                const float share = mix(along[axis], 1.0, clamp(lower + height, 0.0, 1.0));
                sdfgi_lookup_add_pair(probes, k, axis, weight * share, probes.way[partner],
                                      probes.light[partner]);
            }
            const float seen = probes.weight[partner] > 0.0 ? visibility.of_probe[partner] : 0.0;
            const float missing = along[axis] * (1.0 - seen);
            if (missing > 0.01)
                sdfgi_lookup_add_beyond(probes, cascade, cage, k, axis, 0.5 * missing * probes.weight[k], pos,
                                        normal);
        }
    }
}

/* The probes' mean, carried from the middle of those that count to the point. */
vec3 sdfgi_lookup_carry(sdfgi_lookup_probes probes)
{
    vec4 sum = vec4(0.0);
    vec3 middle = vec3(0.0);
    for (int k = 0; k < 8; k++) {
        sum += probes.weight[k] * vec4(probes.light[k], 1.0);
        middle += probes.weight[k] * probes.way[k];
    }
    const vec3 mean = sum.rgb / sum.a;
    const vec3 way = -middle / sum.a / (probes.lever + SDFGI_LOOKUP_LEVER * sum.a);
    /* A wall beside a point hides at most half of an even sky, or doubles it where it shines as brightly. */
    return clamp(mean + probes.rise * way, 0.5 * mean, 2.0 * mean);
}

/* Irradiance in rgb, 1 in a, at a point that is `height` metric cell widths above its surface; all 0 if no
 * probe is visible. */
vec4 sdfgi_lookup_sloped(uint cascade, ivec3 cage, vec3 pos, vec3 normal, float height,
                         sdfgi_visibility visibility)
{
    const vec3 f =
        clamp(sdfgi_cage_coords(cage, pos), SDFGI_LOOKUP_LEAST_SHARE, 1.0 - SDFGI_LOOKUP_LEAST_SHARE);
    sdfgi_lookup_probes probes;
    probes.rise = mat3(0.0);
    probes.lever = vec3(0.0);
    float total = 0.0;
    for (int k = 0; k < 8; k++) {
        probes.weight[k] = 0.0;
        probes.way[k] = vec3(0.0);
        probes.light[k] = vec3(0.0);
        const ivec3 corner = sdfgi_cage_corner(k);
        const ivec3 probe = cage + corner;
        const uint state = sdfgi_probes[sdfgi_probe_index(cascade, probe)];
        if (visibility.of_probe[k] <= 0.0 || sdfgi_probe_is_dead(state))
            continue;
        probes.way[k] = sdfgi_metric_from_cells(sdfgi_probe_position(probe, state) - pos);
        const vec4 light = sdfgi_lookup_shown(cascade, probe, normal);
        probes.weight[k] = sdfgi_lookup_weight(mix(1.0 - f, f, vec3(corner)), probes.way[k], normal) *
                           (visibility.of_probe[k] * light.a);
        probes.light[k] = light.rgb;
        total += probes.weight[k];
    }
    if (total <= 1e-6)
        return vec4(0.0);
    sdfgi_lookup_find_slopes(probes, cascade, cage, pos, normal, height, visibility);
    return vec4(sdfgi_lookup_carry(probes), 1.0);
}

/* Radiance at the end of a ray: the sky's, or that of the light cell before the surface it hits. */
vec3 sdfgi_lookup_ray_light(sdfgi_trace_hit hit, vec3 dir)
{
    if (!hit.hit)
        return sdfgi_sky_radiance(dir, sdfgi_frame.sky_zenith, sdfgi_frame.sky_horizon,
                                  sdfgi_frame.sky_ground);
    if (!hit.has_cell)
        return vec3(0.0);
    return sdfgi_light_unpack_axis(sdfgi_light[sdfgi_cell_index(hit.cascade, hit.cell)], hit.axis);
}

/* Irradiance over pi by rays, for the few points that none of the eight probes can see, behind a pillar or in
 * a niche: a cosine-distributed spiral around the normal. `pos` must be in the open. */
vec4 sdfgi_lookup_rays(uint cascade, vec3 pos, vec3 normal)
{
    const int RAYS = 16;
    const vec3 side =
        normalize(abs(normal.y) < 0.9 ? vec3(-normal.z, 0.0, normal.x) : vec3(0.0, normal.z, -normal.y));
    const vec3 up = cross(normal, side);
    vec3 sum = vec3(0.0);
    for (int i = 0; i < RAYS; i++) {
        const float r2 = (float(i) + 0.5) / float(RAYS), turn = float(i) * 2.39996323; /* golden angle */
        const vec3 dir = sqrt(r2) * (cos(turn) * side + sin(turn) * up) + sqrt(1.0 - r2) * normal;
        sum += sdfgi_lookup_ray_light(sdfgi_trace_ray(cascade, sdfgi_frame.cascade_count - 1u, pos, dir, 1e9),
                                      dir);
    }
    return vec4(sum / float(RAYS), 1.0);
}

sdfgi_visibility sdfgi_visibility_from_bits(uint mask)
{
    sdfgi_visibility v;
    for (int k = 0; k < 8; k++)
        v.of_probe[k] = float(mask >> k & 1u);
    return v;
}

sdfgi_visibility sdfgi_lookup_traced(uint cascade, ivec3 cage, vec3 pos)
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

/* The light cell that stands for a surface point: the one that holds the biased position, else the nearest of
 * its neighbours from which `open`, a point on the way to the viewer, can be seen. The viewer tells the two
 * sides of a thin wall apart, which the point alone, lying inside the wall's sub-voxels, cannot. */
bool sdfgi_lookup_anchor(uint cascade, vec3 pos, vec3 biased, vec3 normal, vec3 open, out ivec3 anchor)
{
    const ivec3 base = ivec3(floor(biased));
    anchor = base;
    if (sdfgi_trace_is_light_cell(cascade, base))
        return true;
    float nearest = 1e30;
    for (int i = 0; i < 64; i++) {
        /* Three of the four values of each pair of bits. */
        const ivec3 offset = ivec3(i & 3, i >> 2 & 3, i >> 4) - 1;
        const ivec3 cell = base + offset;
        if (any(greaterThan(offset, ivec3(1))))
            continue;
        const vec3 centre = vec3(cell) + 0.5;
        const vec3 gap = sdfgi_metric_from_cells(centre - biased);
        if (dot(gap, gap) >= nearest || dot(sdfgi_metric_from_cells(centre - pos), normal) <= 0.0 ||
            !sdfgi_trace_is_light_cell(cascade, cell) || !sdfgi_trace_visible(cascade, centre, open))
            continue;
        nearest = dot(gap, gap);
        anchor = cell;
    }
    return nearest < 1e30;
}

/* Trilinear share of each probe's visible bit over the light cells around a position that can be reached from
 * its anchor through empty cells. Cells of a neighbouring cage speak for the probes they share with this one.
 */
sdfgi_visibility sdfgi_lookup_cell_masks(uint cascade, ivec3 cage, ivec3 anchor, vec3 biased)
{
    sdfgi_visibility v;
    float total[8];
    for (int k = 0; k < 8; k++) {
        v.of_probe[k] = 0.0;
        total[k] = 0.0;
    }
    const vec3 p = clamp(biased, vec3(anchor), vec3(anchor) + 1.0) - 0.5;
    const ivec3 base = ivec3(floor(p));
    const vec3 f = p - vec3(base);
    const ivec3 side = 2 * base + 1 - 2 * anchor; /* -1 or 1: where the other cells of the support lie */
    const bvec3 open = bvec3(sdfgi_trace_is_empty(cascade, anchor + ivec3(side.x, 0, 0)),
                             sdfgi_trace_is_empty(cascade, anchor + ivec3(0, side.y, 0)),
                             sdfgi_trace_is_empty(cascade, anchor + ivec3(0, 0, side.z)));
    for (int i = 0; i < 8; i++) {
        const ivec3 cell = base + sdfgi_cage_corner(i);
        const bvec3 moved = notEqual(cell, anchor);
        const bool reachable =
            !any(moved) || (moved.x && open.x) || (moved.y && open.y) || (moved.z && open.z);
        if (!reachable || !sdfgi_trace_is_light_cell(cascade, cell))
            continue;
        const uint mask = sdfgi_cell_mask(cascade, cell);
        const vec3 t = mix(1.0 - f, f, vec3(sdfgi_cage_corner(i)));
        const float weight = t.x * t.y * t.z;
        const ivec3 shift = cage - cell / SDFGI_PROBE_SPACING;
        for (int k = 0; k < 8; k++) {
            const ivec3 corner = sdfgi_cage_corner(k) + shift;
            if (any(lessThan(corner, ivec3(0))) || any(greaterThan(corner, ivec3(1))))
                continue;
            total[k] += weight;
            v.of_probe[k] += weight * float(mask >> (corner.x + 2 * corner.y + 4 * corner.z) & 1u);
        }
    }
    for (int k = 0; k < 8; k++)
        v.of_probe[k] = total[k] > 0.0 ? v.of_probe[k] / total[k] : 0.0;
    return v;
}

vec2 sdfgi_lookup_depth_texel(uint probe, ivec2 coord)
{
    const uint stride = uint(SDFGI_OCCLUSION_STRIDE);
    return unpackUnorm2x16(
        sdfgi_occlusion[probe * stride * stride + uint(coord.y + 1) * stride + uint(coord.x + 1)]);
}

/* Chebyshev's inequality on a probe's depths (Donnelly and Lauritzen 2006, "Variance shadow maps"), cubed for
 * contrast as in DDGI. `dir` points from the probe to the receiver, `range` is in cells. */
float sdfgi_lookup_chebyshev(uint probe, vec3 dir, float range)
{
    const vec2 t = (sdfgi_octahedral_encode(dir) * 0.5 + 0.5) * float(SDFGI_OCCLUSION_TEXELS) - 0.5;
    const ivec2 base = ivec2(floor(t));
    const vec2 f = t - vec2(base);
    const vec2 low =
        mix(sdfgi_lookup_depth_texel(probe, base), sdfgi_lookup_depth_texel(probe, base + ivec2(1, 0)), f.x);
    const vec2 high = mix(sdfgi_lookup_depth_texel(probe, base + ivec2(0, 1)),
                          sdfgi_lookup_depth_texel(probe, base + ivec2(1)), f.x);
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

sdfgi_visibility sdfgi_lookup_probe_depth(uint cascade, ivec3 cage, vec3 pos)
{
    sdfgi_visibility v;
    for (int k = 0; k < 8; k++) {
        const ivec3 probe = cage + sdfgi_cage_corner(k);
        const uint index = sdfgi_probe_index(cascade, probe);
        const vec3 way = sdfgi_metric_from_cells(pos - sdfgi_probe_position(probe, sdfgi_probes[index]));
        const float range = length(way);
        v.of_probe[k] = range > 1e-4 ? sdfgi_lookup_chebyshev(index, way / range, range) : 1.0;
    }
    return v;
}

/* How far towards the viewer, in cells, a point is taken to be open space; further where that lies in a
 * wall's sub-voxels, as it does for points in an edge that are seen along the wall. */
#define SDFGI_LOOKUP_OPEN_CELLS 4.0

bool sdfgi_lookup_is_solid(uint cascade, vec3 pos)
{
    const ivec3 cell = ivec3(floor(pos));
    return sdfgi_cell_is_valid(cascade, cell) &&
           sdfgi_trace_is_set(sdfgi_cell_bits(cascade, cell), sdfgi_trace_pack_subvoxel(ivec3(floor(pos * 4.0)) & 3));
}

/* A point in the open on the way to a viewer who is `range` cell widths away. */
vec3 sdfgi_lookup_open(uint cascade, vec3 pos, vec3 normal, vec3 eye, float range)
{
    vec3 open;
    float reach = SDFGI_LOOKUP_OPEN_CELLS;
    do {
        open = pos + sdfgi_cells_from_metric(eye * min(range, reach) + 0.25 * normal);
        reach *= 2.0;
    } while (sdfgi_lookup_is_solid(cascade, open) && reach < 2.0 * range);
    return open;
}

/* Light at a surface point. The point is biased off the surface along its normal and, half as far, towards
 * the viewer, who is known to be on its open side (Majercik et al. 2021, "Scaling Probe-Based Real-Time
 * Dynamic Global Illumination", section 3.2). `to_eye` is in cells. */
vec4 sdfgi_lookup_surface(uint cascade, vec3 pos, vec3 normal, vec3 to_eye)
{
    const float range = length(to_eye);
    const vec3 eye = to_eye / max(range, 1e-6);
    const vec3 biased = pos + sdfgi_cells_from_metric(normal + 0.5 * eye) * sdfgi_frame.normal_bias;
    const vec3 open = sdfgi_lookup_open(cascade, pos, normal, eye, range);
    const ivec3 cage = sdfgi_cage_of(cascade, biased);
    const uint method = sdfgi_frame.visibility;
    sdfgi_visibility v;
    ivec3 anchor;
    vec3 seen_from = open;
    if (method == SDFGI_SHADER_VISIBILITY_NONE)
        v = sdfgi_visibility_from_bits(0xffu);
    else if (method == SDFGI_SHADER_VISIBILITY_PROBE_DEPTH)
        v = sdfgi_lookup_probe_depth(cascade, cage, biased);
    else if (method == SDFGI_SHADER_VISIBILITY_CELL_MASK &&
             sdfgi_lookup_anchor(cascade, pos, biased, normal, open, anchor)) {
        v = sdfgi_lookup_cell_masks(cascade, cage, anchor, biased);
        seen_from = clamp(biased, vec3(anchor) + 0.05, vec3(anchor) + 0.95);
    } else
        v = sdfgi_lookup_traced(cascade, cage, pos + sdfgi_cells_from_metric(normal + eye) * 0.25);
    const float height = dot(sdfgi_metric_from_cells(biased - pos), normal);
    const vec4 light = sdfgi_lookup_sloped(cascade, cage, biased, normal, height, v);
    return light.a > 0.0 ? light : sdfgi_lookup_rays(cascade, seen_from, normal);
}

/* How much of a cascade's answer to use at a position: 1 inside, falling to 0 over one probe before its
 * border, which moves smoothly while the cascade steps. */
float sdfgi_lookup_cascade_share(uint cascade, vec3 pos)
{
    const vec3 edge =
        min(pos - sdfgi_frame.cascades[cascade].blend_low, sdfgi_frame.cascades[cascade].blend_high - pos);
    return clamp((min(edge.x, min(edge.y, edge.z)) - 1.0) / float(SDFGI_PROBE_SPACING), 0.0, 1.0);
}

/* Irradiance over pi times exposure at a position in cell space of cascade 0. The finest cascade answers;
 * near its border the next coarser one takes over; outside the last the sky does. */
vec3 sdfgi_lookup_irradiance(vec3 pos_first, vec3 normal, vec3 to_eye)
{
    const vec3 eye_first = to_eye / sdfgi_frame.cascades[0].cell_m;
    vec3 result = vec3(0.0);
    float rest = 1.0;
    for (uint c = 0u; c < sdfgi_frame.cascade_count && rest > 0.0; c++) {
        const vec3 pos = sdfgi_cascade_from_first(c, pos_first);
        const float share = sdfgi_lookup_cascade_share(c, pos);
        if (share <= 0.0)
            continue;
        const vec4 sum =
            sdfgi_lookup_surface(c, pos, normal, eye_first * sdfgi_frame.cascades[c].from_first_scale);
        result += rest * share * sum.rgb / sum.a;
        rest *= 1.0 - share;
    }
    const vec3 sky =
        sdfgi_sky_irradiance(normal, sdfgi_frame.sky_zenith, sdfgi_frame.sky_horizon, sdfgi_frame.sky_ground);
    return result + rest * sky;
}

#endif
