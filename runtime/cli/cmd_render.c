/* SPDX-License-Identifier: MIT
 * sdfgi render: a picture of a glTF scene, offscreen. */
#include "cli.h"
#include "commands.h"
#include "run_options.h"
#include "file/stop.h"
#include "host/host.h"
#include "image/image.h"
#include "report/report.h"
#include "view/view_file.h"

#include <modules/gltf/gltf_scene.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { AOV_NAME_BYTES = 32, FRAMES_IN_FLIGHT = 2, FRAMES_OFF = 5 };

struct options {
    struct run_scene from;
    struct run_common common;
    const char *frames, *out, *off, *debug_name;
    struct run_lookup_names lookup_names;
    struct cli_size size;
    bool gi;
    struct cli_list set, aov;
    uint32_t supersample, seed;
    double exposure, gi_exposure;
    struct host_light_motion lights;
    /* Derived. */
    uint32_t frame_count; /* 0: until converged */
    struct sdfgi_settings settings;
    struct host_lookups lookups;
    struct run_eyes eyes;
    float eye_distance_m;
    enum sdfgi_debug_view debug; /* SDFGI_DEBUG_VIEW_COUNT: none */
};

/* Everything that has to be taken down again, in order of creation. */
struct run {
    struct gltf_scene *gltf;
    struct host_view view;
    struct host_device *device;
    struct host_scene *scene;
    struct host_renderer *renderer;
    struct report report;
    struct cli_progress progress;
    double seconds;
    struct host_light_motion lights;
    uint32_t frames; /* to render; 0: until converged */
    float exposure;  /* that a PNG was written with */
    struct report_cost cost;
    bool stopped; /* by a signal, before the last frame */
};

/* ---- Arguments -------------------------------------------------------------------------------------- */

static bool parse_frames(struct options *options)
{
    if (strcmp(options->frames, "converged") == 0)
        return true;
    char *end;
    const unsigned long count = strtoul(options->frames, &end, 10);
    if (options->frames[0] < '0' || options->frames[0] > '9' || *end || count == 0 || count > 1000000)
        return false;
    options->frame_count = (uint32_t)count;
    return true;
}

/* The picture without GI has the exposure of the other one: both are PNGs. */
static bool check_off(const struct options *options)
{
    if (!options->off)
        return true;
    if (!options->gi)
        cli_error("render: --off is the picture without GI beside the one with it, and GI is off");
    else if (image_format_from_path(options->out) != IMAGE_PNG)
        cli_error("render: --off needs the exposure of a PNG, and --out is \"%s\"", options->out);
    else if (image_format_from_path(options->off) != IMAGE_PNG)
        cli_error("render: --off is \"%s\", expected a name that ends in .png", options->off);
    else
        return true;
    return false;
}

/* Splits "NAME=FILE"; prints what is wrong with it. */
static const char *split_aov(const char *pair, enum host_aov *aov)
{
    char name[AOV_NAME_BYTES];
    const char *path = cli_split_pair(pair, name, sizeof name);
    *aov = path ? host_aov_from_name(name) : HOST_AOV_COUNT;
    const enum image_format format = path ? image_format_from_path(path) : IMAGE_FORMAT_COUNT;
    if (*aov == HOST_AOV_COUNT)
        cli_error("render: --aov is \"%s\", expected NAME=FILE with a name that sdfgi render --help lists",
                  pair);
    else if (format == IMAGE_FORMAT_COUNT || format == IMAGE_PNG)
        cli_error("render: --aov %s: expected a float format: .exr, .hdr or .pfm", path);
    else
        return path;
    return NULL;
}

