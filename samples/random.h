/* SPDX-License-Identifier: MIT
 * Integer hash random numbers: the same on every machine, which rand() is not. */
#ifndef SAMPLES_RANDOM_H
#define SAMPLES_RANDOM_H

#include <stdint.h>

/* The PCG output permutation used as a hash: Jarzynski and Olano, "Hash Functions for GPU Rendering", 2020.
 */
static inline uint32_t random_hash(uint32_t v)
{
    const uint32_t state = v * 747796405u + 2891336453u;
    const uint32_t word = ((state >> ((state >> 28) + 4)) ^ state) * 277803737u;
    return (word >> 22) ^ word;
}

static inline uint32_t random_hash3(uint32_t seed, uint32_t a, uint32_t b)
{
    return random_hash(a + random_hash(b + random_hash(seed)));
}

/* [0, 1) */
static inline float random_unit(uint32_t hash)
{
    return (float)(hash >> 8) / 16777216.0f;
}

struct random {
    uint32_t state;
};

static inline float random_next(struct random *random)
{
    random->state = random_hash(random->state + 0x9E3779B9u);
    return random_unit(random->state);
}

static inline float random_range(struct random *random, float low, float high)
{
    return low + (high - low) * random_next(random);
}

#endif
