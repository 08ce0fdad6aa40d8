/* SPDX-License-Identifier: MIT
 * What a host includes in its own shaders:
 *
 *     #define SDFGI_SET 1            // where the set from sdfgi_get_descriptor_set is bound
 *     #include "sdfgi.glsl"          // needs GL_GOOGLE_include_directive
 *     radiance += albedo / PI * sdfgi_irradiance(position, normal, to_eye);
 *
 * Positions are in metres relative to sdfgi_frame_desc::origin of the last sdfgi_update. Whatever is passed,
 * light is finite. */
#ifndef SDFGI_GLSL
#define SDFGI_GLSL

#include "sdfgi_air.glsl"

/* Indirect diffuse irradiance E (W/m^2) at a surface point with unit normal. A Lambertian surface reflects
 * albedo * E / pi. E includes light that comes straight from the sky and from emissive surfaces, and excludes
 * the direct light of the host's own lights.
 *
 * `to_eye` is the vector from the point to the viewer, in metres. Nothing may stand between the two. Where
 * there is no viewer, a short vector along the normal will do. */
vec3 sdfgi_irradiance(vec3 position, vec3 normal, vec3 to_eye)
{
    /* GI is off, or there has been no update. */
    if (sdfgi_frame.cascade_count == 0u)
        return vec3(0.0);
    const float to_watts = 3.14159265 * sdfgi_frame.exposure_inverse * sdfgi_frame.energy;
    const vec3 unit = sdfgi_lookup_unit(normal);
    const sdfgi_lookup_query query = sdfgi_lookup_query(
        SDFGI_LOOKUP_SURFACE, 0u, sdfgi_lookup_position(position), unit, sdfgi_lookup_to_eye(to_eye, unit));
    return to_watts * sdfgi_lookup(query).rgb;
}

/* Light at a point of the air from all directions, for media and particles, as radiance: see sdfgi_air_light.
 * `direction` is a unit vector, that of `towards`.
 *
 * A medium scatters the mean evenly. One with a phase function of mean cosine g sends the viewer
 * mix(mean, towards, min(1.5 * abs(g), 1)) times its albedo, if `direction` leads from the viewer to the
 * point, or the other way where g < 0. For abs(g) up to 2/3 that is exact in the first two orders of
 * spherical harmonics. Even light is scattered without loss, and nothing gets brighter than what arrives. */
sdfgi_air_light sdfgi_light_air(vec3 position, vec3 direction)
{
    sdfgi_air_light light = sdfgi_air_light(vec3(0.0), vec3(0.0), 0.0);
    if (sdfgi_frame.cascade_count == 0u)
        return light;
    const float scale = sdfgi_frame.exposure_inverse * sdfgi_frame.energy;
    light = sdfgi_air_lookup(sdfgi_lookup_position(position), sdfgi_lookup_unit(direction));
    light.mean *= scale;
    light.towards *= scale;
    return light;
}

/* The irradiance E (W/m^2) of a small surface in the air that faces `direction`. */
vec3 sdfgi_irradiance_air(vec3 position, vec3 direction)
{
    return 3.14159265 * sdfgi_light_air(position, direction).towards;
}

#endif
