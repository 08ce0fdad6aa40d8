/* SPDX-License-Identifier: MIT
 * The sky of the frame: three colours, and spherical harmonics where the host has set any. Values are times
 * exposure. Whether there are harmonics is the same for all threads. */
#ifndef SDFGI_SKY_OF_FRAME_GLSL
#define SDFGI_SKY_OF_FRAME_GLSL

#include "sdfgi_resources.glsl"
#include "../lib/sky.glsl"

float sdfgi_sky_height(vec3 dir)
{
    const float along = (sdfgi_frame.up_axis & 1u) != 0u ? dir.z : dir.y;
    return (sdfgi_frame.up_axis & 2u) != 0u ? -along : along;
}

/* `bands`: factors on the bands 0, 1 and 2. Below 0, where so few bands cannot follow a bright spot, there is
 * no light. */
vec3 sdfgi_sky_harmonics(vec3 dir, vec3 bands)
{
    if (sdfgi_frame.sky_has_harmonics == 0u)
        return vec3(0.0);
    const vec3 first = dir.y * sdfgi_frame.sky_harmonics[1].rgb + dir.z * sdfgi_frame.sky_harmonics[2].rgb +
                       dir.x * sdfgi_frame.sky_harmonics[3].rgb;
    const vec3 second = dir.x * dir.y * sdfgi_frame.sky_harmonics[4].rgb +
                        dir.y * dir.z * sdfgi_frame.sky_harmonics[5].rgb +
                        (3.0 * dir.z * dir.z - 1.0) * sdfgi_frame.sky_harmonics[6].rgb +
                        dir.x * dir.z * sdfgi_frame.sky_harmonics[7].rgb +
                        (dir.x * dir.x - dir.y * dir.y) * sdfgi_frame.sky_harmonics[8].rgb;
    return max(bands.x * sdfgi_frame.sky_harmonics[0].rgb + bands.y * first + bands.z * second, vec3(0.0));
}

vec3 sdfgi_sky_towards(vec3 dir)
{
    return sdfgi_sky_radiance(sdfgi_sky_height(dir), sdfgi_frame.sky_zenith, sdfgi_frame.sky_horizon,
                              sdfgi_frame.sky_ground) +
           sdfgi_sky_harmonics(dir, vec3(1.0));
}

/* Mean radiance over all directions. */
vec3 sdfgi_sky_everywhere()
{
    return sdfgi_sky_mean(sdfgi_frame.sky_zenith, sdfgi_frame.sky_horizon, sdfgi_frame.sky_ground) +
           sdfgi_sky_harmonics(vec3(0.0), vec3(1.0, 0.0, 0.0));
}

/* Irradiance over pi of an unoccluded surface. The cosine lobe keeps these fractions of the bands
 * (Ramamoorthi and Hanrahan 2001, An Efficient Representation for Irradiance Environment Maps). */
vec3 sdfgi_sky_around(vec3 normal)
{
    return sdfgi_sky_irradiance(sdfgi_sky_height(normal), sdfgi_frame.sky_zenith, sdfgi_frame.sky_horizon,
                                sdfgi_frame.sky_ground) +
           sdfgi_sky_harmonics(normal, vec3(1.0, 2.0 / 3.0, 0.25));
}

#endif
