/* SPDX-License-Identifier: MIT
 * How light cells and new probes read probes: the weighted mean over a cage, with the unfiltered irradiance
 * of each probe. Hosts read the filtered irradiance instead: include/sdfgi_lookup.glsl. */
#ifndef SDFGI_BOUNCE_GLSL
#define SDFGI_BOUNCE_GLSL

#include "../include/sdfgi_lookup.glsl"

/* The newest that is known, likewise. */
vec4 bounce_texel(sdfgi_lookup_texels texels, vec4 between)
{
    const vec4 light = sdfgi_lookup_interpolate(texels, between);
    return light.a > 0.0 ? vec4(light.rgb * light.a, 1.0) : vec4(light.rgb, -light.a);
}

/* Sum of probes times weights in rgb, sum of weights in a. A mean: no brighter than the brightest probe. All
 * is read before anything is asked of it: one wait, not sixteen. */
vec4 bounce_sum(uint cascade, ivec3 cage, vec3 pos, vec3 normal, sdfgi_visibility visibility)
{
    const vec3 f = sdfgi_cage_coords(cage, pos);
    uint states[8];
    sdfgi_lookup_texels texels[8];
    const vec4 between = sdfgi_lookup_between(normal);
    for (int k = 0; k < 8; k++) {
        const uint index = sdfgi_probe_index(cascade, cage + sdfgi_cage_corner(k));
        states[k] = sdfgi_probes[index];
        texels[k] = sdfgi_lookup_load(index, between);
    }
    vec4 sum = vec4(0.0);
    for (int k = 0; k < 8; k++) {
        if (visibility.of_probe[k] <= 0.0 || sdfgi_probe_is_dead(states[k]))
            continue;
        const ivec3 corner = sdfgi_cage_corner(k);
        const vec3 way = sdfgi_metric_from_cells(sdfgi_probe_position(cage + corner, states[k]) - pos);
        const float weight =
            sdfgi_lookup_weight(mix(1.0 - f, f, vec3(corner)), way, normal) * visibility.of_probe[k];
        const vec4 light = bounce_texel(texels[k], between);
        sum += vec4(light.rgb, 1.0) * (weight * light.a);
    }
    return sum;
}

/* Sum over the cage of a light cell's centre; `mask` is its own. Where it sees no probe, the light cell of a
 * coarser cascade at the same place may. Rays to other light cells are out of the question: those change in
 * the same pass. */
vec4 bounce_light_cell(uint cascade, ivec3 cell, vec3 normal, uint mask)
{
    const vec3 first = sdfgi_first_from_cascade(cascade, vec3(cell) + 0.5);
    const uint method = sdfgi_frame.visibility;
    for (uint c = cascade; c < sdfgi_frame.cascade_count; c++) {
        const vec3 pos = sdfgi_cascade_from_first(c, first);
        const ivec3 at = ivec3(floor(pos));
        if (c > cascade && !sdfgi_trace_is_light_cell(c, at))
            continue;
        const ivec3 cage = sdfgi_cage_of(c, pos);
        const uint bits =
            method == SDFGI_SHADER_VISIBILITY_NONE ? 0xffu : (c == cascade ? mask : sdfgi_cell_mask(c, at));
        const vec4 sum = method == SDFGI_SHADER_VISIBILITY_PROBE_DEPTH
                             ? bounce_sum(c, cage, pos, normal, sdfgi_lookup_probe_depth(c, cage, pos))
                             : bounce_sum(c, cage, pos, normal, sdfgi_visibility_from_bits(bits));
        if (sum.a > 1e-6)
            return sum;
    }
    return vec4(0.0);
}

#endif
