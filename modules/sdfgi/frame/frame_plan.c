/* SPDX-License-Identifier: MIT
 * Decides what a frame does, in the order in which it happens. */
#include "frame_work.h"
#include "stage.h"

#include <math.h>
#include <string.h>

/* Decides with which exposure light is stored. Light settles as far as the host's hint shows it: a brighter
 * picture shows what was too dim to count, and a larger exposure stores digits that were lost. */
static void plan_exposure(struct frame *frame, const struct frame_input *input)
{
    struct volume_state *next = &frame->next;
    const bool first = next->updates == 0;
    const struct exposure before = next->exposure;
    const float brightest = sdfgi_scene_brightest(input->scene, input->settings->read_sky_light);
    next->exposure = sdfgi_exposure_next(first ? NULL : &before, input->desc->exposure, brightest);
    frame->situation.rescales = !first && next->exposure.stored != before.stored;
    frame->rescale_power = next->exposure.stored - before.stored;
    frame->situation.gains_digits = frame->situation.rescales && frame->rescale_power > 0;
    if (!first && (next->exposure.hint > before.hint || frame->situation.gains_digits))
        sdfgi_accumulation_invalidate(&next->accumulation);
}

/* A new seed makes everything new. A host that gives another one in each frame means none of them. */
static void take_seed(struct volume_state *next, uint32_t seed, bool first)
{
    const bool lasts = first || seed == next->seed_asked;
    next->seed_asked = seed;
    if (!lasts || seed == next->seed)
        return;
    next->seed = seed;
    for (uint32_t c = 0; c < next->cascades.count; c++)
        sdfgi_cascade_outdate(&next->cascades.at[c]);
}

/* Light cells keep from where they get their light, or do not. In the frame in which they begin they know
 * nothing of it: all are visited again. */
static void take_low_light(struct frame *frame, bool low_light)
{
    struct volume_state *next = &frame->next;
    frame->situation.low_light_begins = low_light && !next->low_light;
    next->low_light = low_light;
    if (frame->situation.low_light_begins)
        sdfgi_accumulation_invalidate(&next->accumulation);
}

/* Takes over what the host says about the frame and what changed in the scene. */
static void take_input(struct frame *frame, const struct frame_input *input)
{
    const struct sdfgi_frame_desc *desc = input->desc;
    struct volume_state *next = &frame->next;
    const bool first = next->updates == 0;
    sdfgi_volume_apply_journal(input->journal, next);
    memcpy(next->origin, desc->origin, sizeof next->origin);
    take_seed(next, desc->seed, first);
    const bool all_change = first || frame->situation.gains_digits;
    frame->lights =
        all_change ? (struct light_bits){ SDFGI_LIGHT_ALL, SDFGI_LIGHT_ALL } : input->journal->lights;
    frame->situation.lights_changed = frame->lights.changed != 0;
    if (frame->situation.lights_changed)
        sdfgi_relight_count(&next->relight);
    if (first || (input->journal->notes & JOURNAL_MATERIALS))
        frame->uploads |= FRAME_UPLOAD_MATERIALS;
}

/* What cycles have gathered no longer counts: nothing was there before, or light cells were missing. */
static bool restarts(const struct frame *frame)
{
    return frame->situation.from_nothing || frame->situation.list_grew;
}

/* Moves cascades, and takes the pieces of their changes that are due. */
static void plan_scroll(struct frame *frame, const struct frame_input *input)
{
    struct volume_state *next = &frame->next;
    const struct scroll_limits limits = { input->settings->max_scroll_cells,
                                          input->settings->sdf_method == SDFGI_SDF_FLOOD,
                                          input->starts_in_parts };
    const bool nothing_shown = next->accumulation.phase < LIGHTING_RUNNING;
    if (input->desc->cut)
        sdfgi_scroll_cut(&next->scroll, &next->cascades);
    sdfgi_scroll_plan(&next->scroll, &next->cascades, &limits, input->desc->camera_position, nothing_shown,
                      &frame->scroll);
    sdfgi_volume_note_content(input->scene, next);
    if (frame->scroll.begun)
        sdfgi_accumulation_invalidate(&next->accumulation);
    frame->situation.from_nothing = frame->scroll.from_nothing;
    frame->situation.voxels_due = sdfgi_scroll_plan_has(&frame->scroll, PIECE_VOXELS);
    frame->situation.distances_due = sdfgi_scroll_plan_has(&frame->scroll, PIECE_DISTANCES);
    frame->situation.completes = sdfgi_cascades_complete(&next->cascades);
}

static bool scroll_completes(const struct frame *frame)
{
    const struct cascades *cascades = &frame->next.cascades;
    for (uint32_t c = 0; c < cascades->count; c++)
        if (sdfgi_cascade_completes(&cascades->at[c]) && cascades->at[c].last_turn != CHANGE_EDIT)
            return true;
    return false;
}

/* A frame in which a scroll completes has enough to do: light goes on in the next one. Not where scrolls come
 * thick and fast, and not for geometry, which may change in every frame: that would keep light waiting. */
