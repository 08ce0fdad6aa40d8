/* SPDX-License-Identifier: MIT */
#include "scroll.h"

#include "blend.h"
#include "change.h"

#include <assert.h>
#include <math.h>
#include <string.h>

/* Weights of the newest frame in the running means of the heading and of the pace. The pace falls slowly, so
 * that on a winding path it stays that of the fastest parts. */
#define HEADING_WEIGHT 0.125
#define PACE_WEIGHT    0.015625
/* How much more is done than the camera's pace calls for. */
#define HEADROOM 1.15
/* Scrolls per frame from which on one frame may complete several. */
#define BUSY_SCROLLS 0.5
/* A cascade falls behind if, on some side, its valid region reaches less far from the camera than half the
 * cascade's width less LAG probe spacings. One of these is not due yet, one is being made, one is spare. */
#define LAG 3.0
/* Fraction of the budget that cascades may claim before finer ones wait. */
#define CLAIM_FRACTION 0.9

/* What the functions below work on. */
struct run {
    struct scroll *scroll;
    struct cascades *cascades;
    const struct scroll_limits *limits;
    struct scroll_plan *plan;
};

static uint64_t layer_cells(const struct cascades *cascades)
{
    return (uint64_t)cascades->resolution * cascades->resolution * 4;
}

/* The largest slice that voxels are made in. Settings allow a frame to do that, whatever the resolution. */
static uint64_t slice_cells(const struct cascades *cascades)
{
    return (uint64_t)cascades->resolution * cascades->resolution * SDFGI_PROBE_SPACING;
}

static uint64_t distance_cells(const struct cascades *cascades)
{
    return (uint64_t)cascades->resolution * cascades->resolution * cascades->resolution;
}

/* ---- The camera */

/* The pace is that along the fastest axis, because the other axes scroll with it. It goes up at once, so that
 * work does not fall behind, and down slowly. Of two frames in a row the shorter distance counts, so that a
 * single jump of the camera does not raise the pace. */
static void follow_camera(struct scroll *s, const struct cascade *first, const double camera[static 3])
{
    double moved[3], longest = 0;
    for (int i = 0; i < 3; i++) {
        const double moved_m = s->frames > 0 ? camera[i] - s->camera[i] : 0;
        moved[i] = moved_m / (first->cell_size[i] * SDFGI_PROBE_SPACING);
        longest = fmax(longest, fabs(moved[i]));
        s->camera[i] = camera[i];
    }
    const double sustained = fmin(longest, s->moved);
    s->pace = fmax(sustained, s->pace + PACE_WEIGHT * (sustained - s->pace));
    for (int i = 0; i < 3; i++)
        s->heading[i] += HEADING_WEIGHT * ((isnormal(longest) ? moved[i] / longest : 0) - s->heading[i]);
    s->moved = longest;
    s->frames++;
}

/* Scrolls of a cascade per frame at the camera's pace. */
static double scrolls_per_frame(const struct scroll *s, uint32_t c)
{
    return fmin(ldexp(s->pace, -(int)c), 1);
}

/* Cells that a scroll along one axis makes again. */
static double cells_per_scroll(const struct cascades *cascades)
{
    return (double)(distance_cells(cascades) + slice_cells(cascades));
}

/* ---- Changes begin */

static enum cascade_following following_of(const struct cascade *cascade, bool moved, bool scrolls)
{
    if (cascade->following == CASCADE_KEEPS_UP)
        return CASCADE_KEEPS_UP;
    return moved && !scrolls ? CASCADE_LEFT_BEHIND : CASCADE_WAITS;
}

/* For a cascade that is not being changed, or whose change is out of date: begins the change that it needs,
 * if any. Scrolls and edits take turns. */
