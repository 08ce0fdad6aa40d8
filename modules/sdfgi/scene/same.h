/* SPDX-License-Identifier: MIT
 * Whether two descriptions say the same, field by field: bytes between fields do not count, and +0 is -0.
 * Engines push their whole state in each frame; what is as before costs nothing and wakes nothing. */
#ifndef SDFGI_SAME_H
#define SDFGI_SAME_H

#include <sdfgi/sky.h>

bool sdfgi_same_material(const struct sdfgi_material_desc *a, const struct sdfgi_material_desc *b);
bool sdfgi_same_transform(const struct sdfgi_transform *a, const struct sdfgi_transform *b);
/* The same surfaces, as far as it is bright enough. */
bool sdfgi_same_reach(const struct sdfgi_light_desc *a, const struct sdfgi_light_desc *b);
bool sdfgi_same_light(const struct sdfgi_light_desc *a, const struct sdfgi_light_desc *b);
bool sdfgi_same_sky(const struct sdfgi_sky *a, const struct sdfgi_sky *b);
bool sdfgi_same_harmonics(const struct sdfgi_sky_harmonics *a, const struct sdfgi_sky_harmonics *b);

#endif
