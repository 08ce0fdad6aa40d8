/* SPDX-License-Identifier: MIT
 * Up in the world. */
#ifndef SDFGI_UP_AXIS_H
#define SDFGI_UP_AXIS_H

#include <sdfgi/sdfgi.h>

/* A unit vector, whose x is 0. */
struct up_vector {
    float y, z;
};

static inline struct up_vector sdfgi_up_vector(enum sdfgi_up_axis axis)
{
    static const struct up_vector vectors[] = { [SDFGI_UP_Y] = { 1, 0 },
                                                [SDFGI_UP_Z] = { 0, 1 },
                                                [SDFGI_UP_MINUS_Y] = { -1, 0 },
                                                [SDFGI_UP_MINUS_Z] = { 0, -1 } };
    return vectors[axis];
}

#endif
