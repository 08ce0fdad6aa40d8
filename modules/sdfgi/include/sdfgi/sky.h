/* SPDX-License-Identifier: MIT
 * Skies of more than three colours: second-order spherical harmonics, which a cube map is projected to. They
 * have the diffuse light of a sky to within a few per cent, whatever the sky. A sun is a light of its own,
 * and mirrors show such a sky blurred. Conventions as in sdfgi.h. */
#ifndef SDFGI_SKY_H
#define SDFGI_SKY_H

#include <sdfgi/sdfgi.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Radiance in direction (x, y, z) of the sky, a unit vector with +Y up, is the sum of coefficient times
 * function, and 0 where that is negative:
 *
 *   0  0.282095        1  0.488603 y    4  1.092548 x y              7  1.092548 x z
 *                      2  0.488603 z    5  1.092548 y z              8  0.546274 (x^2 - y^2)
 *                      3  0.488603 x    6  0.315392 (3 z^2 - 1)
 *
 * The sky is turned around X until its +Y is sdfgi_desc::up_axis. The world's (x, y, z) is therefore the
 * sky's (x, y, z) where +Y is up, (x, z, -y) for +Z, (x, -y, -z) for -Y, and (x, -z, y) for -Z. */
struct sdfgi_sky_harmonics {
    float coefficients[9][3]; /* W/(m^2 sr), finite, of any sign */
    float intensity;          /* factor on them, >= 0; 0 means 1 */
    float rotation_rad;       /* turns the sky around its +Y, from its +Z to +X */
};

/* Adds harmonics to the sky of sdfgi_set_sky, which stays. All coefficients zero, the initial state, are
 * none. */
SDFGI_API enum sdfgi_result sdfgi_set_sky_harmonics(sdfgi *gi, const struct sdfgi_sky_harmonics *harmonics);

/* Projects a cube map: `texels` are 6 * side * side colours of linear radiance, 3 floats each, faces in the
 * order +X -X +Y -Y +Z -Z, rows and columns as in a Vulkan cube image. Sets the coefficients, an intensity of
 * 1, no rotation. Needs no context. The result is finite wherever the texels are. */
SDFGI_API void sdfgi_sky_harmonics_from_cube(const float *texels, uint32_t side,
                                             struct sdfgi_sky_harmonics *harmonics);

#ifdef __cplusplus
}
#endif
#endif
