/* SPDX-License-Identifier: MIT
 * The irradiance of one probe in a direction, from the irradiance atlas. */
#ifndef SDFGI_IRRADIANCE_GLSL
#define SDFGI_IRRADIANCE_GLSL

#include "sdfgi_space.glsl"
#include "../lib/finite.glsl"
#include "../lib/irradiance_pack.glsl"
#include "../lib/octahedral.glsl"

/* The four texels around a direction in a probe's octahedral map. */
struct sdfgi_irradiance_footprint {
    vec2 low;      /* the first of the four */
    vec2 fraction; /* from it to the next one, along each side of the map */
};

sdfgi_irradiance_footprint sdfgi_irradiance_footprint_of(vec3 direction)
{
    const vec2 at = (sdfgi_octahedral_encode(direction) * 0.5 + 0.5) * float(SDFGI_IRRADIANCE_TEXELS - 1);
    const float last = float(SDFGI_IRRADIANCE_TEXELS - 2);
    const vec2 low =
        vec2(sdfgi_finite_clamp(floor(at.x), 0.0, last), sdfgi_finite_clamp(floor(at.y), 0.0, last));
    return sdfgi_irradiance_footprint(low, at - low);
}

/* The four texels as they are stored. */
struct sdfgi_irradiance_halves {
    uvec2 texels[4]; /* x + 2 y */
};

sdfgi_irradiance_halves sdfgi_irradiance_load(uint probe_index, sdfgi_irradiance_footprint footprint)
{
    const uint side = uint(SDFGI_IRRADIANCE_TEXELS);
    const uint first =
        probe_index * uint(SDFGI_IRRADIANCE_COUNT) + uint(footprint.low.x) + side * uint(footprint.low.y);
    return sdfgi_irradiance_halves(
        uvec2[4](sdfgi_irradiance_texels_at(first), sdfgi_irradiance_texels_at(first + 1u),
                 sdfgi_irradiance_texels_at(first + side), sdfgi_irradiance_texels_at(first + side + 1u)));
}

sdfgi_irradiance_texel sdfgi_irradiance_interpolate(sdfgi_irradiance_halves halves, vec2 fraction)
{
    const vec4 low =
        mix(sdfgi_half4_decode(halves.texels[0]), sdfgi_half4_decode(halves.texels[1]), fraction.x);
    const vec4 high =
        mix(sdfgi_half4_decode(halves.texels[2]), sdfgi_half4_decode(halves.texels[3]), fraction.x);
    return sdfgi_irradiance_unpack(mix(low, high, fraction.y));
}

sdfgi_irradiance_texel sdfgi_irradiance_of_probe(uint cascade, ivec3 probe, vec3 direction)
{
    const sdfgi_irradiance_footprint footprint = sdfgi_irradiance_footprint_of(direction);
    return sdfgi_irradiance_interpolate(sdfgi_irradiance_load(sdfgi_probe_index(cascade, probe), footprint),
                                        footprint.fraction);
}

#endif
