/* SPDX-License-Identifier: MIT
 * RGB9E5 shared exponent colours (Vulkan specification, "Shared Exponent to RGB"). The exponent comes from
 * the bits of a float, because log2 may be off by one at powers of two. */
#ifndef SDFGI_RGBE_GLSL
#define SDFGI_RGBE_GLSL

#define SDFGI_RGBE_MAX 65408.0

float sdfgi_rgbe_exp2(int e)
{
    return uintBitsToFloat(uint(e + 127) << 23);
}

/* NaN and negative values become 0; values above the largest become the largest. */
vec3 sdfgi_rgbe_clamp(vec3 color)
{
    return vec3(color.r > 0.0 ? min(color.r, SDFGI_RGBE_MAX) : 0.0,
                color.g > 0.0 ? min(color.g, SDFGI_RGBE_MAX) : 0.0,
                color.b > 0.0 ? min(color.b, SDFGI_RGBE_MAX) : 0.0);
}

/* `rounding` in [0, 1) is added before the mantissas are truncated. 0.5 rounds to nearest. A hash rounds
 * without bias over many values, so that light which grows in steps smaller than a mantissa's unit does not
 * stall (HARD_CASES row 30). */
uint sdfgi_rgbe_encode_rounded(vec3 color, float rounding)
{
    const vec3 c = sdfgi_rgbe_clamp(color);
    const float largest = max(c.r, max(c.g, c.b));
    int e = max(int(floatBitsToUint(largest) >> 23) - 127, -16) + 1;
    if (floor(largest * sdfgi_rgbe_exp2(9 - e) + rounding) >= 512.0)
        e += 1;
    const uvec3 m = uvec3(min(floor(c * sdfgi_rgbe_exp2(9 - e) + rounding), 511.0));
    return m.r | m.g << 9 | m.b << 18 | uint(e + 15) << 27;
}

uint sdfgi_rgbe_encode(vec3 color)
{
    return sdfgi_rgbe_encode_rounded(color, 0.5);
}

/* The color times a weight. */
vec3 sdfgi_rgbe_decode_weighted(uint v, float weight)
{
    return vec3(v & 511u, v >> 9 & 511u, v >> 18 & 511u) * (weight * sdfgi_rgbe_exp2(int(v >> 27) - 24));
}

vec3 sdfgi_rgbe_decode(uint v)
{
    return sdfgi_rgbe_decode_weighted(v, 1.0);
}

#endif
