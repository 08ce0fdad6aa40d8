/* SPDX-License-Identifier: MIT
 * A context: the four owners together. */
#ifndef SDFGI_CONTEXT_H
#define SDFGI_CONTEXT_H

#include "frame/frame.h"
#include "view/view.h"

/* What the report says of a pass besides its time. */
struct pass_report {
    const char *reason; /* static; NULL: no frame has been recorded */
    struct pass_tally tally;
};

struct sdfgi {
    struct backend backend;
    struct scene scene;
    struct volume volume;
    struct views views;
    struct sdfgi_settings settings;
    struct blank_set blank; /* for lookups while there is no light to show */
    struct frame frame;     /* this frame's; holds nothing between frames but what the report needs */
    struct pass_recorder recorder;
    struct pass_report passes[PASS_COUNT]; /* of the last update */
    uint32_t command_count;
    bool can_cancel;       /* the last update has not been cancelled */
    uint32_t updates_lost; /* that never ran, as far as is known */
};

#endif
