/* SPDX-License-Identifier: MIT */
#include "change.h"

#include <assert.h>
#include <string.h>

struct cell_box sdfgi_change_box(const struct change *change, uint32_t i, uint32_t resolution)
{
    const struct cell_box whole = sdfgi_cell_box_whole(resolution);
    return sdfgi_cell_box_common(&change->boxes[i], &whole);
}

static uint64_t generated_cells(const struct change *change, uint32_t resolution)
{
    uint64_t cells = 0;
    for (uint32_t i = 0; i < change->count; i++) {
        const struct cell_box inside = sdfgi_change_box(change, i, resolution);
        cells += sdfgi_cell_box_cells(&inside);
    }
    return cells;
}

static void begin(struct cascade *cascade, uint32_t resolution, enum change_cause cause)
{
    struct change *change = &cascade->change;
    const uint64_t n = resolution;
    assert(change->cause == CHANGE_NONE && change->stage == CHANGE_IDLE && cause != CHANGE_NONE);
    assert(change->count > 0 && change->count <= SDFGI_MAX_CHANGES);
    assert(cascade->place != CASCADE_UNPLACED);
    change->cause = cause;
    change->stage = CHANGE_BEGUN;
    change->box = change->layer = 0;
    change->slice = INT32_MIN;
    change->cells_left = generated_cells(change, resolution) + n * n * n;
    cascade->valid = change->kept;
    cascade->place = CASCADE_CURRENT;
}

void sdfgi_change_begin_rebuild(struct cascade *cascade, uint32_t resolution, const double camera[static 3])
{
    cascade->change = (struct change){ .count = 1, .boxes = { sdfgi_cell_box_whole(resolution) } };
    cascade->edit_count = 0;
    for (int i = 0; i < 3; i++)
        cascade->blend_low[i] = cascade->blend_high[i] =
            camera[i] / cascade->cell_size[i] - (double)cascade->origin[i];
    begin(cascade, resolution, CHANGE_REBUILD);
}

static int32_t clamped_shift(int64_t shift, uint32_t resolution)
{
    const int64_t most = resolution;
    return (int32_t)(shift > most ? most : shift < -most ? -most : shift);
}

void sdfgi_change_begin_scroll(struct cascade *cascade, uint32_t resolution, const int64_t origin[static 3],
                               const double camera[static 3])
{
    const struct cell_box whole = sdfgi_cell_box_whole(resolution);
    int32_t shift[3];
    for (int i = 0; i < 3; i++)
        shift[i] = clamped_shift(cascade->origin[i] - origin[i], resolution);
    const struct cell_box old = sdfgi_cell_box_shifted(&cascade->valid, shift);
    const struct cell_box kept = sdfgi_cell_box_common(&whole, &old);
    memcpy(cascade->origin, origin, sizeof cascade->origin);
    for (int i = 0; i < 3; i++) {
        cascade->blend_low[i] += shift[i];
        cascade->blend_high[i] += shift[i];
    }
    cascade->last_turn = CHANGE_SCROLL;
    if (sdfgi_cell_box_empty(&kept) || cascade->place == CASCADE_OUTDATED) {
        sdfgi_change_begin_rebuild(cascade, resolution, camera);
        return;
    }
    cascade->change = (struct change){ .kept = kept };
    struct change *change = &cascade->change;
    memcpy(change->before, shift, sizeof change->before);
    change->count = sdfgi_cell_box_difference(&whole, &kept, change->boxes);
    change->count += sdfgi_cell_box_difference(&old, &kept, change->boxes + change->count);
    begin(cascade, resolution, CHANGE_SCROLL);
}

void sdfgi_change_begin_edit(struct cascade *cascade, uint32_t resolution)
{
    struct change change = { .kept = cascade->valid };
    for (uint32_t i = 0; i < cascade->edit_count; i++) {
        const struct cell_box box = sdfgi_cascade_cells(cascade, resolution, &cascade->edits[i]);
        if (!sdfgi_cell_box_empty(&box))
            change.boxes[change.count++] = box;
    }
    cascade->edit_count = 0;
    cascade->last_turn = CHANGE_EDIT;
    if (change.count == 0)
        return;
    cascade->change = change;
    begin(cascade, resolution, CHANGE_EDIT);
}

void sdfgi_change_enter(struct change *change, enum change_stage stage)
{
    assert(change->cause != CHANGE_NONE && change->stage != CHANGE_IDLE);
    assert(stage >= change->stage);
    assert(stage != CHANGE_COMPLETES || change->stage == CHANGE_READY);
    change->stage = stage;
}

void sdfgi_change_finish(struct change *change)
{
    assert(change->stage == CHANGE_COMPLETES && change->cells_left == 0);
    *change = (struct change){ .cause = CHANGE_NONE, .stage = CHANGE_IDLE };
}

uint32_t sdfgi_change_next_box(const struct change *change, uint32_t resolution)
{
    uint32_t box = change->box;
    for (; box < change->count; box++) {
        const struct cell_box inside = sdfgi_change_box(change, box, resolution);
        if (!sdfgi_cell_box_empty(&inside))
            break;
    }
    return box;
}

int32_t sdfgi_change_bounds_axis(const struct change *change)
{
    if (sdfgi_cell_box_empty(&change->kept))
        return -1;
    return change->before[2] != 0 && change->before[0] == 0 && change->before[1] == 0 ? 0 : 2;
}
