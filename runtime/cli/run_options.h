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

/* What every sub-command takes, as rows of its table. `device_help` says what the device is for. */
struct run_common {
    const char *device, *report;
    bool quiet;
};
#define RUN_COMMON_OPTIONS(common, device_help, report_help)                                                 \
    { "device", CLI_TEXT, &(common)->device, "N", .help = device_help },                                     \
        { "report", CLI_TEXT, &(common)->report, "FILE", .help = report_help },                              \
    {                                                                                                        \
        "quiet", CLI_FLAG, &(common)->quiet, .help = "print nothing but errors"                              \
    }
#define RUN_DEVICE_HELP "index of the device or a part of its name"
#define RUN_NO_DEVICE   "accepted everywhere; no device is needed here"

/* What every sub-command takes that shows a scene. Where a VIEW.json says the same, these count. */
struct run_scene {
    const char *scene, *view, *sky, *sun, *environment, *camera;
    double time_s;
    bool time_given;
};
#define RUN_SCENE_OPTIONS(from, time_name)                                                                   \
    { "sky", CLI_TEXT, &(from)->sky, "SKY", .help = "none, day, a radiance, R,G,B, or nine, see below" },    \
        { "sun", CLI_TEXT, &(from)->sun, "SUN", .help = "none, day, X,Y,Z or X,Y,Z,R,G,B, see below" },      \
        { "environment", CLI_TEXT, &(from)->environment, "FILE",                                             \
          .help = "picture of all directions as sky: .hdr, .exr, .pfm" },                                    \
    {                                                                                                        \
        time_name, CLI_FLOAT, &(from)->time_s, "SECONDS",                                                    \
            .help = "moment of the scene's animations; else at rest", .maximum = 1e9,                        \
            .given = &(from)->time_given                                                                     \
    }
/* Of a struct host_light_motion. `to` follows "that suns turn in a frame". */
#define RUN_LIGHT_OPTIONS(motion, to)                                                                        \
    { "turn-sun",                                                                                            \
      CLI_FLOAT,                                                                                             \
      &(motion)->turn_suns_deg,                                                                              \
      "DEGREES",                                                                                             \
      .help = "that suns turn in a frame" to "; 0",                                                          \
      .minimum = -180,                                                                                       \
      .maximum = 180 },                                                                                      \
    {                                                                                                        \
        "flicker", CLI_FLOAT, &(motion)->flicker_percent, "PERCENT",                                         \
            .help = "of its light by which each lamp flickers; 0", .minimum = 0, .maximum = 100              \
    }
#define RUN_CAMERA_OPTION(from)                                                                              \
    {                                                                                                        \
        "camera", CLI_TEXT, &(from)->camera, "CAMERA",                                                       \
            .help = "X,Y,Z,LX,LY,LZ[,DEGREES], a name, an index, or auto"                                    \
    }
#define RUN_SCENE_NOTES                                                                                      \
    "--sky: radiance, one number, R,G,B, or the colours of zenith, horizon and ground. --sun: the way the "  \
    "light\ntravels, and its irradiance. --environment: rows from up to down, -Z in the middle. Without a "  \
    "light in the\nscene there are a sky and a sun by default.\n"

/* Loads the scene, and the view from a VIEW.json or from the scene, for pictures of that width over height.
 * Prints warnings unless it is to be quiet, and one line on failure. On success the caller calls
 * gltf_scene_destroy and view_file_finish. */
struct gltf_scene *run_load_scene(const char *command, const struct run_scene *from, double aspect,
                                  bool quiet, struct host_view *view);

/* Unless a VIEW.json or a setting says how large cells are, makes them fit a scene that is larger than the
 * cascades, or much smaller. */
void run_fit_cells(const struct run_scene *from, const struct cli_list *set, const struct gltf_scene *scene,
                   const struct host_view *view, struct sdfgi_settings *settings);

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
