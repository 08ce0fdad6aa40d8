/* SPDX-License-Identifier: MIT
 * Single pixels of debug views, and the scales by which they are coloured. */
#ifndef TEST_DEBUG_PIXEL_H
#define TEST_DEBUG_PIXEL_H

#include "gi_test.h"

#include <sdfgi/debug.h>

/* Of the pictures. */
enum { DEBUG_SIDE = 5, DEBUG_PIXELS = DEBUG_SIDE * DEBUG_SIDE };

struct debug_color {
    double rgb[3];
};

/* A camera at `eye`, relative to the frame's origin. */
enum debug_camera {
    DEBUG_CAMERA_REVERSED,
    DEBUG_CAMERA_FORWARD,
    DEBUG_CAMERA_ORTHOGRAPHIC,
    DEBUG_CAMERA_COUNT
};

/* A description of pictures without output, size and view, for a camera that looks along an axis of the
 * world: 0 +x, 1 -x, 2 +y, 3 -y, 4 +z, 5 -z. */
struct sdfgi_debug_desc debug_desc(enum debug_camera camera, const double eye[static 3], int axis);

/* The pixel in the middle of a picture, of which all pixels are finite and from 0 to 1. */
struct debug_color debug_pixel(struct gi_test *t, const struct sdfgi_debug_desc *desc);
/* The same of a view, seen by a camera with reversed depth. */
struct debug_color debug_look(struct gi_test *t, enum sdfgi_debug_view view, const double eye[static 3],
                              int axis);

/* A colour divided by its largest component. */
struct debug_color debug_hue(struct debug_color color);
/* The scale BLUE TO RED at a value from 0 to 1, and the value where a colour's hue is on the scale. */
struct debug_color debug_blue_to_red(double value);
double debug_value_of(struct debug_color color);

#define REQUIRE_COLOR(color, r, g, b, tolerance)                                                             \
    do {                                                                                                     \
        REQUIRE_NEAR((color).rgb[0], r, tolerance);                                                          \
        REQUIRE_NEAR((color).rgb[1], g, tolerance);                                                          \
        REQUIRE_NEAR((color).rgb[2], b, tolerance);                                                          \
    } while (0)

#endif
