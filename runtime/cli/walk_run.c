/* SPDX-License-Identifier: MIT */
#include "walk_run.h"

#include "run_options.h"
#include "file/stop.h"
#include "image/image.h"
#include "view/view_file.h"
#include "walk/walk_sheet.h"

#include <math.h>
#include <modules/gltf/gltf_scene.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* FRAMES_LATE: the library reads times back when its frame's slot comes round again. */
enum { SHEET_MOMENTS = 12, FRAMES_LATE = 2, COST_STEP = 10 };

/* Everything that has to be taken down again, in order of creation. */
struct run {
    const struct walk_order *order;
    struct walk_result *result;
    struct gltf_scene *gltf;
    struct host_view view;
    struct host_device *device;
    struct host_scene *scene;
    struct host_renderer *on, *off;
    struct walk_sheet sheet;
    uint8_t *picture;
    struct report_cost_pair *pairs; /* of every COST_STEP-th frame */
    struct cli_progress progress;
    bool walking; /* in a window: light has settled */
};

bool walk_output_path(const struct walk_order *order, const char *name, char path[WALK_PATH_BYTES])
{
    const int length = snprintf(path, WALK_PATH_BYTES, "%s/%s", order->out, name);
    return length > 0 && length < WALK_PATH_BYTES;
}

static double frame_distance_m(const struct walk_order *order, uint32_t index)
{
    return order->start_m + index * order->speed_m_s / order->fps;
}

void walk_order_camera(const struct walk_order *order, uint32_t index, struct host_camera *camera)
{
    walk_path_camera(&order->path, frame_distance_m(order, index), camera);
}

static bool fail_device(const struct run *run)
{
    cli_error("%s", host_device_error(run->device));
    return false;
}

/* ---- Records ---------------------------------------------------------------------------------------- */

/* Appends frame `index` of the walk as it has just been recorded. */
static bool record_frame(struct run *run, uint32_t index, const struct sdfgi_report *report)
{
    struct walk_record *record = &run->result->record;
    struct host_camera camera;
    if (!walk_record_add(record, report)) {
        cli_error("walk: out of memory");
        return false;
    }
    struct walk_frame *frame = &record->frames[record->frame_count - 1];
    walk_order_camera(run->order, index, &camera);
    memcpy(frame->position, camera.position, sizeof frame->position);
    frame->distance_m = fmin(frame_distance_m(run->order, index), run->order->path.length_m);
    return true;
}

/* ---- Pictures --------------------------------------------------------------------------------------- */

static uint32_t sheet_moments(const struct walk_order *order)
{
    return order->frames < SHEET_MOMENTS ? order->frames : SHEET_MOMENTS;
}

/* The frame of a moment of the sheet: evenly spread, both ends included. */
static uint32_t moment_frame(const struct walk_order *order, uint32_t moment)
{
    const uint32_t last = sheet_moments(order) - 1;
    return last > 0 ? (uint32_t)((uint64_t)moment * (order->frames - 1) / last) : 0;
}

/* The moment at which frame `index` is shown in the sheet, or -1. */
static int32_t frame_moment(const struct walk_order *order, uint32_t index)
{
    for (uint32_t moment = 0; moment < sheet_moments(order); moment++)
        if (moment_frame(order, moment) == index)
            return (int32_t)moment;
    return -1;
}

static bool write_picture(struct run *run, const char *name)
{
    char path[WALK_PATH_BYTES], error[CLI_ERROR_BYTES];
    if (!walk_output_path(run->order, name, path)) {
        cli_error("walk: --out is too long a name");
        return false;
    }
    if (image_write_png(path, run->picture, run->order->size.width, run->order->size.height, 3, error,
                        sizeof error))
        return true;
    cli_error("%s", error);
    return false;
}

