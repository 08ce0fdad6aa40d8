/* SPDX-License-Identifier: MIT
 * sdfgi reference: path-traced ground truth. */
#include "cli.h"
#include "commands.h"
#include "reference_voxels.h"
#include "run_options.h"
#include "file/json_write.h"
#include "file/output_file.h"
#include "file/stop.h"
#include "image/image.h"
#include "view/view_file.h"

#include <modules/gltf/gltf_scene.h>
#include <math.h>
#include <modules/raycast/raycast.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { AOV_NAME_BYTES = 32, DEFAULT_SPP = 64, PATH_BYTES = 4096 };

static const double state_interval_s = 30;
static const double degrees_per_radian = 57.29577951308232;

struct options {
    struct run_scene from;
    struct run_common common;
    const char *out, *geometry;
    struct cli_size size;
    struct cli_list aov, set;
    uint32_t spp, bounces, threads;
    uint64_t seed;
    double seconds, error;
    bool spp_given, resume, cull_back_faces;
    /* Derived. */
    bool voxels;
    struct sdfgi_settings settings;           /* that shape the voxels */
    const char *aov_paths[RAYCAST_AOV_COUNT]; /* NULL: not wanted */
    char *state_path;
};

struct run {
    const struct options *options;
    struct gltf_scene *gltf;
    struct host_view view;
    struct reference_voxels voxels;
    struct raycast *raycast;
    struct cli_progress bar;
    double saved_s; /* when the state was last written */
    bool saved;     /* by this run */
    char spare_path[PATH_BYTES];
};

/* ---- Arguments -------------------------------------------------------------------------------------- */

static bool check_format(const char *path)
{
    const enum image_format format = image_format_from_path(path);
    if (format != IMAGE_FORMAT_COUNT && format != IMAGE_PNG)
        return true;
    cli_error("reference: %s: expected a float format: .exr, .hdr or .pfm", path);
    return false;
}

static bool parse_aov(struct options *options, const char *pair)
{
    char name[AOV_NAME_BYTES];
    const char *path = cli_split_pair(pair, name, sizeof name);
    for (int aov = 0; path && aov < RAYCAST_AOV_COUNT; aov++) {
        if (strcmp(name, raycast_aov_name(aov)) != 0)
            continue;
        if (options->aov_paths[aov]) {
            cli_error("reference: --aov %s is given twice", name);
            return false;
        }
        options->aov_paths[aov] = path;
        return check_format(path);
    }
    cli_error("reference: --aov is \"%s\", expected NAME=FILE with a name that sdfgi reference --help lists",
              pair);
    return false;
}

static bool parse_geometry(struct options *options)
{
    options->voxels = strcmp(options->geometry, "voxels") == 0;
    if (!options->voxels && strcmp(options->geometry, "triangles") != 0) {
        cli_error("reference: --geometry is \"%s\", expected triangles or voxels", options->geometry);
        return false;
    }
    if (!options->voxels && options->set.count > 0) {
        cli_error("reference: --set is of use with --geometry voxels alone");
        return false;
    }
    sdfgi_settings_default(&options->settings);
    return run_apply_settings("reference", &options->set, &options->settings);
}

static bool check_outputs(struct options *options)
{
    struct output_name names[CLI_LIST_MAX + 2] = { { options->out, "--out", NULL },
                                                   { options->common.report, "--report", NULL } };
    if (!check_format(options->out))
        return false;
    for (uint32_t i = 0; i < options->aov.count; i++) {
        const char *pair = options->aov.values[i];
        if (!parse_aov(options, pair))
            return false;
        names[2 + i] = (struct output_name){ strchr(pair, '=') + 1, "--aov", pair };
    }
    return run_check_outputs(names, 2 + options->aov.count);
}

/* What the parser cannot know. */
static bool options_finish(struct options *options)
{
    if (!options->spp_given && (options->seconds > 0 || options->error > 0))
        options->spp = 0;
    if (!parse_geometry(options) || !check_outputs(options))
        return false;
    const size_t bytes = strlen(options->out) + sizeof ".state";
    options->state_path = malloc(bytes);
    if (!options->state_path) {
        cli_error("reference: out of memory");
        return false;
    }
    snprintf(options->state_path, bytes, "%s.state", options->out);
    return true;
}

