/* SPDX-License-Identifier: MIT
 * What GI costs a user: a frame with it minus the same frame without. */
#ifndef RUNTIME_REPORT_COST_H
#define RUNTIME_REPORT_COST_H

#include <cJSON.h>
#include <stdbool.h>
#include <stdint.h>

/* Milliseconds on the GPU; medians. Shadow maps are left out: frames draw only those that are missing, and
 * the frame without GI misses others. */
struct report_cost {
    double frame_ms, frame_off_ms; /* with GI and without */
    double gi_cost_ms;             /* of frames with GI minus those without */
    double update_ms;              /* of this, what sdfgi_update recorded */
    double lookup_ms;              /* and the rest: lookups, wherever they are made */
    uint32_t samples;              /* frames without GI that were drawn for it; 0: it is not known */
};

/* A frame with GI and the same frame without. */
struct report_cost_pair {
    uint64_t frame_ns, update_ns, frame_off_ns;
};

/* All 0 where memory runs out, or nothing was timed. */
struct report_cost report_cost_of(const struct report_cost_pair *pairs, uint32_t count);

/* "GI costs 5.43 ms a frame: ...", and a line feed. Prints nothing where the cost is not known. */
void report_cost_print(const struct report_cost *cost);

/* Adds the object "gi_cost", if the cost is known. False when memory runs out. */
bool report_cost_to_json(cJSON *parent, const struct report_cost *cost);

#endif
