/* SPDX-License-Identifier: MIT
 * The report of a run: what every pass did and took, collected frame by frame and written as JSON. */
#ifndef RUNTIME_REPORT_H
#define RUNTIME_REPORT_H

#include "report_cost.h"

#include <cJSON.h>
#include <sdfgi/sdfgi.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

struct report_samples {
    uint64_t *values;
    size_t count, capacity;
};

struct report_pass {
    const char *name, *work_unit;
    const char *reason;          /* of the last frame it ran in; NULL: never */
    const char *skipped_because; /* of the last frame it did not run in; NULL: never */
    uint64_t ran;                /* frames */
    uint32_t dispatches;         /* of the last frame it ran in */
    uint64_t work;
    struct report_samples gpu_ns;
};

struct report {
    struct report_pass passes[SDFGI_MAX_PASSES];
    uint32_t pass_count;
    struct report_samples frame_gpu_ns;
    struct report_samples lit_gpu_ns, update_gpu_ns; /* for struct report_cost */
    struct report_samples fog_gpu_ns;                /* none where there is no fog */
    struct sdfgi_report last;
    uint64_t frames;
    bool out_of_memory;
};

struct report_summary {
    const char *device_name, *device_driver, *device_type;
    uint32_t width, height;
    double seconds;
    double exposure; /* factor that the picture was written with; 0: a float picture, which has none */
    struct sdfgi_settings settings; /* in force */
    uint64_t estimated_bytes;
    uint32_t validation_messages;
    struct report_cost cost;
};

/* A zero-initialised report is empty. */
void report_add_frame(struct report *report, const struct sdfgi_report *frame, uint64_t frame_gpu_ns);
/* Times of a frame that has finished: all but its shadow maps, and of this its update. */
void report_add_times(struct report *report, uint64_t lit_gpu_ns, uint64_t update_gpu_ns);
/* The state after the last frame has finished, with its GPU time (0: not known). */
void report_set_last(struct report *report, const struct sdfgi_report *last, uint64_t frame_gpu_ns);
/* Time of a frame's fog; 0: it has none. */
void report_add_fog(struct report *report, uint64_t fog_gpu_ns);
void report_finish(struct report *report);

/* The report as JSON, to be freed with cJSON_Delete; NULL when memory ran out. */
cJSON *report_to_json(struct report *report, const struct report_summary *summary);

/* Writes the report to `path`, whole or not at all. On failure returns false and one line in `error`. */
bool report_write(struct report *report, const struct report_summary *summary, const char *path, char *error,
                  size_t error_size);

/* Every property in force, by name. NULL when memory runs out. */
cJSON *report_settings_to_json(const struct sdfgi_settings *settings);

/* A code of the library's as its name, without prefix. */
const char *report_message_name(enum sdfgi_message message);

/* The value at the share `quantile` of the sorted samples (nearest rank); 0 if there are none. Sorts them. */
uint64_t report_quantile(struct report_samples *samples, double quantile);

#endif