static const char notes[] = RUN_SCENE_NOTES
    "AOVs: radiance, emission, direct, diffuse_indirect, reflection, irradiance, normal, depth, albedo, and\n"
    "variance (of the mean, per channel). --spp counts from the start of the picture, --time from the start "
    "of\n"
    "this run; whichever limit comes first ends it. SIGINT and SIGTERM end it as well: the pictures show "
    "the\n"
    "samples there are, and the exit code is 128 + the signal's number. Such a run keeps its samples in\n"
    "OUT.state, and so does one whose pictures cannot be written, one whose time did not do for a sample in\n"
    "each pixel (no picture, exit code 1), and every run with --resume. The same command with --resume goes "
    "on\n"
    "from there, to the same bits as a run that was never stopped.\n"
    "--geometry voxels traces what the renderer's rays see: the set sub-voxels of its cascades, placed as "
    "for "
    "this\nview, with the albedo, emission and normals found there. The camera, and sun, point and spot "
    "lights on "
    "what it\nsees, still meet triangles. Of the settings, those that shape voxels count: cascades, "
    "min_cell_size, y_scale,\nresolution, voxelizer.\n";

static enum cli_outcome parse(struct options *o, int argc, char **argv)
{
    const struct cli_option rows[] = {
        { "view", CLI_TEXT, &o->from.view, "FILE",
          .help = "VIEW.json; without it a view is made up from the scene" },
        RUN_CAMERA_OPTION(&o->from),
        RUN_SCENE_OPTIONS(&o->from, "pose-time"),
        { "out", CLI_TEXT, &o->out, "FILE", .help = "the picture: .exr, .hdr or .pfm", .required = true },
        { "spp", CLI_UINT, &o->spp, "N", .help = "samples per pixel (64 if there is no other limit)",
          .minimum = 1, .maximum = 1e8, .given = &o->spp_given },
        { "time", CLI_FLOAT, &o->seconds, "S", .help = "stop after this many seconds", .minimum = 0.001,
          .maximum = 1e9 },
        { "error", CLI_FLOAT, &o->error, "E", .help = "stop at this mean relative standard error",
          .minimum = 1e-6, .maximum = 1 },
        { "size", CLI_SIZE, &o->size, "WxH", .help = "pixels (320x180)", .minimum = 1, .maximum = 16384 },
        { "seed", CLI_UINT64, &o->seed, "N", .help = "of the random numbers (0)",
          .maximum = 9007199254740991.0 },
        { "bounces", CLI_UINT, &o->bounces, "N", .help = "reflections of a path at most (64)", .minimum = 1,
          .maximum = 65536 },
        { "threads", CLI_UINT, &o->threads, "N", .help = "one per processor if not given", .minimum = 1,
          .maximum = 256 },
        { "aov", CLI_LIST, &o->aov, "NAME=FILE", .help = "another picture, see below" },
        { "geometry", CLI_TEXT, &o->geometry, "KIND", .help = "triangles, the default, or voxels" },
        { "set", CLI_LIST, &o->set, "KEY=VALUE", .help = "with voxels: a setting, see sdfgi properties" },
        { "cull-back-faces", CLI_FLAG, &o->cull_back_faces,
          .help = "the camera sees through the backs of single-sided faces, as a rasteriser does" },
        RUN_COMMON_OPTIONS(&o->common, "with voxels: " RUN_DEVICE_HELP, "samples, rays and error as JSON"),
        { "resume", CLI_FLAG, &o->resume, .help = "go on from OUT.state where there is one, and keep it" },
    };
    const struct cli_positional positionals[] = { { "SCENE", &o->from.scene, .required = true } };
    const struct cli_spec spec = { "reference",
                                   "Traces paths through a glTF scene: ground truth for the renderer.",
                                   CLI_ARRAY(rows), CLI_ARRAY(positionals), notes };
    return cli_parse(&spec, argc, argv);
}

/* ---- Scene and view --------------------------------------------------------------------------------- */

