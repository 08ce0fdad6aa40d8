/* SPDX-License-Identifier: MIT
 * A thread filters a probe, for software drivers: where threads wait for one another, these drivers keep all
 * variables in memory. */
#ifndef SDFGI_PROBE_BLEND_ALONE_GLSL
#define SDFGI_PROBE_BLEND_ALONE_GLSL

#include "probe_filter.glsl"

const uint TEXELS = uint(SDFGI_IRRADIANCE_COUNT);

void blend_probe(uint cascade)
{
    const uint linear = gl_GlobalInvocationID.x, side = sdfgi_frame.probes_per_side;
    filtered_probe probe;
    if (linear >= side * side * side || !probe_begin(cascade, linear, probe))
        return;
    float change = 0.0, light = 0.0;
    uint clamped = 0u;
    for (uint k = SDFGI_ZERO; k < TEXELS; k++) {
        const texel t = texel_load(probe, k);
        change = max(change, t.change);
        light += sdfgi_light_luminance(t.estimate.rgb);
        clamped += uint(t.clamped);
    }
    if (clamped != 0u)
        counter_add(SDFGI_COUNTER_VALUES_CLAMPED, clamped);
    const bool resets = probe_resets(probe, change);
    for (uint k = SDFGI_ZERO; k < TEXELS; k++)
        texel_store(probe, k, texel_load(probe, k), resets);
    probe_end(probe, change, light, resets);
}

#endif