static void begin(struct run *run, struct cascade *cascade)
{
    const uint32_t resolution = run->cascades->resolution;
    struct cascade next = *cascade;
    const bool moved = sdfgi_cascade_place(&next, resolution, run->scroll->camera);
    cascade->place = next.place;
    const bool outdated = cascade->place == CASCADE_OUTDATED;
    const bool scrolls = moved && (cascade->following == CASCADE_KEEPS_UP || outdated);
    cascade->following = following_of(cascade, moved, scrolls);
    if (cascade->edit_count > 0 && !outdated && !(scrolls && cascade->last_turn == CHANGE_EDIT)) {
        sdfgi_change_begin_edit(cascade, resolution);
    } else if (scrolls) {
        run->scroll->scrolls_begun += !sdfgi_cell_box_empty(&cascade->valid);
        sdfgi_change_begin_scroll(cascade, resolution, next.origin, run->scroll->camera);
    } else if (outdated) {
        sdfgi_change_begin_rebuild(cascade, resolution, run->scroll->camera);
    }
    if (cascade->change.cause != CHANGE_NONE)
        run->plan->begun |= 1u << (cascade - run->cascades->at);
}

/* Decides which cascades may scroll: they share the budget from the coarsest on, which may always scroll.
 * Then begins a change in each cascade that has none, or whose change is out of date. */
static void begin_all(struct run *run)
{
    struct cascades *all = run->cascades;
    const double budget = (double)run->limits->max_cells;
    double claimed = 0;
    for (uint32_t c = all->count; c-- > 0;) {
        struct cascade *cascade = &all->at[c];
        claimed += cells_per_scroll(all) * scrolls_per_frame(run->scroll, c);
        const bool waits =
            cascade->place != CASCADE_UNPLACED && claimed > budget * CLAIM_FRACTION && c + 1 < all->count;
        if (!waits)
            cascade->following = CASCADE_KEEPS_UP;
        else if (cascade->following == CASCADE_KEEPS_UP)
            cascade->following = CASCADE_WAITS;
        if (cascade->change.cause == CHANGE_NONE || cascade->place == CASCADE_OUTDATED)
            begin(run, cascade);
    }
}

/* ---- Pieces of this frame */

static struct scroll_piece *add_piece(struct run *run, enum piece_kind kind, uint32_t c)
{
    struct scroll_plan *plan = run->plan;
    if (plan->piece_count == SCROLL_MAX_PIECES)
        return NULL;
    plan->pieces[plan->piece_count] = (struct scroll_piece){ .kind = kind, .cascade = c };
    return &plan->pieces[plan->piece_count++];
}

/* Takes slices of the next box, as many as `cells` allow; returns the cells taken. Boxes begin and end at
 * multiples of SDFGI_PROBE_SPACING, so slices fill them. */
static uint64_t take_voxels(struct run *run, uint32_t c, uint64_t cells)
{
    struct change *change = &run->cascades->at[c].change;
    struct cell_box box = sdfgi_change_box(change, change->box, run->cascades->resolution);
    const int axis = sdfgi_cell_box_longest_axis(&box);
    const int32_t thickness = SDFGI_PROBE_SPACING;
    const uint64_t slice =
        sdfgi_cell_box_cells(&box) / (uint64_t)((box.high[axis] - box.low[axis]) / thickness);
    box.low[axis] = change->slice > box.low[axis] ? change->slice : box.low[axis];
    const uint64_t left = (uint64_t)(box.high[axis] - box.low[axis]) / (uint64_t)thickness;
    const uint64_t slices = cells / slice < left ? cells / slice : left;
    struct scroll_piece *piece = slices > 0 ? add_piece(run, PIECE_VOXELS, c) : NULL;
    if (!piece)
        return 0;
    piece->begins = change->stage == CHANGE_BEGUN;
    sdfgi_change_enter(change, CHANGE_VOXELS);
    piece->box = box;
    piece->box.high[axis] = box.low[axis] + (int32_t)slices * thickness;
    change->slice = piece->box.high[axis];
    if (slices == left) {
        change->box++;
        change->slice = INT32_MIN;
    }
    return slices * slice;
}

/* Takes layers of distances. A flood cannot be cut: it takes all, whatever the budget. */
static uint64_t take_distances(struct run *run, uint32_t c, uint64_t cells)
{
    struct change *change = &run->cascades->at[c].change;
    const uint32_t layers = run->cascades->resolution / 4, left = layers - change->layer;
    const uint64_t layer = layer_cells(run->cascades);
    uint64_t count = run->limits->flood ? (cells > 0 ? layers : 0) : cells / layer;
    count = count < left ? count : left;
    sdfgi_change_enter(change, left > 0 ? CHANGE_DISTANCES : CHANGE_READY);
    struct scroll_piece *piece = count > 0 ? add_piece(run, PIECE_DISTANCES, c) : NULL;
    if (!piece)
        return 0;
    piece->first = change->layer;
    piece->count = (uint32_t)count;
    piece->finds_bits = change->layer == 0 || run->cascades->searched != c;
    run->cascades->searched = c;
    change->layer += (uint32_t)count;
    return count * layer;
}

