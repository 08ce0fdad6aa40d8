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

/* Probes and light cells where voxels and distances are complete; coarse cascades first, from which new
 * probes of finer ones take their start. */
static void complete(struct frame *frame)
{
    struct sdfgi *gi = frame->gi;
    for (uint32_t c = gi->settings.cascades; c-- > 0;) {
        const bool all = schedule_completes(gi, c);
        if (all) {
            probe_place_record(frame, c);
            occlusion_record(frame, c);
        }
        if (restarts(gi))
            probe_reset_record(frame, c);
        else if (all)
            probe_seed_record(frame, c);
        if (all || gi->cascades[c].relist)
            light_cache_list_record(frame, c);
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
    if (cascades > 0 && !restarts(gi))
        ray_forget_record(frame, cascades);
}

/* Direct light of cells that were there before: at once where lights changed, else some a frame. */
static void light_directly(struct frame *frame)
{
    const struct sdfgi *gi = frame->gi;
    if (!gi->lights_changed) {
        light_cache_relight_record(frame);
        return;
    }
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

/* Sends this frame's rays, and publishes what the probes have gathered. */
static void light_probes(struct frame *frame)
{
    struct sdfgi *gi = frame->gi;
    for (uint32_t c = 0; c < gi->settings.cascades; c++)
        probe_trace_record(frame, c);
    if (!gi->plan[PASS_PROBE_BLEND].run)
        return;
    for (uint32_t c = 0; c < gi->settings.cascades; c++) {
        probe_blend_record(frame, c, ring_ends(gi));
        gi->cascades[c].published = true;
        gi->cascades[c].fresh = gi->cascades[c].fresh && !ring_ends(gi);
    }
}

static void clear_counters(struct frame *frame, uint32_t first, uint32_t count)
{
    gpu_use(&frame->rec, GPU_USAGE_TRANSFER, 0, RESOURCE_BIT(COUNTERS));
    gpu_fill(&frame->rec, &frame->gi->resources->buffers[RESOURCE_COUNTERS], 4 * first, 4 * count, 0);
}

static void prepare_atlas(struct frame *frame)
{
    struct resources *r = frame->gi->resources;
    if (r->atlas_ready)
        return;
    gpu_image_to_general(&frame->rec, &r->irradiance, frame->gi->settings.cascades);
    r->atlas_ready = true;
}

/* Moves on in the ring. At its end, decides from the newest ring known whether light has settled. */
static void advance_ring(struct sdfgi *gi)
{
    struct frame_slot *slot = &gi->slots[gi->frame % gi->frames_in_flight];
    slot->ring = gi->ring;
    slot->ring_ends = ring_ends(gi);
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
    prepare_atlas(frame);
    if (gi->plan[PASS_REGION_CLEAR].run)
        clear_counters(frame, 0, SDFGI_COUNTER_LIGHT_CELLS);
    else if (gi->ring_frame == 0)
        clear_counters(frame, SDFGI_COUNTER_VALUES_CLAMPED, SDFGI_COUNTER_MAX_IRRADIANCE);
    generate(frame);
    if (gi->plan[PASS_LIGHT_LIST].run) {
        complete(frame);
        forget_rays(frame);
    }
    if (gi->plan[PASS_LIGHT_DIRECT].run)
        light_directly(frame);
    if (gi->plan[PASS_PROBE_TRACE].run)
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
