/* SPDX-License-Identifier: MIT
 * A frame, from top to bottom. docs/frame.md tells the same story with reasons. */
#include "internal.h"

#include <math.h>
#include <string.h>

static const char *frame_problem(const struct sdfgi_frame_desc *d)
{
    for (int i = 0; i < 3; i++)
        if (!isfinite(d->camera_position[i]) || !isfinite(d->origin[i]))
            return "camera_position or origin is not finite";
    if (!(isfinite(d->exposure) && d->exposure >= 0))
        return "exposure is negative or not finite";
    return NULL;
}

static void size_cells(struct sdfgi *gi)
{
    for (uint32_t c = 0; c < gi->settings.cascades; c++)
        for (int i = 0; i < 3; i++)
            gi->cascades[c].cell_size[i] = ldexp(gi->settings.min_cell_size_m, (int)c) *
                                           (i == 1 ? y_scale_factor(gi->settings.y_scale) : 1.0);
}

/* Takes over what the host says about the frame. */
static void take_frame(struct sdfgi *gi, const struct sdfgi_frame_desc *desc)
{
    const float exposure = desc->exposure > 0 ? desc->exposure : 1.0f;
    memcpy(gi->origin, desc->origin, sizeof gi->origin);
    if (exposure != gi->exposure) {
        gi->exposure = exposure;
        gi->lights_changed = true;
        light_disturb(gi);
    }
    if (desc->seed != gi->seed) {
        gi->seed = desc->seed;
        for (uint32_t c = 0; c < SDFGI_MAX_CASCADES; c++)
            gi->cascades[c].rebuild = true;
    }
    size_cells(gi);
    schedule_frame(gi, desc->camera_position);
}

static bool any_relisted(const struct sdfgi *gi)
{
    for (uint32_t c = 0; c < gi->settings.cascades; c++)
        if (gi->cascades[c].relist)
            return true;
    return false;
}

/* What rings have gathered no longer counts: nothing was there before, or light cells were missing. */
static bool restarts(const struct sdfgi *gi)
{
    return gi->schedule.from_nothing || any_relisted(gi);
}

static bool all_published(const struct sdfgi *gi)
{
    for (uint32_t c = 0; c < gi->settings.cascades; c++)
        if (!gi->cascades[c].published)
            return false;
    return true;
}

static bool any_steps(const struct sdfgi *gi)
{
    for (uint32_t c = 0; c < gi->settings.cascades; c++)
        if (schedule_completes(gi, c) && !gi->cascades[c].edited)
            return true;
    return false;
}

/* A frame in which a step of a cascade becomes complete has enough to do: probes go on in the next one. Not
 * where steps come thick and fast, nor for geometry, which may change in every frame: that would keep light
 * waiting. */
static void decide_wait(struct sdfgi *gi)
{
    gi->takes_step = any_steps(gi);
    gi->light_waits =
        gi->takes_step && !restarts(gi) && all_published(gi) && gi->schedule.calm_frames >= SDFGI_CALM_FRAMES;
}

/* Whatever changes may make remembered rays unknown, of any sample: after that the ring has to come round
 * once. */
static void count_missing_rays(struct sdfgi *gi)
{
    bool changes = restarts(gi);
    for (uint32_t c = 0; c < gi->settings.cascades; c++)
        changes = changes || gi->cascades[c].change.active;
    if (changes)
        gi->rays_missing = ring_frames(&gi->settings);
}

static bool ring_ends(const struct sdfgi *gi)
{
    return gi->ring_frame + 1 == ring_frames(&gi->settings);
}

/* A ring that starts over has no samples yet, and what it measures is not mixed with what was before. */
static void restart_ring(struct sdfgi *gi)
{
    gi->ring++;
    gi->ring_frame = 0;
    gi->converged = false;
    gi->disturbed_ring = gi->ring - 1;
    settle_reset(&gi->settling);
}

static void make_plan(struct sdfgi *gi)
{
    decide_wait(gi);
    count_missing_rays(gi);
    light_cache_plan(gi);
    for (uint32_t c = 0; c < gi->settings.cascades; c++)
        if (gi->cascades[c].fresh && gi->schedule.from_nothing)
            gi->cascades[c].published = false;
    const bool due = (gi->ring_frame + 1) % gi->settings.frames_to_update_lights == 0;
    const struct situation situation = {
        .enabled = true,
        .generates = schedule_has(gi, STEP_VOXELS),
        .measures = schedule_has(gi, STEP_DISTANCE),
        .completes = schedule_has(gi, STEP_COMPLETE),
        .fresh = gi->schedule.from_nothing,
        .relights = light_cache_relights(gi),
        .list_grew = any_relisted(gi),
        .has_geometry = gi->scene.instances.count > 0,
        .has_lights = gi->scene.lights.count > 0,
        .converged = gi->converged,
        .lights_changed = gi->lights_changed,
        .light_waits = gi->light_waits,
        .rays_missing = gi->rays_missing > 0,
        .publish = due || ring_ends(gi) || !all_published(gi),
        .raster = gi->settings.voxelizer == SDFGI_VOXELIZER_RASTER,
        .flood = gi->settings.sdf_method == SDFGI_SDF_FLOOD,
        .occlusion = gi->settings.use_occlusion && gi->settings.visibility == SDFGI_VISIBILITY_PROBE_DEPTH,
        .masks = gi->settings.use_occlusion && gi->settings.visibility != SDFGI_VISIBILITY_PROBE_DEPTH,
    };
    plan_make(&situation, gi->plan);
}

