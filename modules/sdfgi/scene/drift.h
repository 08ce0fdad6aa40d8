/* SPDX-License-Identifier: MIT
 * By which part of their light suns and skies change: 0 not at all, 1 or more wholly. As a day goes by both
 * change in each frame, but little; what is known of their light then stays of use. */
#ifndef SDFGI_DRIFT_H
#define SDFGI_DRIFT_H

#include <sdfgi/sky.h>

/* If light changes by more than this part in the time of an epoch, what is known of it is outdated. */
#define DRIFT_OUTDATES 0.1f

/* What a light contributes, per channel: finite. */
void sdfgi_light_power(const struct sdfgi_light_desc *light, float out[static 3]);
/* The largest difference of so many numbers, over the largest of all. */
float sdfgi_relative_difference(const float *before, const float *after, int count);

/* Of directional lights: the angle in radians between them counts as such a part as well. 1 if either is of
 * another type. */
float sdfgi_drift_of_sun(const struct sdfgi_light_desc *before, const struct sdfgi_light_desc *after);
float sdfgi_drift_of_sky(const struct sdfgi_sky *before, const struct sdfgi_sky *after);
float sdfgi_drift_of_harmonics(const struct sdfgi_sky_harmonics *before,
                               const struct sdfgi_sky_harmonics *after);

#endif
