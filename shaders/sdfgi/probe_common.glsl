/* SPDX-License-Identifier: MIT
 * Samples of a probe's ring: ring.z directions, spread evenly over its octahedron. Every probe shifts them by
 * an amount of its own, fixed by its place in the world. */
#ifndef SDFGI_PROBE_COMMON_GLSL
#define SDFGI_PROBE_COMMON_GLSL

#include "pass.glsl"
#include "../lib/octahedral.glsl"
#include "../lib/random.glsl"

/* Per probe the running sums of this ring, radiance times weight in rgb, weight in a; and one more, its
 * memory: x how far sums have strayed from the mean in this ring, y in the ring before, z its age in rings.
 */
layout(std430, set = SDFGI_SET_WORK, binding = SDFGI_BINDING_SUMS) buffer sdfgi_sums_buffer
{
    vec4 sdfgi_sums[];
};

/* A probe that is new, or whose light has changed much, is young until the ring after this one has ended: in
 * each frame it reads the rays of so many, and what it has gathered counts for little. They trace no more
 * rays than others: tracing five frames' rays at once took 1.8 ms instead of 0.9 in a walk's worst frame on
 * an H200. */
const uint PROBE_YOUNG_FRAMES = 5u;
/* Ages. */
const float PROBE_BORN = -2.0; /* young while below 0 */
const float PROBE_WHOLE = 1.0; /* the ring before was a whole one */
const float PROBE_GROWN = 2.0; /* and how far its sums strayed is known */

bool probe_is_young(vec4 memory)
{
    return memory.z < 0.0;
}

uint probe_sums(uint slot)
{
    return slot * uint(SDFGI_SUMS_STRIDE);
}

uint probe_memory(uint slot)
{
    return probe_sums(slot) + uint(SDFGI_IRRADIANCE_COUNT);
}

ivec3 probe_from_linear(uint i)
{
    const uint side = sdfgi_frame.probes_per_side;
    return ivec3(i % side, i / side % side, i / (side * side));
}

/* The probe that a sdfgi_probe_index stands for. */
ivec3 probe_from_index(uint index, out uint cascade)
{
    const uint side = sdfgi_frame.probes_per_side;
    cascade = index / (side * side * side);
    const ivec3 probe =
        probe_from_linear(index % (side * side * side)) - sdfgi_frame.cascades[cascade].probe_wrap;
    return probe + int(side) * ivec3(lessThan(probe, ivec3(0)));
}

/* Direction of a sample (unit) and its solid angle up to a constant factor. One sequence over the whole map:
 * with one of 20 points in each of the 25 texels, edges of walls cost three times the error
 * (docs/decisions.md). */
vec3 probe_sample_direction(uint cascade, ivec3 probe, uint s, out float solid_angle)
{
    const ivec3 world = (probe + sdfgi_frame.cascades[cascade].probe_base) & (SDFGI_HASH_PERIOD - 1);
    const uint shift = sdfgi_random_hash3(world, sdfgi_frame.seed + cascade);
    const vec3 point = sdfgi_octahedral_point(sdfgi_random_r2(s, shift) * 2.0 - 1.0);
    solid_angle = sdfgi_octahedral_solid_angle(point);
    return normalize(point);
}

/* Weight that a texel sums up over a ring, less a tenth, so that a whole ring always reaches it: the mean of
 * a direction's solid angle times its cosine is pi / 4. */
float probe_ring_weight()
{
    return 0.9 * 0.25 * 3.14159265 * float(sdfgi_frame.cycle_samples);
}

/* Directions of the stored texels: they span the map from edge to edge, so that all six axes are among them
 * and walls, floors and ceilings are read without interpolation. */
vec3 probe_texel_direction(uint texel)
{
    const uint n = uint(SDFGI_IRRADIANCE_TEXELS);
    return sdfgi_octahedral_decode(vec2(texel % n, texel / n) * (2.0 / float(n - 1u)) - 1.0);
}

#endif
