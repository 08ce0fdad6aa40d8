/* SPDX-License-Identifier: MIT */
#include "walk_record.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* ---- Counts ----------------------------------------------------------------------------------------- */

static uint64_t count_library_commands(const struct sdfgi_report *report)
{
    return report->command_count;
}

/* Every cascade that has become complete, after it moved or something in it changed, has its list of light
 * cells written once. */
static uint64_t count_cascades_generated(const struct sdfgi_report *report)
{
    for (uint32_t i = 0; i < report->pass_count; i++)
        if (strcmp(report->passes[i].name, "light_list") == 0)
            return report->passes[i].ran ? report->passes[i].dispatches : 0;
    return 0;
}

static uint64_t count_scroll_cells(const struct sdfgi_report *report)
{
    return report->scroll.cells;
}

static uint64_t count_pending_cells(const struct sdfgi_report *report)
{
    return report->scroll.pending_cells;
}

static uint64_t count_cascades_waiting(const struct sdfgi_report *report)
{
    return report->scroll.cascades_waiting;
}

/* What all passes together did, each in its own unit. */
static uint64_t count_counted_work(const struct sdfgi_report *report)
{
    uint64_t work = 0;
    for (uint32_t i = 0; i < report->pass_count; i++)
        work += report->passes[i].ran ? report->passes[i].work : 0;
    return work;
}

static const struct {
    const char *name, *unit;
    uint64_t (*get)(const struct sdfgi_report *report);
} counts[WALK_COUNT_COUNT] = {
#define COUNT_ROW(name, unit) { #name, unit, count_##name },
    WALK_COUNTS(COUNT_ROW)
#undef COUNT_ROW
};

const char *walk_count_name(enum walk_count count)
{
    return counts[count].name;
}

const char *walk_count_unit(enum walk_count count)
{
    return counts[count].unit;
}

/* ---- Frames ----------------------------------------------------------------------------------------- */

static struct walk_frame *frame_append(struct walk_record *record)
{
    if (record->frame_count == record->capacity) {
        const uint32_t capacity = record->capacity ? 2 * record->capacity : 64;
        struct walk_frame *frames = realloc(record->frames, capacity * sizeof *frames);
        if (!frames)
            return NULL;
        record->frames = frames;
        record->capacity = capacity;
    }
    struct walk_frame *frame = &record->frames[record->frame_count++];
    memset(frame, 0, sizeof *frame);
    return frame;
}

bool walk_record_add(struct walk_record *record, const struct sdfgi_report *report)
{
    struct walk_frame *frame = frame_append(record);
    if (!frame)
        return false;
    frame->converged = report->converged;
    frame->converged_fraction = report->converged_fraction;
    for (int i = 0; i < WALK_COUNT_COUNT; i++)
        frame->counts[i] = counts[i].get(report);
    record->pass_count = report->pass_count;
    for (uint32_t i = 0; i < report->pass_count; i++) {
        const struct sdfgi_pass_report *pass = &report->passes[i];
        record->pass_names[i] = pass->name;
        record->pass_units[i] = pass->work_unit;
        frame->passes[i] = (struct walk_pass){ .reason = pass->reason,
                                               .work = pass->ran ? pass->work : 0,
                                               .dispatches = pass->dispatches,
                                               .ran = pass->ran };
    }
    for (uint32_t i = 0; i < report->health_count; i++) {
        uint64_t *most = &record->health[report->health[i].code];
        *most = report->health[i].count > *most ? report->health[i].count : *most;
    }
    return true;
}

void walk_record_times(struct walk_record *record, int64_t index, const struct sdfgi_report *report)
{
    if (index < 0 || index >= record->frame_count)
        return;
    struct walk_frame *frame = &record->frames[index];
    for (uint32_t i = 0; i < report->pass_count; i++) {
        if (!report->passes[i].gpu_ns_valid || !frame->passes[i].ran)
            continue;
        frame->passes[i].gpu_ns = report->passes[i].gpu_ns;
        frame->passes[i].timed = true;
        frame->gi_gpu_ns += report->passes[i].gpu_ns;
    }
}

void walk_record_finish(struct walk_record *record)
{
    free(record->frames);
    *record = (struct walk_record){ 0 };
}

/* ---- Series ----------------------------------------------------------------------------------------- */

bool walk_series_gpu_ns(const struct walk_frame *frame, uint32_t index, double *value)
{
    (void)index;
    *value = (double)frame->gpu_ns;
    return frame->gpu_ns > 0;
}

/* A frame in which nothing ran took no time; one whose passes were not timed is not known. */
bool walk_series_gi_gpu_ns(const struct walk_frame *frame, uint32_t index, double *value)
{
    (void)index;
    bool ran = false, timed = false;
    for (int i = 0; i < SDFGI_MAX_PASSES; i++) {
        ran = ran || frame->passes[i].ran;
        timed = timed || frame->passes[i].timed;
    }
    *value = (double)frame->gi_gpu_ns;
    return timed || !ran;
}

bool walk_series_pass_work(const struct walk_frame *frame, uint32_t index, double *value)
{
    *value = (double)frame->passes[index].work;
    return true;
}

bool walk_series_pass_gpu_ns(const struct walk_frame *frame, uint32_t index, double *value)
{
    *value = (double)frame->passes[index].gpu_ns;
    return frame->passes[index].timed || !frame->passes[index].ran;
}

bool walk_series_count(const struct walk_frame *frame, uint32_t index, double *value)
{
    *value = (double)frame->counts[index];
    return true;
}

/* ---- Statistics ------------------------------------------------------------------------------------- */

static int compare_values(const void *a, const void *b)
{
    const double left = *(const double *)a, right = *(const double *)b;
    return (left > right) - (left < right);
}

static double quantile(const double *sorted, uint32_t count, double share)
{
    const double rank = ceil(share * (double)count);
    return sorted[rank < 1 ? 0 : (uint32_t)rank - 1];
}

bool walk_record_statistics(const struct walk_record *record, walk_series_fn series, uint32_t index,
                            struct walk_statistics *out)
{
    *out = (struct walk_statistics){ 0 };
    double *values = calloc((size_t)record->frame_count + 1, sizeof *values);
    if (!values)
        return false;
    for (uint32_t i = 0; i < record->frame_count; i++) {
        double value;
        if (!series(&record->frames[i], index, &value))
            continue;
        if (out->samples == 0 || value > out->worst) {
            out->worst = value;
            out->worst_frame = i;
        }
        out->total += value;
        values[out->samples++] = value;
    }
    qsort(values, out->samples, sizeof *values, compare_values);
    if (out->samples > 0) {
        out->median = quantile(values, out->samples, 0.5);
        out->p99 = quantile(values, out->samples, 0.99);
    }
    free(values);
    return true;
}

double walk_frame_luminance(const struct walk_frame *frame, uint32_t sample)
{
    const float *rgb = frame->irradiance[sample];
    return 0.2126 * (double)rgb[0] + 0.7152 * (double)rgb[1] + 0.0722 * (double)rgb[2];
}

double walk_record_change(const struct walk_record *record, uint32_t sample, uint32_t *frame)
{
    double largest = 0;
    *frame = 0;
    for (uint32_t i = 1; i < record->frame_count; i++) {
        const double before = walk_frame_luminance(&record->frames[i - 1], sample);
        const double change = fabs(walk_frame_luminance(&record->frames[i], sample) - before);
        /* From black to anything is a change of the whole. */
        const double share = before > 0 ? change / before : change > 0;
        if (share > largest) {
            largest = share;
            *frame = i;
        }
    }
    return largest;
}
