/* SPDX-License-Identifier: MIT
 * Spherical harmonics of a sky: turned, bounded, and as shaders add them up. */
#ifndef SDFGI_HARMONICS_H
#define SDFGI_HARMONICS_H

#include <sdfgi/sky.h>

#include <stdbool.h>

bool sdfgi_harmonics_any(const struct sdfgi_sky_harmonics *h);
/* Factors of 1, y, z, x, xy, yz, 3z^2 - 1, xz, x^2 - y^2 in radiance, with intensity and rotation. */
void sdfgi_harmonics_factors(const struct sdfgi_sky_harmonics *h, enum sdfgi_up_axis up_axis,
                             float factors[static 9][3]);
/* No direction is brighter in any channel; little more than the brightest is. */
float sdfgi_harmonics_brightest(const struct sdfgi_sky_harmonics *h);

#endif
