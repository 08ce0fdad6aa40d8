/* SPDX-License-Identifier: MIT
 * How light cells and new probes read probes: the weighted mean over a cage. A cell reads two kinds of light.
 * What leaves its surfaces follows the probes' unfiltered irradiance, so that light spreads as fast as it
 * can. Lookups show irradiance that follows it slowly. */
#ifndef SDFGI_BOUNCE_GLSL
#define SDFGI_BOUNCE_GLSL

#include "visibility.glsl"
#include "../include/sdfgi_cells.glsl"
#include "../include/sdfgi_probes.glsl"

/* Irradiance over pi times exposure, of one probe or of several. Both parts of a sum are times weight. */
struct bounce_light {
    vec3 estimate;  /* unfiltered */
    vec3 displayed; /* filtered */
    float weight;
};

/* The sum over the eight probes of a cage. Over its weight it is no brighter than the brightest probe. A
 * first loop loads everything, and a second one adds: the loads overlap, so that a thread waits once instead
 * of sixteen times. */
bounce_light bounce_sum(uint cascade, ivec3 cage, vec3 pos, vec3 normal, sdfgi_visibility visibility)
{
    const vec3 f = sdfgi_cage_coords(cage, pos);
    uint states[8];
    sdfgi_irradiance_halves halves[8];
    const sdfgi_irradiance_footprint footprint = sdfgi_irradiance_footprint_of(normal);
    for (int k = 0; k < 8; k++) {
        const uint index = sdfgi_probe_index(cascade, cage + sdfgi_cage_corner(k));
        states[k] = sdfgi_probes_at(index);
        halves[k] = sdfgi_irradiance_load(index, footprint);
    }
    bounce_light sum = bounce_light(vec3(0.0), vec3(0.0), 0.0);
    for (int k = 0; k < 8; k++) {
        if (visibility.of_probe[k] <= 0.0 || sdfgi_probe_is_dead(states[k]))
            continue;
        const ivec3 corner = sdfgi_cage_corner(k);
        const vec3 offset = sdfgi_metric_from_cells(sdfgi_probe_position(cage + corner, states[k]) - pos);
        const sdfgi_irradiance_texel texel = sdfgi_irradiance_interpolate(halves[k], footprint.fraction);
        const float weight = sdfgi_probe_weight(mix(1.0 - f, f, vec3(corner)), offset, normal) *
                             visibility.of_probe[k] * texel.confidence;
        sum.displayed += weight * texel.light;
        sum.estimate += weight * texel.gain * texel.light;
        sum.weight += weight;
    }
    return sum;
}

/* Irradiance of a light cell, at its centre, of weight 1, or of weight 0 if it sees no probe; `bits` are its
 * visibility bits. A cell that sees no probe reads the light cell of the next coarser cascade at the same
 * place, if there is one. It cannot trace rays to other light cells, because those change in the same pass.
 */
bounce_light bounce_light_cell(uint cascade, ivec3 cell, vec3 normal, uint bits)
{
    const vec3 first = sdfgi_first_from_cascade(cascade, vec3(cell) + 0.5);
    for (uint c = cascade; c < sdfgi_frame.cascade_count; c++) {
        const vec3 pos = sdfgi_cascade_from_first(c, first);
        const ivec3 at = ivec3(floor(pos));
        if (c > cascade && !(sdfgi_cell_is_valid(c, at) && sdfgi_cell_is_light(c, at)))
            continue;
        const ivec3 cage = sdfgi_cage_of(c, pos);
        const uint bits_here = c == cascade ? bits : visibility_bits_of_cell(c, at);
        const bounce_light sum =
            bounce_sum(c, cage, pos, normal, visibility_of_cage(c, cage, pos, bits_here));
        if (sum.weight > 1e-6)
            return bounce_light(sum.estimate / sum.weight, sum.displayed / sum.weight, 1.0);
    }
    return bounce_light(vec3(0.0), vec3(0.0), 0.0);
}

#endif
