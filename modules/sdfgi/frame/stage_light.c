/* SPDX-License-Identifier: MIT
 * Stages 6 and 7 for all cascades: direct light that changed, rays, probes, light that bounces. */
#include "stage.h"

/* Lights ranges of several cascades in one dispatch, as far as lights that have changed reach. */
static void add_direct(const struct plan_stage *stage, const struct relight_range *ranges, uint32_t count,
                       const struct light_bits *lights, uint32_t lit)
{
    if (count == 0)
        return;
    struct work *work = sdfgi_stage_add(stage, PASS_LIGHT_DIRECT, 0);
    struct sdfgi_light_direct_args *args = &work->args.light_direct;
    args->threads_per_ray = stage->input->threads_per_ray;
    args->changed = lights->changed;
    args->moved = lights->moved;
    args->lit = lit;
    for (uint32_t i = 0; i < count; i++) {
        const struct relight_range *range = &ranges[i];
        args->first[range->cascade] = range->first;
        args->end[range->cascade] = range->first + range->count;
        work->count = range->count > work->count ? range->count : work->count;
        work->units += range->count;
    }
}

/* Probes hold light once a frame has shown it: in this one, that is the case behind PROBE_BLEND. */
static bool probes_are_dark(const struct plan_stage *stage)
{
    return !sdfgi_work_has(&stage->frame->work, PASS_PROBE_BLEND) &&
           stage->frame->next.accumulation.phase == LIGHTING_DARK;
}

/* Light cells that a frame visits. */
static uint64_t visits_of(const struct gather_range *ranges, uint32_t count)
{
    uint64_t visits = 0;
    for (uint32_t i = 0; i < count; i++)
        visits += ranges[i].count + ranges[i].watched_count;
    return visits;
}

/* Lets a pass run over the cells that the frame visits. */
static void run_over_visits(const struct plan_stage *stage, struct work *work, uint32_t record)
{
    work->indirect = record;
    work->records = RESOURCE_SEEN;
    work->units = visits_of(stage->frame->gathers, stage->frame->gather_count);
}

/* Lets a pass run over all entries. `end` is that of its arguments. The list of each cascade takes whole
 * workgroups of SDFGI_GROUP_LINEAR. */
static void run_over_all(const struct plan_stage *stage, struct work *work,
                         uint32_t end[static SDFGI_MAX_CASCADES])
{
    const struct frame *frame = stage->frame;
    const uint32_t group = SDFGI_GROUP_LINEAR;
    for (uint32_t c = 0; c < frame->next.cascades.count; c++) {
        end[c] = sdfgi_light_list_entries(&frame->next.relight, &stage->input->lists, c);
        work->count += (end[c] + group - 1) / group * group;
        work->units += end[c];
    }
}

/* What arrives at surfaces and leaves them. */
static struct work *add_bounce(const struct plan_stage *stage)
{
    struct work *work = sdfgi_stage_add(stage, PASS_LIGHT_BOUNCE, 0);
    work->args.light_bounce.without_probes = probes_are_dark(stage);
    return work;
}

static void bounce_visited(const struct plan_stage *stage)
{
    struct work *work = add_bounce(stage);
    work->args.light_bounce.visited = 1;
    run_over_visits(stage, work, SDFGI_VISITS_BOUNCE);
}

/* What lookups show of it: a run of the filter. */
static void filter_visited(const struct plan_stage *stage, enum pass pass)
{
    struct work *work = sdfgi_stage_add(stage, pass, 0);
    if (!work)
        return;
    work->args.cell_filter.visited = 1;
    run_over_visits(stage, work, SDFGI_VISITS_FILTER);
}

/* Both, of all entries. */
static void bounce_all(const struct plan_stage *stage)
{
    static const enum pass filters[] = { PASS_CELL_FILTER, PASS_CELL_FILTER_FAR };
    struct work *bounce = add_bounce(stage);
    run_over_all(stage, bounce, bounce->args.light_bounce.end);
    for (size_t i = 0; i < sizeof filters / sizeof *filters; i++) {
        struct work *work = sdfgi_stage_add(stage, filters[i], 0);
        if (work)
            run_over_all(stage, work, work->args.cell_filter.end);
    }
}

/* What leaves cells that this frame has lit directly. What arrives does not change. */
static void bounce_lit(const struct plan_stage *stage)
{
    struct work *work = add_bounce(stage);
    work->args.light_bounce.lit = stage->frame->next.relight.lit;
    run_over_all(stage, work, work->args.light_bounce.end);
}

