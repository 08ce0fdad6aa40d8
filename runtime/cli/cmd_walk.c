/* SPDX-License-Identifier: MIT
 * sdfgi walk: a camera along a path, GI off and on, with what every frame cost. */
#include "cli.h"
#include "commands.h"
#include "run_options.h"
#include "walk_run.h"
#include "file/stop.h"
#include "file/temporary_file.h"

#include <base/text.h>
#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

static const char default_scene[] = "out/world.glb";

struct options {
    struct run_scene from;
    struct run_common common;
    const char *path, *out, *debug_name;
    struct run_lookup_names lookup_names;
    struct cli_size size;
    struct cli_list set, samples;
    double speed_m_s, fps, start_m, exposure, gi_exposure;
    struct host_light_motion lights;
    uint32_t frames, hold, every, seed;
    bool hold_given, window;
};

static enum cli_outcome parse(struct options *o, int argc, char **argv)
{
    const struct cli_option table[] = {
        { "path", CLI_TEXT, &o->path, "PATH.json", .help = "the way; views/walk.json beside the scene" },
        { "view", CLI_TEXT, &o->from.view, "VIEW.json",
          .help = "sky and lights; else the path's, or the scene's" },
        RUN_SCENE_OPTIONS(&o->from, "time"),
        RUN_LIGHT_OPTIONS(&o->lights, ""),
        { "frames", CLI_UINT, &o->frames, "N", .help = "frames to walk; else to the end of the way",
          .minimum = 1, .maximum = WALK_FRAMES_MAX },
        { "size", CLI_SIZE, &o->size, "WxH", .help = "pixels; 640x360", .minimum = 1, .maximum = 16384 },
        { "speed", CLI_FLOAT, &o->speed_m_s, "M_PER_S", .help = "metres a second; else the path's",
          .minimum = 1e-3, .maximum = 1e6 },
        { "fps", CLI_FLOAT, &o->fps, "F", .help = "frames a second; else the path's", .minimum = 1e-3,
          .maximum = 1e4 },
        { "start", CLI_FLOAT, &o->start_m, "M", .help = "metres of the way to leave out; 0", .minimum = 0,
          .maximum = 1e12 },
        { "hold", CLI_UINT, &o->hold, "N", .help = "frames at rest before; else until converged, at most 60",
          .minimum = 0, .maximum = WALK_FRAMES_MAX, .given = &o->hold_given },
        { "every", CLI_UINT, &o->every, "K", .help = "write each K-th frame, off and on, as PNG",
          .minimum = 1, .maximum = WALK_FRAMES_MAX },
        { "sample", CLI_LIST, &o->samples, "X,Y,Z,NX,NY,NZ", .help = "report diffuse light at a point" },
        { "debug", CLI_TEXT, &o->debug_name, "NAME", .help = RUN_DEBUG_HELP },
        { "lookup", CLI_TEXT, &o->lookup_names.diffuse, "WHERE", .help = RUN_LOOKUP_HELP },
        { "reflections", CLI_TEXT, &o->lookup_names.reflection, "WHERE", .help = RUN_REFLECTIONS_HELP },
        { "gi-exposure", CLI_FLOAT, &o->gi_exposure, "X", .help = RUN_GI_EXPOSURE_HELP, .minimum = 0,
          .maximum = 1e12 },
        { "set", CLI_LIST, &o->set, "KEY=VALUE", .help = "a setting, see sdfgi properties" },
        { "window", CLI_FLAG, &o->window, .help = "show it in a window; no pictures are written" },
        { "exposure", CLI_FLOAT, &o->exposure, "X", .help = "factor for PNG; 0, the default: automatic",
          .minimum = 0, .maximum = 1e12 },
        { "seed", CLI_UINT, &o->seed, "N", .help = "of the random sequence; 0" },
        RUN_COMMON_OPTIONS(&o->common, RUN_DEVICE_HELP, "every frame as JSON; DIR/report.json"),
        { "out", CLI_TEXT, &o->out, "DIR", .help = "folder for what is written", .required = true },
    };
    const struct cli_positional positionals[] = { { "SCENE", &o->from.scene, false } };
    const struct cli_spec spec = {
        "walk", "Drives a camera along a path through a glTF scene.", CLI_ARRAY(table),
        CLI_ARRAY(positionals),
        RUN_SCENE_NOTES
        "Without SCENE, walks through out/world.glb, which ./run.sh makes. Writes\n"
        "  DIR/contact_sheet.png  12 moments, without GI above with GI\n"
        "  DIR/report.json        every frame: passes, why they ran, work, times\n"
        "  DIR/walk.svg           the same as a plot, through gnuplot\n"
        "PATH.json: {\"points\": [[x,y,z], ...]}, and if wanted speed_m_s, fps, yfov_deg,\n"
        "look_at, smooth_m and view (a VIEW.json). A point may be an object with position\n"
        "and look_at.\n"
        "SIGINT and SIGTERM end it after the frame in flight. What is written then tells of the\n"
        "frames before, and the exit code is 128 + the signal's number."
    };
    return cli_parse(&spec, argc, argv);
}

