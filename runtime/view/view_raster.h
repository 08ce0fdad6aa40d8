/* SPDX-License-Identifier: MIT
 * A small picture of what lies where: enough to tell a good place for a camera from a bad one. */
#ifndef RUNTIME_VIEW_RASTER_H
#define RUNTIME_VIEW_RASTER_H

#include <stdint.h>

enum { VIEW_RASTER_SIDE = 64, VIEW_RASTER_PIXELS = VIEW_RASTER_SIDE * VIEW_RASTER_SIDE };

/* A camera that looks along `forward`. The axes are unit vectors at right angles. */
struct view_eye {
    double position[3], right[3], up[3], forward[3];
    double tan_x, tan_y; /* tangents of half the angles of view */
};

struct view_raster {
    float nearness[VIEW_RASTER_PIXELS]; /* 1 / distance along the axis; 0: nothing is there */
    uint32_t what[VIEW_RASTER_PIXELS];
};

/* Draws a triangle of corners in the eye's space: right, up, forward. Parts nearer than `near_m` are cut off.
 */
void view_raster_triangle(struct view_raster *raster, const struct view_eye *eye, double corners[3][3],
                          double near_m, uint32_t what);

#endif
