/* SPDX-License-Identifier: MIT
 * Smooth noise on an integer lattice. */
#ifndef SAMPLES_NOISE_H
#define SAMPLES_NOISE_H

#include <stdint.h>

/* Value noise in [-1, 1]; `period` lattice cells repeat, 0: never. */
float noise_value(uint32_t seed, float x, float y, uint32_t period);

/* Octaves of value noise, each at twice the frequency and half the height, in about [-1, 1]. */
float noise_fractal(uint32_t seed, float x, float y, uint32_t period, uint32_t octaves);

static inline float mix(float a, float b, float t)
{
    return a + (b - a) * t;
}

static inline float clamp01(float x)
{
    return x < 0 ? 0 : x > 1 ? 1 : x;
}

static inline float smooth_step(float low, float high, float x)
{
    const float t = clamp01((x - low) / (high - low));
    return t * t * (3 - 2 * t);
}

#endif
