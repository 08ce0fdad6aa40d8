/* SPDX-License-Identifier: MIT
 * Samples of a probe's ring: ring.z directions, spread evenly over the 25 texels of its octahedron and jittered inside
 * them. Every probe has its own jitter, fixed by its place in the world. */
#ifndef SDFGI_PROBE_COMMON_GLSL
#define SDFGI_PROBE_COMMON_GLSL

#include "pass.glsl"
#include "../lib/octahedral.glsl"
#include "../lib/random.glsl"

/* Running sums of this ring: radiance times weight in rgb, weight in a. */
layout(std430, set = 0, binding = SDFGI_BINDING_SUMS) buffer sdfgi_sums_buffer { vec4 sdfgi_sums[]; };

ivec3 probe_from_linear(uint i)
{
    const uint side = sdfgi_frame.size.z;
    return ivec3(i % side, i / side % side, i / (side * side));
}

/* Direction of a sample (unit) and its solid angle up to a constant factor. */
vec3 probe_sample_direction(uint cascade, ivec3 probe, uint s, out float solid_angle)
{
    const uint n = uint(SDFGI_IRRADIANCE_COUNT);
    const uint texel = s % n;
    const ivec3 world = probe + sdfgi_frame.cascades[cascade].probe_base.xyz;
    const uint shift = random_hash3(world, sdfgi_frame.light.w + texel + n * cascade);
    const vec2 jitter = random_r2(s / n, shift);
    const vec2 at = vec2(texel % uint(SDFGI_IRRADIANCE_TEXELS), texel / uint(SDFGI_IRRADIANCE_TEXELS)) + jitter;
    const vec3 point = octahedral_point(at * (2.0 / float(SDFGI_IRRADIANCE_TEXELS)) - 1.0);
    solid_angle = octahedral_solid_angle(point);
    return normalize(point);
}

/* Directions of the stored texels: they span the map from edge to edge, so that all six axes are among them and walls,
 * floors and ceilings are read without interpolation. */
vec3 probe_texel_direction(uint texel)
{
    const uint n = uint(SDFGI_IRRADIANCE_TEXELS);
    return octahedral_decode(vec2(texel % n, texel / n) * (2.0 / float(n - 1u)) - 1.0);
}

#endif