static bool check_outputs(const struct options *options)
{
    if (image_format_from_path(options->out) == IMAGE_FORMAT_COUNT) {
        cli_error("render: --out is \"%s\", expected a name that ends in %s", options->out,
                  image_format_list());
        return false;
    }
    if (!check_off(options))
        return false;
    struct output_name names[CLI_LIST_MAX + 3] = { { options->out, "--out", NULL },
                                                   { options->common.report, "--report", NULL },
                                                   { options->off, "--off", NULL } };
    for (uint32_t i = 0; i < options->aov.count; i++) {
        enum host_aov aov;
        const char *pair = options->aov.values[i], *path = split_aov(pair, &aov);
        if (!path)
            return false;
        names[3 + i] = (struct output_name){ path, "--aov", pair };
    }
    return run_check_outputs(names, 3 + options->aov.count);
}

static bool resolve_options(struct options *options)
{
    sdfgi_settings_default(&options->settings);
    options->settings.enabled = options->gi;
    if (!run_apply_settings("render", &options->set, &options->settings) ||
        !run_parse_lookups("render", &options->lookup_names, &options->lookups) ||
        !run_parse_eyes("render", &options->eyes, &options->eye_distance_m) ||
        !run_parse_debug("render", options->debug_name, options->settings.enabled, &options->debug))
        return false;
    if (!parse_frames(options)) {
        cli_error("render: --frames is \"%s\", expected a number from 1 to 1000000 or converged",
                  options->frames);
        return false;
    }
    if ((uint64_t)options->size.width * options->supersample > 16384 ||
        (uint64_t)options->size.height * options->supersample > 16384) {
        cli_error("render: --size times --ssaa is more than 16384 pixels along a side");
        return false;
    }
    const bool turns = options->lights.turn_suns_deg != 0, flickers = options->lights.flicker_percent != 0;
    if ((turns || flickers) && options->frame_count == 0) {
        cli_error("render: %s needs --frames with a number: light does not converge meanwhile",
                  turns ? "--turn-sun" : "--flicker");
        return false;
    }
    return check_outputs(options);
}

static enum cli_outcome parse(struct options *o, int argc, char **argv)
{
    const struct cli_option table[] = {
        { "view", CLI_TEXT, &o->from.view, "VIEW.json",
          .help = "camera, sky and lights; else from the scene" },
        RUN_CAMERA_OPTION(&o->from),
        RUN_SCENE_OPTIONS(&o->from, "time"),
        RUN_LIGHT_OPTIONS(&o->lights, ", to where they are"),
        { "size", CLI_SIZE, &o->size, "WxH", .help = "pixels; 1280x720", .minimum = 1, .maximum = 16384 },
        { "frames", CLI_TEXT, &o->frames, "N", .help = "frames to render, or converged, the default" },
        { "gi", CLI_SWITCH, &o->gi, .help = "global illumination; on" },
        { "lookup", CLI_TEXT, &o->lookup_names.diffuse, "WHERE", .help = RUN_LOOKUP_HELP },
        { "reflections", CLI_TEXT, &o->lookup_names.reflection, "WHERE", .help = RUN_REFLECTIONS_HELP },
        { "gi-exposure", CLI_FLOAT, &o->gi_exposure, "X", .help = RUN_GI_EXPOSURE_HELP, .minimum = 0,
          .maximum = 1e12 },
        { "set", CLI_LIST, &o->set, "KEY=VALUE", .help = "a setting, see sdfgi properties" },
        { "debug", CLI_TEXT, &o->debug_name, "NAME", .help = RUN_DEBUG_HELP },
        { "stereo", CLI_FLAG, &o->eyes.stereo, .help = RUN_STEREO_HELP },
        { "eyes", CLI_FLOAT, &o->eyes.distance_m, "METRES", .help = RUN_EYES_HELP, .minimum = 1e-4,
          .maximum = 1e6 },
        { "aov", CLI_LIST, &o->aov, "NAME=FILE", .help = "one part of the light, as .exr, .hdr or .pfm" },
        RUN_COMMON_OPTIONS(&o->common, RUN_DEVICE_HELP, "times, work, memory and health as JSON"),
        { "ssaa", CLI_UINT, &o->supersample, "N", .help = "samples along a side of a pixel; 1", .minimum = 1,
          .maximum = 4 },
        { "exposure", CLI_FLOAT, &o->exposure, "X", .help = "factor for PNG; 0, the default: automatic",
          .minimum = 0, .maximum = 1e12 },
        { "seed", CLI_UINT, &o->seed, "N", .help = "of the random sequence; 0" },
        { "off", CLI_TEXT, &o->off, "FILE", .help = "the picture without GI, with the same exposure: .png" },
        { "out", CLI_TEXT, &o->out, "FILE", .help = "picture: .png, .exr, .hdr or .pfm", .required = true },
    };
    const struct cli_positional positionals[] = { { "SCENE", &o->from.scene, true } };
    const struct cli_spec spec = {
        "render", "Renders a glTF scene offscreen.", CLI_ARRAY(table), CLI_ARRAY(positionals),
        RUN_SCENE_NOTES "Float pictures are linear radiance without exposure. Parts of the light: "
                        "color, direct, diffuse_indirect,\n"
                        "irradiance, reflection, normal, depth, albedo, roughness. Debug views are linear "
                        "from 0 to 1.\n"
                        "SIGINT and SIGTERM end it after the frame in flight. The files are written "
                        "as they are then, and the exit\n"
                        "code is 128 + the signal's number."
    };
    return cli_parse(&spec, argc, argv);
}

