/* SPDX-License-Identifier: MIT
 * Stage 6: lists the light cells of a cascade, finds which probes each sees, lights them directly, and adds
 * emission and what the probes bring. */
#include "internal.h"

/* Room beyond what is needed, so that a scene that grows a little does not grow the list each time. */
#define SPARE_SHARE 8
/* Workgroups that share a row of 64 blocks: along the ground it holds a thousand cells. */
#define LIST_SHARES 4
/* Blocks of which a workgroup marks the light cells. On a CPU looking for the next one in vain takes as long
 * as marking it: with one for each a step of 64^3 takes 42 ms there instead of 17. */
#define MARK_BLOCKS     1
#define MARK_BLOCKS_CPU 16
/* Of frames that all complete a step one in so many lights cells again that stay. */
#define RELIGHT_PATIENCE 4

static uint64_t most_light_cells(const struct sdfgi *gi)
{
    uint64_t most = 0;
    for (uint32_t c = 0; c < gi->settings.cascades; c++)
        if (gi->counters[SDFGI_COUNTER_LIGHT_CELLS + c] > most)
            most = gi->counters[SDFGI_COUNTER_LIGHT_CELLS + c];
    return most;
}

void light_cache_make_room(struct sdfgi *gi)
{
    struct resources *r = gi->resources;
    const uint64_t needed = most_light_cells(gi), wanted = needed + needed / SPARE_SHARE;
    const uint64_t room = wanted < r->extent.light_cells_max ? wanted : r->extent.light_cells_max;
    if (needed <= r->extent.light_cells || needed == r->light_cells_refused)
        return;
    if (room > r->extent.light_cells && resources_grow_light_cells(gi, room)) {
        for (uint32_t c = 0; c < gi->settings.cascades; c++)
            gi->cascades[c].relist = true;
        return;
    }
    if (r->light_cells_refused == 0)
        message(gi, SDFGI_MESSAGE_LIGHT_CELLS_OVERFLOW,
                "sdfgi_update: %llu light cells in a cascade, room for %llu, and no memory for more",
                (unsigned long long)needed, (unsigned long long)r->extent.light_cells);
    r->light_cells_refused = needed;
}

/* ---- Which direct light is to be made
 *
 * A cell that is listed as new is lit in the same frame. Those that stay keep their direct light; but
 * surfaces that came or went may throw shadows on them, or throw them no more. They are lit again over the
 * following frames, so many a frame. */

bool light_cache_is_new(const struct sdfgi *gi, uint32_t c)
{
    const struct cascade *cascade = &gi->cascades[c];
    return cascade->relist || (schedule_completes(gi, c) && cell_box_empty(&cascade->change.kept));
}

/* Cells in a list: as counted once the count of this list has come back, till then all it has room for. */
static uint32_t listed_cells(const struct sdfgi *gi, uint32_t c)
{
    const uint32_t room = (uint32_t)gi->resources->extent.light_cells;
    const uint32_t count = gi->counters[SDFGI_COUNTER_LIGHT_CELLS + c];
    return gi->frame >= gi->cascades[c].listed_at + gi->frames_in_flight && count < room ? count : room;
}

/* Goes on to the next entry that there is. */
static void skip_room(struct sdfgi *gi, uint32_t c)
{
    struct cascade *cascade = &gi->cascades[c];
    const uint32_t room = (uint32_t)gi->resources->extent.light_cells, cells = listed_cells(gi, c);
    while (cascade->relight_left > 0 && cascade->relight_next >= cells) {
        const uint32_t gap = room - cascade->relight_next;
        cascade->relight_left -= gap < cascade->relight_left ? gap : cascade->relight_left;
        cascade->relight_next = 0;
    }
}

bool light_cache_relights(const struct sdfgi *gi)
{
    for (uint32_t c = 0; c < gi->settings.cascades; c++)
        if (gi->cascades[c].relight_left > 0)
            return true;
    return false;
}

/* Where the list changes while a pass over it is under way, the pass goes on at the same entry until it has
 * come round once more: it may have passed by cells that have moved to entries before it. */
