/* SPDX-License-Identifier: MIT
 * A camera's path: a curve through points, travelled at constant speed, from a PATH.json.
 *
 *     { "points": [[x,y,z], {"position":[x,y,z], "look_at":[x,y,z]}, ...],   two or more, in metres
 *       "speed_m_s": 5, "fps": 60, "yfov_deg": 60,
 *       "look_at": [x,y,z],          where to look all the way; points may then name no other place
 *       "smooth_m": 2,               over what length of the way turns of the view are spread
 *       "view": "VIEW.json" }        sky, sun, lights and materials; relative to this file's folder
 *
 * Only "points" is required. Where a point says nothing about the view, it goes along the path. The curve is
 * a centripetal Catmull-Rom spline: through every point, without cusps or loops of its own (Yuksel, Schaefer
 * and Keyser, Parameterization and applications of Catmull-Rom curves, 2011). */
#ifndef RUNTIME_WALK_PATH_H
#define RUNTIME_WALK_PATH_H

#include "host/host_view.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

enum { WALK_POINTS_MAX = 1024 };

struct walk_point {
    double position[3];
    double look_at[3];
    bool looks; /* `look_at` was given */
};

/* The curve where it has been measured. */
struct walk_station {
    double distance_m; /* along the way */
    double position[3];
    double yaw, pitch; /* radians; yaw 0 looks along -Z, and does not wrap */
};

struct walk_path {
    struct walk_point *points;
    uint32_t point_count;
    double look_at[3];
    bool looks; /* at `look_at` all the way */
    double speed_m_s, fps, smooth_m;
    float yfov_rad;
    char *view; /* path of the VIEW.json, or NULL */
    struct walk_station *stations;
    uint32_t station_count;
    double length_m;
};

/* Reads the file at `path` and measures the curve. On failure returns false, with one line in `error` that
 * names file and key. Otherwise give `walk` to walk_path_finish. */
bool walk_path_load(const char *path, struct walk_path *walk, char *error, size_t error_size);

/* A zeroed path is accepted. */
void walk_path_finish(struct walk_path *walk);

/* The camera after `distance_m` of the way; before the start and past the end it stands there. */
void walk_path_camera(const struct walk_path *walk, double distance_m, struct host_camera *camera);

#endif
