/* SPDX-License-Identifier: MIT */
#include "ztest.h"

#include <math.h>

/* Of float pictures that two programs summed up from a thousand samples: a constant sky differs by 1.4e-5. */
static const double rounding = 1e-4;

double ztest_limit(double alpha, size_t tests)
{
    /* Both tails of one test; expm1 and log1p keep the digits of what is close to nothing. */
    const double tails = -expm1(log1p(-alpha) / (double)tests);
    double low = 0, high = 40;
    for (int i = 0; i < 100; i++) {
        const double middle = 0.5 * (low + high);
        *(erfc(middle / sqrt(2)) > tails ? &low : &high) = middle;
    }
    return low;
}

static bool is_accepted(const struct ztest_input *in, size_t i, double limit)
{
    const double off = fabs((double)in->picture[i] - (double)in->expected[i]);
    const double variance =
        (double)in->variance[i] + (in->expected_variance ? (double)in->expected_variance[i] : 0);
    return off <= limit * sqrt(variance) + rounding * fabs((double)in->expected[i]);
}

double ztest_accepted(const struct ztest_input *in, double alpha)
{
    size_t tested = 0, accepted = 0;
    for (size_t p = 0; p < in->pixels; p++)
        tested += !(in->skipped && in->skipped[p]);
    const double limit = ztest_limit(alpha, 3 * tested);
    for (size_t p = 0; p < in->pixels; p++) {
        if (in->skipped && in->skipped[p])
            continue;
        accepted += is_accepted(in, 3 * p, limit) && is_accepted(in, 3 * p + 1, limit) &&
                    is_accepted(in, 3 * p + 2, limit);
    }
    return (double)accepted / (double)tested;
}
