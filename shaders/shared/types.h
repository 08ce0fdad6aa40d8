/* SPDX-License-Identifier: MIT
 * Read by C and GLSL alike. Structs hold only vec4-sized members, or scalars whose offsets are the same in C, std430
 * and scalar layout, so that no layout feature is needed. */
#ifndef SDFGI_SHARED_TYPES_H
#define SDFGI_SHARED_TYPES_H

#ifdef VULKAN
#define SDFGI_STRUCT(type) type
/* A declaration without effect: before version 4.60, GLSL has no empty one for the semicolon that follows. */
#define SDFGI_ASSERT_SIZE(type, bytes) precision highp int
#else
#include <assert.h>
#include <stdint.h>
typedef uint32_t uint;
typedef struct { float x, y, z, w; } vec4;
typedef struct { int32_t x, y, z, w; } ivec4;
typedef struct { uint32_t x, y, z, w; } uvec4;
#define SDFGI_STRUCT(type) struct type
#define SDFGI_ASSERT_SIZE(type, bytes) static_assert(sizeof(struct type) == (bytes), "size of " #type)
#endif

#endif
