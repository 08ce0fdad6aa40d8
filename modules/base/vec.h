/* SPDX-License-Identifier: MIT
 * Three-component vectors as plain arrays, which is how positions and directions cross the interfaces. */
#ifndef BASE_VEC_H
#define BASE_VEC_H

#include <math.h>
#include <stdbool.h>

static inline double base_vec3d_dot(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static inline double base_vec3d_length(const double a[3])
{
    return sqrt(base_vec3d_dot(a, a));
}

static inline void base_vec3d_sub(const double a[3], const double b[3], double out[3])
{
    for (int i = 0; i < 3; i++)
        out[i] = a[i] - b[i];
}

/* `out` must not be `a` or `b`. */
static inline void base_vec3d_cross(const double a[3], const double b[3], double out[3])
{
    out[0] = a[1] * b[2] - a[2] * b[1];
    out[1] = a[2] * b[0] - a[0] * b[2];
    out[2] = a[0] * b[1] - a[1] * b[0];
}

/* Scales to unit length. A vector too short or too long to have a direction is left alone: returns false. */
static inline bool base_vec3d_normalize(double a[3])
{
    const double length = base_vec3d_length(a);
    if (!(length > 0) || !isfinite(length))
        return false;
    for (int i = 0; i < 3; i++)
        a[i] /= length;
    return true;
}

/* out = m * v, `m` row-major. `out` must not be `v`. */
static inline void base_mat3f_mul_vec3f(const float m[9], const float v[3], float out[3])
{
    for (int row = 0; row < 3; row++)
        out[row] = m[3 * row] * v[0] + m[3 * row + 1] * v[1] + m[3 * row + 2] * v[2];
}

#endif
