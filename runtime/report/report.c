/* SPDX-License-Identifier: MIT */
#include "report.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static bool samples_add(struct report_samples *samples, uint64_t value)
{
    if (samples->count == samples->capacity) {
        const size_t capacity = samples->capacity ? 2 * samples->capacity : 256;
        uint64_t *values = realloc(samples->values, capacity * sizeof *values);
        if (!values)
            return false;
        samples->values = values;
        samples->capacity = capacity;
    }
    samples->values[samples->count++] = value;
    return true;
}

static int compare_values(const void *a, const void *b)
{
    const uint64_t left = *(const uint64_t *)a, right = *(const uint64_t *)b;
    return (left > right) - (left < right);
}

uint64_t report_quantile(struct report_samples *samples, double quantile)
{
    if (samples->count == 0)
        return 0;
    qsort(samples->values, samples->count, sizeof *samples->values, compare_values);
    const double rank = ceil(quantile * (double)samples->count);
    return samples->values[rank < 1 ? 0 : (size_t)rank - 1];
}

static struct report_pass *find_pass(struct report *report, const char *name)
{
    for (uint32_t i = 0; i < report->pass_count; i++)
        if (strcmp(report->passes[i].name, name) == 0)
            return &report->passes[i];
    if (report->pass_count == SDFGI_MAX_PASSES)
        return NULL;
    report->passes[report->pass_count] = (struct report_pass){ .name = name };
    return &report->passes[report->pass_count++];
}

static bool add_pass(struct report *report, const struct sdfgi_pass_report *from)
{
    struct report_pass *pass = find_pass(report, from->name);
    if (!pass)
        return true;
    pass->work_unit = from->work_unit;
    if (from->ran) {
        pass->ran++;
        pass->reason = from->reason;
        pass->dispatches = from->dispatches;
        pass->work = from->work;
    } else {
        pass->skipped_because = from->reason;
    }
    return !from->gpu_ns_valid || samples_add(&pass->gpu_ns, from->gpu_ns);
}

void report_set_last(struct report *report, const struct sdfgi_report *last, uint64_t frame_gpu_ns)
{
    report->last = *last;
    if (frame_gpu_ns && !samples_add(&report->frame_gpu_ns, frame_gpu_ns))
        report->out_of_memory = true;
}

void report_add_frame(struct report *report, const struct sdfgi_report *frame, uint64_t frame_gpu_ns)
{
    report->frames++;
    report_set_last(report, frame, frame_gpu_ns);
    for (uint32_t i = 0; i < frame->pass_count && i < SDFGI_MAX_PASSES; i++)
        if (!add_pass(report, &frame->passes[i]))
            report->out_of_memory = true;
}

void report_add_times(struct report *report, uint64_t lit_gpu_ns, uint64_t update_gpu_ns)
{
    if (!samples_add(&report->lit_gpu_ns, lit_gpu_ns) || !samples_add(&report->update_gpu_ns, update_gpu_ns))
        report->out_of_memory = true;
}

void report_add_fog(struct report *report, uint64_t fog_gpu_ns)
{
    if (fog_gpu_ns > 0 && !samples_add(&report->fog_gpu_ns, fog_gpu_ns))
        report->out_of_memory = true;
}

void report_finish(struct report *report)
{
    for (uint32_t i = 0; i < report->pass_count; i++)
        free(report->passes[i].gpu_ns.values);
    free(report->frame_gpu_ns.values);
    free(report->lit_gpu_ns.values);
    free(report->update_gpu_ns.values);
    free(report->fog_gpu_ns.values);
    *report = (struct report){ 0 };
}
