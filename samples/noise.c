/* SPDX-License-Identifier: MIT */
#include "noise.h"

#include <math.h>

#include "random.h"

static float lattice(uint32_t seed, int32_t x, int32_t y, uint32_t period)
{
    const int32_t wrap = (int32_t)period;
    const uint32_t a = (uint32_t)(wrap ? ((x % wrap) + wrap) % wrap : x);
    const uint32_t b = (uint32_t)(wrap ? ((y % wrap) + wrap) % wrap : y);
    return 2 * random_unit(random_hash3(seed, a, b)) - 1;
}

float noise_value(uint32_t seed, float x, float y, uint32_t period)
{
    const float fx = floorf(x), fy = floorf(y);
    const int32_t ix = (int32_t)fx, iy = (int32_t)fy;
    const float tx = smooth_step(0, 1, x - fx), ty = smooth_step(0, 1, y - fy);
    const float low = mix(lattice(seed, ix, iy, period), lattice(seed, ix + 1, iy, period), tx);
    const float high = mix(lattice(seed, ix, iy + 1, period), lattice(seed, ix + 1, iy + 1, period), tx);
    return mix(low, high, ty);
}

float noise_fractal(uint32_t seed, float x, float y, uint32_t period, uint32_t octaves)
{
    float sum = 0, height = 0.5f;
    for (uint32_t i = 0; i < octaves; i++, height *= 0.5f) {
        const float scale = (float)(1u << i);
        sum += height * noise_value(seed + i, x * scale, y * scale, period << i);
    }
    return sum;
}
