/* SPDX-License-Identifier: MIT
 * sdfgi view: a glTF scene in a window. */
#include "cli.h"
#include "commands.h"
#include "run_options.h"
#include "file/stop.h"
#include "host/host.h"
#include "report/report.h"
#include "view/view_file.h"

#include <modules/gltf/gltf_scene.h>

#ifdef SDFGI_WITH_EDITOR
#include "view_editor.h"
#define PANEL_HELP "F1 opens a panel: effects, debug views, all settings, what the frame did and why.\n"
#else
#define PANEL_HELP ""
#endif

enum { FRAMES_IN_FLIGHT = 2 };

struct options {
    struct run_scene from;
    struct run_common common;
    const char *debug_name;
    struct run_lookup_names lookup_names;
    struct cli_size size;
    struct cli_list set;
    struct run_eyes eyes;
    bool gi;
    struct host_light_motion lights;
    uint32_t frames;
};

static enum cli_outcome parse(struct options *o, int argc, char **argv)
{
    const struct cli_option table[] = {
        { "view", CLI_TEXT, &o->from.view, "VIEW.json",
          .help = "camera, sky and lights; else from the scene" },
        RUN_CAMERA_OPTION(&o->from),
        RUN_SCENE_OPTIONS(&o->from, "time"),
        RUN_LIGHT_OPTIONS(&o->lights, ""),
        { "size", CLI_SIZE, &o->size, "WxH", .help = "pixels; 1280x720", .minimum = 1, .maximum = 16384 },
        { "gi", CLI_SWITCH, &o->gi, .help = "global illumination at the start; on" },
        { "lookup", CLI_TEXT, &o->lookup_names.diffuse, "WHERE", .help = RUN_LOOKUP_HELP },
        { "reflections", CLI_TEXT, &o->lookup_names.reflection, "WHERE", .help = RUN_REFLECTIONS_HELP },
        { "debug", CLI_TEXT, &o->debug_name, "NAME", .help = RUN_DEBUG_HELP },
        { "stereo", CLI_FLAG, &o->eyes.stereo, .help = RUN_STEREO_HELP },
        { "eyes", CLI_FLOAT, &o->eyes.distance_m, "METRES", .help = RUN_EYES_HELP, .minimum = 1e-4,
          .maximum = 1e6 },
        { "set", CLI_LIST, &o->set, "KEY=VALUE", .help = "a setting, see sdfgi properties" },
        RUN_COMMON_OPTIONS(&o->common, RUN_DEVICE_HELP, "times, work, memory and health as JSON"),
        { "frames", CLI_UINT, &o->frames, "N", .help = "close after that many; 0, the default: never" },
    };
    const struct cli_positional positionals[] = { { "SCENE", &o->from.scene, true } };
    const struct cli_spec spec = {
        "view", "Shows a glTF scene in a window.", CLI_ARRAY(table), CLI_ARRAY(positionals),
        RUN_SCENE_NOTES PANEL_HELP
        "G switches global illumination. V and Shift V walk through the debug views that\n"
        "sdfgi info lists, 1 to 9 choose one of the first nine, 0 the picture, and F2 walks\n"
        "through parts of its light. WASD, Q and E move, Shift hurries, a held mouse button\n"
        "turns, Escape closes. SIGINT and SIGTERM close, too; the exit code is 128 + the\n"
        "signal's number then."
    };
    return cli_parse(&spec, argc, argv);
}

/* Asked before each frame: from the first on there is a window to close. */
static bool stop_view(void)
{
    stop_keep();
    return stop_asked();
}

/* With the panel, where it is built. */
static bool run_window(struct host_window_desc *desc, char *error, size_t error_size)
{
#ifdef SDFGI_WITH_EDITOR
    struct view_editor editor = { NULL };
    const struct host_overlay overlay = view_editor_overlay(&editor);
    desc->overlay = &overlay;
#endif
    return host_window_run(desc, error, error_size);
}