static struct raycast_light light_convert(const struct host_light *from)
{
    struct raycast_light to = {
        .type = from->type == HOST_LIGHT_SPOT ? RAYCAST_LIGHT_SPOT : RAYCAST_LIGHT_POINT,
        .inner_deg = (float)(from->inner_rad * degrees_per_radian),
        .outer_deg = (float)(from->outer_rad * degrees_per_radian),
        .radius_m = from->radius_m,
        .range_m = from->range_m,
    };
    memcpy(to.position, from->position, sizeof to.position);
    memcpy(to.direction, from->direction, sizeof to.direction);
    memcpy(to.intensity, from->intensity, sizeof to.intensity);
    return to;
}

static void sun_convert(const struct host_sun *from, struct raycast_sun *to)
{
    if (!from->enabled)
        return;
    memcpy(to->direction, from->direction, sizeof to->direction);
    memcpy(to->irradiance, from->irradiance, sizeof to->irradiance);
    to->angle_deg = (float)(from->angle_rad * degrees_per_radian);
}

/* The lights go to `lights`, which holds as many as the view has. */
static struct raycast_view view_convert(const struct host_view *from, struct raycast_light *lights)
{
    struct raycast_view to = {
        .camera = { .yfov_deg = (float)(from->camera.yfov_rad * degrees_per_radian),
                    .ymag_m = from->camera.ymag_m,
                    .znear_m = from->camera.znear_m,
                    .zfar_m = from->camera.zfar_m },
        .lights = lights,
        .light_count = from->light_count,
        .environment = { from->environment.rgb, from->environment.width, from->environment.height },
        .punctual_scale = from->punctual_scale,
        .emissive_scale = from->emissive_scale,
        .materials =
            from->materials == HOST_MATERIALS_LAMBERT ? RAYCAST_MATERIALS_LAMBERT : RAYCAST_MATERIALS_GLTF,
    };
    memcpy(to.camera.position, from->camera.position, sizeof to.camera.position);
    memcpy(to.camera.look_at, from->camera.look_at, sizeof to.camera.look_at);
    memcpy(to.camera.up, from->camera.up, sizeof to.camera.up);
    memcpy(to.sky.zenith, from->sky.zenith, sizeof to.sky.zenith);
    memcpy(to.sky.horizon, from->sky.horizon, sizeof to.sky.horizon);
    memcpy(to.sky.ground, from->sky.ground, sizeof to.sky.ground);
    memcpy(to.default_albedo, from->default_albedo, sizeof to.default_albedo);
    sun_convert(&from->sun, &to.sun);
    for (uint32_t i = 0; i < from->light_count; i++)
        lights[i] = light_convert(&from->lights[i]);
    return to;
}

static bool load_inputs(struct run *run)
{
    const struct options *const o = run->options;
    run->gltf = run_load_scene("reference", &o->from, (double)o->size.width / o->size.height, o->common.quiet,
                               &run->view);
    if (run->gltf && run->view.fog.density > 0 && !o->common.quiet)
        fprintf(stderr, "sdfgi: warning: %s: the reference leaves out fog\n", o->from.view);
    return run->gltf != NULL;
}

static uint32_t aov_bits(const struct options *options)
{
    uint32_t bits = 0;
    for (int aov = 0; aov < RAYCAST_AOV_COUNT; aov++)
        bits |= options->aov_paths[aov] ? 1u << aov : 0;
    return bits;
}

static bool create_tracer(struct run *run)
{
    const struct options *o = run->options;
    const struct raycast_settings settings = {
        .width = o->size.width,
        .height = o->size.height,
        .seed = o->seed,
        .max_bounces = o->bounces,
        .threads = o->threads,
        .aovs = aov_bits(o),
        .cull_back_faces = o->cull_back_faces,
        .voxels = o->voxels ? &run->voxels.voxels : NULL,
    };
    struct raycast_light *lights = calloc((size_t)run->view.light_count + 1, sizeof *lights);
    if (!lights) {
        cli_error("reference: out of memory");
        return false;
    }
    const struct raycast_view view = view_convert(&run->view, lights);
    char error[CLI_ERROR_BYTES];
    run->raycast = raycast_create(run->gltf, &view, &settings, error, sizeof error);
    free(lights);
    if (!run->raycast)
        cli_error("%s", error);
    return run->raycast != NULL;
}

static bool voxelize(struct run *run)
{
    const struct options *o = run->options;
    return !o->voxels ||
           reference_voxels_read(run->gltf, &run->view, &o->settings, o->common.device, &run->voxels);
}

/* ---- The run ---------------------------------------------------------------------------------------- */

