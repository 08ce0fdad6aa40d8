/* SPDX-License-Identifier: MIT
 * IEC 61966-2-1: the encoding of sRGB. */
#ifndef SDFGI_SRGB_GLSL
#define SDFGI_SRGB_GLSL

/* Linear values of encoded ones, for which [0, 1] is meant. Whatever the argument, no result is NaN that was
 * none before. */
vec3 sdfgi_srgb_decode(vec3 c)
{
    const vec3 curve = pow((max(c, vec3(0.0)) + 0.055) / 1.055, vec3(2.4));
    return mix(curve, c / 12.92, lessThanEqual(c, vec3(0.04045)));
}

#endif
