/* SPDX-License-Identifier: MIT
 * Probes as all passes see them: the directions of their sample cycle, the running sums of their texels, and
 * their history. */
#ifndef SDFGI_PROBE_COMMON_GLSL
#define SDFGI_PROBE_COMMON_GLSL

#include "pass.glsl"
#include "../lib/octahedral.glsl"
#include "../lib/random.glsl"

/* Per probe SDFGI_SUMS_STRIDE vec4. First one per texel, the running sum of this sample cycle: radiance times
 * weight in rgb, weight in a. Then the packed probe_history. */
layout(std430, set = SDFGI_SET_WORK, binding = SDFGI_BINDING_SUMS) buffer sdfgi_sums_buffer
{
    vec4 sdfgi_sums[];
};

/* True if all four are finite and within the bounds. Comparisons of NaN are not relied on. */
bool probe_within(vec4 v, vec4 low, vec4 high)
{
    const uvec4 exponents = floatBitsToUint(v) & 0x7f800000u;
    return !any(equal(exponents, uvec4(0x7f800000u))) && all(greaterThanEqual(v, low)) &&
           all(lessThanEqual(v, high));
}

uint probe_sums(uint slot)
{
    return slot * uint(SDFGI_SUMS_STRIDE);
}

ivec3 probe_from_linear(uint i)
{
    const uint side = sdfgi_frame.probes_per_side;
    return ivec3(i % side, i / side % side, i / (side * side));
}

/* Inverse of sdfgi_probe_index. */
ivec3 probe_from_index(uint index, out uint cascade)
{
    const uint side = sdfgi_frame.probes_per_side;
    cascade = index / (side * side * side);
    const ivec3 probe =
        probe_from_linear(index % (side * side * side)) - sdfgi_frame.cascades[cascade].probe_wrap;
    return probe + int(side) * ivec3(lessThan(probe, ivec3(0)));
}

/* ---- History */

/* A deviation says how far the light of a partial cycle differs from the mean of the cycle before. It is
 * relative, and the largest of all texels. */
struct probe_history {
    float largest_change; /* of any texel in this cycle so far, relative */
    float deviation;      /* of the cycle before */
    float cycles;         /* history length: ends of cycles since the history reset, 4 at most */
    float mark;           /* luminance of all texels when it was last marked */
};

/* States of a history. NEW: the probe is new or its light has changed by half, so its history counts for
 * little. STEADY: the deviation of a complete cycle is known. WARMING_UP: neither. */
const uint PROBE_NEW = 0u;
const uint PROBE_WARMING_UP = 1u;
const uint PROBE_STEADY = 2u;

/* Lengths of a history. A probe is NEW for the rest of the cycle of the history reset and for the next one.
 * The cycle after that is the first one that the probe sums up as a whole. The cycle after the first complete
 * cycle is the first one that has a mean to deviate from. */
const float PROBE_NEW_CYCLES = 2.0;
const float PROBE_COMPLETE_CYCLES = 3.0; /* the cycle before was a complete one */
const float PROBE_STEADY_CYCLES = 4.0;

/* A NEW probe reads the rays of this many frames in each frame. It traces no more rays than other probes:
 * tracing five frames' rays at once took 1.8 ms instead of 0.9 in a walk's worst frame on an H200. */
const uint PROBE_NEW_FRAMES = 5u;

/* The length is stored less PROBE_NEW_CYCLES, so that NEW probes are those below 0. */
vec4 probe_history_pack(probe_history h)
{
    return vec4(h.largest_change, h.deviation, h.cycles - PROBE_NEW_CYCLES, h.mark);
}

probe_history probe_history_unpack(vec4 packed)
{
    return probe_history(packed.x, packed.y, packed.z + PROBE_NEW_CYCLES, packed.w);
}

/* Memory that holds no history of a probe makes the probe NEW. */
probe_history probe_history_load(uint slot)
{
    const vec4 packed = sdfgi_sums_at(probe_sums(slot) + uint(SDFGI_IRRADIANCE_COUNT));
    const vec4 least = vec4(0.0, 0.0, -PROBE_NEW_CYCLES, 0.0),
               most = vec4(1.0, 1.0, PROBE_STEADY_CYCLES - PROBE_NEW_CYCLES, 1e30);
    return probe_within(packed, least, most) ? probe_history_unpack(packed)
                                             : probe_history(0.0, 0.0, 0.0, 0.0);
}

void probe_history_store(uint slot, probe_history h)
{
    sdfgi_sums[probe_sums(slot) + uint(SDFGI_IRRADIANCE_COUNT)] = probe_history_pack(h);
}

uint probe_history_state(probe_history h)
{
    if (h.cycles < PROBE_NEW_CYCLES)
        return PROBE_NEW;
    return h.cycles < PROBE_STEADY_CYCLES ? PROBE_WARMING_UP : PROBE_STEADY;
}

/* ---- Directions */

/* By how much a probe shifts random sequences: it depends on the probe's place in the world alone. */
uint probe_shift(uint cascade, ivec3 probe)
{
    const ivec3 world = (probe + sdfgi_frame.cascades[cascade].probe_base) & (SDFGI_HASH_PERIOD - 1);
    return sdfgi_random_hash3(world, sdfgi_frame.seed + cascade);
}

/* Direction of a sample (unit), and its solid angle up to a constant factor. One sequence, which each probe
 * shifts, spreads the samples of a cycle over the whole octahedron. With one of 20 points in each of the 25
 * texels instead, edges of walls cost three times the error (docs/decisions.md). */
vec3 probe_sample_direction(uint cascade, ivec3 probe, uint s, out float solid_angle)
{
    const vec3 point = sdfgi_octahedral_point(sdfgi_random_r2(s, probe_shift(cascade, probe)) * 2.0 - 1.0);
    solid_angle = sdfgi_octahedral_solid_angle(point);
    return normalize(point);
}

/* Weight that a texel sums up over a cycle, less a tenth, so that a complete cycle always reaches it. The
 * mean of a direction's solid angle times its cosine is pi / 4. */
float probe_cycle_weight()
{
    return 0.9 * 0.25 * 3.14159265 * float(sdfgi_frame.cycle_samples);
}

/* The sum of a texel; 0 if it is none that rays can have made. NEW probes count PROBE_NEW_FRAMES times. Light
 * has no upper bound: its mean is cut when it is stored. */
vec4 probe_load_sum(uint slot, uint texel)
{
    const vec4 sum = sdfgi_sums_at(probe_sums(slot) + texel);
    const float most_weight = 2.0 * float(PROBE_NEW_FRAMES) * probe_cycle_weight();
    return probe_within(sum, vec4(0.0), vec4(vec3(3e38), most_weight)) ? sum : vec4(0.0);
}

/* Directions of the stored texels. They span the octahedral map from edge to edge, so that all six axes are
 * among them and walls, floors and ceilings are read without interpolation. */
vec3 probe_texel_direction(uint texel)
{
    const uint n = uint(SDFGI_IRRADIANCE_TEXELS);
    return sdfgi_octahedral_decode(vec2(texel % n, texel / n) * (2.0 / float(n - 1u)) - 1.0);
}

#endif
