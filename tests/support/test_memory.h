/* SPDX-License-Identifier: MIT
 * Memory and random numbers for tests: running out of memory ends the program, so callers need not check. */
#ifndef TEST_MEMORY_H
#define TEST_MEMORY_H

#include <stddef.h>
#include <stdint.h>

/* Zeroed memory for `count` elements, for free(). */
void *test_array_alloc(size_t count, size_t size);
void *test_array_resize(void *memory, size_t count, size_t size);

/* Seeded sequence (PCG-RXS-M-XS 32, O'Neill 2014), the same on every machine. */
struct test_random {
    uint32_t state;
};

uint32_t test_random_uint(struct test_random *random);
double test_random_real(struct test_random *random, double low, double high);       /* [low, high) */
void test_random_direction(struct test_random *random, double direction[static 3]); /* uniform, unit length */

#endif
