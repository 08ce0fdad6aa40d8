/* SPDX-License-Identifier: MIT
 * What happened in every frame of a walk: who worked, why, how much and how long, and what light arrived at
 * fixed points; and what of it is the median, the 99th percentile and the worst. */
#ifndef RUNTIME_WALK_RECORD_H
#define RUNTIME_WALK_RECORD_H

#include <sdfgi/sdfgi.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

enum { WALK_SAMPLES_MAX = 16 };

/* Numbers of a frame beside its passes: X(name, unit), read from the library's report by count_NAME in
 * walk_record.c. */
#define WALK_COUNTS(X)                                                                                       \
    X(library_commands, "commands")                                                                          \
    X(cascades_generated, "cascades")                                                                        \
    X(scroll_cells, "cells")                                                                                 \
    X(pending_cells, "cells")                                                                                \
    X(cascades_waiting, "cascades")                                                                          \
    X(counted_work, "units")

enum walk_count {
#define WALK_COUNT_ENUM(name, unit) WALK_COUNT_##name,
    WALK_COUNTS(WALK_COUNT_ENUM)
#undef WALK_COUNT_ENUM
        WALK_COUNT_COUNT,
};

const char *walk_count_name(enum walk_count count);
const char *walk_count_unit(enum walk_count count);

struct walk_pass {
    const char *reason; /* why it ran or was skipped */
    uint64_t work, gpu_ns;
    uint32_t dispatches;
    bool ran, timed;
};

struct walk_frame {
    double distance_m, position[3];
    uint64_t gpu_ns;    /* of everything; 0: not known */
    uint64_t gi_gpu_ns; /* of the library's passes that were timed */
    bool converged;
    float converged_fraction;
    uint64_t counts[WALK_COUNT_COUNT];
    struct walk_pass passes[SDFGI_MAX_PASSES];
    float irradiance[WALK_SAMPLES_MAX][3];
};

/* A zero-initialised record is empty. */
struct walk_record {
    struct walk_frame *frames;
    uint32_t frame_count, capacity;
    uint32_t pass_count; /* of the library */
    const char *pass_names[SDFGI_MAX_PASSES], *pass_units[SDFGI_MAX_PASSES];
    uint64_t health[SDFGI_MESSAGE_COUNT]; /* the most of each code in any frame */
};

/* Appends a frame as the library reports it just after recording. False when memory runs out. */
bool walk_record_add(struct walk_record *record, const struct sdfgi_report *report);

/* Takes over the passes' times that have arrived with `report`: they are those of frame `index`, which may
 * lie outside the record. */
void walk_record_times(struct walk_record *record, int64_t index, const struct sdfgi_report *report);

void walk_record_finish(struct walk_record *record);

/* ---- Statistics ------------------------------------------------------------------------------------- */

struct walk_statistics {
    double median, p99, worst, total; /* nearest rank */
    uint32_t worst_frame, samples;
};

/* One number of a frame; false if it is not known there. `index` says which pass, count or sample. */
typedef bool (*walk_series_fn)(const struct walk_frame *frame, uint32_t index, double *value);

bool walk_series_gpu_ns(const struct walk_frame *frame, uint32_t index, double *value);
bool walk_series_gi_gpu_ns(const struct walk_frame *frame, uint32_t index, double *value);
bool walk_series_pass_work(const struct walk_frame *frame, uint32_t index, double *value);
bool walk_series_pass_gpu_ns(const struct walk_frame *frame, uint32_t index, double *value);
bool walk_series_count(const struct walk_frame *frame, uint32_t index, double *value);

/* False when memory runs out. Zero samples give zeros. */
bool walk_record_statistics(const struct walk_record *record, walk_series_fn series, uint32_t index,
                            struct walk_statistics *out);

/* Largest relative change of the luminance at a sample from one frame to the next, and in which frame. */
double walk_record_change(const struct walk_record *record, uint32_t sample, uint32_t *frame);

/* Luminance (Rec. 709) of a sample's irradiance. */
double walk_frame_luminance(const struct walk_frame *frame, uint32_t sample);

#endif