/* ---- What is walked through ------------------------------------------------------------------------- */

/* views/walk.json in the scene's folder. */
static char *default_path(const char *scene)
{
    static const char name[] = "views/walk.json";
    const char *slash = strrchr(scene, '/');
    const size_t folder = slash ? (size_t)(slash + 1 - scene) : 0;
    char *path = malloc(folder + sizeof name);
    if (path) {
        memcpy(path, scene, folder);
        memcpy(path + folder, name, sizeof name);
    }
    return path;
}

static bool load_path(const struct options *o, struct walk_order *order, char **path_name)
{
    char error[CLI_ERROR_BYTES];
    order->from = o->from;
    if (!order->from.scene)
        order->from.scene = default_scene;
    if (!o->from.scene && access(default_scene, F_OK) != 0) {
        cli_error("walk: no SCENE is given, and %s is not there: ./run.sh makes it", default_scene);
        return false;
    }
    *path_name = o->path ? NULL : default_path(order->from.scene);
    order->path_name = o->path ? o->path : *path_name;
    if (!order->path_name) {
        cli_error("walk: out of memory");
        return false;
    }
    if (!o->path && access(order->path_name, F_OK) != 0) {
        cli_error("walk: --path is missing, and there is no %s", order->path_name);
        return false;
    }
    if (walk_path_load(order->path_name, &order->path, error, sizeof error))
        return true;
    cli_error("%s", error);
    return false;
}

/* How many frames, how fast, from where. */
static bool resolve_pace(const struct options *o, struct walk_order *order)
{
    order->lights = o->lights;
    order->speed_m_s = o->speed_m_s > 0 ? o->speed_m_s : order->path.speed_m_s;
    order->fps = o->fps > 0 ? o->fps : order->path.fps;
    order->start_m = o->start_m;
    order->hold = o->hold_given ? o->hold : WALK_HOLD_SETTLED;
    if (order->start_m >= order->path.length_m) {
        cli_error("walk: --start is %g, but the way is only %.6g m long", order->start_m,
                  order->path.length_m);
        return false;
    }
    /* A little more than the last step, so that rounding does not cost it. */
    const double steps = (order->path.length_m - order->start_m) * order->fps / order->speed_m_s + 1e-6;
    if (o->frames == 0 && steps >= WALK_FRAMES_MAX) {
        cli_error("walk: the way takes %.6g frames, more than %d: give --frames, --speed or --fps", steps,
                  WALK_FRAMES_MAX);
        return false;
    }
    order->frames = o->frames > 0 ? o->frames : (uint32_t)steps + 1;
    return true;
}

/* ---- Points whose light is reported ----------------------------------------------------------------- */

/* Six numbers between commas. */
static bool split_numbers(const char *text, double values[6])
{
    for (int i = 0; i < 6; i++) {
        char number[64];
        const size_t length = strcspn(text, ",");
        if (length >= sizeof number || (text[length] == ',') != (i < 5))
            return false;
        memcpy(number, text, length);
        number[length] = '\0';
        if (!base_text_to_double(number, &values[i]))
            return false;
        text += length + (i < 5);
    }
    return true;
}

