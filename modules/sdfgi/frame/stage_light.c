/* SPDX-License-Identifier: MIT
 * Stages 6 and 7 for all cascades: direct light that changed, rays, probes, light that bounces. */
#include "stage.h"

static void add_direct(const struct plan_stage *stage, const struct relight_range *range)
{
    struct work *work = sdfgi_stage_add(stage, PASS_LIGHT_DIRECT, range->cascade);
    work->first = range->first;
    work->count = range->count;
    work->units = range->count;
    work->args.light_direct = (struct sdfgi_light_direct_args){
        .cascade = range->cascade,
        .first = range->first,
        .end = range->first + range->count,
        .threads_per_ray = stage->input->threads_per_ray,
    };
}

/* What leaves the surfaces, in all cascades. */
static void add_bounce(const struct plan_stage *stage)
{
    const struct frame *frame = stage->frame;
    struct work *work = sdfgi_stage_add(stage, PASS_LIGHT_BOUNCE, 0);
    for (uint32_t c = 0; c < frame->next.cascades.count; c++) {
        const uint32_t entries = sdfgi_light_list_entries(&frame->next.relight, &stage->input->lists, c);
        work->count = entries > work->count ? entries : work->count;
        work->units += stage->input->counters[SDFGI_COUNTER_LIGHT_CELLS + c];
    }
    /* Probes hold light once a frame has shown it: in this one, that is the case behind PROBE_BLEND. */
    const bool shown = sdfgi_work_has(&frame->work, PASS_PROBE_BLEND);
    work->args.light_bounce = (struct sdfgi_light_bounce_args){
        .end = work->count,
        .without_probes = !shown && frame->next.accumulation.phase == LIGHTING_DARK,
    };
}

/* Lights changed: all cells that were there before. */
static void light_directly(const struct plan_stage *stage)
{
    const struct frame *frame = stage->frame;
    bool any = false;
    for (uint32_t c = 0; c < frame->next.cascades.count; c++) {
        if (sdfgi_frame_relist(frame, c) == RELIST_NEW)
            continue;
        const uint32_t entries = sdfgi_light_list_entries(&frame->next.relight, &stage->input->lists, c);
        add_direct(stage, &(struct relight_range){ c, 0, entries });
        any = true;
    }
    if (any)
        add_bounce(stage);
}

/* Lights this frame's part of the cells again on which shadows may have changed. */
static void relight(const struct plan_stage *stage)
{
    struct frame *frame = stage->frame;
    struct relight_range ranges[SDFGI_MAX_CASCADES];
    const uint32_t count = sdfgi_relight_take(&frame->next.relight, &stage->input->lists,
                                              frame->situation.scroll_completes, ranges);
    for (uint32_t i = 0; i < count; i++)
        add_direct(stage, &ranges[i]);
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

/* This frame's rays, and beside them some direct light. */
static void trace(const struct plan_stage *stage)
{
    sdfgi_stage_add_phase(stage, PHASE_RAYS, &(struct plan_target){ 0 });
    const uint32_t first = sdfgi_stage_begin_group(stage);
    add_probe_trace(stage);
    if (stage->needs->holds[NEED_DIRECT] && !stage->frame->situation.lights_changed)
        relight(stage);
    sdfgi_stage_end_group(stage, first);
}

/* Adds up what this frame's rays find, shows what the probes have gathered, and hands it to the surfaces. */
static void light_probes(const struct plan_stage *stage)
{
    sdfgi_stage_add_phase(stage, PHASE_PROBES, &(struct plan_target){ 0 });
    if (sdfgi_work_has(&stage->frame->work, PASS_PROBE_BLEND))
        add_bounce(stage);
}

void sdfgi_stage_light(const struct plan_stage *stage)
{
    if (stage->needs->holds[NEED_DIRECT] && stage->frame->situation.lights_changed)
        light_directly(stage);
    trace(stage);
    light_probes(stage);
}