/* ---- Rendering -------------------------------------------------------------------------------------- */

static bool start(struct run *run, struct options *options)
{
    const double aspect = (double)options->size.width / options->size.height;
    run->gltf = run_load_scene("render", &options->from, aspect, options->common.quiet, &run->view);
    if (!run->gltf)
        return false;
    run_fit_cells(&options->from, &options->set, run->gltf, &run->view, &options->settings);
    run->device = run_open_device(options->common.device);
    if (!run->device)
        return false;
    run->scene = host_scene_create(run->device, run->gltf, &run->view);
    const struct host_renderer_desc desc = { .width = options->size.width,
                                             .height = options->size.height,
                                             .supersample = options->supersample,
                                             .settings = &options->settings,
                                             .log = { options->common.quiet ? NULL : run_log, NULL },
                                             .seed = options->seed,
                                             .gi_exposure = (float)options->gi_exposure,
                                             .lookups = options->lookups,
                                             .eye_distance_m = options->eye_distance_m };
    run->renderer = run->scene ? host_renderer_create(run->device, run->scene, &desc) : NULL;
    if (!run->renderer)
        cli_error("%s", host_device_error(run->device));
    return run->renderer != NULL;
}

static void finish(struct run *run)
{
    host_renderer_destroy(run->renderer);
    host_scene_destroy(run->scene);
    host_device_destroy(run->device);
    gltf_scene_destroy(run->gltf);
    view_file_finish(&run->view);
    report_finish(&run->report);
}

/* Of the newest frame that has finished. */
static void collect_times(struct run *run)
{
    struct host_times times;
    host_renderer_get_times(run->renderer, &times);
    if (times.frame_ns > 0)
        report_add_times(&run->report, times.frame_ns - times.shadow_ns, times.update_ns);
    report_add_fog(&run->report, times.fog_ns);
}

/* Before frame `index`. In the last one lights are as view and file have them. */
static void move_lights(struct run *run, uint32_t index)
{
    if (index < run->frames)
        host_scene_move_lights(run->scene, &run->lights, (double)index + 1 - run->frames);
}

static bool collect_frame(void *user, const struct host_frame *frame)
{
    struct run *run = user;
    stop_keep();
    report_add_frame(&run->report, frame->report, frame->gpu_ns);
    collect_times(run);
    cli_progress_update(&run->progress, run->frames == 0
                                            ? (uint64_t)(100.0 * (double)frame->report->converged_fraction)
                                            : frame->index + 1);
    run->stopped = stop_asked();
    move_lights(run, frame->index + 1);
    return !run->stopped;
}

