/* SPDX-License-Identifier: MIT
 * What sub-commands that load a scene and render it have in common. */
#ifndef RUNTIME_RUN_OPTIONS_H
#define RUNTIME_RUN_OPTIONS_H

#include "cli.h"
#include "file/output_names.h"
#include "host/host.h"

#include <sdfgi/sdfgi.h>
#include <stdbool.h>

struct gltf_scene;

/* Applies "key=value" pairs to `settings`; on failure prints one line and returns false. The prefix "sdfgi_"
 * may be left out. */
bool run_apply_settings(const char *command, const struct cli_list *pairs, struct sdfgi_settings *settings);

/* The one place that says where light is looked up unless --lookup does. */
#define RUN_LOOKUP_DEFAULT "full"
#define RUN_LOOKUP_HELP    "where light is looked up: forward, full, half, quarter; " RUN_LOOKUP_DEFAULT

#define RUN_GI_EXPOSURE_HELP "what brings the light near 1, as a hint; 0, the default: from the lights"

#define RUN_REFLECTIONS_HELP "at which resolution rays are sent: full, half, quarter; " RUN_LOOKUP_DEFAULT

/* Values of --lookup and --reflections. */
struct run_lookup_names {
    const char *diffuse, *reflection;
};
#define RUN_LOOKUP_NAMES                                                                                     \
    {                                                                                                        \
        RUN_LOOKUP_DEFAULT, RUN_LOOKUP_DEFAULT                                                               \
    }

/* Reads them; on failure prints one line and returns false. */
bool run_parse_lookups(const char *command, const struct run_lookup_names *names,
                       struct host_lookups *lookups);

#define RUN_DEBUG_HELP "show a debug view instead, see sdfgi info"

/* Reads the value of --debug, which needs `gi`; NULL means SDFGI_DEBUG_VIEW_COUNT. On failure prints one line
 * and returns false. */
bool run_parse_debug(const char *command, const char *text, bool gi, enum sdfgi_debug_view *view);

#define RUN_STEREO_HELP "two eyes side by side, each in a half of the picture"
#define RUN_EYES_HELP   "how far apart they are; 0.064"

/* Values of --stereo and --eyes. */
struct run_eyes {
    bool stereo;
    double distance_m; /* 0: a person's */
};

/* The distance between two eyes; 0: there is one. On failure, when --eyes is given without --stereo, prints
 * one line and returns false. */
bool run_parse_eyes(const char *command, const struct run_eyes *eyes, float *distance_m);

/* Loads the scene, and the view from `view_path` or, if that is NULL, from the scene. Prints warnings, and
 * one line on failure. On success the caller calls gltf_scene_destroy and view_file_finish. */
struct gltf_scene *run_load_scene(const char *scene_path, const char *view_path, struct host_view *view);

/* A device by its index or a part of its name; NULL: the best one. Prints one line and returns NULL on
 * failure. */
struct host_device *run_open_device(const char *select);

/* Where compiled pipelines are kept for the next run; NULL if the user has no such folder. */
const char *run_cache_folder(void);

/* True if all outputs can be written, each to a file of its own; else prints one line. */
bool run_check_outputs(const struct output_name *names, uint32_t count);

/* Prints messages of the library to stderr: errors and warnings, one line each. `user` is not used. */
void run_log(void *user, enum sdfgi_log_level level, enum sdfgi_message id, const char *text);

#endif