static bool light_waits(const struct frame *frame)
{
    return frame->situation.scroll_completes && !restarts(frame) &&
           frame->next.accumulation.phase != LIGHTING_DARK &&
           frame->next.scroll.calm_frames >= SCROLL_CALM_FRAMES;
}

/* Decides where in the sample cycle this frame is. */
static void plan_cycle(struct frame *frame, const struct frame_input *input)
{
    struct accumulation *a = &frame->next.accumulation;
    const uint32_t cycle_frames = sdfgi_settings_cycle_frames(input->settings);
    if (restarts(frame)) {
        sdfgi_accumulation_restart(a);
        sdfgi_gathering_restart(&frame->next.gathering);
    }
    frame->situation.scroll_completes = scroll_completes(frame);
    frame->situation.light_waits = light_waits(frame);
    if (frame->scroll.from_nothing)
        sdfgi_accumulation_go_dark(a);
    /* Any change may invalidate cached rays of any sample, so rays are traced for one full cycle afterwards.
     * A new ray cache is empty. */
    bool changes = restarts(frame) || input->gaps.emitters;
    for (uint32_t c = 0; c < frame->next.cascades.count; c++)
        changes = changes || frame->next.cascades.at[c].change.cause != CHANGE_NONE;
    if (changes)
        a->rays_missing = cycle_frames;
    frame->cycle_ends = sdfgi_accumulation_cycle_ends(a, cycle_frames);
    frame->situation.rays_missing = a->rays_missing > 0;
    frame->situation.converged = a->phase == LIGHTING_CONVERGED;
    const bool due = (a->frame + 1) % input->settings->frames_to_update_lights == 0;
    frame->situation.shows = due || frame->cycle_ends || a->phase == LIGHTING_DARK;
}

/* Decides whose direct light is to be made again. */
static void plan_relight(struct frame *frame, const struct frame_input *input)
{
    enum relist relists[SDFGI_MAX_CASCADES] = { RELIST_NOT };
    for (uint32_t c = 0; c < frame->next.cascades.count; c++)
        relists[c] = sdfgi_frame_relist(frame, c);
    for (uint32_t c = 0; c < frame->next.cascades.count; c++)
        frame->situation.lists_stay = frame->situation.lists_stay || relists[c] != RELIST_NEW;
    frame->situation.has_lights = input->scene->lights.count > 0;
    sdfgi_relight_note(&frame->next.relight, &input->lists, relists, &input->journal->suns,
                       sdfgi_frame_lights_all(frame) || !frame->situation.has_lights);
    frame->situation.relights = sdfgi_relight_is_due(&frame->next.relight);
}

static bool ranges_hold_cells(const struct frame *frame)
{
    for (uint32_t i = 0; i < frame->gather_count; i++)
        if (frame->gathers[i].count > 0)
            return true;
    return false;
}

/* Decides which light cells gather. */
static void plan_gathering(struct frame *frame, const struct frame_input *input)
{
    struct volume_state *next = &frame->next;
    const uint32_t visits = sdfgi_settings_cycle_visits(input->settings);
    frame->situation.cells = visits > 0;
    sdfgi_gathering_begin(&next->gathering, next->accumulation.invalidations);
    if (visits == 0 || frame->situation.converged || frame->situation.light_waits)
        return;
    frame->gather_count =
        sdfgi_gathering_take(&next->gathering, &next->relight, &input->lists,
                             input->settings->cell_rays_per_frame / sdfgi_extent_visit_rays(&input->extent),
                             visits, frame->gathers);
    frame->situation.gathers = ranges_hold_cells(frame);
    frame->situation.gathering = next->accumulation.phase >= LIGHTING_RUNNING;
}

static bool geometry_is_due(const struct frame *frame, const struct scene *scene)
{
    for (uint32_t i = 0; i < frame->scroll.piece_count; i++) {
        const struct scroll_piece *piece = &frame->scroll.pieces[i];
        const struct cascade *cascade = &frame->next.cascades.at[piece->cascade];
        const struct box box = sdfgi_cascade_world_box(cascade, &piece->box);
        if (piece->kind == PIECE_VOXELS && sdfgi_scene_touches(scene, &box))
            return true;
    }
    return false;
}

static void plan_methods(struct situation *s, const struct sdfgi_settings *settings)
{
    s->raster = sdfgi_pass_fits(PASS_VOXELIZE_RASTER, settings);
    s->flood = sdfgi_pass_fits(PASS_FLOOD_STEP, settings);
    s->occlusion = sdfgi_pass_fits(PASS_OCCLUSION_TRACE, settings);
    s->masks = sdfgi_pass_fits(PASS_CELL_MASK, settings);
}

/* Compares the parameters with those that were uploaded last. */
static void plan_uploads(struct frame *frame, const struct frame_input *input,
                         const struct situation_needs *needs)
{
    const struct params_input params_input = { input->settings, input->scene, &input->extent,
                                               input->low_light_begin };
    struct sdfgi_frame_params params;
    sdfgi_params_fill(&params, &frame->next, &params_input);
    if (memcmp(&params, &frame->next.params, sizeof params) != 0)
        frame->uploads |= FRAME_UPLOAD_PARAMS;
    frame->next.params = params;
    if (needs->holds[NEED_DIRECT] && frame->situation.has_lights)
        frame->uploads |= FRAME_UPLOAD_LIGHTS;
    if (needs->holds[NEED_TRACE])
        frame->uploads |= FRAME_UPLOAD_RAY_QUEUE;
    if (needs->holds[NEED_CELLS])
        frame->uploads |= FRAME_UPLOAD_VISITS;
}