void light_cache_plan(struct sdfgi *gi)
{
    const uint32_t room = (uint32_t)gi->resources->extent.light_cells;
    uint32_t dirty = 0;
    for (uint32_t c = 0; c < gi->settings.cascades; c++) {
        if (schedule_completes(gi, c))
            dirty = c + 1;
        if (schedule_completes(gi, c) || gi->cascades[c].relist)
            gi->cascades[c].listed_at = gi->frame;
    }
    if (!light_cache_relights(gi))
        gi->relight_cascade = 0;
    for (uint32_t c = 0; c < gi->settings.cascades; c++) {
        struct cascade *cascade = &gi->cascades[c];
        if (c < dirty)
            cascade->relight_left = room;
        if (light_cache_is_new(gi, c) || gi->lights_changed || gi->scene.lights.count == 0)
            cascade->relight_left = 0;
        skip_room(gi, c);
    }
}

/* ---- Recording */

static uint32_t groups_for(uint64_t cells, uint32_t per_group)
{
    return (uint32_t)((cells + per_group - 1) / per_group);
}

static uint32_t one_row(uint32_t groups)
{
    return groups < SDFGI_MAX_GROUPS ? groups : SDFGI_MAX_GROUPS;
}

/* Of light_direct. Where few threads run at once none should be idle. */
static uint32_t threads_per_ray(const struct frame *frame)
{
    return frame->gi->device.is_cpu ? 1 : SDFGI_GROUP_SURFACES;
}

static void record_range(struct frame *frame, uint32_t c, uint32_t first, uint32_t count)
{
    const struct sdfgi_light_direct_args args = { .cascade = c,
                                                  .first = first,
                                                  .end = first + count,
                                                  .threads_per_ray = threads_per_ray(frame) };
    pass_begin(frame, PASS_LIGHT_DIRECT);
    const uint32_t groups = groups_for(count, SDFGI_CELLS_OF_SURFACES);
    pass_dispatch(frame, PASS_LIGHT_DIRECT, PASS_ARGS(args), one_row(groups),
                  (groups + SDFGI_MAX_GROUPS - 1) / SDFGI_MAX_GROUPS, 1);
    frame->gi->passes[PASS_LIGHT_DIRECT].work += count;
    pass_end(frame);
}

/* Cells of the blocks that a change renews, some of them more than once: those in cages that touch it. */
static uint64_t dirty_cells(const struct sdfgi *gi, uint32_t c)
{
    if (light_cache_is_new(gi, c))
        return gi->resources->extent.cells;
    const struct change *change = &gi->cascades[c].change;
    const struct cell_box whole = cell_box_whole(gi->settings.resolution);
    uint64_t cells = 0;
    for (uint32_t i = 0; i < change->count; i++) {
        struct cell_box box = change->boxes[i];
        for (int k = 0; k < 3; k++) {
            box.low[k] -= SDFGI_PROBE_SPACING;
            box.high[k] += SDFGI_PROBE_SPACING;
        }
        box = cell_box_common(&box, &whole);
        cells += cell_box_cells(&box);
    }
    return cells;
}

static uint64_t list_blocks(const struct sdfgi *gi)
{
    return gi->resources->extent.cells / 64;
}

void light_cache_clear_record(struct frame *frame)
{
    const uint64_t words = sdfgi_scratch_light_before(frame->gi->params.resolution_log2);
    pass_clear(frame, RESOURCE_SCRATCH, 0, 4 * words);
}

void light_cache_mark_record(struct frame *frame, uint32_t c)
{
    struct sdfgi *gi = frame->gi;
    const struct sdfgi_light_mark_args args = { .cascade = c, .rebuild = light_cache_is_new(gi, c) };
    const uint64_t cells = dirty_cells(gi, c), room = gi->resources->extent.light_cells;
    pass_begin(frame, PASS_LIGHT_MARK);
    const uint32_t per_group = SDFGI_GROUP_LINEAR * (gi->device.is_cpu ? MARK_BLOCKS_CPU : MARK_BLOCKS);
    pass_dispatch(frame, PASS_LIGHT_MARK, PASS_ARGS(args), one_row(groups_for(cells > room ? cells : room, per_group)),
                  1, 1);
    gi->passes[PASS_LIGHT_MARK].work += cells;
    pass_end(frame);
}

