/* SPDX-License-Identifier: MIT
 * Stage 2: which part of what cascades need is done in this frame.
 *
 * A cascade that steps keeps serving the cells that its old and its new place share: all volumes are
 * toroidal, so the cells that enter take the storage of those that leave and nothing is held twice. What is
 * new is done in units of whole slices and layers: voxels, then distances, then, in one frame, probes, light
 * cells and light; with that the window opens.
 *
 * Each frame does as much as keeps all cascades just ahead of the camera, near ones first, so that work is
 * even from frame to frame; the budget is a hard limit. Where the camera is faster than the budget, fine
 * cascades wait and coarser ones answer. */
#include "internal.h"

#include <math.h>
#include <string.h>

/* Share of a new direction in the running mean, of a slower pace in that of the pace: a path that winds keeps
 * the pace of its fastest parts. */
#define HEADING_SHARE 0.125
#define PACE_SHARE    0.015625
/* How much more is done than the camera's pace calls for. */
#define HEADROOM 1.15
/* Steps of cascades per frame from which on one frame may complete several. */
#define BUSY_STEPS 0.5
/* Probe spacings that a window may lack on a side before its cascade falls behind: one that is not due yet,
 * one that is being made, one more. */
#define LAG 3.0
/* Share of the budget that cascades may claim before finer ones wait. */
#define CLAIM_SHARE 0.9

static uint64_t layer_cells(const struct sdfgi *gi)
{
    return (uint64_t)gi->settings.resolution * gi->settings.resolution * 4;
}

/* The largest slice that voxels are made in. Settings allow a frame to do that, whatever the resolution. */
static uint64_t slice_cells(const struct sdfgi *gi)
{
    return (uint64_t)gi->settings.resolution * gi->settings.resolution * SDFGI_PROBE_SPACING;
}

static uint64_t distance_cells(const struct sdfgi *gi)
{
    return (uint64_t)gi->settings.resolution * gi->settings.resolution * gi->settings.resolution;
}

/* ---- The camera */

/* The pace is that along the fastest axis, as others step with it. It goes up at once, so that work does not
 * fall behind, and down slowly. A jump is no pace: of two steps in a row, the shorter counts. */
static void follow_camera(struct sdfgi *gi, const double camera[3])
{
    struct schedule *s = &gi->schedule;
    double step[3], longest = 0;
    for (int i = 0; i < 3; i++) {
        const double step_m = s->has_camera ? camera[i] - s->camera[i] : 0;
        step[i] = step_m / (gi->cascades[0].cell_size[i] * SDFGI_PROBE_SPACING);
        longest = fmax(longest, fabs(step[i]));
        s->camera[i] = camera[i];
    }
    const double lasting = fmin(longest, s->last_step);
    s->pace = fmax(lasting, s->pace + PACE_SHARE * (lasting - s->pace));
    for (int i = 0; i < 3; i++)
        s->heading[i] += HEADING_SHARE * ((isnormal(longest) ? step[i] / longest : 0) - s->heading[i]);
    s->last_step = longest;
    s->has_camera = true;
}

/* Steps of a cascade per frame at the camera's pace. */
static double steps_per_frame(const struct sdfgi *gi, uint32_t c)
{
    return fmin(ldexp(gi->schedule.pace, -(int)c), 1);
}

/* Cells that a step along one axis makes new. */
static double cells_per_step(const struct sdfgi *gi)
{
    return (double)(distance_cells(gi) + slice_cells(gi));
}

/* ---- Changes */

static uint64_t generated_cells(const struct change *change, const struct cell_box *whole)
{
    uint64_t cells = 0;
    for (uint32_t i = 0; i < change->count; i++) {
        const struct cell_box inside = cell_box_common(&change->boxes[i], whole);
        cells += cell_box_cells(&inside);
    }
    return cells;
}

static void begin_change(struct sdfgi *gi, struct cascade *cascade)
{
    struct change *change = &cascade->change;
    const struct cell_box whole = cell_box_whole(gi->settings.resolution);
    change->active = true;
    change->box = change->layer = 0;
    change->slice = INT32_MIN;
    change->cells_left = generated_cells(change, &whole) + distance_cells(gi);
    cascade->window = change->kept;
    cascade->rebuild = false;
    light_disturb(gi);
}