/* ---- Phases */

/* Voxels and distances that are due in this frame. */
static void generate(struct frame *frame)
{
    const struct sdfgi *gi = frame->gi;
    for (uint32_t i = 0; i < gi->schedule.step_count; i++) {
        const struct step *step = &gi->schedule.steps[i];
        const struct change *change = &gi->cascades[step->cascade].change;
        const bool whole = cell_box_empty(&change->kept);
        const struct distance_part part = { step->first, step->count, change->boxes,
                                            whole ? 0 : change->count };
        if (step->kind == STEP_VOXELS)
            voxelize_record(frame, step->cascade, &step->box);
        else if (step->kind == STEP_DISTANCE)
            distance_field_record(frame, step->cascade, &part);
    }
}

/* Rays of a cascade go on into coarser ones, never into finer. */
static void forget_rays(struct frame *frame)
{
    const struct sdfgi *gi = frame->gi;
    uint32_t cascades = 0;
    for (uint32_t c = 0; c < gi->settings.cascades; c++)
        if (schedule_completes(gi, c))
            cascades = c + 1;
    if (cascades > 0)
        ray_invalidate_record(frame, cascades);
}

static bool last_to_complete(const struct sdfgi *gi, uint32_t c)
{
    for (uint32_t finer = 0; finer < c; finer++)
        if (schedule_completes(gi, finer))
            return false;
    return schedule_completes(gi, c);
}

/* Probes and light cells of a cascade whose voxels and distances are complete. The order of passes is such
 * that neighbours touch nothing in common: no barrier comes between them. */
static void complete_cascade(struct frame *frame, uint32_t c)
{
    const struct sdfgi *gi = frame->gi;
    const bool all = schedule_completes(gi, c), keeps = !restarts(gi);
    light_cache_clear_record(frame);

    pass_group_begin(frame);
    light_cache_mark_record(frame, c);
    if (all)
        probe_place_record(frame, c);
    pass_group_end(frame);

    light_cache_list_record(frame, c);

    pass_group_begin(frame);
    light_cache_renew_record(frame, c);
    if (all)
        occlusion_record(frame, c);
    if (all && !gi->schedule.from_nothing)
        probe_seed_record(frame, c);
    if (last_to_complete(gi, c) && keeps)
        forget_rays(frame);
    pass_group_end(frame);

    light_cache_renew_bounce_record(frame, c);
}

/* Coarse cascades first, from which new probes of finer ones take their start. */
static void complete(struct frame *frame)
{
    struct sdfgi *gi = frame->gi;
    for (uint32_t c = gi->settings.cascades; c-- > 0;) {
        if (restarts(gi))
            probe_reset_record(frame, c);
        if (schedule_completes(gi, c) || gi->cascades[c].relist)
            complete_cascade(frame, c);
    }
}

/* Direct light of all cells that were there before. */
static void light_directly(struct frame *frame)
{
    const struct sdfgi *gi = frame->gi;
    bool any = false;
    for (uint32_t c = 0; c < gi->settings.cascades; c++) {
        if (light_cache_is_new(gi, c))
            continue;
        light_cache_direct_record(frame, c);
        any = true;
    }
    if (any)
        light_cache_bounce_record(frame);
}

/* Sends this frame's rays, and makes some direct light again, beside each other. */
static void trace_rays(struct frame *frame)
{
    const struct sdfgi *gi = frame->gi;
    if (gi->plan[PASS_RAY_LIST].run)
        ray_list_record(frame);
    pass_group_begin(frame);
    if (gi->plan[PASS_PROBE_TRACE].run)
        probe_trace_record(frame);
    if (gi->plan[PASS_LIGHT_DIRECT].run && !gi->lights_changed)
        light_cache_relight_record(frame);
    pass_group_end(frame);
}

/* Adds up what this frame's rays find, and publishes what the probes have gathered. */
static void light_probes(struct frame *frame)
{
    struct sdfgi *gi = frame->gi;
    probe_sum_record(frame);
    if (!gi->plan[PASS_PROBE_BLEND].run)
        return;
    probe_blend_record(frame, ring_ends(gi));
    for (uint32_t c = 0; c < gi->settings.cascades; c++) {
        gi->cascades[c].published = true;
        gi->cascades[c].fresh = gi->cascades[c].fresh && !ring_ends(gi);
    }
}

