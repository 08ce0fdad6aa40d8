/* SPDX-License-Identifier: MIT
 * sdfgi view: a glTF scene in a window. */
#include "cli.h"
#include "commands.h"
#include "run_options.h"
#include "file/stop.h"
#include "host/host.h"
#include "view/view_file.h"

#include <modules/gltf/gltf_scene.h>

#ifdef SDFGI_WITH_EDITOR
#include "view_editor.h"
#define PANEL_HELP "F1 opens a panel: effects, debug views, all settings, what the frame did and why.\n"
#else
#define PANEL_HELP ""
#endif

struct options {
    const char *scene, *view, *device, *debug_name;
    struct run_lookup_names lookup_names;
    struct cli_size size;
    struct cli_list set;
    struct run_eyes eyes;
    bool gi;
    uint32_t frames;
};

static enum cli_outcome parse(struct options *o, int argc, char **argv)
{
    const struct cli_option table[] = {
        { "view", CLI_TEXT, &o->view, "VIEW.json", .help = "camera, sky and lights; else from the scene" },
        { "size", CLI_SIZE, &o->size, "WxH", .help = "pixels; 1280x720", .minimum = 1, .maximum = 16384 },
        { "gi", CLI_SWITCH, &o->gi, .help = "global illumination at the start; on" },
        { "lookup", CLI_TEXT, &o->lookup_names.diffuse, "WHERE", .help = RUN_LOOKUP_HELP },
        { "reflections", CLI_TEXT, &o->lookup_names.reflection, "WHERE", .help = RUN_REFLECTIONS_HELP },
        { "debug", CLI_TEXT, &o->debug_name, "NAME", .help = RUN_DEBUG_HELP },
        { "stereo", CLI_FLAG, &o->eyes.stereo, .help = RUN_STEREO_HELP },
        { "eyes", CLI_FLOAT, &o->eyes.distance_m, "METRES", .help = RUN_EYES_HELP, .minimum = 1e-4,
          .maximum = 1e6 },
        { "set", CLI_LIST, &o->set, "KEY=VALUE", .help = "a setting, see sdfgi properties" },
        { "device", CLI_TEXT, &o->device, "N", .help = "index of the device or a part of its name" },
        { "frames", CLI_UINT, &o->frames, "N", .help = "close after that many; 0, the default: never" },
    };
    const struct cli_positional positionals[] = { { "SCENE", &o->scene, true } };
    const struct cli_spec spec = {
        "view", "Shows a glTF scene in a window.", CLI_ARRAY(table), CLI_ARRAY(positionals),
        PANEL_HELP "G switches global illumination. V and Shift V walk through the debug views that\n"
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

int cmd_view(int argc, char **argv)
{
    struct options options = { .lookup_names = RUN_LOOKUP_NAMES, .gi = true, .size = { 1280, 720 } };
    struct sdfgi_settings settings;
    struct host_lookups lookups;
    enum sdfgi_debug_view debug;
    struct host_view view;
    float eye_distance_m;
    char error[CLI_ERROR_BYTES];
    const enum cli_outcome outcome = parse(&options, argc, argv);
    if (outcome != CLI_RUN)
        return cli_exit_code(outcome);
    sdfgi_settings_default(&settings);
    settings.enabled = options.gi;
    if (!run_apply_settings("view", &options.set, &settings) ||
        !run_parse_lookups("view", &options.lookup_names, &lookups) ||
        !run_parse_eyes("view", &options.eyes, &eye_distance_m) ||
        !run_parse_debug("view", options.debug_name, settings.enabled, &debug))
        return CLI_EXIT_USAGE;
    struct gltf_scene *gltf = run_load_scene(options.scene, options.view, &view);
    if (!gltf)
        return CLI_EXIT_FAILURE;
    struct host_window_desc desc = { .device_select = options.device,
                                     .cache_folder = run_cache_folder(),
                                     .gltf = gltf,
                                     .view = &view,
                                     .settings = &settings,
                                     .lookups = lookups,
                                     .eye_distance_m = eye_distance_m,
                                     .debug = &debug,
                                     .width = options.size.width,
                                     .height = options.size.height,
                                     .frames = options.frames,
                                     .stop = stop_view,
                                     .log = { run_log, NULL } };
    const bool ok = run_window(&desc, error, sizeof(error));
    if (!ok || stop_asked())
        cli_error("view: %s%s", ok ? "closed by " : error, ok ? stop_name() : "");
    gltf_scene_destroy(gltf);
    view_file_finish(&view);
    return !ok ? CLI_EXIT_FAILURE : stop_asked() ? stop_exit_code() : CLI_EXIT_OK;
}
