/* SPDX-License-Identifier: MIT
 * What a probe keeps: its last ring, and its square of the atlas. */
#ifndef SDFGI_PROBE_STORE_GLSL
#define SDFGI_PROBE_STORE_GLSL

#include "probe_common.glsl"

/* Mean radiance and weight of the last ring, four half floats. */
layout(std430, set = 0, binding = SDFGI_BINDING_PREVIOUS) buffer sdfgi_previous_buffer { uvec2 sdfgi_previous[]; };
layout(set = 0, binding = SDFGI_BINDING_IRRADIANCE_STORE, rgba16f) uniform image2DArray irradiance_store;

/* As sdfgi_lookup.glsl's lookup_stored reads them. */
shared vec4 texels[SDFGI_IRRADIANCE_COUNT];

/* Share of a ring that other probes' light counts for at most in a new one: half as much as the five frames of rays that it
 * goes on to read. */
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

/* What the atlas holds of a texel of the map. */
vec4 probe_stored_texel(uint cascade, ivec3 probe, uint texel)
{
    const uint n = uint(SDFGI_IRRADIANCE_TEXELS);
    return imageLoad(irradiance_store,
                     ivec3(probe_atlas_corner(cascade, probe) + 1 + ivec2(texel % n, texel / n), int(cascade)));
}

/* Copies `texels` to the atlas, border included. Called by at least 49 threads. */
void probe_store_texels(uint cascade, ivec3 probe)
{
    const uint i = gl_LocalInvocationIndex, stride = uint(SDFGI_IRRADIANCE_STRIDE);
    if (i >= stride * stride)
        return;
    const ivec2 coord = ivec2(i % stride, i / stride);
    const ivec2 source = octahedral_border_source(coord - 1, SDFGI_IRRADIANCE_TEXELS);
    imageStore(irradiance_store, ivec3(probe_atlas_corner(cascade, probe) + coord, int(cascade)),
               texels[source.x + SDFGI_IRRADIANCE_TEXELS * source.y]);
}

#endif