enum cleared { CLEARED_CHANGE, CLEARED_CYCLE };

static const struct {
    uint32_t counter;
    enum cleared cleared;
} counters[] = {
#define ROW(id, cleared, health) { SDFGI_COUNTER_##id, CLEARED_##cleared },
    SDFGI_COUNTERS(ROW)
#undef ROW
};

/* Clears the counters of this row and all later ones; a voxelising frame clears all rows. */
static void clear_counters(struct frame *frame, enum cleared when)
{
    uint32_t first = SDFGI_COUNTER_SINGLE_COUNT, end = 0;
    for (size_t i = 0; i < sizeof counters / sizeof *counters; i++)
        if (counters[i].cleared >= when) {
            first = counters[i].counter < first ? counters[i].counter : first;
            end = counters[i].counter + 1 > end ? counters[i].counter + 1 : end;
        }
    gpu_use(&frame->rec, GPU_USAGE_TRANSFER, 0, RESOURCE_BIT(COUNTERS));
    gpu_fill(&frame->rec, &frame->gi->resources->buffers[RESOURCE_COUNTERS], 4 * first, 4 * (end - first), 0);
}

/* Moves on in the ring. At its end, decides from the newest ring known whether light has settled. */
static void advance_ring(struct sdfgi *gi)
{
    struct frame_slot *slot = &gi->slots[gi->frame % gi->frames_in_flight];
    slot->ring = gi->ring;
    slot->ring_ends = ring_ends(gi);
    gi->rays_missing -= gi->rays_missing > 0;
    if (!ring_ends(gi)) {
        gi->ring_frame++;
        return;
    }
    gi->converged = gi->converged || (schedule_idle(gi) && settle_done(&gi->settling));
    gi->ring++;
    gi->ring_frame = 0;
}

static void record_work(struct frame *frame)
{
    struct sdfgi *gi = frame->gi;
    if (gi->plan[PASS_REGION_CLEAR].run)
        clear_counters(frame, CLEARED_CHANGE);
    else if (gi->ring_frame == 0)
        clear_counters(frame, CLEARED_CYCLE);
    generate(frame);
    if (gi->plan[PASS_LIGHT_LIST].run)
        complete(frame);
    if (gi->plan[PASS_LIGHT_DIRECT].run && gi->lights_changed)
        light_directly(frame);
    trace_rays(frame);
    if (gi->plan[PASS_PROBE_SUM].run)
        light_probes(frame);
    if (gi->plan[PASS_PROBE_BLEND].run)
        light_cache_bounce_record(frame);
    readback_record(frame);
}

static void record_frame(struct sdfgi *gi, struct frame *frame)
{
    if (restarts(gi))
        restart_ring(gi);
    make_plan(gi);
    upload_params(gi);
    upload_record(gi, &frame->rec);
    if (!gi->converged) {
        record_work(frame);
        if (!gi->light_waits)
            advance_ring(gi);
    }
    gpu_recorder_end(&frame->rec);
    schedule_finish(gi);
    for (uint32_t c = 0; c < gi->settings.cascades; c++)
        gi->cascades[c].relist = false;
    gi->lights_changed = false;
    gi->command_count = frame->rec.command_count;
    gi->active = true;
    gi->update_count++;
}

static void begin_report(struct sdfgi *gi)
{
    for (int i = 0; i < PASS_COUNT; i++) {
        gi->passes[i].dispatches = 0;
        gi->passes[i].work = 0;
        gi->passes[i].gpu_ns_valid = false;
    }
    gi->gathers = 0;
    gi->command_count = 0;
}

enum sdfgi_result sdfgi_update(sdfgi *gi, VkCommandBuffer cmd, const struct sdfgi_frame_desc *desc)
{
    const char *problem = frame_problem(desc);
    if (problem)
        return invalid(gi, "sdfgi_update: %s", problem);
    if (gi->device_lost)
        return SDFGI_ERROR_DEVICE_LOST;
    gi->frame++;
    resources_collect(gi, false);
    scene_collect(gi);
    begin_report(gi);
    if (!gi->resources) {
        plan_make(&(struct situation){ .enabled = false }, gi->plan);
        return SDFGI_OK;
    }
    struct frame frame = { .gi = gi, .slot = (uint32_t)(gi->frame % gi->frames_in_flight) };
    readback_read(gi, frame.slot);
    light_cache_make_room(gi);
    gpu_recorder_begin(&frame.rec, &gi->device, cmd);
    gpu_timer_begin_frame(&gi->resources->timer, frame.slot);
    gi->slots[frame.slot].timed = true;
    take_frame(gi, desc);
    record_frame(gi, &frame);
    return SDFGI_OK;
}