static bool file_exists(const char *path)
{
    FILE *const file = fopen(path, "rb");
    if (file)
        fclose(file);
    return file != NULL;
}

static bool resume(struct run *run)
{
    const char *const path = run->options->state_path;
    char error[CLI_ERROR_BYTES];
    if (!run->options->resume || !file_exists(path) ||
        raycast_state_load(run->raycast, path, error, sizeof error))
        return true;
    cli_error("%s", error);
    return false;
}

static bool save_state(struct run *run, const char *path)
{
    char error[CLI_ERROR_BYTES];
    struct output_file file;
    run->saved_s = cli_time_s();
    bool saved = output_file_begin(&file, path, error, sizeof error);
    if (saved) {
        raycast_state_write(run->raycast, file.stream); /* commit sees whether the stream failed */
        saved = output_file_commit(&file, error, sizeof error);
    }
    if (!saved)
        cli_error("%s", error);
    return saved;
}

/* Saves to OUT.state, or where that cannot be written among the temporary files. Returns where, or NULL. */
static const char *keep_state(struct run *run)
{
    const char *const temporary = getenv("TMPDIR"), *const path = run->options->state_path;
    if (save_state(run, path))
        return path;
    snprintf(run->spare_path, sizeof run->spare_path, "%s/sdfgi.%ld.state", temporary ? temporary : "/tmp",
             (long)getpid());
    return save_state(run, run->spare_path) ? run->spare_path : NULL;
}

static bool on_progress(const struct raycast_progress *progress, void *user)
{
    struct run *const run = user;
    cli_progress_update(&run->bar, (uint64_t)(1000 * progress->fraction));
    if (cli_time_s() - run->saved_s > state_interval_s)
        run->saved |= save_state(run, run->options->state_path);
    return true;
}

static bool stop_tracing(void *user)
{
    (void)user;
    return stop_asked();
}

static bool write_image(const struct run *run, enum raycast_aov aov, const char *path)
{
    const struct raycast_settings *const s = raycast_settings_get(run->raycast);
    const size_t pixels = (size_t)s->width * s->height;
    const uint32_t channels = raycast_aov_channels(aov);
    float *const values = malloc(pixels * channels * sizeof *values), *const rgba =
                                                                          malloc(pixels * 4 * sizeof *rgba);
    char error[CLI_ERROR_BYTES] = "reference: out of memory";
    bool ok = values && rgba && raycast_image(run->raycast, aov, values);
    for (size_t i = 0; ok && i < pixels; i++) {
        for (uint32_t k = 0; k < 3; k++)
            rgba[4 * i + k] = values[channels * i + (k < channels ? k : 0)];
        rgba[4 * i + 3] = 1.0f;
    }
    ok = ok && image_write_float(path, rgba, s->width, s->height, channels, error, sizeof error);
    if (!ok)
        cli_error("%s", error);
    free(values);
    free(rgba);
    return ok;
}

static bool write_images(const struct run *run)
{
    bool ok = write_image(run, RAYCAST_AOV_RADIANCE, run->options->out);
    for (int aov = 0; ok && aov < RAYCAST_AOV_COUNT; aov++)
        if (run->options->aov_paths[aov])
            ok = write_image(run, aov, run->options->aov_paths[aov]);
    return ok;
}

static bool write_report(const struct run *run, const struct raycast_progress *p)
{
    const struct raycast_settings *const s = raycast_settings_get(run->raycast);
    char error[CLI_ERROR_BYTES];
    cJSON *json = cJSON_CreateObject(), *size = cJSON_AddArrayToObject(json, "size");
    const bool complete = cJSON_AddItemToArray(size, cJSON_CreateNumber(s->width)) &&
                          cJSON_AddItemToArray(size, cJSON_CreateNumber(s->height)) &&
                          json_add_text(json, "scene", run->options->from.scene) &&
                          json_add_number(json, "samples_per_pixel", p->mean_samples) &&
                          json_add_number(json, "seconds", p->seconds) &&
                          json_add_number(json, "rays", (double)p->rays) &&
                          json_add_number(json, "relative_error", p->samples >= 16 ? p->error : NAN) &&
                          json_add_number(json, "samples_not_finite", (double)p->not_finite);
    if (!complete) {
        cJSON_Delete(json);
        json = NULL;
    }
    if (json_write_file(json, run->options->common.report, error, sizeof error))
        return true;
    cli_error("%s", error);
    return false;
}

