/* SPDX-License-Identifier: MIT
 * Values from outside before they become integers: GLSL leaves min, max and clamp of NaN undefined, and so
 * does SPIR-V the conversion of NaN and of what an integer cannot hold (HARD_CASES row 60). */
#ifndef SDFGI_FINITE_GLSL
#define SDFGI_FINITE_GLSL

/* `low` for NaN and for less, at most `high`. */
float sdfgi_finite_clamp(float v, float low, float high)
{
    return v > low ? min(v, high) : low;
}

/* 0 for NaN and for less, at most `high`. */
vec3 sdfgi_finite_color(vec3 v, float high)
{
    return vec3(sdfgi_finite_clamp(v.r, 0.0, high), sdfgi_finite_clamp(v.g, 0.0, high),
                sdfgi_finite_clamp(v.b, 0.0, high));
}

#endif
