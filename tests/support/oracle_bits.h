/* SPDX-License-Identifier: MIT
 * A cube of size^3 bits, the sub-voxel grid of one cascade (size = 4 cells: 512 for 128 cells), and walks
 * through its empty part. */
#ifndef TEST_ORACLE_BITS_H
#define TEST_ORACLE_BITS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

struct oracle_bits {
    uint32_t size;      /* bits along a side */
    uint32_t row_words; /* 64-bit words per row along x; bits past `size` are 0 */
    uint64_t *words;    /* row (y, z) starts at word (y + size * z) * row_words */
};

/* Where a grid lies: sub-voxel (i, j, k) is the box from origin + (i, j, k) * step to one step further. */
struct oracle_grid {
    double origin[3];
    double step[3]; /* metres per sub-voxel; y may differ (sdfgi_y_scale) */
};

struct oracle_bits oracle_bits_create(uint32_t size);
/* `draws` bits set at random places, some of them more than once. */
struct oracle_bits oracle_bits_random(uint32_t seed, uint32_t size, uint32_t draws);
void oracle_bits_destroy(struct oracle_bits *bits);
void oracle_bits_clear(struct oracle_bits *bits);
uint64_t oracle_bits_count(const struct oracle_bits *bits);

static inline uint64_t *oracle_bits_row(const struct oracle_bits *bits, uint32_t y, uint32_t z)
{
    return bits->words + ((size_t)y + (size_t)bits->size * z) * bits->row_words;
}

static inline bool oracle_bits_get(const struct oracle_bits *bits, uint32_t x, uint32_t y, uint32_t z)
{
    return oracle_bits_row(bits, y, z)[x >> 6] >> (x & 63) & 1;
}

static inline void oracle_bits_set(struct oracle_bits *bits, uint32_t x, uint32_t y, uint32_t z)
{
    oracle_bits_row(bits, y, z)[x >> 6] |= UINT64_C(1) << (x & 63);
}

/* Number of bits that `subset` has and `superset` lacks; the first of them goes to `first` (may be NULL). */
uint64_t oracle_bits_missing(const struct oracle_bits *superset, const struct oracle_bits *subset,
                             uint32_t first[3]);

/* Half the size: a bit is set if any of its 2^3 is. The size must be even. */
struct oracle_bits oracle_bits_downsample(const struct oracle_bits *bits);

/* Every empty sub-voxel that a 6-connected walk from `seed` reaches. Nothing, if the seed is set. */
struct oracle_bits oracle_bits_walk(const struct oracle_bits *solid, const uint32_t seed[static 3]);

/* True if a 6-connected walk from `seed` through empty sub-voxels touches the border of the grid: false for
 * every seed inside a closed surface. `reached` (may be NULL) gets the number of sub-voxels visited. */
bool oracle_bits_walk_escapes(const struct oracle_bits *solid, const uint32_t seed[static 3],
                              uint64_t *reached);

#endif