static void print_summary(const struct run *run, const struct raycast_progress *p)
{
    const struct raycast_settings *const s = raycast_settings_get(run->raycast);
    printf("%ux%u, %.*f samples per pixel, %.1f s, %.1f million rays, %.2f million rays per second", s->width,
           s->height, p->mean_samples > p->samples ? 2 : 0, p->mean_samples, p->seconds,
           1e-6 * (double)p->rays, p->seconds > 0 ? 1e-6 * (double)p->rays / p->seconds : 0.0);
    if (p->samples >= 16)
        printf(", mean relative standard error %.4f", p->error);
    putchar('\n');
    if (p->not_finite > 0)
        printf("%llu samples were not finite and are left out\n", (unsigned long long)p->not_finite);
}

/* Says why a run ended before its limits or without all its pictures, and where its samples are. */
static void print_end(const struct run *run, const struct raycast_progress *p, bool finished, bool written,
                      const char *kept)
{
    const char *const usual = run->options->state_path;
    const char *const pictures = written          ? "the pictures show them"
                                 : p->samples > 0 ? "not all pictures could be written"
                                                  : "too few for a picture";
    char place[2 * PATH_BYTES] = "nothing is kept";
    if (!kept && run->saved)
        snprintf(place, sizeof place, "only the earlier samples in %s are kept", usual);
    else if (kept)
        snprintf(place, sizeof place, "--resume goes on from %s%s%s", kept,
                 kept == usual ? "" : " once it is moved to ", kept == usual ? "" : usual);
    const char *const end = !finished ? "stopped by " : p->samples > 0 ? "ended" : "--time ended it";
    cli_error("reference: %s%s after %.4g samples per pixel; %s; %s", end, finished ? "" : stop_name(),
              p->mean_samples, pictures, place);
}

/* Keeps the state of a run that has more to do, or whose pictures cannot be written. */
static int keep(struct run *run, const struct raycast_progress *last, bool finished)
{
    const struct options *const o = run->options;
    const bool any = last->mean_samples > 0, whole = finished && last->samples > 0;
    const char *kept = any && (!whole || o->resume) ? keep_state(run) : NULL;
    const bool written = last->samples > 0 && write_images(run);
    if (!written && any && !kept)
        kept = keep_state(run);
    const bool ok = whole && written && (!o->resume || kept == o->state_path);
    if (!ok) {
        print_end(run, last, finished, written, kept);
        return finished ? CLI_EXIT_FAILURE : stop_exit_code();
    }
    if (run->saved && !o->resume)
        remove(o->state_path);
    if (!o->common.quiet)
        print_summary(run, last);
    return !o->common.report || write_report(run, last) ? CLI_EXIT_OK : CLI_EXIT_FAILURE;
}

static int trace(struct run *run)
{
    const struct options *const o = run->options;
    const struct raycast_budget budget = {
        .samples = o->spp, .seconds = o->seconds, .error = o->error, .stop = stop_tracing
    };
    struct raycast_progress last;
    cli_progress_begin(&run->bar, "reference", 1000);
    run->saved_s = cli_time_s();
    stop_keep();
    const bool finished = raycast_render(run->raycast, &budget, on_progress, run, &last);
    cli_progress_end(&run->bar);
    return keep(run, &last, finished);
}

int cmd_reference(int argc, char **argv)
{
    struct options options = { .spp = DEFAULT_SPP, .size = { 320, 180 }, .geometry = "triangles" };
    const enum cli_outcome outcome = parse(&options, argc, argv);
    if (outcome != CLI_RUN)
        return cli_exit_code(outcome);
    struct run run = { .options = &options };
    int code = CLI_EXIT_FAILURE;
    if (!options_finish(&options))
        code = CLI_EXIT_USAGE;
    else if (load_inputs(&run) && voxelize(&run) && create_tracer(&run) && resume(&run))
        code = trace(&run);
    raycast_destroy(run.raycast);
    reference_voxels_finish(&run.voxels);
    view_file_finish(&run.view);
    gltf_scene_destroy(run.gltf);
    free(options.state_path);
    return code;
}
