/* SPDX-License-Identifier: MIT
 * Colours in 48 bits: three mantissas of 14 bits with a shared exponent, as RGB9E5 but finer. Half floats
 * have 11 bits: light that grows by less than a unit of them in each bounce, as in a white room, would come
 * to rest too early. */
#ifndef SDFGI_RGB48_GLSL
#define SDFGI_RGB48_GLSL

#include "rgbe.glsl"

const int SDFGI_RGB48_BITS = 14, SDFGI_RGB48_BIAS = 46;

/* x: red, green and 4 bits of blue; y: the rest of blue and the exponent, 16 bits. Rounded to nearest.
 * Clamped as RGB9E5. */
uvec2 sdfgi_rgb48_encode(vec3 color)
{
    const vec3 c = sdfgi_rgbe_clamp(color);
    const float largest = max(c.r, max(c.g, c.b));
    int e = max(int(floatBitsToUint(largest) >> 23) - 126, -SDFGI_RGB48_BIAS);
    if (floor(largest * sdfgi_rgbe_exp2(SDFGI_RGB48_BITS - e) + 0.5) >= 16384.0)
        e += 1;
    const uvec3 m = uvec3(c * sdfgi_rgbe_exp2(SDFGI_RGB48_BITS - e) + 0.5);
    return uvec2(m.r | m.g << 14u | m.b << 28u, m.b >> 4u | uint(e + SDFGI_RGB48_BIAS) << 10u);
}

vec3 sdfgi_rgb48_decode(uvec2 v)
{
    const uvec3 m = uvec3(v.x & 16383u, v.x >> 14u & 16383u, v.x >> 28u | (v.y & 1023u) << 4u);
    return vec3(m) * sdfgi_rgbe_exp2(int(v.y >> 10u) - SDFGI_RGB48_BIAS - SDFGI_RGB48_BITS);
}

#endif
