/* SPDX-License-Identifier: MIT
 * The gradient sky: lerp(horizon, h >= 0 ? zenith : ground, |h|) at the height h of a direction, the cosine
 * of its angle to up. */
#ifndef SDFGI_SKY_GLSL
#define SDFGI_SKY_GLSL

vec3 sdfgi_sky_radiance(float height, vec3 zenith, vec3 horizon, vec3 ground)
{
    return mix(horizon, height >= 0.0 ? zenith : ground, abs(height));
}

/* Mean radiance over all directions. */
vec3 sdfgi_sky_mean(vec3 zenith, vec3 horizon, vec3 ground)
{
    return 0.5 * horizon + 0.25 * (zenith + ground);
}

/* Mean of max(0, h) over the directions of a hemisphere, weighted by the cosine to its normal, where y is the
 * height of the normal. A parabola through the exact values at y = 1 (2/3), 0 (2 / (3 pi)) and -1 (0);
 * quadrature differs by at most 0.006. */
float sdfgi_sky_ramp(float y)
{
    return 0.212207 + y * (0.333333 + y * 0.121126);
}

/* Irradiance over pi of an unoccluded surface, by the height of its normal. */
vec3 sdfgi_sky_irradiance(float height, vec3 zenith, vec3 horizon, vec3 ground)
{
    return horizon + (zenith - horizon) * sdfgi_sky_ramp(height) +
           (ground - horizon) * sdfgi_sky_ramp(-height);
}

#endif
