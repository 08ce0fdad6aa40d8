/* SPDX-License-Identifier: MIT
 * Where cascades are. Pure arithmetic, no Vulkan; constant time however far the camera moves. */
#include "cascade.h"

#include "core/extent.h"

#include <assert.h>
#include <math.h>
#include <string.h>

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

bool sdfgi_cascade_place(struct cascade *cascade, uint32_t resolution, const double camera[static 3])
{
    const int64_t half = resolution / 2, spacing = SDFGI_PROBE_SPACING;
    int64_t off_centre[3];
    bool moves = cascade->place == CASCADE_UNPLACED;
    for (int i = 0; i < 3; i++) {
        off_centre[i] = camera_cell(camera[i], cascade->cell_size[i]) - (cascade->origin[i] + half);
        moves = moves || off_centre[i] < -spacing || off_centre[i] > spacing;
    }
    for (int i = 0; moves && i < 3; i++)
        cascade->origin[i] += spacing * (cascade->place == CASCADE_UNPLACED
                                             ? sdfgi_floor_div(off_centre[i] + spacing / 2, spacing)
                                             : spacings_to_step(off_centre[i], cascade->spare[i]));
    if (cascade->place == CASCADE_UNPLACED)
        cascade->place = CASCADE_OUTDATED;
    return moves;
}

struct cell_box sdfgi_cascade_cells(const struct cascade *cascade, uint32_t resolution, const struct box *box)
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

struct box sdfgi_cascade_world_box(const struct cascade *cascade, const struct cell_box *cells)
{
    struct box box;
    for (int i = 0; i < 3; i++) {
        const double margin = 1.0 / SDFGI_SUBVOXELS, size = cascade->cell_size[i];
        box.min[i] = ((double)(cascade->origin[i] + cells->low[i]) - margin) * size;
        box.max[i] = ((double)(cascade->origin[i] + cells->high[i]) + margin) * size;
    }
    return box;
}

void sdfgi_cascades_init(struct cascades *cascades, const struct sdfgi_settings *settings)
{
    memset(cascades, 0, sizeof *cascades);
    cascades->count = settings->cascades;
    cascades->resolution = settings->resolution;
    for (uint32_t c = 0; c < cascades->count; c++)
        for (int i = 0; i < 3; i++)
            cascades->at[c].cell_size[i] =
                ldexp(settings->min_cell_size_m, (int)c) * (i == 1 ? sdfgi_settings_y_scale(settings) : 1.0);
}

void sdfgi_cascade_outdate(struct cascade *cascade)
{
    if (cascade->place == CASCADE_CURRENT)
        cascade->place = CASCADE_OUTDATED;
}

bool sdfgi_cascade_overlaps(const struct cascade *cascade, uint32_t resolution, const struct box *box)
{
    const struct cell_box whole = sdfgi_cell_box_whole(resolution);
    const struct box own = sdfgi_cascade_world_box(cascade, &whole);
    return cascade->place != CASCADE_UNPLACED && sdfgi_box_overlaps(&own, box);
}

bool sdfgi_cascade_add_edit(struct cascade *cascade, uint32_t resolution, const struct box *box)
{
    if (!sdfgi_cascade_overlaps(cascade, resolution, box))
        return false;
    sdfgi_box_list_join(cascade->edits, &cascade->edit_count, SDFGI_MAX_CHANGES, box);
    return true;
}

bool sdfgi_cascade_completes(const struct cascade *cascade)
{
    return cascade->change.stage == CHANGE_COMPLETES;
}

bool sdfgi_cascades_complete(const struct cascades *cascades)
{
    for (uint32_t c = 0; c < cascades->count; c++)
        if (sdfgi_cascade_completes(&cascades->at[c]))
            return true;
    return false;
}

bool sdfgi_cascades_are_current(const struct cascades *cascades)
{
    for (uint32_t c = 0; c < cascades->count; c++) {
        const struct cascade *cascade = &cascades->at[c];
        if (cascade->place != CASCADE_CURRENT || cascade->change.cause != CHANGE_NONE ||
            cascade->edit_count > 0)
            return false;
    }
    return true;
}

bool sdfgi_cascades_rest(const struct cascades *cascades)
{
    for (uint32_t c = 0; c < cascades->count; c++)
        if (cascades->at[c].change.cause != CHANGE_NONE || cascades->at[c].following == CASCADE_LEFT_BEHIND)
            return false;
    return true;
}
