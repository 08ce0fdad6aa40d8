/* SPDX-License-Identifier: MIT
 * Irradiance at a surface point from the eight probes of its cage. A probe's weight is the product of a
 * trilinear weight, a facing weight and its visibility (Majercik et al. 2019, "Dynamic Diffuse Global
 * Illumination", section 3), normalised over the cage.
 *
 * Where walls hide some of the probes, the weighted mean is the light at the centre of those that are left,
 * and not at the point. So the mean is extrapolated from there to the point, along a gradient that is fitted
 * to pairs of neighbouring probes by weighted least squares. A constant field is returned exactly, however
 * few probes are visible. */
#ifndef SDFGI_CAGE_GLSL
#define SDFGI_CAGE_GLSL

#include "sdfgi_irradiance.glsl"
#include "sdfgi_visibility.glsl"

/* Added to the mean squared distance between the probes of a pair, in squared cell widths: it draws the
 * gradient towards 0 where pairs are close together or have little weight, and so say little. At 0.25
 * pictures came out worse (FLIP of two_rooms_lit 0.097 instead of 0.095), errors of walls next to probes
 * stayed alike (2.5 % at most instead of 2.3 %). */
#define SDFGI_CAGE_GRADIENT_DAMPING 1.0

/* For the gradient, a probe in the plane opposite the point keeps at least this trilinear weight per axis:
 * probes that have moved off the lattice need a gradient across it even where the point lies in a plane of
 * the lattice. */
#define SDFGI_CAGE_LEAST_WEIGHT 0.03125

/* A probe's weight, without its visibility: trilinear, and less if the probe is behind the surface. Such
 * probes keep a little weight because there may be no others. `trilinear` has a factor per axis. `offset` is
 * metric and leads to the probe; where it is 0 its direction is undefined, and the probe counts as straight
 * above the surface. */
float sdfgi_cage_weight(vec3 trilinear, vec3 offset, vec3 normal)
{
    const float range = length(offset);
    const float facing = range > 1e-4 ? 0.5 + 0.5 * dot(offset, normal) / range : 1.0;
    return (trilinear.x * trilinear.y * trilinear.z + 1e-4) * max(facing * facing, 1e-2);
}

/* The probes of a cage as a surface point sees them, and a gradient of their light: per axis the quotient of
 *
 *     numerator    sum of weight * distance along the axis * difference of light, over pairs of neighbours
 *     denominator  sum of weight * distance^2
 *
 * Lengths are metric, in cell widths. */
struct sdfgi_cage_samples {
    float weight[8]; /* 0: not visible */
    vec3 offset[8];  /* from the point to the probe */
    vec3 light[8];
    mat3 gradient_numerator; /* a column per axis */
    vec3 gradient_denominator;
};

/* Adds the pair of probe k and another, at `offset`, to the gradient along an axis. */
void sdfgi_cage_add_pair(inout sdfgi_cage_samples samples, int k, int axis, float weight, vec3 offset,
                         vec3 light)
{
    const float span = offset[axis] - samples.offset[k][axis];
    samples.gradient_numerator[axis] += weight * span * (light - samples.light[k]);
    samples.gradient_denominator[axis] += weight * span * span;
}

/* Adds the pair of probe k and its neighbour outside the cage, if the two see each other. It takes the place
 * of the pair with the neighbour within the cage, where the point does not see that one. */
void sdfgi_cage_add_outer_pair(inout sdfgi_cage_samples samples, uint cascade, ivec3 cage, int k, int axis,
                               float weight, vec3 pos, vec3 normal)
{
    const ivec3 probe = cage + sdfgi_cage_corner(k);
    ivec3 outer = probe;
    const bool forward = (k >> axis & 1) != 0;
    outer[axis] += forward ? 1 : -1;
    if (!sdfgi_probe_is_valid(cascade, outer))
        return;
    const uint outer_state = sdfgi_probes[sdfgi_probe_index(cascade, outer)];
    const uint lower_state = forward ? sdfgi_probes[sdfgi_probe_index(cascade, probe)] : outer_state;
    if (sdfgi_probe_is_dead(outer_state) || !sdfgi_probe_is_linked(lower_state, axis))
        return;
    const sdfgi_irradiance_texel texel = sdfgi_irradiance_of_probe(cascade, outer, normal);
    const vec3 offset = sdfgi_metric_from_cells(sdfgi_probe_position(outer, outer_state) - pos);
    sdfgi_cage_add_pair(samples, k, axis, weight * texel.confidence, offset, texel.light);
}

