/* SPDX-License-Identifier: MIT
 *
 * Random numbers that depend on nothing but (seed, pixel, sample, draw): no state outlives a sample, so the
 * order in which threads take pixels cannot show in a picture.
 */
#ifndef RAYCAST_RANDOM_H
#define RAYCAST_RANDOM_H

#include <stdint.h>

struct random {
    uint64_t state;
};

/* Finaliser of SplitMix64 (Steele, Lea, Flood 2014): every output bit depends on every input bit. */
static inline uint64_t random_mix(uint64_t x)
{
    x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
    x = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
    return x ^ (x >> 31);
}

#define RANDOM_STEP                                                                                          \
    0x9e3779b97f4a7c15u /* 2^64 over the golden ratio, odd: the sequence visits every state                  \
                         */

static inline struct random random_begin(uint64_t seed, uint64_t pixel, uint64_t sample)
{
    const uint64_t a = random_mix(seed + RANDOM_STEP);
    const uint64_t b = random_mix((a ^ pixel) + RANDOM_STEP);
    return (struct random){ random_mix((b ^ sample) + RANDOM_STEP) };
}

static inline uint32_t random_bits(struct random *r)
{
    r->state += RANDOM_STEP;
    return (uint32_t)(random_mix(r->state) >> 32);
}

/* Uniform in [0, 1): 24 bits, so the largest value is below one in single precision. */
static inline float random_float(struct random *r)
{
    return (float)(random_bits(r) >> 8) * 0x1p-24f;
}

/* Uniform in [0, 1) from keys, for decisions that must not depend on the order of asking. */
static inline float random_from_keys(uint32_t a, uint32_t b, uint32_t c)
{
    const uint64_t h = random_mix(((uint64_t)a << 32 | b) + RANDOM_STEP * (c + 1ull));
    return (float)(h >> 40) * 0x1p-24f;
}

#endif
