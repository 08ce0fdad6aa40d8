/* SPDX-License-Identifier: MIT
 * The little double-precision vector algebra the renderer needs on the CPU: world positions are doubles, and
 * only differences to a nearby origin become floats. */
#ifndef HOST_MATH_H
#define HOST_MATH_H

#include <math.h>

static inline double host_dot3(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static inline void host_cross3(const double a[3], const double b[3], double out[3])
{
    const double r[3] = { a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0] };
    out[0] = r[0], out[1] = r[1], out[2] = r[2];
}

/* Makes `v` a unit vector and returns its former length; a zero or non-finite vector becomes +Z. */
static inline double host_normalize3(double v[3])
{
    const double length = sqrt(host_dot3(v, v));
    if (!(length > 1e-30) || !isfinite(length)) {
        v[0] = 0, v[1] = 0, v[2] = 1;
        return 0;
    }
    for (int i = 0; i < 3; i++)
        v[i] /= length;
    return length;
}

/* Any two unit vectors that make a right-handed frame with the unit vector `z`: right x up = z. */
static inline void host_frame3(const double z[3], double right[3], double up[3])
{
    const int smallest =
        fabs(z[0]) < fabs(z[1]) ? (fabs(z[0]) < fabs(z[2]) ? 0 : 2) : (fabs(z[1]) < fabs(z[2]) ? 1 : 2);
    const double axis[3] = { smallest == 0, smallest == 1, smallest == 2 };
    host_cross3(axis, z, right);
    host_normalize3(right);
    host_cross3(z, right, up);
}

#endif