static void begin_whole(struct sdfgi *gi, struct cascade *cascade)
{
    cascade->change = (struct change){ .count = 1, .boxes = { cell_box_whole(gi->settings.resolution) } };
    cascade->edit_count = 0;
    /* What lookups read of it grows out from the camera. */
    for (int i = 0; i < 3; i++)
        cascade->share_low[i] = cascade->share_high[i] =
            gi->schedule.camera[i] / cascade->cell_size[i] - (double)cascade->origin[i];
    begin_change(gi, cascade);
}

static int32_t clamped_shift(int64_t shift, uint32_t resolution)
{
    const int64_t most = resolution;
    return (int32_t)(shift > most ? most : shift < -most ? -most : shift);
}

/* Moves a cascade to the place of `next`: keeps what both places share. */
static void begin_step(struct sdfgi *gi, struct cascade *cascade, const struct cascade *next)
{
    const uint32_t n = gi->settings.resolution;
    const struct cell_box whole = cell_box_whole(n);
    int32_t shift[3];
    for (int i = 0; i < 3; i++)
        shift[i] = clamped_shift(cascade->origin[i] - next->origin[i], n);
    const struct cell_box old = cell_box_shifted(&cascade->window, shift);
    const struct cell_box kept = cell_box_common(&whole, &old);
    memcpy(cascade->origin, next->origin, sizeof cascade->origin);
    for (int i = 0; i < 3; i++) {
        cascade->share_low[i] += shift[i];
        cascade->share_high[i] += shift[i];
    }
    cascade->edited = false;
    gi->schedule.steps_begun += !cell_box_empty(&cascade->window);
    if (cell_box_empty(&kept) || cascade->rebuild) {
        begin_whole(gi, cascade);
        return;
    }
    cascade->change = (struct change){ .kept = kept };
    struct change *change = &cascade->change;
    memcpy(change->before, shift, sizeof change->before);
    change->count = cell_box_difference(&whole, &kept, change->boxes);
    change->count += cell_box_difference(&old, &kept, change->boxes + change->count);
    begin_change(gi, cascade);
}

/* Makes the boxes new in which geometry changed. They stay readable meanwhile. */
static void begin_edits(struct sdfgi *gi, struct cascade *cascade)
{
    cascade->change = (struct change){ .kept = cascade->window, .at_once = true };
    struct change *change = &cascade->change;
    for (uint32_t i = 0; i < cascade->edit_count; i++) {
        const struct cell_box box = cascade_cells(cascade, gi->settings.resolution, &cascade->edits[i]);
        if (!cell_box_empty(&box))
            change->boxes[change->count++] = box;
    }
    cascade->edit_count = 0;
    cascade->edited = true;
    if (change->count > 0)
        begin_change(gi, cascade);
}

/* Starts what a cascade that is at rest needs; steps and edits take turns. */
static void begin(struct sdfgi *gi, struct cascade *cascade)
{
    struct cascade next = *cascade;
    const bool moved = cascade_place(&next, gi->settings.resolution, gi->schedule.camera);
    cascade->placed = true;
    const bool steps = moved && (!cascade->waits || cascade->rebuild);
    cascade->left_behind = moved && !steps;
    if (cascade->edit_count > 0 && !cascade->rebuild && !(steps && cascade->edited))
        begin_edits(gi, cascade);
    else if (steps)
        begin_step(gi, cascade, &next);
    else if (cascade->rebuild)
        begin_whole(gi, cascade);
}

/* ---- Steps of this frame */

static struct step *add_step(struct sdfgi *gi, enum step_kind kind, uint32_t cascade)
{
    struct schedule *s = &gi->schedule;
    if (s->step_count == SDFGI_MAX_STEPS)
        return NULL;
    s->steps[s->step_count] = (struct step){ .kind = kind, .cascade = cascade };
    return &s->steps[s->step_count++];
}

static int longest_axis(const struct cell_box *box)
{
    int axis = 2;
    for (int i = 1; i >= 0; i--)
        if (box->high[i] - box->low[i] > box->high[axis] - box->low[axis])
            axis = i;
    return axis;
}

