/* SPDX-License-Identifier: MIT */
#include "picture_flip.h"

#include "require.h"

#include <image/flip.h>
#include <stdlib.h>

double picture_flip(const float *a, const float *b, uint32_t width, uint32_t height, float exposure)
{
    const size_t count = (size_t)width * height;
    float *const shown = calloc(count, 8 * sizeof *shown), *const errors = calloc(count, sizeof *errors);
    REQUIRE_TRUE(shown && errors);
    for (size_t i = 0; i < count; i++) {
        tone_map(a + 4 * i, exposure, shown + 4 * i);
        tone_map(b + 4 * i, exposure, shown + 4 * (count + i));
    }
    REQUIRE_TRUE(flip_ldr(shown, shown + 4 * count, width, height, errors));
    double sum = 0;
    for (size_t i = 0; i < count; i++)
        sum += (double)errors[i];
    free(shown);
    free(errors);
    return sum / (double)count;
}
