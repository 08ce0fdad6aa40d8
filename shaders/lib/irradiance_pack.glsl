/* SPDX-License-Identifier: MIT
 * A texel of the irradiance atlas: four half floats. rgb is the irradiance that surfaces show. Alpha holds
 * one of two values, which its sign tells apart:
 *
 * - confidence, for a probe with a short history: how far the probe counts beside others, 0 to 1, stored
 *   negated. Nothing is filtered yet, so the light that surfaces show is all that is known.
 * - gain, above 0, for a probe with a longer history: the unfiltered irradiance over the one that surfaces
 * show, which follows it slowly. The confidence of such a probe is 1.
 *
 * All texels of a probe hold the same of the two, so interpolation between them never mixes the two. */
#ifndef SDFGI_IRRADIANCE_PACK_GLSL
#define SDFGI_IRRADIANCE_PACK_GLSL

struct sdfgi_irradiance_texel {
    vec3 light;       /* what surfaces show; times gain what light cells read */
    float confidence; /* weight of the probe beside others */
    float gain;
};

vec4 sdfgi_irradiance_pack_confidence(vec3 light, float confidence)
{
    return vec4(light, -confidence);
}

vec4 sdfgi_irradiance_pack_gain(vec3 light, float gain)
{
    return vec4(light, gain);
}

sdfgi_irradiance_texel sdfgi_irradiance_unpack(vec4 packed)
{
    const bool has_gain = packed.a > 0.0;
    return sdfgi_irradiance_texel(max(packed.rgb, vec3(0.0)), has_gain ? 1.0 : -packed.a,
                                  has_gain ? packed.a : 1.0);
}

/* The nearest values towards zero that half floats hold, so that packHalf2x16 has nothing to round. Its
 * rounding to nearest, which Vulkan leaves open, keeps light that fades where a step rounds to itself, and
 * light that converges in a circle. */
vec4 sdfgi_half4_truncate(vec4 v)
{
    const float NORMAL_MIN = 6.103515625e-5, SUBNORMAL_STEP = 5.9604644775390625e-8;
    const vec4 normal = uintBitsToFloat(floatBitsToUint(v) & 0xffffe000u); /* 10 bits of mantissa */
    return mix(normal, trunc(v / SUBNORMAL_STEP) * SUBNORMAL_STEP, lessThan(abs(v), vec4(NORMAL_MIN)));
}

/* The nearest values that half floats hold. Sums that grow over many steps must not lose half a unit in each:
 * cut towards zero, 32 of them lost 0.8 % of the light, and a bounce as much again. */
vec4 sdfgi_half4_round(vec4 v)
{
    const float NORMAL_MIN = 6.103515625e-5, HALF_STEP = 2.98023223876953125e-8;
    const vec4 normal = uintBitsToFloat(floatBitsToUint(v) + 0x1000u); /* half of the last of 10 bits */
    return sdfgi_half4_truncate(mix(normal, v + sign(v) * HALF_STEP, lessThan(abs(v), vec4(NORMAL_MIN))));
}

/* Four half floats. */
uvec2 sdfgi_half4_encode(vec4 v)
{
    return uvec2(packHalf2x16(v.rg), packHalf2x16(v.ba));
}

/* Infinity and NaN, which nobody stores, are 0: whatever memory holds, no light is made of them. */
vec4 sdfgi_half4_decode(uvec2 halves)
{
    const uvec4 exponents = uvec4(halves.x, halves.x >> 16u, halves.y, halves.y >> 16u) & 0x7c00u;
    return mix(vec4(unpackHalf2x16(halves.x), unpackHalf2x16(halves.y)), vec4(0.0),
               equal(exponents, uvec4(0x7c00u)));
}

#endif
