/* SPDX-License-Identifier: MIT */
#include "report_cost.h"

#include "file/json_write.h"

#include <stdio.h>
#include <stdlib.h>

static double frame_of(const struct report_cost_pair *pair)
{
    return (double)pair->frame_ns;
}

static double frame_off_of(const struct report_cost_pair *pair)
{
    return (double)pair->frame_off_ns;
}

static double cost_of(const struct report_cost_pair *pair)
{
    return frame_of(pair) - frame_off_of(pair);
}

static double lookup_of(const struct report_cost_pair *pair)
{
    return cost_of(pair) - (double)pair->update_ns;
}

static int compare_values(const void *a, const void *b)
{
    const double left = *(const double *)a, right = *(const double *)b;
    return (left > right) - (left < right);
}

static double pair_median_ms(const struct report_cost_pair *pairs, uint32_t count,
                             double (*value)(const struct report_cost_pair *), double *values)
{
    for (uint32_t i = 0; i < count; i++)
        values[i] = value(&pairs[i]);
    qsort(values, count, sizeof *values, compare_values);
    return 1e-6 * values[(count - 1) / 2];
}

struct report_cost report_cost_of(const struct report_cost_pair *pairs, uint32_t count)
{
    struct report_cost cost = { 0 };
    double *values = count > 0 && pairs[0].frame_ns > 0 ? malloc(count * sizeof *values) : NULL;
    if (!values)
        return cost;
    cost.frame_ms = pair_median_ms(pairs, count, frame_of, values);
    cost.frame_off_ms = pair_median_ms(pairs, count, frame_off_of, values);
    cost.gi_cost_ms = pair_median_ms(pairs, count, cost_of, values);
    cost.lookup_ms = pair_median_ms(pairs, count, lookup_of, values);
    cost.update_ms = cost.gi_cost_ms - cost.lookup_ms;
    cost.samples = count;
    free(values);
    return cost;
}

/* ---- Output */

void report_cost_print(const struct report_cost *cost)
{
    if (cost->samples > 0)
        printf("GI costs %.2f ms a frame: %.2f update, %.2f lookup (%.2f with, %.2f without)\n",
               cost->gi_cost_ms, cost->update_ms, cost->lookup_ms, cost->frame_ms, cost->frame_off_ms);
}

bool report_cost_to_json(cJSON *parent, const struct report_cost *cost)
{
    if (cost->samples == 0)
        return true;
    cJSON *object = json_add_object(parent, "gi_cost");
    return json_add_number(object, "frame_ms", cost->frame_ms) &&
           json_add_number(object, "frame_off_ms", cost->frame_off_ms) &&
           json_add_number(object, "gi_cost_ms", cost->gi_cost_ms) &&
           json_add_number(object, "update_ms", cost->update_ms) &&
           json_add_number(object, "lookup_ms", cost->lookup_ms) &&
           json_add_number(object, "samples", cost->samples);
}
