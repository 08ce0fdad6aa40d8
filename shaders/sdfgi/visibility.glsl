/* SPDX-License-Identifier: MIT
 * Which of the eight probes of a cage a light cell sees. Two methods answer: the visibility bits of the cell,
 * and depths that are stored per probe. A pass that writes one of the buffers defines SDFGI_WRITES_MASKS or
 * SDFGI_WRITES_OCCLUSION. */
#ifndef SDFGI_VISIBILITY_GLSL
#define SDFGI_VISIBILITY_GLSL

#include "pass.glsl"
#include "../lib/chebyshev.glsl"
#include "../lib/octahedral.glsl"

#ifdef SDFGI_WRITES_MASKS
#define SDFGI_ACCESS_MASKS
#else
#define SDFGI_ACCESS_MASKS readonly
#endif
#ifdef SDFGI_WRITES_OCCLUSION
#define SDFGI_ACCESS_OCCLUSION
#else
#define SDFGI_ACCESS_OCCLUSION readonly
#endif

/* Visibility bits: eight per cell, which probes of its cage a light cell sees. Four cells per word. */
layout(std430, set = SDFGI_SET_WORK,
       binding = SDFGI_BINDING_MASKS) SDFGI_ACCESS_MASKS buffer sdfgi_masks_buffer
{
    uint sdfgi_masks[];
};

/* Mean and mean of squares of depth as unorm16 of SDFGI_OCCLUSION_RANGE, 18 x 18 texels per probe. Empty
 * unless the visibility method is PROBE_DEPTH. */
layout(std430, set = SDFGI_SET_WORK,
       binding = SDFGI_BINDING_OCCLUSION) SDFGI_ACCESS_OCCLUSION buffer sdfgi_occlusion_buffer
{
    uint sdfgi_occlusion[];
};

/* How far each probe of a cage is visible, 0 to 1, in the order of sdfgi_cage_corner. */
struct sdfgi_visibility {
    float of_probe[8];
};

/* A bit per probe of the cage: whether the light cell sees it. */
uint visibility_bits_of_cell(uint cascade, ivec3 cell)
{
    const uint index = sdfgi_cell_index(cascade, cell);
    return sdfgi_masks_at(index >> 2u) >> (8u * (index & 3u)) & 0xffu;
}

sdfgi_visibility visibility_from_bits(uint bits)
{
    sdfgi_visibility v;
    for (int k = 0; k < 8; k++)
        v.of_probe[k] = float(bits >> k & 1u);
    return v;
}

/* ---- Depths per probe */

vec2 visibility_depth_texel(uint probe_index, ivec2 coord)
{
    const uint stride = uint(SDFGI_OCCLUSION_STRIDE);
    return unpackUnorm2x16(
        sdfgi_occlusion_at(probe_index * stride * stride + uint(coord.y + 1) * stride + uint(coord.x + 1)));
}

/* How far a receiver is visible. `dir` leads to it from the probe, `range` is its distance in cell widths. */
float visibility_chebyshev(uint probe_index, vec3 dir, float range)
{
    const vec2 t = (sdfgi_octahedral_encode(dir) * 0.5 + 0.5) * float(SDFGI_OCCLUSION_TEXELS) - 0.5;
    const ivec2 base = ivec2(floor(t));
    const vec2 f = t - vec2(base);
    const vec2 low = mix(visibility_depth_texel(probe_index, base),
                         visibility_depth_texel(probe_index, base + ivec2(1, 0)), f.x);
    const vec2 high = mix(visibility_depth_texel(probe_index, base + ivec2(0, 1)),
                          visibility_depth_texel(probe_index, base + ivec2(1)), f.x);
    const vec2 moments =
        mix(low, high, f.y) * vec2(SDFGI_OCCLUSION_RANGE, SDFGI_OCCLUSION_RANGE * SDFGI_OCCLUSION_RANGE);
    return sdfgi_chebyshev(moments, range - sdfgi_frame.probe_bias - moments.x);
}

float visibility_from_depth(uint cascade, ivec3 probe, vec3 pos)
{
    const uint index = sdfgi_probe_index(cascade, probe);
    const vec3 offset = sdfgi_metric_from_cells(pos - sdfgi_probe_position(probe, sdfgi_probes_at(index)));
    const float range = length(offset);
    return range > 1e-4 ? visibility_chebyshev(index, offset / range, range) : 1.0;
}

/* By the method of the settings; `bits` are those of the light cell at `pos`. Software drivers run both sides
 * of a condition, but a loop only as often as it goes round. */
sdfgi_visibility visibility_of_cage(uint cascade, ivec3 cage, vec3 pos, uint bits)
{
    const uint method = sdfgi_frame.visibility;
    sdfgi_visibility v = visibility_from_bits(method == SDFGI_SHADER_VISIBILITY_CELL_MASK ? bits : 0xffu);
    const int depths = method == SDFGI_SHADER_VISIBILITY_PROBE_DEPTH ? 8 : 0;
    for (int k = 0; k < depths; k++) {
        const float visible = visibility_from_depth(cascade, cage + sdfgi_cage_corner(k), pos);
        for (int i = 0; i < 8; i++)
            v.of_probe[i] = i == k ? visible : v.of_probe[i];
    }
    return v;
}

#endif
