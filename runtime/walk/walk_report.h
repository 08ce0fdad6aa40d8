/* SPDX-License-Identifier: MIT
 * A walk's record as JSON and as a plot. */
#ifndef RUNTIME_WALK_REPORT_H
#define RUNTIME_WALK_REPORT_H

#include "walk_record.h"
#include "report/report.h"

struct walk_summary {
    struct report_summary run; /* device, size, seconds, settings, memory; its exposure is not used */
    const char *scene, *path;
    double length_m, start_m, speed_m_s, fps;
    uint32_t frames_asked; /* a walk that is stopped has fewer */
    uint32_t hold_frames;  /* rendered before the first, for light to settle */
    double sample_positions[WALK_SAMPLES_MAX][3];
    float sample_normals[WALK_SAMPLES_MAX][3];
    uint32_t sample_count;
};

/* The report as JSON, to be freed with cJSON_Delete; NULL when memory ran out. */
cJSON *walk_report_to_json(const struct walk_record *record, const struct walk_summary *summary);

/* Writes the report to `path`, whole or not at all. On failure returns false and one line in `error`. */
bool walk_report_write(const struct walk_record *record, const struct walk_summary *summary, const char *path,
                       char *error, size_t error_size);

enum walk_plot_result {
    WALK_PLOT_WRITTEN,
    WALK_PLOT_NO_GNUPLOT, /* it is not installed, or failed */
    WALK_PLOT_NOT_WRITTEN,
};

/* Plots times, work and light over the frames into an SVG at `path`, through gnuplot. Where it does not write
 * the file, it leaves the one that is there, and one line in `error`. */
enum walk_plot_result walk_plot_write(const struct walk_record *record, const struct walk_summary *summary,
                                      const char *path, char *error, size_t error_size);

#endif
