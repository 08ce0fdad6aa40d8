/* SPDX-License-Identifier: MIT
 * Integer hashes and a low-discrepancy sequence, as pure functions. */
#ifndef SDFGI_RANDOM_GLSL
#define SDFGI_RANDOM_GLSL

/* PCG output permutation (Jarzynski and Olano 2020, "Hash Functions for GPU Rendering"). */
uint sdfgi_random_hash(uint v)
{
    const uint state = v * 747796405u + 2891336453u;
    const uint word = ((state >> ((state >> 28u) + 4u)) ^ state) * 277803737u;
    return (word >> 22u) ^ word;
}

/* A hash as a number in [0, 1). */
float sdfgi_random_unit(uint hash)
{
    return float(hash >> 8u) * (1.0 / 16777216.0);
}

uint sdfgi_random_hash3(ivec3 v, uint seed)
{
    return sdfgi_random_hash(
        uint(v.x) + sdfgi_random_hash(uint(v.y) + sdfgi_random_hash(uint(v.z) + sdfgi_random_hash(seed))));
}

/* Point `index` of the R2 sequence (Roberts 2018), shifted by a hash, in [0, 1)^2. It is computed in fixed
 * point, because floats lose precision as the index grows. */
vec2 sdfgi_random_r2(uint index, uint shift)
{
    const uvec2 p = uvec2(3242174889u, 2447445414u) * index + uvec2(shift, sdfgi_random_hash(shift));
    return vec2(p >> 8u) * (1.0 / 16777216.0);
}

/* Point `index` of the R3 sequence likewise, in [0, 1)^3. */
vec3 sdfgi_random_r3(uint index, uint shift)
{
    const uint second = sdfgi_random_hash(shift);
    const uvec3 p = uvec3(3518319155u, 2882110345u, 2360945575u) * index +
                    uvec3(shift, second, sdfgi_random_hash(second));
    return vec3(p >> 8u) * (1.0 / 16777216.0);
}

#endif
