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

#endif
