/* SPDX-License-Identifier: MIT
 * What a host includes in its own shaders:
 *
 *     #define SDFGI_SET 1            // where the set from sdfgi_get_descriptor_set is bound
 *     #include "sdfgi.glsl"          // needs GL_GOOGLE_include_directive
 *     radiance += albedo / PI * sdfgi_irradiance(position, normal, to_eye);
 *
 * Positions are in metres relative to sdfgi_frame_desc::origin of the last sdfgi_update. */
#ifndef SDFGI_GLSL
#define SDFGI_GLSL

#include "sdfgi_lookup.glsl"

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
    const sdfgi_lookup_query query =
        sdfgi_lookup_query(SDFGI_LOOKUP_SURFACE, sdfgi_first_from_position(position), normal, normal, to_eye);
    return to_watts * sdfgi_lookup(query).rgb;
}

/* The same in the air, for particles and fog: the irradiance of a small surface that faces `direction`. The
 * mean of E over all directions, over pi, is the mean radiance, which a medium scatters. */
vec3 sdfgi_irradiance_air(vec3 position, vec3 direction)
{
    if (sdfgi_frame.cascade_count == 0u)
        return vec3(0.0);
    const float to_watts = 3.14159265 * sdfgi_frame.exposure_inverse * sdfgi_frame.energy;
    const sdfgi_lookup_query query = sdfgi_lookup_query(SDFGI_LOOKUP_AIR, sdfgi_first_from_position(position),
                                                        direction, direction, vec3(0.0));
    return to_watts * sdfgi_lookup(query).rgb;
}

#endif