static bool render_frames(struct run *run, const struct options *options)
{
    run->frames = options->frame_count;
    /* Until convergence the bar shows per cent. */
    cli_progress_begin(&run->progress, "rendering", options->frame_count ? options->frame_count : 100);
    run->lights = options->lights;
    move_lights(run, 0);
    const double start_s = cli_time_s();
    const struct host_until_desc until = { .frames = options->frame_count,
                                           .progress = collect_frame,
                                           .user = run };
    const bool rendered = host_render_until(run->renderer, &run->view.camera, &until, NULL);
    run->seconds = cli_time_s() - start_s;
    cli_progress_end(&run->progress);
    if (!rendered) {
        cli_error("%s", host_device_error(run->device));
        return false;
    }
    struct sdfgi_report last;
    host_renderer_get_report(run->renderer, &last);
    report_set_last(&run->report, &last, host_renderer_frame_gpu_ns(run->renderer));
    collect_times(run);
    return true;
}

/* ---- Output ----------------------------------------------------------------------------------------- */

static uint32_t aov_channels(enum host_aov aov)
{
    return aov == HOST_AOV_DEPTH ? 1 : 3;
}

/* HOST_AOV_COUNT: the debug view. */
static bool read_float(struct run *run, const struct options *options, enum host_aov aov, float *rgba)
{
    if (aov == HOST_AOV_COUNT)
        return host_renderer_read_debug(run->renderer, options->debug, (float)options->exposure, rgba);
    return host_renderer_read_aov(run->renderer, aov, rgba);
}

static bool write_float(struct run *run, const struct options *options, enum host_aov aov, const char *path)
{
    char error[CLI_ERROR_BYTES] = "";
    struct image image;
    bool written = image_init(&image, options->size.width, options->size.height, error, sizeof error);
    if (written && !read_float(run, options, aov, image.rgba)) {
        snprintf(error, sizeof error, "%s: %s", path, host_device_error(run->device));
        written = false;
    }
    written = written && image_write_float(path, image.rgba, image.width, image.height, aov_channels(aov),
                                           error, sizeof error);
    image_finish(&image);
    if (!written)
        cli_error("%s", error);
    return written;
}

static bool write_png(struct run *run, const struct options *options, const struct host_picture_desc *desc,
                      const char *path)
{
    char error[CLI_ERROR_BYTES] = "";
    uint8_t *rgba = malloc((size_t)4 * options->size.width * options->size.height);
    bool written = rgba && host_renderer_read_picture(run->renderer, desc, rgba);
    if (!written)
        snprintf(error, sizeof error, "%s: %s", path,
                 rgba ? host_device_error(run->device) : "out of memory");
    written = written &&
              image_write_png(path, rgba, options->size.width, options->size.height, 3, error, sizeof error);
    free(rgba);
    if (!written)
        cli_error("%s", error);
    return written;
}

/* The picture, and the one without GI. */
static bool write_pngs(struct run *run, const struct options *options)
{
    const struct host_picture_desc on = { .exposure = (float)options->exposure,
                                          .exposure_out = &run->exposure,
                                          .debug = &options->debug };
    if (!write_png(run, options, &on, options->out))
        return false;
    const struct host_picture_desc off = { .exposure = run->exposure, .without_gi = true };
    return !options->off || write_png(run, options, &off, options->off);
}

static bool write_run_report(struct run *run, const struct options *options)
{
    char error[CLI_ERROR_BYTES];
    struct host_device_info info;
    struct sdfgi_memory estimate = { .total_bytes = 0 };
    struct report_summary summary = { .width = options->size.width,
                                      .height = options->size.height,
                                      .seconds = run->seconds,
                                      .exposure = (double)run->exposure,
                                      .validation_messages = host_device_validation_count(run->device) };
    host_device_get_info(run->device, &info);
    host_renderer_get_settings(run->renderer, &summary.settings);
    if (summary.settings.enabled)
        sdfgi_estimate_memory(&summary.settings, FRAMES_IN_FLIGHT, &estimate);
    summary.cost = run->cost;
    summary.estimated_bytes = estimate.total_bytes;
    summary.device_name = info.name;
    summary.device_driver = info.driver;
    summary.device_type = info.type;
    if (report_write(&run->report, &summary, options->common.report, error, sizeof error))
        return true;
    cli_error("%s", error);
    return false;
}