/* ---- What is urgent */

/* True if the valid region of a cascade that may scroll ends too near the camera. */
static bool falls_behind(const struct run *run, const struct cascade *cascade)
{
    const double half = run->cascades->resolution / 2.0;
    double nearest = half;
    for (int i = 0; i < 3; i++) {
        const double at = run->scroll->camera[i] / cascade->cell_size[i] - (double)cascade->origin[i];
        nearest = fmin(nearest, fmin(at - cascade->valid.low[i], cascade->valid.high[i] - at));
    }
    return cascade->following == CASCADE_KEEPS_UP && nearest < fmax(half - LAG * SDFGI_PROBE_SPACING, 0);
}

/* True if a change calls for the whole budget: geometry changed in sight, nothing is shown yet, or the camera
 * runs away or was elsewhere. */
static bool hurries(const struct run *run, const struct cascade *cascade)
{
    return cascade->change.cause != CHANGE_NONE && (cascade->change.cause == CHANGE_EDIT || cascade->cut ||
                                                    run->plan->from_nothing || falls_behind(run, cascade));
}

static bool any_hurries(const struct run *run)
{
    for (uint32_t c = 0; c < run->cascades->count; c++)
        if (hurries(run, &run->cascades->at[c]))
            return true;
    return false;
}

/* Scrolls of all cascades per frame, except those that wait. */
static double scrolls_of_all(const struct run *run)
{
    double scrolls = 0;
    for (uint32_t c = 0; c < run->cascades->count; c++)
        scrolls += run->cascades->at[c].following == CASCADE_KEEPS_UP ? scrolls_per_frame(run->scroll, c) : 0;
    return scrolls;
}

/* Frames that may lie between two completions at the camera's pace: less than 0 where one frame may complete
 * several. */
static double frames_apart(const struct run *run)
{
    return fmin(SCROLL_CALM_FRAMES, BUSY_SCROLLS / scrolls_of_all(run) - 1);
}

/* The frame after a completion traces the rays of new probes. At a slow pace voxels wait for the next one. */
static bool voxels_wait(const struct run *run)
{
    return run->scroll->calm_frames == 0 && frames_apart(run) >= SCROLL_CALM_FRAMES && !any_hurries(run);
}

/* Completing a cascade is extra work, so up to SCROLL_CALM_FRAMES frames lie between two completions, fewer
 * if the camera is fast. From BUSY_SCROLLS on, or if a change hurries, one frame may complete several. */
static bool may_complete(const struct run *run)
{
    const double scrolls = scrolls_of_all(run);
    const bool apart =
        !sdfgi_cascades_complete(run->cascades) && run->scroll->calm_frames >= frames_apart(run);
    return apart || scrolls >= BUSY_SCROLLS || any_hurries(run);
}

/* ---- Changes go on */

/* Does as much of a change as the budget allows. */
static void advance(struct run *run, uint32_t c, uint64_t *budget)
{
    struct change *change = &run->cascades->at[c].change;
    uint64_t done;
    do {
        change->box = sdfgi_change_next_box(change, run->cascades->resolution);
        if (change->box < change->count)
            done = voxels_wait(run) ? 0 : take_voxels(run, c, *budget);
        else
            done = take_distances(run, c, *budget);
        assert(done <= change->cells_left);
        change->cells_left -= done;
        *budget -= done < *budget ? done : *budget;
        run->plan->cells += done;
    } while (done > 0);
    if (change->cells_left == 0 && may_complete(run))
        sdfgi_change_enter(change, CHANGE_COMPLETES);
}

/* The cells that all changes together may do in this frame. The camera's pace with HEADROOM calls for so
 * many, in whole layers, so that one frame costs as much as the next. It is a slice at least. If a change
 * hurries, it is all that the setting allows; if nothing is shown yet, there may be no limit. */
