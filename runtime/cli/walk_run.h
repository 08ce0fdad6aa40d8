/* SPDX-License-Identifier: MIT
 * A walk as it is carried out: what was asked for, and what came of it. */
#ifndef RUNTIME_WALK_RUN_H
#define RUNTIME_WALK_RUN_H

#include "cli.h"
#include "run_options.h"
#include "host/host.h"
#include "walk/walk_path.h"
#include "walk/walk_record.h"
#include "walk/walk_report.h"

/* What was asked for, all of it resolved and checked. */
struct walk_order {
    struct walk_path path;
    const char *path_name, *out;
    struct run_scene from; /* without a view: that of the scene */
    struct run_common common;
    struct cli_size size;
    struct sdfgi_settings settings;
    struct host_lookups lookups;
    enum sdfgi_debug_view debug; /* shown with GI; SDFGI_DEBUG_VIEW_COUNT: the picture */
    double speed_m_s, fps, start_m, exposure, gi_exposure;
    struct host_light_motion lights;
    uint32_t frames, seed;
    uint32_t hold;  /* frames before the walk; WALK_HOLD_SETTLED: until light has settled */
    uint32_t every; /* frames from one that is written to the next; 0: none */
    struct host_sample samples[WALK_SAMPLES_MAX];
    uint32_t sample_count;
    bool window;
};

enum {
    WALK_HOLD_SETTLED = UINT32_MAX,
    WALK_HOLD_MAX = 60, /* frames that WALK_HOLD_SETTLED waits at most */
    WALK_FRAMES_MAX = 100000,
    WALK_PATH_BYTES = 4096, /* of an output's name */
};

struct walk_result {
    struct walk_record record;
    struct walk_summary summary;
    struct host_device_info device;
};

/* Walks, and writes pictures and contact sheet; prints one line and returns false on failure. `result` is to
 * be finished with walk_record_finish either way. */
bool walk_run(const struct walk_order *order, struct walk_result *result);

/* The camera of frame `index` of the walk. */
void walk_order_camera(const struct walk_order *order, uint32_t index, struct host_camera *camera);

/* OUT/name into `path`; false if it does not fit. */
bool walk_output_path(const struct walk_order *order, const char *name, char path[WALK_PATH_BYTES]);

#endif
