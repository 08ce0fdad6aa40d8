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

/* Probe spacings to step along an axis on which the camera is `off_centre` cells from the middle: up to the
 * camera; or one, past it, into what lookups have left free on the other side. */
static int64_t spacings_to_step(int64_t off_centre, double spare)
{
    const int64_t spacing = SDFGI_PROBE_SPACING;
    if (off_centre > -spacing && off_centre < spacing)
        return ((double)off_centre + spare >= (double)spacing) -
               ((double)off_centre + 1 + spare <= -(double)spacing);
    return off_centre / spacing;
}

bool cascade_place(struct cascade *cascade, uint32_t resolution, const double camera[3])
{
    const int64_t half = resolution / 2, spacing = SDFGI_PROBE_SPACING;
    int64_t off_centre[3];
    bool moves = !cascade->placed;
    for (int i = 0; i < 3; i++) {
        off_centre[i] = camera_cell(camera[i], cascade->cell_size[i]) - (cascade->origin[i] + half);
        moves = moves || off_centre[i] < -spacing || off_centre[i] > spacing;
    }
    for (int i = 0; moves && i < 3; i++)
        cascade->origin[i] += spacing * (cascade->placed ? spacings_to_step(off_centre[i], cascade->spare[i])
                                                         : floor_div(off_centre[i] + spacing / 2, spacing));
    cascade->placed = true;
    return moves;
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

struct cell_box cell_box_whole(uint32_t resolution)
{
    const int32_t n = (int32_t)resolution;
    return (struct cell_box){ { 0, 0, 0 }, { n, n, n } };
}

struct cell_box cell_box_shifted(const struct cell_box *box, const int32_t by[3])
{
    struct cell_box shifted;
    for (int i = 0; i < 3; i++) {
        shifted.low[i] = box->low[i] + by[i];
        shifted.high[i] = box->high[i] + by[i];
    }
    return shifted;
}

struct cell_box cell_box_common(const struct cell_box *a, const struct cell_box *b)
{
    struct cell_box common;
    for (int i = 0; i < 3; i++) {
        common.low[i] = a->low[i] > b->low[i] ? a->low[i] : b->low[i];
        common.high[i] = a->high[i] < b->high[i] ? a->high[i] : b->high[i];
    }
    return cell_box_empty(&common) ? (struct cell_box){ 0 } : common;
}

bool cell_box_empty(const struct cell_box *box)
{
    for (int i = 0; i < 3; i++)
        if (box->low[i] >= box->high[i])
            return true;
    return false;
}

uint64_t cell_box_cells(const struct cell_box *box)
{
    uint64_t cells = 1;
    for (int i = 0; i < 3; i++)
        cells *= (uint64_t)(box->high[i] > box->low[i] ? box->high[i] - box->low[i] : 0);
    return cells;
}

uint32_t cell_box_difference(const struct cell_box *box, const struct cell_box *hole, struct cell_box out[3])
{
    uint32_t count = 0;
    struct cell_box rest = *box;
    for (int i = 0; i < 3; i++) {
        struct cell_box below = rest, above = rest;
        below.high[i] = hole->low[i];
        above.low[i] = hole->high[i];
        if (!cell_box_empty(&below))
            out[count++] = below;
        if (!cell_box_empty(&above) && count < 3)
            out[count++] = above;
        rest.low[i] = hole->low[i];
        rest.high[i] = hole->high[i];
    }
    return count;
}

struct cell_box cascade_cells(const struct cascade *cascade, uint32_t resolution, const struct box *box)
{
    const double n = (double)resolution;
    struct cell_box cells;
    for (int i = 0; i < 3; i++) {
        const double origin = (double)cascade->origin[i], spacing = SDFGI_PROBE_SPACING;
        /* One sub-voxel more on either side: triangles set sub-voxels that they touch. */
        const double margin = 1.0 / SDFGI_SUBVOXELS;
        const double low = floor((box->min[i] / cascade->cell_size[i] - origin - margin) / spacing) * spacing;
        const double high = ceil((box->max[i] / cascade->cell_size[i] - origin + margin) / spacing) * spacing;
        cells.low[i] = (int32_t)fmin(fmax(low, 0), n);
        cells.high[i] = (int32_t)fmin(fmax(high, 0), n);
    }
    return cells;
}