/* Sums up the gradient. `height` is that of the point above its surface. Along the surface all pairs count.
 * Along the normal a pair within the cage counts only as far as both probes are in front of the surface, and
 * outer pairs do not count: there it is the surface itself that hides the inner neighbour, and what is behind
 * the surface does not change the light before it. */
void sdfgi_cage_find_gradient(inout sdfgi_cage_samples samples, uint cascade, ivec3 cage, vec3 pos,
                              vec3 normal, float height, sdfgi_visibility visibility)
{
    const vec3 tangential = 1.0 - normal * normal; /* per axis: 1 along the surface, 0 along its normal */
    for (int k = 0; k < 8; k++) {
        if (samples.weight[k] <= 0.0)
            continue;
        for (int axis = 0; axis < 3; axis++) {
            const int partner = k ^ 1 << axis;
            const float both = samples.weight[k] + samples.weight[partner];
            if (samples.weight[partner] > 0.0 && k < partner) {
                const float lower = min(dot(samples.offset[k], normal), dot(samples.offset[partner], normal));
                const float weight = samples.weight[k] * samples.weight[partner] / both;
                const float in_front = mix(tangential[axis], 1.0, clamp(lower + height, 0.0, 1.0));
                sdfgi_cage_add_pair(samples, k, axis, weight * in_front, samples.offset[partner],
                                    samples.light[partner]);
            }
            const float seen = samples.weight[partner] > 0.0 ? visibility.of_probe[partner] : 0.0;
            const float missing = tangential[axis] * (1.0 - seen);
            if (missing > 0.01)
                sdfgi_cage_add_outer_pair(samples, cascade, cage, k, axis, 0.5 * missing * samples.weight[k],
                                          pos, normal);
        }
    }
}

/* The weighted mean of the probes, extrapolated along the gradient from their centre to the point. */
vec3 sdfgi_cage_extrapolate(sdfgi_cage_samples samples)
{
    vec4 sum = vec4(0.0);
    vec3 centre = vec3(0.0);
    for (int k = 0; k < 8; k++) {
        sum += samples.weight[k] * vec4(samples.light[k], 1.0);
        centre += samples.weight[k] * samples.offset[k];
    }
    const vec3 mean = sum.rgb / sum.a;
    const vec3 to_point =
        -centre / sum.a / (samples.gradient_denominator + SDFGI_CAGE_GRADIENT_DAMPING * sum.a);
    /* A wall next to the point may hide half of a uniform sky, or double the light if it is as bright. More
     * than that is an error of the extrapolation. */
    return clamp(mean + samples.gradient_numerator * to_point, 0.5 * mean, 2.0 * mean);
}

/* Irradiance / pi * exposure in rgb, 1 in a, at a point that is `height` metric cell widths above its
 * surface; all 0 if no probe is visible. */
vec4 sdfgi_cage_irradiance(uint cascade, ivec3 cage, vec3 pos, vec3 normal, float height,
                           sdfgi_visibility visibility)
{
    const vec3 f =
        clamp(sdfgi_cage_coords(cage, pos), SDFGI_CAGE_LEAST_WEIGHT, 1.0 - SDFGI_CAGE_LEAST_WEIGHT);
    sdfgi_cage_samples samples;
    samples.gradient_numerator = mat3(0.0);
    samples.gradient_denominator = vec3(0.0);
    float total = 0.0;
    for (int k = 0; k < 8; k++) {
        samples.weight[k] = 0.0;
        samples.offset[k] = vec3(0.0);
        samples.light[k] = vec3(0.0);
        const ivec3 corner = sdfgi_cage_corner(k);
        const ivec3 probe = cage + corner;
        const uint state = sdfgi_probes[sdfgi_probe_index(cascade, probe)];
        if (visibility.of_probe[k] <= 0.0 || sdfgi_probe_is_dead(state))
            continue;
        samples.offset[k] = sdfgi_metric_from_cells(sdfgi_probe_position(probe, state) - pos);
        const sdfgi_irradiance_texel texel = sdfgi_irradiance_of_probe(cascade, probe, normal);
        samples.weight[k] = sdfgi_cage_weight(mix(1.0 - f, f, vec3(corner)), samples.offset[k], normal) *
                            (visibility.of_probe[k] * texel.confidence);
        samples.light[k] = texel.light;
        total += samples.weight[k];
    }
    if (total <= 1e-6)
        return vec4(0.0);
    sdfgi_cage_find_gradient(samples, cascade, cage, pos, normal, height, visibility);
    return vec4(sdfgi_cage_extrapolate(samples), 1.0);
}

#endif