/* One picture of the pair, at the exposure that the one with GI asks for. */
static bool take_picture(struct run *run, uint32_t index, bool gi, float *exposure)
{
    const struct walk_order *order = run->order;
    const int32_t moment = frame_moment(order, index);
    const struct host_picture_desc desc = { .exposure = *exposure,
                                            .exposure_out = exposure,
                                            .debug = gi ? &order->debug : NULL };
    if (!host_renderer_read_picture(gi ? run->on : run->off, &desc, run->picture))
        return fail_device(run);
    if (moment >= 0)
        walk_sheet_add(&run->sheet, (uint32_t)moment, gi, run->picture);
    if (order->every == 0 || index % order->every != 0)
        return true;
    char name[64];
    snprintf(name, sizeof name, "frame_%06u.%s.png", index, gi ? "on" : "off");
    return write_picture(run, name);
}

static bool take_pictures(struct run *run, uint32_t index, const struct host_camera *camera)
{
    const struct walk_order *order = run->order;
    float exposure = (float)order->exposure;
    if (frame_moment(order, index) < 0 && (order->every == 0 || index % order->every != 0))
        return true;
    if (!take_picture(run, index, true, &exposure))
        return false;
    if (!host_renderer_frame(run->off, camera))
        return fail_device(run);
    return take_picture(run, index, false, &exposure);
}

static bool write_sheet(struct run *run)
{
    char path[WALK_PATH_BYTES], error[CLI_ERROR_BYTES];
    const struct walk_sheet *sheet = &run->sheet;
    if (walk_output_path(run->order, "contact_sheet.png", path) &&
        image_write_png(path, sheet->rgba, sheet->width, sheet->height, 3, error, sizeof error))
        return true;
    cli_error("%s", error);
    return false;
}

/* ---- Cost ------------------------------------------------------------------------------------------- */

static uint32_t pair_count(uint32_t frames)
{
    return (frames + COST_STEP - 1) / COST_STEP;
}

/* Draws a frame again without GI. */
static bool compare_cost(struct run *run, uint32_t index, const struct host_camera *camera,
                         const struct host_times *on)
{
    const struct host_until_desc one = { .frames = 1 };
    struct host_times off;
    if (index % COST_STEP != 0 || !run->order->settings.enabled)
        return true;
    if (!host_render_until(run->off, camera, &one, NULL))
        return fail_device(run);
    host_renderer_get_times(run->off, &off);
    run->pairs[index / COST_STEP] = (struct report_cost_pair){ on->frame_ns - on->shadow_ns, on->update_ns,
                                                               off.frame_ns - off.shadow_ns };
    return true;
}

/* ---- Offscreen -------------------------------------------------------------------------------------- */

static struct host_renderer *start_renderer(struct run *run, bool gi)
{
    const struct walk_order *order = run->order;
    struct sdfgi_settings settings = order->settings;
    settings.enabled = settings.enabled && gi;
    const struct host_renderer_desc desc = { .width = order->size.width,
                                             .height = order->size.height,
                                             .settings = &settings,
                                             .log = { gi && !order->common.quiet ? run_log : NULL, NULL },
                                             .seed = order->seed,
                                             .gi_exposure = (float)order->gi_exposure,
                                             .lookups = order->lookups };
    return host_renderer_create(run->device, run->scene, &desc);
}

static bool start_offscreen(struct run *run)
{
    const struct cli_size size = run->order->size;
    run->device = run_open_device(run->order->common.device);
    if (!run->device)
        return false;
    run->scene = host_scene_create(run->device, run->gltf, &run->view);
    run->on = run->scene ? start_renderer(run, true) : NULL;
    run->off = run->on ? start_renderer(run, false) : NULL;
    if (!run->off)
        return fail_device(run);
    run->picture = malloc((size_t)4 * size.width * size.height);
    run->pairs = calloc(pair_count(run->order->frames), sizeof *run->pairs);
    if (run->picture && run->pairs &&
        walk_sheet_init(&run->sheet, sheet_moments(run->order), size.width, size.height))
        return true;
    cli_error("walk: out of memory");
    return false;
}