/* Voxelisers read instances from a buffer. It is brought up to date in frames that voxelise any. */
static void plan_instances(struct frame *frame, const struct frame_input *input)
{
    if (!frame->situation.geometry_due || frame->next.instances == input->scene->revision)
        return;
    frame->uploads |= FRAME_UPLOAD_INSTANCES;
    frame->instances_since = frame->next.instances;
    frame->next.instances = input->scene->revision;
}

/* Whatever else the frame does, and also where light has converged. */
static void add_rescale(struct frame *frame)
{
    if (!frame->situation.rescales)
        return;
    struct work *work = sdfgi_work_add(&frame->work, PASS_LIGHT_RESCALE, 0, sdfgi_need_reason(NEED_RESCALE));
    work->args.light_rescale.factor = ldexpf(1, frame->rescale_power);
}

static void plan_reasons(struct frame *frame)
{
    for (int i = 0; i < PASS_COUNT; i++) {
        const enum need need = sdfgi_pass_row((enum pass)i)->need;
        frame->reasons[i] = sdfgi_work_has(&frame->work, (enum pass)i) ? sdfgi_need_reason(need)
                                                                       : sdfgi_need_reason_not(need);
    }
}

void sdfgi_frame_plan(struct frame *frame, const struct frame_input *input)
{
    memset(frame, 0, sizeof *frame);
    frame->next = *input->state;
    frame->situation.list_grew = input->gaps.lists;
    frame->situation.lists_emitters = input->extent.emits;
    plan_exposure(frame, input);
    take_input(frame, input);
    take_low_light(frame, input->low_light);
    plan_scroll(frame, input);
    plan_cycle(frame, input);
    plan_relight(frame, input);
    plan_gathering(frame, input);
    plan_methods(&frame->situation, input->settings);
    frame->situation.geometry_due = geometry_is_due(frame, input->scene);
    const struct situation_needs needs = sdfgi_frame_needs(&frame->situation);
    plan_uploads(frame, input, &needs);
    plan_instances(frame, input);
    add_rescale(frame);
    if (!frame->situation.converged)
        sdfgi_frame_add_work(frame, input, &needs);
    plan_reasons(frame);
}

/* True if the plan is a frame of the sample cycle: rays are sent, or their cached hits are read. */
static bool takes_samples(const struct frame *frame)
{
    return !frame->situation.converged && !frame->situation.light_waits;
}

/* No work is left but that of the sample cycle. */
static bool rests(const struct volume_state *state, const struct sdfgi_settings *settings)
{
    return sdfgi_cascades_rest(&state->cascades) && !sdfgi_relight_is_due(&state->relight) &&
           (sdfgi_settings_cycle_visits(settings) == 0 ||
            sdfgi_gathering_has_settled(&state->gathering, state->cascades.count));
}

void sdfgi_frame_next_state(const struct frame *frame, const struct sdfgi_settings *settings,
                            struct volume_state *state)
{
    *state = frame->next;
    state->paused = false;
    state->updates++;
    if (sdfgi_work_has(&frame->work, PASS_PROBE_BLEND))
        sdfgi_accumulation_show(&state->accumulation, frame->cycle_ends);
    if (takes_samples(frame))
        sdfgi_accumulation_advance(&state->accumulation, sdfgi_settings_cycle_frames(settings),
                                   rests(state, settings));
    sdfgi_scroll_finish(&state->scroll, &state->cascades);
}

struct feedback_slot sdfgi_frame_feedback(const struct frame *frame)
{
    struct feedback_slot slot = {
        .content = frame->situation.converged ? FEEDBACK_TIMES : FEEDBACK_TIMES_AND_COUNTERS,
        .ended_cycle = frame->cycle_ends && takes_samples(frame) ? frame->next.accumulation.cycle : 0,
    };
    for (uint32_t i = 0; i < frame->gather_count; i++)
        slot.ended_gathers[frame->gathers[i].cascade] = frame->gathers[i].ends_cycle;
    return slot;
}

void sdfgi_frame_commit(const struct frame *frame, const struct sdfgi_settings *settings,
                        struct volume *volume)
{
    volume->undo = (struct volume_undo){ true, volume->state, volume->journal, volume->gaps };
    sdfgi_frame_next_state(frame, settings, &volume->state);
    struct feedback_slot *slot = &volume->feedback.slots[sdfgi_backend_slot(volume->backend)];
    *slot = sdfgi_frame_feedback(frame);
    volume->resources->used = true;
    slot->number = sdfgi_backend_number(volume->backend);
    if (!frame->situation.converged)
        volume->gaps = (struct volume_gaps){ 0 };
    sdfgi_journal_clear(&volume->journal);
}
