/* SPDX-License-Identifier: MIT
 * Where a context keeps its state on the device, and why passes run: all that journeys know of the inside of
 * the library. */
#ifndef TEST_JOURNEY_STATE_H
#define TEST_JOURNEY_STATE_H

#include "gi_test.h"

enum { JOURNEY_MAX_BUFFERS = 32 };

struct journey_buffer {
    const char *name; /* static, such as "BITS" */
    VkBuffer buffer;
    uint64_t size;
};

struct journey_state {
    uint32_t count; /* 0 while the context is switched off */
    struct journey_buffer buffers[JOURNEY_MAX_BUFFERS];
};

void journey_state_find(const struct gi_test *t, struct journey_state *state);

/* A pass that ran gives the reason of its row in the table, and one that did not gives another. */
void journey_state_require_reasons(const struct sdfgi_report *report);

#endif