/* What --report is made of. */
struct record {
    struct report report;
    struct host_device_info device;
    double start_s;
};

static bool collect_frame(void *user, const struct host_frame *frame)
{
    struct record *record = user;
    report_add_frame(&record->report, frame->report, frame->gpu_ns);
    report_set_last(&record->report, frame->report, 0);
    return true;
}

static bool record_write(struct record *record, const struct options *options,
                         const struct sdfgi_settings *settings)
{
    char error[CLI_ERROR_BYTES];
    struct sdfgi_memory estimate = { .total_bytes = 0 };
    if (settings->enabled)
        sdfgi_estimate_memory(settings, FRAMES_IN_FLIGHT, &estimate);
    const struct report_summary summary = { .width = options->size.width,
                                            .height = options->size.height,
                                            .seconds = cli_time_s() - record->start_s,
                                            .settings = *settings,
                                            .estimated_bytes = estimate.total_bytes,
                                            .device_name = record->device.name,
                                            .device_driver = record->device.driver,
                                            .device_type = record->device.type };
    if (report_write(&record->report, &summary, options->common.report, error, sizeof error))
        return true;
    cli_error("%s", error);
    return false;
}

static int view_scene(const struct options *options, struct sdfgi_settings *settings,
                      struct host_window_desc *desc)
{
    char error[CLI_ERROR_BYTES];
    struct host_view view;
    struct record record = { .start_s = cli_time_s() };
    const double aspect = (double)options->size.width / options->size.height;
    struct gltf_scene *gltf = run_load_scene("view", &options->from, aspect, options->common.quiet, &view);
    if (!gltf)
        return CLI_EXIT_FAILURE;
    run_fit_cells(&options->from, &options->set, gltf, &view, settings);
    desc->gltf = gltf;
    desc->view = &view;
    desc->progress = options->common.report ? collect_frame : NULL;
    desc->user = &record;
    desc->device_info = &record.device;
    bool ok = run_window(desc, error, sizeof(error));
    if (!ok || stop_asked())
        cli_error("view: %s%s", ok ? "closed by " : error, ok ? stop_name() : "");
    ok = ok && (!options->common.report || record_write(&record, options, settings));
    report_finish(&record.report);
    gltf_scene_destroy(gltf);
    view_file_finish(&view);
    return !ok ? CLI_EXIT_FAILURE : stop_asked() ? stop_exit_code() : CLI_EXIT_OK;
}

int cmd_view(int argc, char **argv)
{
    struct options options = { .lookup_names = RUN_LOOKUP_NAMES, .gi = true, .size = { 1280, 720 } };
    struct sdfgi_settings settings;
    enum sdfgi_debug_view debug;
    const enum cli_outcome outcome = parse(&options, argc, argv);
    if (outcome != CLI_RUN)
        return cli_exit_code(outcome);
    const struct output_name report = { options.common.report, "--report", NULL };
    struct host_window_desc desc = { .device_select = options.common.device,
                                     .cache_folder = run_cache_folder(),
                                     .settings = &settings,
                                     .debug = &debug,
                                     .width = options.size.width,
                                     .height = options.size.height,
                                     .frames = options.frames,
                                     .lights = options.lights,
                                     .stop = stop_view,
                                     .log = { options.common.quiet ? NULL : run_log, NULL } };
    sdfgi_settings_default(&settings);
    settings.enabled = options.gi;
    if (!run_apply_settings("view", &options.set, &settings) ||
        !run_parse_lookups("view", &options.lookup_names, &desc.lookups) ||
        !run_parse_eyes("view", &options.eyes, &desc.eye_distance_m) ||
        !run_parse_debug("view", options.debug_name, settings.enabled, &debug) ||
        !run_check_outputs(&report, 1))
        return CLI_EXIT_USAGE;
    return view_scene(&options, &settings, &desc);
}