/* Takes slices of the next box, as many as `cells` allow; returns the cells taken. */
static uint64_t take_voxels(struct sdfgi *gi, uint32_t c, uint64_t cells)
{
    struct change *change = &gi->cascades[c].change;
    const struct cell_box whole = cell_box_whole(gi->settings.resolution);
    struct cell_box box = cell_box_common(&change->boxes[change->box], &whole);
    const int axis = longest_axis(&box);
    const int32_t thickness = SDFGI_PROBE_SPACING;
    const uint64_t slice = cell_box_cells(&box) / (uint64_t)((box.high[axis] - box.low[axis]) / thickness);
    box.low[axis] = change->slice > box.low[axis] ? change->slice : box.low[axis];
    const uint64_t left = (uint64_t)(box.high[axis] - box.low[axis]) / (uint64_t)thickness;
    const uint64_t slices = cells / slice < left ? cells / slice : left;
    struct step *step = slices > 0 ? add_step(gi, STEP_VOXELS, c) : NULL;
    if (!step)
        return 0;
    step->box = box;
    step->box.high[axis] = box.low[axis] + (int32_t)slices * thickness;
    change->slice = step->box.high[axis];
    if (slices == left) {
        change->box++;
        change->slice = INT32_MIN;
    }
    return slices * slice;
}

/* Takes layers of distances. A flood cannot be cut: it takes all, whatever the budget. */
static uint64_t take_distances(struct sdfgi *gi, uint32_t c, uint64_t cells)
{
    struct change *change = &gi->cascades[c].change;
    const uint32_t layers = gi->settings.resolution / 4, left = layers - change->layer;
    uint64_t count = cells / layer_cells(gi);
    if (gi->settings.sdf_method == SDFGI_SDF_FLOOD)
        count = cells > 0 ? layers : 0;
    count = count < left ? count : left;
    struct step *step = count > 0 ? add_step(gi, STEP_DISTANCE, c) : NULL;
    if (!step)
        return 0;
    step->first = change->layer;
    step->count = (uint32_t)count;
    change->layer += (uint32_t)count;
    return count * layer_cells(gi);
}

/* The next box with cells in the cascade; `count` if there is none. */
static uint32_t next_box(const struct sdfgi *gi, const struct change *change)
{
    const struct cell_box whole = cell_box_whole(gi->settings.resolution);
    uint32_t box = change->box;
    for (; box < change->count; box++) {
        const struct cell_box inside = cell_box_common(&change->boxes[box], &whole);
        if (!cell_box_empty(&inside))
            break;
    }
    return box;
}

/* True if a window ends too near to the camera, although its cascade could keep up. */
static bool falls_behind(const struct sdfgi *gi, const struct cascade *cascade)
{
    const double half = gi->settings.resolution / 2.0;
    double nearest = half;
    for (int i = 0; i < 3; i++) {
        const double at = gi->schedule.camera[i] / cascade->cell_size[i] - (double)cascade->origin[i];
        nearest = fmin(nearest, fmin(at - cascade->window.low[i], cascade->window.high[i] - at));
    }
    return !cascade->waits && nearest < fmax(half - LAG * SDFGI_PROBE_SPACING, 0);
}

/* True if a change cannot wait for its turn: geometry changed in sight, or the camera runs away. */
static bool hurries(const struct sdfgi *gi, const struct cascade *cascade)
{
    return cascade->change.active &&
           (cascade->change.at_once || gi->schedule.from_nothing || falls_behind(gi, cascade));
}

/* Steps of all cascades per frame, but of those that wait. */
static double steps_of_all(const struct sdfgi *gi)
{
    double steps = 0;
    for (uint32_t c = 0; c < gi->settings.cascades; c++)
        steps += gi->cascades[c].waits ? 0 : steps_per_frame(gi, c);
    return steps;
}

static bool any_hurries(const struct sdfgi *gi)
{
    for (uint32_t c = 0; c < gi->settings.cascades; c++)
        if (hurries(gi, &gi->cascades[c]))
            return true;
    return false;
}

/* That a cascade becomes complete is work of its own: some frames lie between one and the next, as many as
 * the pace leaves time for, unless they hurry. */
static bool may_complete(const struct sdfgi *gi)
{
    const double steps = steps_of_all(gi);
    const bool apart = !schedule_has(gi, STEP_COMPLETE) &&
                       gi->schedule.calm_frames >= fmin(SDFGI_CALM_FRAMES, BUSY_STEPS / steps - 1);
    return apart || steps >= BUSY_STEPS || any_hurries(gi);
}

/* Does as much of a change as the budget allows. */
static void advance(struct sdfgi *gi, uint32_t c, uint64_t *budget)
{
    struct change *change = &gi->cascades[c].change;
    uint64_t done;
    do {
        change->box = next_box(gi, change);
        done = change->box < change->count ? take_voxels(gi, c, *budget) : take_distances(gi, c, *budget);
        change->cells_left -= done;
        *budget -= done < *budget ? done : *budget;
        gi->schedule.cells += done;
    } while (done > 0);
    if (change->cells_left == 0 && may_complete(gi))
        add_step(gi, STEP_COMPLETE, c);
}

