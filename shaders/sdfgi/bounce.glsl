/* SPDX-License-Identifier: MIT
 * How light cells and new probes read probes: the weighted mean over a cage, without extrapolation, which
 * could amplify light from bounce to bounce. Hosts read a cage by include/sdfgi_cage.glsl instead.
 *
 * The mean takes the unfiltered irradiance, so that light spreads as fast as it can. Surfaces show irradiance
 * that follows it slowly. */
#ifndef SDFGI_BOUNCE_GLSL
#define SDFGI_BOUNCE_GLSL

#include "../include/sdfgi_cage.glsl"

/* Sum of unfiltered irradiance over pi times weight in rgb, sum of weights in a, for the eight probes of a
 * cage. The quotient is no brighter than the brightest probe. A first loop loads everything, and a second one
 * adds: the loads overlap, so that a thread waits once instead of sixteen times. */
vec4 bounce_sum(uint cascade, ivec3 cage, vec3 pos, vec3 normal, sdfgi_visibility visibility)
{
    const vec3 f = sdfgi_cage_coords(cage, pos);
    uint states[8];
    sdfgi_irradiance_halves halves[8];
    const sdfgi_irradiance_footprint footprint = sdfgi_irradiance_footprint_of(normal);
    for (int k = 0; k < 8; k++) {
        const uint index = sdfgi_probe_index(cascade, cage + sdfgi_cage_corner(k));
        states[k] = sdfgi_probes[index];
        halves[k] = sdfgi_irradiance_load(index, footprint);
    }
    vec4 sum = vec4(0.0);
    for (int k = 0; k < 8; k++) {
        if (visibility.of_probe[k] <= 0.0 || sdfgi_probe_is_dead(states[k]))
            continue;
        const ivec3 corner = sdfgi_cage_corner(k);
        const vec3 offset = sdfgi_metric_from_cells(sdfgi_probe_position(cage + corner, states[k]) - pos);
        const float weight =
            sdfgi_cage_weight(mix(1.0 - f, f, vec3(corner)), offset, normal) * visibility.of_probe[k];
        const sdfgi_irradiance_texel texel = sdfgi_irradiance_interpolate(halves[k], footprint.fraction);
        sum += vec4(texel.light * texel.gain, 1.0) * (weight * texel.confidence);
    }
    return sum;
}

/* The same for a light cell, at its centre; `bits` are its visibility bits. A cell that sees no probe reads
 * the light cell of the next coarser cascade at the same place, if there is one. It cannot trace rays to
 * other light cells, because those change in the same pass. */
vec4 bounce_light_cell(uint cascade, ivec3 cell, vec3 normal, uint bits)
{
    const vec3 first = sdfgi_first_from_cascade(cascade, vec3(cell) + 0.5);
    const uint method = sdfgi_frame.visibility;
    for (uint c = cascade; c < sdfgi_frame.cascade_count; c++) {
        const vec3 pos = sdfgi_cascade_from_first(c, first);
        const ivec3 at = ivec3(floor(pos));
        if (c > cascade && !sdfgi_trace_is_light_cell(c, at))
            continue;
        const ivec3 cage = sdfgi_cage_of(c, pos);
        const uint bits_here = method == SDFGI_SHADER_VISIBILITY_NONE
                                   ? 0xffu
                                   : (c == cascade ? bits : sdfgi_cell_visibility_bits(c, at));
        const vec4 sum = method == SDFGI_SHADER_VISIBILITY_PROBE_DEPTH
                             ? bounce_sum(c, cage, pos, normal, sdfgi_visibility_from_depths(c, cage, pos))
                             : bounce_sum(c, cage, pos, normal, sdfgi_visibility_from_bits(bits_here));
        if (sum.a > 1e-6)
            return sum;
    }
    return vec4(0.0);
}

#endif
