/* SPDX-License-Identifier: MIT
 * What a probe keeps: its last complete ring, and its square of the atlas. */
#ifndef SDFGI_PROBE_STORE_GLSL
#define SDFGI_PROBE_STORE_GLSL

#include "probe_common.glsl"

/* Mean radiance and weight of the last complete ring, four half floats. */
layout(std430, set = 0, binding = SDFGI_BINDING_PREVIOUS) buffer sdfgi_previous_buffer { uvec2 sdfgi_previous[]; };
layout(set = 0, binding = SDFGI_BINDING_IRRADIANCE_STORE, rgba16f) uniform writeonly image2DArray irradiance_store;

shared vec3 texels[SDFGI_IRRADIANCE_COUNT];

void probe_store_previous(uint at, vec3 value, float weight)
{
    sdfgi_previous[at] = uvec2(packHalf2x16(value.rg), packHalf2x16(vec2(value.b, weight)));
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
               vec4(texels[source.x + SDFGI_IRRADIANCE_TEXELS * source.y], 0.0));
}

#endif