/* Lights changed: cells that were there before, as far as these reach. */
static void light_directly(const struct plan_stage *stage)
{
    const struct frame *frame = stage->frame;
    struct relight_range ranges[SDFGI_MAX_CASCADES];
    uint32_t count = 0;
    for (uint32_t c = 0; c < frame->next.cascades.count; c++) {
        if (sdfgi_frame_relist(frame, c) == RELIST_NEW)
            continue;
        const uint32_t entries = sdfgi_light_list_entries(&frame->next.relight, &stage->input->lists, c);
        ranges[count++] = (struct relight_range){ c, 0, entries };
    }
    add_direct(stage, ranges, count, &frame->lights, frame->next.relight.lit);
    if (count > 0)
        bounce_lit(stage);
}

/* Lights this frame's part of the cells again on which shadows may have changed. What leaves them changes
 * with their next visit. */
static void relight(const struct plan_stage *stage)
{
    struct frame *frame = stage->frame;
    const struct light_bits lights = sdfgi_relight_lights(&frame->next.relight);
    struct relight_range ranges[SDFGI_MAX_CASCADES];
    const uint32_t count = sdfgi_relight_take(&frame->next.relight, &stage->input->lists,
                                              frame->situation.scroll_completes, ranges);
    add_direct(stage, ranges, count, &lights, lights.changed == SDFGI_LIGHT_ALL ? 0 : SDFGI_LIGHT_DRIFTED);
    if (count > 0)
        sdfgi_accumulation_invalidate(&frame->next.accumulation);
}

/* How many rays are traced comes back frames later: the work is that of the newest frame known. */
static void add_probe_trace(const struct plan_stage *stage)
{
    struct work *work = sdfgi_stage_add(stage, PASS_PROBE_TRACE, 0);
    if (!work)
        return;
    work->indirect = SDFGI_INDIRECT_RAYS;
    work->units = stage->input->counters[SDFGI_COUNTER_RAYS_TRACED];
}

static void clear_change(const struct plan_stage *stage, const struct gather_range *range)
{
    static const uint32_t counters[] = { SDFGI_COUNTER_CELL_CHANGE, SDFGI_COUNTER_CELLS_CHANGING,
                                         SDFGI_COUNTER_CELL_DRIFT };
    const uint64_t first = sdfgi_gather_counters_offset(&stage->input->extent);
    for (size_t i = 0; i < sizeof counters / sizeof *counters; i++)
        sdfgi_work_add_clear(&stage->frame->work, RESOURCE_GATHERED,
                             first + 4 * (counters[i] - SDFGI_COUNTER_GATHER + range->cascade), 4);
}

/* Words of marks that hold what is visited: in the cascade that has most of them. */
static uint32_t words_of(const struct gathering *gathering, const struct gather_range *range)
{
    const uint32_t end = range->first + range->count, watched = gathering->at[range->cascade].watched_end;
    return ((end > watched ? end : watched) + SDFGI_SEEN_BITS - 1) / SDFGI_SEEN_BITS;
}

/* Lists the light cells that are visited. */
static void list_visits(const struct plan_stage *stage)
{
    static const enum pass passes[SDFGI_VISITS_RECORDS] = {
        [SDFGI_VISITS_GATHER] = PASS_CELL_GATHER,
        [SDFGI_VISITS_BOUNCE] = PASS_LIGHT_BOUNCE,
        [SDFGI_VISITS_FILTER] = PASS_CELL_FILTER,
    };
    const struct frame *frame = stage->frame;
    struct work *work = sdfgi_stage_add(stage, PASS_VISIT_LIST, 0);
    if (!work)
        return;
    struct sdfgi_visit_list_args *args = &work->args.visit_list;
    for (uint32_t i = 0; i < SDFGI_VISITS_RECORDS; i++)
        args->groups[i] = sdfgi_work_group_size(passes[i], &stage->input->extent, stage->input->software);
    if (!stage->input->software) /* a workgroup has shared memory for so many rays */
        args->groups[SDFGI_VISITS_GATHER] /= sdfgi_gathering_new_rays(&frame->next.gathering);
    for (uint32_t i = 0; i < frame->gather_count; i++) {
        const struct gather_range *range = &frame->gathers[i];
        const uint32_t words = words_of(&frame->next.gathering, range);
        args->first[range->cascade] = range->first;
        args->end[range->cascade] = range->first + range->count;
        work->count = words > work->count ? words : work->count;
    }
    work->units = visits_of(frame->gathers, frame->gather_count);
}