/* Lets light settle before the camera moves. */
static bool hold(struct run *run)
{
    const uint32_t wanted = run->order->hold;
    const struct host_until_desc until = { .frames = wanted == WALK_HOLD_SETTLED ? 0 : wanted,
                                           .max_frames = WALK_HOLD_MAX };
    struct host_camera camera;
    walk_order_camera(run->order, 0, &camera);
    if (wanted == 0 || host_render_until(run->on, &camera, &until, &run->result->summary.hold_frames))
        return true;
    return fail_device(run);
}

/* One frame, waited for, so that its time is not another's. */
static bool render_frame(struct run *run, const struct host_camera *camera, struct sdfgi_report *report)
{
    const struct host_until_desc one = { .frames = 1 };
    if (!host_render_until(run->on, camera, &one, NULL))
        return fail_device(run);
    host_renderer_get_report(run->on, report);
    return true;
}

static bool walk_frame(struct run *run, uint32_t index)
{
    const struct walk_order *order = run->order;
    struct sdfgi_report report;
    struct host_camera camera;
    struct host_times times;
    walk_order_camera(order, index, &camera);
    host_scene_move_lights(run->scene, &order->lights, index);
    if (!render_frame(run, &camera, &report) || !record_frame(run, index, &report))
        return false;
    struct walk_record *record = &run->result->record;
    struct walk_frame *frame = &record->frames[index];
    host_renderer_get_times(run->on, &times);
    frame->gpu_ns = times.frame_ns;
    walk_record_times(record, (int64_t)index - FRAMES_LATE, &report);
    if (order->sample_count > 0 &&
        !host_renderer_sample(run->on, order->samples, order->sample_count, frame->irradiance))
        return fail_device(run);
    return take_pictures(run, index, &camera) && compare_cost(run, index, &camera, &times);
}

/* The times of the last frames come back while others are rendered. */
static bool collect_times(struct run *run)
{
    const uint32_t frames = run->order->frames;
    struct sdfgi_report report;
    struct host_camera camera;
    walk_order_camera(run->order, frames - 1, &camera);
    for (uint32_t i = 0; i < FRAMES_LATE; i++) {
        if (!render_frame(run, &camera, &report))
            return false;
        walk_record_times(&run->result->record, (int64_t)frames + i - FRAMES_LATE, &report);
    }
    return true;
}

static bool walk_offscreen(struct run *run)
{
    const uint32_t frames = run->order->frames;
    bool walked = start_offscreen(run) && hold(run);
    cli_progress_begin(&run->progress, "walking", frames);
    for (uint32_t i = 0; walked && i < frames && !stop_asked(); i++) {
        walked = walk_frame(run, i);
        stop_keep();
        cli_progress_update(&run->progress, i + 1);
    }
    const uint32_t done = run->result->record.frame_count;
    /* Who stops a walk does not want to wait for the times of its last frames. */
    walked = walked && (done < frames || collect_times(run));
    cli_progress_end(&run->progress);
    if (walked) {
        host_device_get_info(run->device, &run->result->device);
        if (run->order->settings.enabled)
            run->result->summary.run.cost = report_cost_of(run->pairs, pair_count(done));
        run->result->summary.run.validation_messages = host_device_validation_count(run->device);
    }
    return walked && write_sheet(run);
}

/* ---- In a window ------------------------------------------------------------------------------------ */

#ifdef SDFGI_WITH_WINDOW

static bool lead_camera(void *user, uint32_t frame, struct host_camera *camera)
{
    struct run *run = user;
    const uint32_t index = run->walking ? frame - run->result->summary.hold_frames : 0;
    walk_order_camera(run->order, index, camera);
    return index < run->order->frames + FRAMES_LATE;
}