void light_cache_list_record(struct frame *frame, uint32_t c)
{
    struct sdfgi *gi = frame->gi;
    const struct sdfgi_cascade_args args = { .cascade = c };
    pass_begin(frame, PASS_LIGHT_LIST);
    pass_dispatch(frame, PASS_LIGHT_LIST, PASS_ARGS(args), (uint32_t)(list_blocks(gi) / SDFGI_GROUP_LINEAR),
                  LIST_SHARES, 1);
    gi->passes[PASS_LIGHT_LIST].work += gi->counters[SDFGI_COUNTER_LIGHT_CELLS + c];
    pass_end(frame);
}

/* A pass over the cells in renewed blocks. */
static void record_dirty(struct frame *frame, enum pass pass, struct pass_args args, uint32_t c)
{
    if (!frame->gi->plan[pass].run)
        return;
    pass_begin(frame, pass);
    pass_dispatch_dirty(frame, pass, args, c);
    pass_end(frame);
}

void light_cache_renew_record(struct frame *frame, uint32_t c)
{
    const struct sdfgi_light_direct_args direct = { .cascade = c,
                                                    .only_dirty = 1,
                                                    .threads_per_ray = threads_per_ray(frame) };
    const struct sdfgi_cascade_args mask = { c };
    record_dirty(frame, PASS_LIGHT_DIRECT, PASS_ARGS(direct), c);
    record_dirty(frame, PASS_CELL_MASK, PASS_ARGS(mask), c);
}

void light_cache_renew_bounce_record(struct frame *frame, uint32_t c)
{
    const struct sdfgi_light_bounce_args args = { .cascade = c,
                                                  .only_dirty = 1,
                                                  .without_probes = !frame->gi->cascades[c].published };
    record_dirty(frame, PASS_LIGHT_BOUNCE, PASS_ARGS(args), c);
}

/* Goes on with a cascade, at most to the end of its list; returns how many cells that was. */
static uint32_t relight_part(struct frame *frame, uint32_t c, uint32_t most)
{
    struct cascade *cascade = &frame->gi->cascades[c];
    if (cascade->relight_left == 0)
        return 0;
    uint32_t count = listed_cells(frame->gi, c) - cascade->relight_next;
    count = count < cascade->relight_left ? count : cascade->relight_left;
    count = count < most ? count : most;
    record_range(frame, c, cascade->relight_next, count);
    cascade->relight_next += count;
    cascade->relight_left -= count;
    skip_room(frame->gi, c);
    return count;
}

void light_cache_relight_record(struct frame *frame)
{
    struct sdfgi *gi = frame->gi;
    /* A frame in which a step becomes complete has enough to do, but that may be so in every frame. */
    gi->relight_waits = gi->takes_step ? (gi->relight_waits + 1) % RELIGHT_PATIENCE : 0;
    if (gi->relight_waits > 0 || !light_cache_relights(gi))
        return;
    light_disturb(gi);
    uint32_t left = gi->relight_budget;
    for (uint32_t i = 0; i < gi->settings.cascades && left > 0; i++) {
        left -= relight_part(frame, gi->relight_cascade, left);
        /* In turn, so that changes frame after frame do not keep coarse cascades waiting for ever. */
        if (left > 0)
            gi->relight_cascade = (gi->relight_cascade + 1) % gi->settings.cascades;
    }
}

void light_cache_direct_record(struct frame *frame, uint32_t c)
{
    record_range(frame, c, 0, listed_cells(frame->gi, c));
}

void light_cache_bounce_record(struct frame *frame)
{
    struct sdfgi *gi = frame->gi;
    struct sdfgi_light_bounce_args args = { .without_probes = !gi->cascades[0].published };
    uint32_t most = 0;
    for (uint32_t c = 0; c < gi->settings.cascades; c++) {
        const uint32_t cells = listed_cells(gi, c);
        most = cells > most ? cells : most;
        gi->passes[PASS_LIGHT_BOUNCE].work += gi->counters[SDFGI_COUNTER_LIGHT_CELLS + c];
    }
    args.end = most;
    pass_begin(frame, PASS_LIGHT_BOUNCE);
    pass_dispatch(frame, PASS_LIGHT_BOUNCE, PASS_ARGS(args), groups_for(most, SDFGI_GROUP_LINEAR),
                  gi->settings.cascades, 1);
    pass_end(frame);
}
