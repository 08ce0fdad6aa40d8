/* SPDX-License-Identifier: MIT */
#include "drift.h"

#include <float.h>
#include <math.h>

void sdfgi_light_power(const struct sdfgi_light_desc *light, float out[static 3])
{
    for (int i = 0; i < 3; i++)
        out[i] = fminf(light->indirect_energy * light->intensity[i], FLT_MAX);
}

float sdfgi_relative_difference(const float *before, const float *after, int count)
{
    float difference = 0, largest = 0;
    for (int i = 0; i < count; i++) {
        difference = fmaxf(difference, fabsf(after[i] - before[i]));
        largest = fmaxf(largest, fmaxf(fabsf(after[i]), fabsf(before[i])));
    }
    return largest > 0 ? difference / largest : 0;
}

/* Radians between two vectors of any length. */
static float angle_between(const float a[static 3], const float b[static 3])
{
    double across = 0, along = 0;
    for (int i = 0; i < 3; i++) {
        const int j = (i + 1) % 3, k = (i + 2) % 3;
        const double normal = (double)a[j] * (double)b[k] - (double)a[k] * (double)b[j];
        across += normal * normal;
        along += (double)a[i] * (double)b[i];
    }
    return (float)atan2(sqrt(across), along);
}

float sdfgi_drift_of_sun(const struct sdfgi_light_desc *before, const struct sdfgi_light_desc *after)
{
    if (before->type != SDFGI_LIGHT_DIRECTIONAL || after->type != SDFGI_LIGHT_DIRECTIONAL ||
        before->casts_shadow != after->casts_shadow)
        return 1;
    float from[3], to[3];
    sdfgi_light_power(before, from);
    sdfgi_light_power(after, to);
    return sdfgi_relative_difference(from, to, 3) + angle_between(before->direction, after->direction);
}

float sdfgi_drift_of_sky(const struct sdfgi_sky *before, const struct sdfgi_sky *after)
{
    float from[9], to[9];
    for (int i = 0; i < 3; i++) {
        from[i] = before->zenith[i];
        from[3 + i] = before->horizon[i];
        from[6 + i] = before->ground[i];
        to[i] = after->zenith[i];
        to[3 + i] = after->horizon[i];
        to[6 + i] = after->ground[i];
    }
    return sdfgi_relative_difference(from, to, 9);
}

float sdfgi_drift_of_harmonics(const struct sdfgi_sky_harmonics *before,
                               const struct sdfgi_sky_harmonics *after)
{
    float from[27], to[27];
    const float before_scale = before->intensity > 0 ? before->intensity : 1,
                after_scale = after->intensity > 0 ? after->intensity : 1;
    for (int i = 0; i < 27; i++) {
        from[i] = before_scale * before->coefficients[i / 3][i % 3];
        to[i] = after_scale * after->coefficients[i / 3][i % 3];
    }
    return sdfgi_relative_difference(from, to, 27) + fabsf(after->rotation_rad - before->rotation_rad);
}
