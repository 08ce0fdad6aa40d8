/* SPDX-License-Identifier: MIT
 * Types that C and GLSL share. A struct holds only scalars, vec4, and vec3 followed by a scalar, and every
 * vec3 begins at a multiple of 16 bytes: offsets are then the same in C, std140 and std430, and no layout
 * feature is needed. */
#ifndef SDFGI_SHARED_TYPES_H
#define SDFGI_SHARED_TYPES_H

#ifdef VULKAN
#define SDFGI_STRUCT(type) type
#define SDFGI_FUNCTION
/* A declaration without effect: before version 4.60, GLSL has no empty one for the semicolon that follows. */
#define SDFGI_ASSERT_SIZE(type, bytes) precision highp int
#else
#include <assert.h>
#include <stdint.h>
typedef uint32_t uint;
typedef struct {
    float x, y, z;
} vec3;
typedef struct {
    float x, y, z, w;
} vec4;
typedef struct {
    int32_t x, y, z;
} ivec3;
#define SDFGI_STRUCT(type)             struct type
#define SDFGI_FUNCTION                 static inline
#define SDFGI_ASSERT_SIZE(type, bytes) static_assert(sizeof(struct type) == (bytes), "size of " #type)
#endif

#endif