static bool resolve_samples(const struct options *o, struct walk_order *order)
{
    if (o->samples.count > WALK_SAMPLES_MAX) {
        cli_error("walk: --sample is given %u times, expected at most %d", o->samples.count,
                  WALK_SAMPLES_MAX);
        return false;
    }
    if (o->samples.count > 0 && (o->window || !order->settings.enabled)) {
        cli_error("walk: --sample needs GI, and no --window");
        return false;
    }
    for (uint32_t i = 0; i < o->samples.count; i++) {
        double v[6];
        if (!split_numbers(o->samples.values[i], v) || fabs(v[0]) > 1.5e11 || fabs(v[1]) > 1.5e11 ||
            fabs(v[2]) > 1.5e11 || !(hypot(hypot(v[3], v[4]), v[5]) > 1e-6)) {
            cli_error("walk: --sample is \"%s\", expected X,Y,Z,NX,NY,NZ: a point in metres and a normal",
                      o->samples.values[i]);
            return false;
        }
        order->samples[order->sample_count++] =
            (struct host_sample){ { v[0], v[1], v[2] }, { (float)v[3], (float)v[4], (float)v[5] } };
    }
    return true;
}

/* ---- Outputs ---------------------------------------------------------------------------------------- */

struct outputs {
    bool made_folder;
    char report[WALK_PATH_BYTES], plot[WALK_PATH_BYTES], sheet[WALK_PATH_BYTES];
};

/* What killed walks have left of their pictures. */
static void remove_old_frames(const struct walk_order *order)
{
    char prefix[WALK_PATH_BYTES];
    if (walk_output_path(order, "frame_", prefix))
        temporary_file_remove_leftovers(prefix);
}

static bool resolve_outputs(const struct options *o, const struct walk_order *order, struct outputs *outputs)
{
    const bool fits = walk_output_path(order, "contact_sheet.png", outputs->sheet) &&
                      walk_output_path(order, "walk.svg", outputs->plot) &&
                      (o->common.report ? strlen(o->common.report) < WALK_PATH_BYTES
                                        : walk_output_path(order, "report.json", outputs->report));
    if (!fits) {
        cli_error("walk: --out or --report is longer than %d bytes", WALK_PATH_BYTES - 32);
        return false;
    }
    if (o->common.report)
        strcpy(outputs->report, o->common.report);
    outputs->made_folder = mkdir(order->out, 0777) == 0;
    if (!outputs->made_folder && errno != EEXIST) {
        cli_error("%s: cannot be made: %s", order->out, strerror(errno));
        return false;
    }
    remove_old_frames(order);
    const struct output_name names[] = { { outputs->sheet, "the contact sheet", NULL },
                                         { outputs->plot, "the plot", NULL },
                                         { outputs->report, "--report", NULL } };
    return run_check_outputs(names, 3);
}

static bool write_outputs(const struct walk_result *result, const struct outputs *outputs)
{
    char error[CLI_ERROR_BYTES];
    if (!walk_report_write(&result->record, &result->summary, outputs->report, error, sizeof error)) {
        cli_error("%s", error);
        return false;
    }
    const enum walk_plot_result plot =
        walk_plot_write(&result->record, &result->summary, outputs->plot, error, sizeof error);
    /* Pictures and report are worth keeping where there is no gnuplot. */
    if (plot == WALK_PLOT_NO_GNUPLOT)
        fprintf(stderr, "sdfgi: warning: %s\n", error);
    else if (plot == WALK_PLOT_NOT_WRITTEN)
        cli_error("%s", error);
    return plot != WALK_PLOT_NOT_WRITTEN;
}

