/* SPDX-License-Identifier: MIT
 * Where cascades are. Pure arithmetic, no Vulkan; constant time however far the camera moves. */
#include "internal.h"

#include <math.h>

int64_t floor_div(int64_t a, int64_t b)
{
    return a / b - (a % b != 0 && (a % b < 0) != (b < 0));
}

int64_t floor_mod(int64_t a, int64_t b)
{
    return a - floor_div(a, b) * b;
}

/* Beyond this many cells the camera's cell is clamped: doubles no longer tell neighbouring cells apart. */
#define FARTHEST_CELL 4503599627370496.0 /* 2^52 */

static int64_t camera_cell(double position, double cell_size)
{
    const double cell = floor(position / cell_size);
    return (int64_t)fmin(fmax(cell, -FARTHEST_CELL), FARTHEST_CELL);
}

bool cascade_place(struct cascade *cascade, uint32_t resolution, const double camera[3])
{
    const int64_t half = resolution / 2, spacing = SDFGI_PROBE_SPACING;
    bool moved = false;
    for (int i = 0; i < 3; i++) {
        const int64_t cell = camera_cell(camera[i], cascade->cell_size[i]);
        const int64_t off_centre = cell - (cascade->origin[i] + half);
        if (cascade->placed && off_centre >= -spacing && off_centre <= spacing)
            continue;
        /* Rounded to the nearest probe: at most half a spacing off, so that the way back to the threshold is
         * at least half a spacing and a camera that oscillates around any point moves the cascade at most
         * once. */
        const int64_t origin = floor_div(cell - half + spacing / 2, spacing) * spacing;
        moved = moved || !cascade->placed || origin != cascade->origin[i];
        cascade->origin[i] = origin;
    }
    cascade->placed = true;
    return moved;
}

struct box cascade_box(const struct cascade *cascade, uint32_t resolution)
{
    struct box box;
    for (int i = 0; i < 3; i++) {
        box.min[i] = (double)cascade->origin[i] * cascade->cell_size[i];
        box.max[i] = (double)(cascade->origin[i] + resolution) * cascade->cell_size[i];
    }
    return box;
}

bool box_overlaps(const struct box *a, const struct box *b)
{
    for (int i = 0; i < 3; i++)
        if (a->max[i] < b->min[i] || a->min[i] > b->max[i])
            return false;
    return true;
}