/* Draws the view without GI. Its camera rests, so any of the frames with GI would do. */
static bool measure_cost(struct run *run, const struct options *options)
{
    struct report_cost_pair pairs[FRAMES_OFF];
    struct host_times times;
    if (!options->settings.enabled || (options->common.quiet && !options->common.report) || run->stopped)
        return true;
    for (int i = 0; i < FRAMES_OFF; i++) {
        if (!host_renderer_frame_without_gi(run->renderer, &run->view.camera)) {
            cli_error("%s", host_device_error(run->device));
            return false;
        }
        host_renderer_get_times(run->renderer, &times);
        pairs[i] = (struct report_cost_pair){ report_quantile(&run->report.lit_gpu_ns, 0.5),
                                              report_quantile(&run->report.update_gpu_ns, 0.5),
                                              times.frame_ns - times.shadow_ns };
    }
    run->cost = report_cost_of(pairs, FRAMES_OFF);
    return true;
}

static bool write_outputs(struct run *run, const struct options *options)
{
    const bool png = image_format_from_path(options->out) == IMAGE_PNG;
    const enum host_aov shown = options->debug < SDFGI_DEBUG_VIEW_COUNT ? HOST_AOV_COUNT : HOST_AOV_COLOR;
    bool written = png ? write_pngs(run, options) : write_float(run, options, shown, options->out);
    for (uint32_t i = 0; written && i < options->aov.count; i++) {
        enum host_aov aov;
        const char *path = split_aov(options->aov.values[i], &aov);
        written = path && write_float(run, options, aov, path);
    }
    return written && measure_cost(run, options) &&
           (!options->common.report || write_run_report(run, options));
}

static void print_summary(struct run *run, const struct options *options)
{
    const struct sdfgi_report *last = &run->report.last;
    printf("%s: %llu frame%s in %.2f s, %.3f ms GPU per frame (median), GI %s\n", options->out,
           (unsigned long long)run->report.frames, run->report.frames == 1 ? "" : "s", run->seconds,
           1e-6 * (double)report_quantile(&run->report.frame_gpu_ns, 0.5),
           !options->settings.enabled ? "off"
           : last->converged          ? "on, converged"
                                      : "on, not converged");
    for (uint32_t i = 0; i < last->health_count; i++)
        printf("  %s (count %llu)\n", last->health[i].hint, (unsigned long long)last->health[i].count);
    report_cost_print(&run->cost);
}

static void print_stop(const struct run *run, const struct options *options)
{
    cli_error("render: stopped by %s after %llu frame%s; %s shows the light that there was then", stop_name(),
              (unsigned long long)run->report.frames, run->report.frames == 1 ? "" : "s", options->out);
}

int cmd_render(int argc, char **argv)
{
    struct options options = { .frames = "converged",
                               .lookup_names = RUN_LOOKUP_NAMES,
                               .size = { 1280, 720 },
                               .gi = true,
                               .supersample = 1 };
    const enum cli_outcome outcome = parse(&options, argc, argv);
    if (outcome != CLI_RUN)
        return cli_exit_code(outcome);
    if (!resolve_options(&options))
        return CLI_EXIT_USAGE;
    struct run *run = calloc(1, sizeof *run);
    if (!run)
        return cli_error("render: out of memory");
    const bool done = start(run, &options) && render_frames(run, &options) && write_outputs(run, &options);
    const bool stopped = done && run->stopped;
    if (stopped)
        print_stop(run, &options);
    else if (done && !options.common.quiet)
        print_summary(run, &options);
    finish(run);
    free(run);
    return stopped ? stop_exit_code() : done ? CLI_EXIT_OK : CLI_EXIT_FAILURE;
}
