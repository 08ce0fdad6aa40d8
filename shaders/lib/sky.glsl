/* SPDX-License-Identifier: MIT
 * The gradient sky: lerp(horizon, d.y >= 0 ? zenith : ground, |d.y|). */
#ifndef SDFGI_SKY_GLSL
#define SDFGI_SKY_GLSL

vec3 sdfgi_sky_radiance(vec3 dir, vec3 zenith, vec3 horizon, vec3 ground)
{
    return mix(horizon, dir.y >= 0.0 ? zenith : ground, abs(dir.y));
}

/* Mean radiance over all directions. */
vec3 sdfgi_sky_mean(vec3 zenith, vec3 horizon, vec3 ground)
{
    return 0.5 * horizon + 0.25 * (zenith + ground);
}

/* Mean of max(0, d.y) over the directions d of a hemisphere, weighted by the cosine to its normal, where y is
 * the normal's y. A parabola through the exact values at y = 1 (2/3), 0 (2 / (3 pi)) and -1 (0); quadrature
 * differs by at most 0.006. */
float sdfgi_sky_ramp(float y)
{
    return 0.212207 + y * (0.333333 + y * 0.121126);
}

/* Irradiance over pi of an unoccluded surface. */
vec3 sdfgi_sky_irradiance(vec3 normal, vec3 zenith, vec3 horizon, vec3 ground)
{
    return horizon + (zenith - horizon) * sdfgi_sky_ramp(normal.y) +
           (ground - horizon) * sdfgi_sky_ramp(-normal.y);
}

#endif