/* Rays of light cells. */
static void gather(const struct plan_stage *stage)
{
    const struct frame *frame = stage->frame;
    struct work *work = sdfgi_stage_add(stage, PASS_CELL_GATHER, 0);
    if (!work)
        return;
    struct sdfgi_cell_gather_args *args = &work->args.cell_gather;
    run_over_visits(stage, work, SDFGI_VISITS_GATHER);
    work->variant = frame->next.low_light ? PASS_LOBES : PASS_PLAIN;
    for (uint32_t i = 0; i < frame->gather_count; i++) {
        const struct gather_range *range = &frame->gathers[i];
        args->visits[range->cascade] = range->visits;
        args->marks |= (uint32_t)range->marks << range->cascade;
    }
    args->new_rays = sdfgi_gathering_new_rays(&frame->next.gathering);
    work->units *= sdfgi_extent_visit_rays(&stage->input->extent) * args->new_rays;
}

/* A pass of the distances that are made beside light. */
static void add_beside(const struct plan_stage *stage, enum pass pass)
{
    const struct scroll_piece *piece = sdfgi_stage_piece_beside(stage);
    if (piece)
        sdfgi_stage_add_pass(stage, pass, &(struct plan_target){ piece->cascade, piece });
}

/* This frame's rays, and some direct light beside them. */
static void trace(const struct plan_stage *stage)
{
    const uint32_t lists = sdfgi_stage_begin_group(stage);
    sdfgi_stage_add_phase(stage, PHASE_RAYS, &(struct plan_target){ 0 });
    list_visits(stage);
    add_beside(stage, PASS_DISTANCE_PREPARE);
    sdfgi_stage_end_group(stage, lists);
    for (uint32_t i = 0; i < stage->frame->gather_count; i++)
        if (stage->frame->gathers[i].begins_cycle)
            clear_change(stage, &stage->frame->gathers[i]);
    if (stage->frame->situation.gathers && sdfgi_gathering_forgets_hit(&stage->frame->next.gathering))
        for (uint32_t c = 0; c < stage->frame->next.cascades.count; c++)
            sdfgi_stage_forget_hit(stage, c);
    const uint32_t first = sdfgi_stage_begin_group(stage);
    add_probe_trace(stage);
    gather(stage);
    if (stage->needs->holds[NEED_DIRECT] && !sdfgi_frame_lights_all(stage->frame))
        relight(stage);
    sdfgi_stage_end_group(stage, first);
    if (stage->frame->situation.gathers && sdfgi_gathering_forgets_seen(&stage->frame->next.gathering))
        for (uint32_t c = 0; c < stage->frame->next.cascades.count; c++)
            sdfgi_stage_forget_seen(stage, c);
}

bool sdfgi_stage_bounces(const struct plan_stage *stage)
{
    const struct frame *frame = stage->frame;
    return frame->situation.gathering && frame->gather_count > 0 && frame->situation.gathers;
}

/* Adds up what this frame's rays have found. Light cells that have begun to gather change with what they
 * gather, and the passes of probes run beside the filter; before that, and if they never gather, they change
 * with the probes. */
static void add_up(const struct plan_stage *stage)
{
    const struct frame *frame = stage->frame;
    const struct plan_target all = { 0 };
    const bool bounces = sdfgi_stage_bounces(stage);
    if (bounces)
        bounce_visited(stage);
    const uint32_t first = sdfgi_stage_begin_group(stage);
    if (bounces)
        filter_visited(stage, PASS_CELL_FILTER);
    sdfgi_stage_add_phase(stage, PHASE_SUM, &all);
    add_beside(stage, PASS_DISTANCE_PLANE);
    sdfgi_stage_end_group(stage, first);
    const uint32_t second = sdfgi_stage_begin_group(stage);
    if (bounces)
        filter_visited(stage, PASS_CELL_FILTER_FAR);
    sdfgi_stage_add_phase(stage, PHASE_BLEND, &all);
    add_beside(stage, PASS_DISTANCE_EXACT);
    sdfgi_stage_end_group(stage, second);
    if (!frame->situation.gathering && sdfgi_work_has(&frame->work, PASS_PROBE_BLEND))
        bounce_all(stage);
}

void sdfgi_stage_light(const struct plan_stage *stage)
{
    if (stage->needs->holds[NEED_DIRECT] && stage->frame->situation.lights_changed)
        light_directly(stage);
    trace(stage);
    add_up(stage);
}
