/* SPDX-License-Identifier: MIT */
#include "run_options.h"

#include "file/cache_file.h"
#include "view/view_file.h"
#include "view/view_frame.h"
#include "view/view_option.h"

#include <base/text.h>
#include <math.h>
#include <modules/gltf/gltf_scene.h>
#include <stdio.h>
#include <string.h>

enum { NAME_BYTES = 64, CACHE_PATH_BYTES = 1024 };

static const char name_prefix[] = "sdfgi_";

bool run_apply_settings(const char *command, const struct cli_list *pairs, struct sdfgi_settings *settings)
{
    for (uint32_t i = 0; i < pairs->count; i++) {
        char name[NAME_BYTES], full_name[NAME_BYTES + sizeof name_prefix], error[CLI_ERROR_BYTES];
        const char *value = cli_split_pair(pairs->values[i], name, sizeof name);
        if (!value) {
            cli_error("%s: --set is \"%s\", expected key=value", command, pairs->values[i]);
            return false;
        }
        const bool prefixed = strncmp(name, name_prefix, strlen(name_prefix)) == 0;
        snprintf(full_name, sizeof full_name, "%s%s", prefixed ? "" : name_prefix, name);
        if (!sdfgi_settings_set(settings, full_name, value, error, sizeof error)) {
            cli_error("%s: --set: %s", command, error);
            return false;
        }
    }
    return true;
}

bool run_parse_lookups(const char *command, const struct run_lookup_names *names,
                       struct host_lookups *lookups)
{
    *lookups = (struct host_lookups){ host_lookup_from_name(names->diffuse),
                                      host_lookup_from_name(names->reflection) };
    const enum host_lookup reflection = lookups->reflection;
    if (lookups->diffuse == HOST_LOOKUP_COUNT)
        cli_error("%s: --lookup is \"%s\", expected forward, full, half or quarter", command, names->diffuse);
    else if (reflection == HOST_LOOKUP_FORWARD || reflection == HOST_LOOKUP_COUNT)
        cli_error("%s: --reflections is \"%s\", expected full, half or quarter", command, names->reflection);
    else
        return true;
    return false;
}

bool run_parse_debug(const char *command, const char *text, bool gi, enum sdfgi_debug_view *view)
{
    *view = text ? sdfgi_debug_view_find(text) : SDFGI_DEBUG_VIEW_COUNT;
    if (text && *view == SDFGI_DEBUG_VIEW_COUNT)
        cli_error("%s: --debug is \"%s\", expected a name that sdfgi info lists", command, text);
    else if (text && !gi)
        cli_error("%s: --debug shows what GI holds, and GI is off", command);
    else
        return true;
    return false;
}

bool run_parse_eyes(const char *command, const struct run_eyes *eyes, float *distance_m)
{
    /* Between the pupils of adults, in the mean. */
    static const double usual_m = 0.064;
    *distance_m = eyes->stereo ? (float)(eyes->distance_m > 0 ? eyes->distance_m : usual_m) : 0;
    if (eyes->stereo || eyes->distance_m == 0)
        return true;
    cli_error("%s: --eyes needs --stereo", command);
    return false;
}

/* What the command line says goes over what the file or the scene says. */
static bool view_change(const struct run_scene *from, const struct gltf_scene *scene, double aspect,
                        struct host_view *view, char *error, size_t error_size)
{
    if (from->environment && from->sky)
        return base_text_error(error, error_size, "--sky and --environment: give one of them");
    const struct {
        const char *name, *text;
        view_option *read;
    } options[] = { { "--environment", from->environment, view_option_environment },
                    { "--sky", from->sky, view_option_sky },
                    { "--sun", from->sun, view_option_sun } };
    char reason[CLI_ERROR_BYTES];
    for (size_t i = 0; i < sizeof options / sizeof *options; i++)
        if (options[i].text && !options[i].read(options[i].text, view, reason, sizeof reason))
            return base_text_error(error, error_size, "%s %s", options[i].name, reason);
    return !from->camera || view_option_camera(from->camera, scene, aspect, view, reason, sizeof reason) ||
           base_text_error(error, error_size, "--camera %s", reason);
}

struct gltf_scene *run_load_scene(const char *command, const struct run_scene *from, double aspect,
                                  bool quiet, struct host_view *view)
{
    char error[CLI_ERROR_BYTES];
    const struct gltf_pose pose = { from->time_s };
    *view = (struct host_view){ 0 };
    if (from->view && !view_file_load(from->view, view, error, sizeof error)) {
        cli_error("%s", error);
        return NULL;
    }
    struct gltf_scene *scene =
        gltf_scene_load_posed(from->scene, from->time_given ? &pose : NULL, error, sizeof error);
    if (scene && scene->warning && !quiet)
        fprintf(stderr, "sdfgi: warning: %s\n", scene->warning);
    if (scene && !from->view)
        view_file_from_scene(scene, aspect, view);
    const bool changed = scene && view_change(from, scene, aspect, view, error, sizeof error);
    if (changed)
        return scene;
    cli_error("%s%s%s", scene ? command : "", scene ? ": " : "", error);
    gltf_scene_destroy(scene);
    view_file_finish(view);
    return NULL;
}

static bool sets_cells(const struct cli_list *set)
{
    static const char *const names[] = { "min_cell_size=", "cascade0_distance=", "max_distance=" };
    for (uint32_t i = 0; i < set->count; i++)
        for (int k = 0; k < 3; k++) {
            const char *const pair = set->values[i];
            const bool prefixed = strncmp(pair, name_prefix, strlen(name_prefix)) == 0;
            if (strncmp(pair + (prefixed ? strlen(name_prefix) : 0), names[k], strlen(names[k])) == 0)
                return true;
        }
    return false;
}

void run_fit_cells(const struct run_scene *from, const struct cli_list *set, const struct gltf_scene *scene,
                   const struct host_view *view, struct sdfgi_settings *settings)
{
    if (from->view || sets_cells(set))
        return;
    /* Cascades move by a probe, which is 8 cells, and are not centred better; a little is blended. */
    const double whole = 1 - 20 / fmax(sdfgi_settings_get(settings, "sdfgi_resolution"), 32);
    const double finest_m = whole * 2 * sdfgi_settings_get(settings, "sdfgi_cascade0_distance");
    const double coarsest_m = whole * sdfgi_settings_get(settings, "sdfgi_max_distance");
    const double scale = view_cells_scale(scene, &view->camera, finest_m, coarsest_m);
    settings->min_cell_size_m = (float)fmin(fmax((double)settings->min_cell_size_m * scale, 0.01), 64);
}

const char *run_cache_folder(void)
{
    static char folder[CACHE_PATH_BYTES];
    return cache_folder(folder, sizeof folder) ? folder : NULL;
}

struct host_device *run_open_device(const char *select)
{
    char error[CLI_ERROR_BYTES];
    const struct host_device_desc desc = { .select = select, .cache_folder = run_cache_folder() };
    struct host_device *const device = host_device_create(&desc, error, sizeof error);
    if (!device)
        cli_error("%s", error);
    return device;
}

bool run_check_outputs(const struct output_name *names, uint32_t count)
{
    char error[CLI_ERROR_BYTES];
    if (output_names_check(names, count, error, sizeof error))
        return true;
    cli_error("%s", error);
    return false;
}

void run_log(void *user, enum sdfgi_log_level level, enum sdfgi_message id, const char *text)
{
    (void)user;
    (void)id;
    if (level != SDFGI_LOG_INFO)
        fprintf(stderr, "sdfgi: %s%s\n", level == SDFGI_LOG_WARNING ? "warning: " : "", text);
}