static bool any_complete(const struct sdfgi *gi)
{
    for (uint32_t c = 0; c < gi->settings.cascades; c++)
        if (!cell_box_empty(&gi->cascades[c].window))
            return true;
    return false;
}

/* Cascades that the budget can keep at the camera, coarse ones first; the coarsest always may try. */
static void begin_all(struct sdfgi *gi, double budget)
{
    double claimed = 0;
    for (uint32_t c = gi->settings.cascades; c-- > 0;) {
        struct cascade *cascade = &gi->cascades[c];
        claimed += cells_per_step(gi) * steps_per_frame(gi, c);
        cascade->waits = cascade->placed && claimed > budget * CLAIM_SHARE && c + 1 < gi->settings.cascades;
        if (!cascade->change.active)
            begin(gi, cascade);
    }
}

/* What all changes together do in this frame: as much as the camera's pace calls for, in whole layers, so
 * that one frame costs as much as the next; a slice at least, and never more than the setting allows, unless
 * there is nothing to show. */
static uint64_t frame_budget(const struct sdfgi *gi)
{
    const double limit = (double)gi->settings.max_scroll_cells, layer = (double)layer_cells(gi);
    if (gi->schedule.from_nothing)
        return UINT64_MAX;
    if (any_hurries(gi))
        return gi->settings.max_scroll_cells;
    const double called_for = cells_per_step(gi) * steps_of_all(gi) * HEADROOM;
    return (uint64_t)fmin(fmax(ceil(called_for / layer) * layer, (double)slice_cells(gi)), limit);
}

/* Fine cascades first, but before all the coarsest if it falls behind: behind that there is nothing. */
static void advance_all(struct sdfgi *gi, uint64_t budget)
{
    const uint32_t count = gi->settings.cascades,
                   first = hurries(gi, &gi->cascades[count - 1]) ? count - 1 : 0;
    for (uint32_t i = 0; i < count; i++) {
        const uint32_t c = (first + i) % count;
        if (gi->cascades[c].change.active)
            advance(gi, c, &budget);
    }
}

void schedule_frame(struct sdfgi *gi, const double camera[3])
{
    struct schedule *s = &gi->schedule;
    s->calm_frames = schedule_has(gi, STEP_COMPLETE) ? 0 : s->calm_frames + 1;
    s->step_count = 0;
    s->cells = 0;
    follow_camera(gi, camera);
    border_leave(gi);
    begin_all(gi, (double)gi->settings.max_scroll_cells);
    /* With nothing to show, there is nothing to wait for. */
    s->from_nothing = !any_complete(gi);
    if (s->from_nothing)
        s->pace = 0;
    for (uint32_t c = 0; c < gi->settings.cascades; c++)
        gi->cascades[c].fresh = gi->cascades[c].fresh || s->from_nothing;
    advance_all(gi, frame_budget(gi));
    for (uint32_t i = 0; i < s->step_count; i++)
        if (s->steps[i].kind == STEP_COMPLETE)
            gi->cascades[s->steps[i].cascade].window = cell_box_whole(gi->settings.resolution);
    border_move(gi);
}

void schedule_finish(struct sdfgi *gi)
{
    for (uint32_t i = 0; i < gi->schedule.step_count; i++)
        if (gi->schedule.steps[i].kind == STEP_COMPLETE)
            gi->cascades[gi->schedule.steps[i].cascade].change = (struct change){ 0 };
}

bool schedule_has(const struct sdfgi *gi, enum step_kind kind)
{
    for (uint32_t i = 0; i < gi->schedule.step_count; i++)
        if (gi->schedule.steps[i].kind == kind)
            return true;
    return false;
}

bool schedule_completes(const struct sdfgi *gi, uint32_t c)
{
    for (uint32_t i = 0; i < gi->schedule.step_count; i++)
        if (gi->schedule.steps[i].kind == STEP_COMPLETE && gi->schedule.steps[i].cascade == c)
            return true;
    return false;
}

bool schedule_idle(const struct sdfgi *gi)
{
    for (uint32_t c = 0; c < gi->settings.cascades; c++)
        if (gi->cascades[c].change.active || gi->cascades[c].left_behind || gi->cascades[c].relight_left > 0)
            return false;
    return true;
}
