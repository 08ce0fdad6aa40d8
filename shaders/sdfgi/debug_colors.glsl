/* SPDX-License-Identifier: MIT
 * The colours of debug views, linear from 0 to 1. What they mean is said in sdfgi/debug.h. */
#ifndef SDFGI_DEBUG_COLORS_GLSL
#define SDFGI_DEBUG_COLORS_GLSL

const vec3 DEBUG_SKY = vec3(0.01, 0.015, 0.03);  /* the ray met nothing */
const vec3 DEBUG_UNKNOWN = vec3(0.25, 0.0, 0.3); /* there is nothing to tell of a surface */
const vec3 DEBUG_GREY = vec3(0.25);              /* nothing remarkable */
const vec3 DEBUG_RED = vec3(1.0, 0.05, 0.02);
const vec3 DEBUG_ORANGE = vec3(1.0, 0.35, 0.0);
const vec3 DEBUG_YELLOW = vec3(1.0, 0.85, 0.0);
const vec3 DEBUG_GREEN = vec3(0.1, 0.8, 0.1);
const vec3 DEBUG_BLUE = vec3(0.1, 0.3, 1.0);
const vec3 DEBUG_MAGENTA = vec3(1.0, 0.0, 1.0);

/* By cascade. */
const vec3 DEBUG_CASCADES[8] = vec3[8](DEBUG_GREEN, DEBUG_BLUE, DEBUG_ORANGE, vec3(0.5, 0.15, 0.9),
                                       vec3(0.05, 0.8, 0.8), DEBUG_YELLOW, vec3(1.0, 0.35, 0.6), vec3(0.6));

/* By face: +x -x +y -y +z -z. */
const float DEBUG_SHADES[6] = float[6](0.85, 0.6, 1.0, 0.4, 0.75, 0.5);

/* 0 to 1 as blue, cyan, green, yellow, red. */
vec3 debug_blue_to_red(float x)
{
    const float from_green = 4.0 * clamp(x, 0.0, 1.0) - 2.0;
    return clamp(vec3(from_green, 2.0 - abs(from_green), -from_green), 0.0, 1.0);
}

/* 0 to 1 as red, yellow, green. */
vec3 debug_red_to_green(float x)
{
    const float twice = 2.0 * clamp(x, 0.0, 1.0);
    return vec3(clamp(2.0 - twice, 0.0, 1.0), clamp(twice, 0.0, 1.0), 0.0);
}

/* -1 to 1 as blue, grey, red. */
vec3 debug_difference(float x)
{
    return mix(DEBUG_GREY, x > 0.0 ? DEBUG_RED : DEBUG_BLUE, clamp(abs(x), 0.0, 1.0));
}

/* Light of any brightness. */
vec3 debug_tone(vec3 light)
{
    return light / (1.0 + light);
}

/* 1, or less in every second band between whole numbers. */
float debug_band(float x)
{
    return (int(floor(x)) & 1) == 0 ? 1.0 : 0.7;
}

#endif
