/* SPDX-License-Identifier: MIT
 * sdfgi_update: a frame, from top to bottom. */
#include "context.h"

#include "core/problem.h"

#include <math.h>
#include <string.h>

static struct problem frame_problem(const struct sdfgi_frame_desc *d)
{
    struct problem p = { "" };
    sdfgi_problem_finite(&p, "camera_position", d->camera_position, 3);
    sdfgi_problem_finite(&p, "origin", d->origin, 3);
    sdfgi_problem_floats(&p, "exposure", &d->exposure, 1, 0, INFINITY);
    return p;
}

/* Threads that follow a shadow ray: where few threads run at once none should be idle. */
static uint32_t threads_per_ray(const struct gpu_device *device)
{
    return device->is_cpu ? 1 : SDFGI_GROUP_SURFACES;
}

/* True if rough surfaces are to reflect light by where it comes from. */
static bool wants_low_light(const struct sdfgi *gi, const struct sdfgi_frame_desc *desc)
{
    const bool forward = desc->forward_reflections && gi->scene.smoothest > 0;
    return gi->settings.rough_lobes && (forward || sdfgi_views_reflect(&gi->views));
}

static struct frame_input frame_input(struct sdfgi *gi, const struct sdfgi_frame_desc *desc, bool low_light)
{
    const struct extent *extent = &gi->volume.resources->extent;
    const uint32_t most_texels = gi->backend.device.limits.maxTexelBufferElements;
    return (struct frame_input){ .state = &gi->volume.state,
                                 .desc = desc,
                                 .settings = &gi->settings,
                                 .scene = &gi->scene,
                                 .journal = &gi->volume.journal,
                                 .extent = *extent,
                                 .counters = gi->volume.feedback.counters,
                                 .lists = sdfgi_volume_light_lists(&gi->volume),
                                 .gaps = gi->volume.gaps,
                                 .low_light = low_light,
                                 .low_light_begin = sdfgi_low_light_begin(extent, most_texels),
                                 .starts_in_parts = sdfgi_preparation_keeps(gi),
                                 .threads_per_ray = threads_per_ray(&gi->backend.device),
                                 .software = gi->backend.software };
}

static void report_off(struct sdfgi *gi)
{
    memset(gi->passes, 0, sizeof gi->passes);
    for (int i = 0; i < PASS_COUNT; i++)
        gi->passes[i].reason = "GI is switched off";
    gi->command_count = 0;
}

static void report_frame(struct sdfgi *gi)
{
    for (int i = 0; i < PASS_COUNT; i++)
        gi->passes[i] = (struct pass_report){ gi->frame.reasons[i], gi->recorder.tally[i] };
    gi->command_count = gi->recorder.gpu.command_count;
}

/* What the host may want to know of an update that has been taken over. */
static void log_light(struct sdfgi *gi, enum lighting_phase before)
{
    const bool had_settled = gi->has_settled;
    const unsigned long long updates = gi->volume.state.updates;
    gi->has_settled = sdfgi_volume_has_settled(&gi->volume);
    if (before == LIGHTING_DARK && gi->volume.state.accumulation.phase != LIGHTING_DARK)
        sdfgi_message_log(&gi->backend.hooks, SDFGI_MESSAGE_FIRST_LIGHT,
                          "sdfgi_update: update %llu is the first to give light", updates);
    if (gi->has_settled && !had_settled)
        sdfgi_message_log(&gi->backend.hooks, SDFGI_MESSAGE_SETTLED,
                          "sdfgi_update: light has settled in update %llu", updates);
}

/* Takes in what the frame found out that used this slot before. */
static enum sdfgi_result read_back(struct sdfgi *gi, uint32_t slot)
{
    bool has_run;
    const VkResult result = sdfgi_volume_read_back(&gi->volume, slot, &has_run);
    if (result == VK_ERROR_DEVICE_LOST) /* times that cannot be read for another reason can be done without */
        return sdfgi_message_vulkan(&gi->backend.hooks, result, "sdfgi_update");
    if (has_run)
        return SDFGI_OK;
    gi->updates_lost++;
    sdfgi_message_log(&gi->backend.hooks, SDFGI_MESSAGE_UPDATE_LOST,
                      "sdfgi_update: an update was recorded %u updates ago and has not run: all is made anew",
                      (unsigned)gi->backend.retired.frames_in_flight);
    sdfgi_reset(gi);
    return SDFGI_OK;
}

enum sdfgi_result sdfgi_update(sdfgi *gi, VkCommandBuffer cmd, const struct sdfgi_frame_desc *desc)
{
    struct problem problem = frame_problem(desc);
    if (gi->settings.enabled && !cmd)
        sdfgi_problem_add(&problem, "cmd is null");
    if (problem.text[0])
        return sdfgi_problem_report(&problem, &gi->backend.hooks, "sdfgi_update");
    if (gi->backend.hooks.device_lost)
        return SDFGI_ERROR_DEVICE_LOST;

    /* Destroy what the frame that ends now was the last to use. */
    gi->backend.retired.frame++;
    gi->views.used = gi->debug_views.used = 0;
    gi->can_cancel = true;
    gi->exposure_hint = desc->exposure > 0 ? desc->exposure : 1;
    gpu_retire_collect(&gi->backend.retired);
    if (!gi->settings.enabled) {
        gi->volume.undo.valid = false; /* this update is the last one, and has nothing to undo */
        sdfgi_preparation_drop(gi);
        report_off(gi);
        return SDFGI_OK;
    }

    /* Take in what an earlier frame found out. */
    const uint32_t slot = sdfgi_backend_slot(&gi->backend);
    const enum sdfgi_result read = read_back(gi, slot);
    if (read != SDFGI_OK)
        return read;
    sdfgi_volume_make_room(&gi->volume);
    sdfgi_volume_add_emitters(&gi->volume, gi->scene.emissive > 0);
    const bool low_light = sdfgi_volume_add_low_light(&gi->volume, wants_low_light(gi, desc));
    sdfgi_volume_add_instances(&gi->volume, &gi->scene);

    /* Decide what this frame does. */
    const struct frame_input input = frame_input(gi, desc, low_light);
    sdfgi_frame_plan(&gi->frame, &input);

    /* Record it. */
    sdfgi_pass_recorder_begin(&gi->recorder, &gi->backend, gi->volume.resources, cmd,
                              sdfgi_pass_stamps(&gi->frame.work));
    gpu_timer_begin_frame(&gi->volume.resources->timer, slot);
    sdfgi_frame_record(&gi->frame, &gi->scene, &gi->recorder, &gi->draws, slot,
                       sdfgi_backend_number(&gi->backend));
    sdfgi_pass_recorder_end(&gi->recorder);

    /* Take it over as done. */
    const enum lighting_phase before = gi->volume.state.accumulation.phase;
    sdfgi_frame_commit(&gi->frame, &gi->settings, &gi->volume);
    report_frame(gi);
    log_light(gi, before);
    return SDFGI_OK;
}

void sdfgi_cancel_update(sdfgi *gi)
{
    if (!gi->can_cancel)
        return;
    gi->can_cancel = false;
    sdfgi_volume_cancel(&gi->volume);
    gi->backend.retired.frame--;
}
