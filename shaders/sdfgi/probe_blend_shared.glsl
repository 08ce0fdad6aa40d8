/* SPDX-License-Identifier: MIT
 * A workgroup filters a probe, with a thread for each texel. */
#ifndef SDFGI_PROBE_BLEND_SHARED_GLSL
#define SDFGI_PROBE_BLEND_SHARED_GLSL

#include "probe_filter.glsl"

shared uint group_change;                         /* float bits: largest change of the probe's texels */
shared float group_light[SDFGI_IRRADIANCE_COUNT]; /* E of the texels, as luminances */

bool has_texel()
{
    return gl_LocalInvocationIndex < uint(SDFGI_IRRADIANCE_COUNT);
}

/* The largest change of a probe's texels. Called by the whole workgroup. */
float largest_change(texel t)
{
    if (gl_LocalInvocationIndex == 0u)
        group_change = 0u;
    barrier();
    if (has_texel())
        atomicMax(group_change, floatBitsToUint(t.change));
    barrier();
    return uintBitsToFloat(group_change);
}

/* Sums the luminances of a probe's texels in order. Called by the whole workgroup. */
float sum_light(texel t)
{
    if (has_texel())
        group_light[gl_LocalInvocationIndex] = sdfgi_light_luminance(t.estimate.rgb);
    barrier();
    float sum = 0.0;
    for (uint i = 0u; i < uint(SDFGI_IRRADIANCE_COUNT); i++)
        sum += group_light[i];
    return sum;
}

void blend_probe(uint cascade)
{
    filtered_probe probe;
    if (!probe_begin(cascade, gl_WorkGroupID.x, probe))
        return;
    texel t;
    if (has_texel()) {
        t = texel_load(probe, gl_LocalInvocationIndex);
        if (t.clamped)
            counter_add(SDFGI_COUNTER_VALUES_CLAMPED, 1u);
    }
    const float change = largest_change(t);
    const bool resets = probe_resets(probe, change);
    if (has_texel())
        texel_store(probe, gl_LocalInvocationIndex, t, resets);
    const float light = args.marks != 0u ? sum_light(t) : 0.0;
    if (gl_LocalInvocationIndex == 0u)
        probe_end(probe, change, light, resets);
}

#endif
