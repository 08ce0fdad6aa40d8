/* SPDX-License-Identifier: MIT
 * What a probe keeps: its last ring, and the irradiance that lookups read. */
#ifndef SDFGI_PROBE_STORE_GLSL
#define SDFGI_PROBE_STORE_GLSL

#include "probe_common.glsl"

/* Mean radiance and weight of the last ring, four half floats. */
layout(std430, set = SDFGI_SET_WORK, binding = SDFGI_BINDING_PREVIOUS) buffer sdfgi_previous_buffer
{
    uvec2 sdfgi_previous[];
};

/* Share of a ring that other probes' light counts for at most in a new one: half as much as the five frames
 * of rays that it goes on to read. */
const float PROBE_SEED_SHARE = 0.125;

void probe_store_previous(uint at, vec3 value, float weight)
{
    sdfgi_previous[at] = uvec2(packHalf2x16(value.rg), packHalf2x16(vec2(value.b, weight)));
}

/* How far a probe counts beside others that have gathered more. */
float probe_trust(float weight)
{
    return min(weight / (PROBE_SEED_SHARE * probe_ring_weight()), 1.0);
}

/* Irradiance of a texel, as sdfgi_lookup_stored reads it. */
void probe_store_irradiance(uint slot, uint texel, vec4 value)
{
    sdfgi_irradiance_texels[slot * uint(SDFGI_IRRADIANCE_COUNT) + texel] =
        uvec2(packHalf2x16(value.rg), packHalf2x16(value.ba));
}

vec4 probe_load_irradiance(uint slot, uint texel)
{
    const uvec2 halves = sdfgi_irradiance_texels[slot * uint(SDFGI_IRRADIANCE_COUNT) + texel];
    return vec4(unpackHalf2x16(halves.x), unpackHalf2x16(halves.y));
}

#endif
