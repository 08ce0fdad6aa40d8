/* SPDX-License-Identifier: MIT */
#include "oracle_gloss.h"

#include <math.h>

double oracle_fresnel(double f0, double cosine)
{
    return f0 + (1 - f0) * pow(1 - cosine, 5);
}

static double slope(double cosine, double alpha)
{
    return sqrt(1 + alpha * alpha * (1 / (cosine * cosine) - 1));
}

double oracle_smith(double viewer, double light, double alpha)
{
    return 2 / (slope(viewer, alpha) + slope(light, alpha));
}
