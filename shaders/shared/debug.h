/* SPDX-License-Identifier: MIT
 * Debug views as shaders number them: enum sdfgi_debug_view of sdfgi/debug.h, compared in debug.c. */
#ifndef SDFGI_SHARED_DEBUG_H
#define SDFGI_SHARED_DEBUG_H

#define SDFGI_SHADER_DEBUG_SOLID             0
#define SDFGI_SHADER_DEBUG_DISTANCE          1
#define SDFGI_SHADER_DEBUG_DISTANCE_SLICE    2
#define SDFGI_SHADER_DEBUG_CASCADE           3
#define SDFGI_SHADER_DEBUG_STEPS             4
#define SDFGI_SHADER_DEBUG_ALBEDO            5
#define SDFGI_SHADER_DEBUG_EMISSION          6
#define SDFGI_SHADER_DEBUG_LIGHT             7
#define SDFGI_SHADER_DEBUG_IRRADIANCE        8
#define SDFGI_SHADER_DEBUG_CONFIDENCE        9
#define SDFGI_SHADER_DEBUG_AGE               10
#define SDFGI_SHADER_DEBUG_VISIBILITY        11
#define SDFGI_SHADER_DEBUG_PROBES_IRRADIANCE 12
#define SDFGI_SHADER_DEBUG_PROBES_STATE      13
#define SDFGI_SHADER_DEBUG_LEAKS             14
#define SDFGI_SHADER_DEBUG_WOKE              15
#define SDFGI_SHADER_DEBUG_REFLECTION_TIER   16

#endif
