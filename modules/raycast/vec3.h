/* SPDX-License-Identifier: MIT
 *
 * Vectors of the path tracer: single precision, by value, all inline.
 */
#ifndef RAYCAST_VEC3_H
#define RAYCAST_VEC3_H

#include <math.h>
#include <stdbool.h>

#define VEC3_PI 3.14159265358979323846f

struct vec3 {
    float x, y, z;
};

static inline struct vec3 vec3_make(float x, float y, float z)
{
    return (struct vec3){ x, y, z };
}

static inline struct vec3 vec3_load(const float v[3])
{
    return vec3_make(v[0], v[1], v[2]);
}

static inline struct vec3 vec3_splat(float s)
{
    return vec3_make(s, s, s);
}

static inline struct vec3 vec3_add(struct vec3 a, struct vec3 b)
{
    return vec3_make(a.x + b.x, a.y + b.y, a.z + b.z);
}

static inline struct vec3 vec3_sub(struct vec3 a, struct vec3 b)
{
    return vec3_make(a.x - b.x, a.y - b.y, a.z - b.z);
}

static inline struct vec3 vec3_mul(struct vec3 a, struct vec3 b)
{
    return vec3_make(a.x * b.x, a.y * b.y, a.z * b.z);
}

static inline struct vec3 vec3_scale(struct vec3 a, float s)
{
    return vec3_make(a.x * s, a.y * s, a.z * s);
}

/* a + b * s */
static inline struct vec3 vec3_mad(struct vec3 a, struct vec3 b, float s)
{
    return vec3_make(a.x + b.x * s, a.y + b.y * s, a.z + b.z * s);
}

static inline struct vec3 vec3_lerp(struct vec3 a, struct vec3 b, float t)
{
    return vec3_add(vec3_scale(a, 1.0f - t), vec3_scale(b, t));
}

static inline float vec3_dot(struct vec3 a, struct vec3 b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

static inline struct vec3 vec3_cross(struct vec3 a, struct vec3 b)
{
    return vec3_make(a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x);
}

static inline float vec3_length(struct vec3 a)
{
    return sqrtf(vec3_dot(a, a));
}

/* Zero stays zero. */
static inline struct vec3 vec3_normalize(struct vec3 a)
{
    const float length = vec3_length(a);
    return length > 0.0f ? vec3_scale(a, 1.0f / length) : a;
}

static inline struct vec3 vec3_negate(struct vec3 a)
{
    return vec3_make(-a.x, -a.y, -a.z);
}

static inline float vec3_max(struct vec3 a)
{
    return fmaxf(a.x, fmaxf(a.y, a.z));
}

static inline bool vec3_is_finite(struct vec3 a)
{
    return isfinite(a.x) && isfinite(a.y) && isfinite(a.z);
}

/* Rec. 709 luminance; only chooses samples and stops, never enters a picture. */
static inline float vec3_luminance(struct vec3 a)
{
    return 0.2126f * a.x + 0.7152f * a.y + 0.0722f * a.z;
}

static inline float clamp01(float x)
{
    return x < 0.0f ? 0.0f : x > 1.0f ? 1.0f : x;
}

/* An orthonormal frame around a unit normal. */
struct frame {
    struct vec3 s, t, n;
};

/* Branchless construction without a singular direction: Duff et al. 2017, "Building an Orthonormal Basis,
 * Revisited", JCGT 6(1). */
static inline struct frame frame_around(struct vec3 n)
{
    const float sign = copysignf(1.0f, n.z);
    const float a = -1.0f / (sign + n.z);
    const float b = n.x * n.y * a;
    return (struct frame){
        .s = vec3_make(1.0f + sign * n.x * n.x * a, sign * b, -sign * n.x),
        .t = vec3_make(b, sign + n.y * n.y * a, -n.y),
        .n = n,
    };
}

static inline struct vec3 frame_to_world(const struct frame *f, struct vec3 v)
{
    return vec3_mad(vec3_mad(vec3_scale(f->s, v.x), f->t, v.y), f->n, v.z);
}

static inline struct vec3 frame_to_local(const struct frame *f, struct vec3 v)
{
    return vec3_make(vec3_dot(v, f->s), vec3_dot(v, f->t), vec3_dot(v, f->n));
}

#endif
