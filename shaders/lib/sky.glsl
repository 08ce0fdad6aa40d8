/* SPDX-License-Identifier: MIT
 * The gradient sky: lerp(horizon, d.y >= 0 ? zenith : ground, |d.y|). */
#ifndef SDFGI_SKY_GLSL
#define SDFGI_SKY_GLSL

vec3 sdfgi_sky_radiance(vec3 dir, vec3 zenith, vec3 horizon, vec3 ground)
{
    return mix(horizon, dir.y >= 0.0 ? zenith : ground, abs(dir.y));
}

/* Share of a cosine-weighted hemisphere around a normal of height y that the upward ramp max(0, d.y) fills:
 * exact at y = 1 (2/3), 0 (2 / (3 pi)) and -1 (0), a parabola between, at most 0.006 off (compared with
 * quadrature). */
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