static uint64_t frame_budget(const struct run *run)
{
    const double limit = (double)run->limits->max_cells, layer = (double)layer_cells(run->cascades);
    if (run->plan->from_nothing && !run->limits->starts_in_parts)
        return UINT64_MAX;
    if (any_hurries(run))
        return run->limits->max_cells;
    const double called_for = cells_per_scroll(run->cascades) * scrolls_of_all(run) * HEADROOM;
    return (uint64_t)fmin(fmax(ceil(called_for / layer) * layer, (double)slice_cells(run->cascades)), limit);
}

/* Fine cascades go first. The coarsest one goes before them if it hurries, because no other cascade covers
 * its place. An edit there stays in order, because the old cells can be read until it is done. */
static void advance_all(struct run *run, uint64_t budget)
{
    const uint32_t count = run->cascades->count;
    const struct cascade *coarsest = &run->cascades->at[count - 1];
    const uint32_t first = hurries(run, coarsest) && coarsest->change.cause != CHANGE_EDIT ? count - 1 : 0;
    for (uint32_t i = 0; i < count; i++) {
        const uint32_t c = (first + i) % count;
        if (run->cascades->at[c].change.cause != CHANGE_NONE)
            advance(run, c, &budget);
    }
}

static bool any_valid(const struct cascades *cascades)
{
    for (uint32_t c = 0; c < cascades->count; c++)
        if (!sdfgi_cell_box_empty(&cascades->at[c].valid))
            return true;
    return false;
}

void sdfgi_scroll_init(struct scroll *scroll)
{
    *scroll = (struct scroll){ .calm_frames = 1 };
}

void sdfgi_scroll_cut(struct scroll *scroll, struct cascades *cascades)
{
    scroll->frames = 0;
    scroll->moved = scroll->pace = 0;
    for (int i = 0; i < 3; i++)
        scroll->heading[i] = 0;
    for (uint32_t c = 0; c < cascades->count; c++) {
        cascades->at[c].cut = true;
        for (int i = 0; i < 3; i++)
            cascades->at[c].spare[i] = 0;
    }
}

/* A cascade has arrived where the camera wants it, and all that it has is shown. */
static void end_cut(const struct run *run, struct cascade *cascade)
{
    struct cascade next = *cascade;
    const bool changes = cascade->change.cause != CHANGE_NONE && !sdfgi_cascade_completes(cascade);
    if (!changes && !sdfgi_cascade_place(&next, run->cascades->resolution, run->scroll->camera))
        cascade->cut = false;
}

void sdfgi_scroll_plan(struct scroll *scroll, struct cascades *cascades, const struct scroll_limits *limits,
                       const double camera[static 3], bool blend_jumps, struct scroll_plan *plan)
{
    struct run run = { scroll, cascades, limits, plan };
    memset(plan, 0, sizeof *plan);
    follow_camera(scroll, &cascades->at[0], camera);
    sdfgi_blend_reserve(cascades, scroll);
    begin_all(&run);
    plan->from_nothing = !any_valid(cascades);
    /* A teleport says nothing of the camera's speed: later frames do not keep its pace. */
    if (plan->from_nothing)
        scroll->pace = 0;
    if (plan->from_nothing && limits->starts_in_parts)
        sdfgi_scroll_cut(scroll, cascades);
    advance_all(&run, frame_budget(&run));
    for (uint32_t c = 0; c < cascades->count; c++)
        if (sdfgi_cascade_completes(&cascades->at[c]))
            cascades->at[c].valid = sdfgi_cell_box_whole(cascades->resolution);
    sdfgi_blend_move(cascades, scroll, blend_jumps || plan->from_nothing);
    for (uint32_t c = 0; c < cascades->count; c++)
        end_cut(&run, &cascades->at[c]);
}

void sdfgi_scroll_finish(struct scroll *scroll, struct cascades *cascades)
{
    scroll->calm_frames = sdfgi_cascades_complete(cascades) ? 0 : scroll->calm_frames + 1;
    for (uint32_t c = 0; c < cascades->count; c++)
        if (sdfgi_cascade_completes(&cascades->at[c]))
            sdfgi_change_finish(&cascades->at[c].change);
}

bool sdfgi_scroll_plan_has(const struct scroll_plan *plan, enum piece_kind kind)
{
    for (uint32_t i = 0; i < plan->piece_count; i++)
        if (plan->pieces[i].kind == kind)
            return true;
    return false;
}