/* Frame `frame->index` has been drawn; with the next one the walk may begin. */
static bool follow_window(void *user, const struct host_frame *frame)
{
    struct run *run = user;
    const uint32_t held = frame->index + 1, wanted = run->order->hold;
    uint32_t *hold_frames = &run->result->summary.hold_frames;
    if (!run->walking) {
        run->walking =
            wanted == WALK_HOLD_SETTLED ? frame->report->converged || held >= WALK_HOLD_MAX : held >= wanted;
        *hold_frames = held;
        return true;
    }
    struct walk_record *record = &run->result->record;
    const uint32_t index = frame->index - *hold_frames;
    if (index < run->order->frames && !record_frame(run, index, frame->report))
        return false;
    walk_record_times(record, (int64_t)index - FRAMES_LATE, frame->report);
    stop_keep();
    if (index >= FRAMES_LATE)
        record->frames[index - FRAMES_LATE].gpu_ns = frame->gpu_ns;
    return true;
}

static bool walk_in_window(struct run *run)
{
    const struct walk_order *order = run->order;
    char error[CLI_ERROR_BYTES];
    run->walking = order->hold == 0;
    const struct host_window_desc desc = { .device_select = order->common.device,
                                           .cache_folder = run_cache_folder(),
                                           .gltf = run->gltf,
                                           .view = &run->view,
                                           .settings = &order->settings,
                                           .lookups = order->lookups,
                                           .debug = &order->debug,
                                           .lights = order->lights,
                                           .width = order->size.width,
                                           .height = order->size.height,
                                           .log = { run_log, NULL },
                                           .camera = lead_camera,
                                           .progress = follow_window,
                                           .stop = stop_asked,
                                           .user = run,
                                           .device_info = &run->result->device };
    if (host_window_run(&desc, error, sizeof error))
        return true;
    cli_error("walk: %s", error);
    return false;
}

#else

static bool walk_in_window(struct run *run)
{
    (void)run;
    cli_error("walk: --window: this program was built without windows");
    return false;
}

#endif

/* ---- The whole -------------------------------------------------------------------------------------- */

static void finish(struct run *run)
{
    host_renderer_destroy(run->off);
    host_renderer_destroy(run->on);
    host_scene_destroy(run->scene);
    host_device_destroy(run->device);
    gltf_scene_destroy(run->gltf);
    view_file_finish(&run->view);
    walk_sheet_finish(&run->sheet);
    free(run->picture);
    free(run->pairs);
}

static void summarise(const struct walk_order *order, struct walk_result *result)
{
    struct walk_summary *summary = &result->summary;
    struct sdfgi_memory estimate = { .total_bytes = 0 };
    if (order->settings.enabled)
        sdfgi_estimate_memory(&order->settings, FRAMES_LATE, &estimate);
    summary->run.device_name = result->device.name;
    summary->run.device_driver = result->device.driver;
    summary->run.device_type = result->device.type;
    summary->run.width = order->size.width;
    summary->run.height = order->size.height;
    summary->run.settings = order->settings;
    summary->run.estimated_bytes = estimate.total_bytes;
    summary->scene = order->from.scene;
    summary->path = order->path_name;
    summary->length_m = order->path.length_m;
    summary->start_m = order->start_m;
    summary->speed_m_s = order->speed_m_s;
    summary->fps = order->fps;
    summary->frames_asked = order->frames;
    summary->sample_count = order->sample_count;
    for (uint32_t i = 0; i < order->sample_count; i++) {
        memcpy(summary->sample_positions[i], order->samples[i].position, sizeof order->samples[i].position);
        memcpy(summary->sample_normals[i], order->samples[i].normal, sizeof order->samples[i].normal);
    }
}

bool walk_run(const struct walk_order *order, struct walk_result *result)
{
    struct run run = { .order = order, .result = result };
    const double start_s = cli_time_s();
    const double aspect = (double)order->size.width / order->size.height;
    run.gltf = run_load_scene("walk", &order->from, aspect, order->common.quiet, &run.view);
    const bool walked = run.gltf && (order->window ? walk_in_window(&run) : walk_offscreen(&run));
    result->summary.run.seconds = cli_time_s() - start_s;
    finish(&run);
    summarise(order, result);
    return walked;
}
