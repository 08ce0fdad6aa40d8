/* SPDX-License-Identifier: MIT */
#include "test_memory.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

void *test_array_alloc(size_t count, size_t size)
{
    void *memory = calloc(count ? count : 1, size);
    if (!memory) {
        fprintf(stderr, "tests: out of memory (%zu elements of %zu bytes)\n", count, size);
        exit(EXIT_FAILURE);
    }
    return memory;
}

void *test_array_resize(void *memory, size_t count, size_t size)
{
    void *grown = realloc(memory, (count ? count : 1) * size);
    if (!grown) {
        fprintf(stderr, "tests: out of memory (%zu elements of %zu bytes)\n", count, size);
        exit(EXIT_FAILURE);
    }
    return grown;
}

uint32_t test_random_uint(struct test_random *random)
{
    const uint32_t state = random->state;
    random->state = state * 747796405u + 2891336453u;
    const uint32_t word = ((state >> ((state >> 28) + 4)) ^ state) * 277803737u;
    return (word >> 22) ^ word;
}

double test_random_real(struct test_random *random, double low, double high)
{
    return low + (high - low) * (test_random_uint(random) * 0x1p-32);
}

void test_random_direction(struct test_random *random, double direction[static 3])
{
    const double z = test_random_real(random, -1, 1);
    const double angle = test_random_real(random, 0, 2 * 3.14159265358979323846);
    const double r = sqrt(fmax(0, 1 - z * z));
    direction[0] = r * cos(angle);
    direction[1] = r * sin(angle);
    direction[2] = z;
}