static void print_summary(const struct walk_result *result, const char *out)
{
    const struct walk_record *record = &result->record;
    struct walk_statistics gi, cascades, cells, work;
    if (!walk_record_statistics(record, walk_series_gi_gpu_ns, 0, &gi) ||
        !walk_record_statistics(record, walk_series_count, WALK_COUNT_cascades_generated, &cascades) ||
        !walk_record_statistics(record, walk_series_count, WALK_COUNT_scroll_cells, &cells) ||
        !walk_record_statistics(record, walk_series_count, WALK_COUNT_counted_work, &work))
        return;
    printf(
        "%s: %u frames in %.2f s; GI on the GPU: median %.3f ms, 99 %% %.3f ms, worst %.3f ms in frame %u\n",
        out, record->frame_count, result->summary.run.seconds, 1e-6 * gi.median, 1e-6 * gi.p99,
        1e-6 * gi.worst, gi.worst_frame);
    printf("  cascades generated: %.0f in all, at most %.0f in a frame; cells voxelised or given distances: "
           "median "
           "%.0f, 99 %% %.0f, worst %.0f\n",
           cascades.total, cascades.worst, cells.median, cells.p99, cells.worst);
    printf("  counted work: median %.0f, 99 %% %.0f, worst %.0f\n", work.median, work.p99, work.worst);
    for (uint32_t i = 0; i < result->summary.sample_count; i++) {
        uint32_t frame;
        const double change = walk_record_change(record, i, &frame);
        const double *p = result->summary.sample_positions[i];
        printf("  light at (%.6g, %.6g, %.6g): changes by at most %.2f %% from one frame to the next, in "
               "frame %u\n",
               p[0], p[1], p[2], 100 * change, frame);
    }
    report_cost_print(&result->summary.run.cost);
}

/* ---- The command ------------------------------------------------------------------------------------ */

static bool resolve(const struct options *o, struct walk_order *order, char **path_name)
{
    sdfgi_settings_default(&order->settings);
    order->settings.enabled = true;
    order->out = o->out;
    order->size = o->size;
    order->common = o->common;
    order->exposure = o->exposure;
    order->gi_exposure = o->gi_exposure;
    order->seed = o->seed;
    order->every = o->every;
    order->window = o->window;
    if (!run_apply_settings("walk", &o->set, &order->settings) ||
        !run_parse_lookups("walk", &o->lookup_names, &order->lookups) ||
        !run_parse_debug("walk", o->debug_name, order->settings.enabled, &order->debug) ||
        !load_path(o, order, path_name))
        return false;
    if (!order->from.view)
        order->from.view = order->path.view;
    return resolve_pace(o, order) && resolve_samples(o, order);
}

static int walk(const struct options *options, struct walk_order *order)
{
    struct outputs outputs = { .made_folder = false };
    struct walk_result result = { .record = { NULL } };
    const bool walked = resolve_outputs(options, order, &outputs) && walk_run(order, &result) &&
                        write_outputs(&result, &outputs);
    /* Stays where anything was written. */
    if (!walked && outputs.made_folder)
        rmdir(order->out);
    const uint32_t frames = result.record.frame_count;
    const bool stopped = walked && stop_asked() && frames < order->frames;
    if (stopped)
        cli_error("walk: stopped by %s after %u of %u frames; %s has the report and the plot%s of those",
                  stop_name(), frames, order->frames, order->out, order->window ? "" : " and the pictures");
    else if (walked && !order->common.quiet)
        print_summary(&result, order->out);
    walk_record_finish(&result.record);
    return stopped ? stop_exit_code() : walked ? CLI_EXIT_OK : CLI_EXIT_FAILURE;
}

int cmd_walk(int argc, char **argv)
{
    struct options options = { .lookup_names = RUN_LOOKUP_NAMES, .size = { 640, 360 } };
    struct walk_order order = { .path = { NULL } };
    char *path_name = NULL;
    const enum cli_outcome outcome = parse(&options, argc, argv);
    if (outcome != CLI_RUN)
        return cli_exit_code(outcome);
    const int code = resolve(&options, &order, &path_name) ? walk(&options, &order) : CLI_EXIT_USAGE;
    walk_path_finish(&order.path);
    free(path_name);
    return code;
}
