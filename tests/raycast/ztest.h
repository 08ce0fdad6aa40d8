/* SPDX-License-Identifier: MIT
 * Which pixels of a noisy picture agree with what they should be, given the variance of each. */
#ifndef TESTS_RAYCAST_ZTEST_H
#define TESTS_RAYCAST_ZTEST_H

#include <stdbool.h>
#include <stddef.h>

/* How many standard deviations a normal number may be off when `tests` of them shall all be within, at the
 * family-wise significance `alpha` (Sidak 1967, "Rectangular confidence regions for the means of multivariate
 * normal distributions"). */
double ztest_limit(double alpha, size_t tests);

/* Pictures of `pixels` times 3 channels. */
struct ztest_input {
    const float *picture, *variance; /* variance of the picture's values */
    const float *expected;
    const float *expected_variance; /* NULL: exact */
    const bool *skipped;            /* per pixel; NULL: none */
    size_t pixels;
};

/* Share of the pixels of which every channel is within the limit for all channels of all pixels at once.
 * Where there is no variance, values may differ by their rounding alone. */
double ztest_accepted(const struct ztest_input *input, double alpha);

#endif
