/* SPDX-License-Identifier: MIT
 * What a probe keeps per texel: the mean of the last sample cycle, and the irradiance that lookups read. */
#ifndef SDFGI_PROBE_STORE_GLSL
#define SDFGI_PROBE_STORE_GLSL

#include "probe_common.glsl"
#include "../lib/irradiance_pack.glsl"

/* Mean radiance and weight of the last cycle, four half floats. */
layout(std430, set = SDFGI_SET_WORK, binding = SDFGI_BINDING_PREVIOUS) buffer sdfgi_previous_buffer
{
    uvec2 sdfgi_previous[];
};

/* The light of coarser probes counts in a new probe for this fraction of a cycle at most. That is half as
 * much as the five frames of rays that the new probe reads next, because a cycle has 20 frames by default. */
const float PROBE_SEED_FRACTION = 0.125;

uint probe_texel(uint slot, uint texel)
{
    return slot * uint(SDFGI_IRRADIANCE_COUNT) + texel;
}

void probe_store_previous(uint slot, uint texel, vec3 mean, float weight)
{
    sdfgi_previous[probe_texel(slot, texel)] = sdfgi_half4_encode(vec4(mean, weight));
}

/* Mean in rgb, weight in a. */
vec4 probe_load_previous(uint slot, uint texel)
{
    const uvec2 packed = sdfgi_previous_at(probe_texel(slot, texel));
    return max(sdfgi_half4_decode(packed), vec4(0.0));
}

/* How far a texel of this weight counts beside those of probes with a longer history. */
float probe_confidence(float weight)
{
    return min(weight / (PROBE_SEED_FRACTION * probe_cycle_weight()), 1.0);
}

/* Irradiance of a texel, packed by lib/irradiance_pack.glsl. */
void probe_store_irradiance(uint slot, uint texel, vec4 value)
{
    sdfgi_irradiance_texels[probe_texel(slot, texel)] = sdfgi_half4_encode(sdfgi_half4_truncate(value));
}

vec4 probe_load_irradiance(uint slot, uint texel)
{
    const uvec2 halves = sdfgi_irradiance_texels_at(probe_texel(slot, texel));
    return sdfgi_half4_decode(halves);
}

#endif
