/* SPDX-License-Identifier: MIT
 * A journey: a context whose whole state is hashed after each frame. All of its memory is zero before the
 * first frame that uses it, so that bytes that nobody writes are the same in each run. */
#ifndef TEST_JOURNEY_H
#define TEST_JOURNEY_H

#include "journey_screen.h"
#include "journey_state.h"

struct journey {
    struct gi_test t;
    const char *name;
    uint32_t frame; /* the next one's number */
    struct journey_state state;
    struct journey_screen screen; /* where there is one, each frame ends with sdfgi_gather */
};

/* Must stay where it is until it is closed. */
void journey_open(struct journey *j, const char *name, const struct sdfgi_settings *settings);
void journey_close(struct journey *j);

/* One frame seen from `camera`; takes its row of hashes to the book. */
void journey_frame(struct journey *j, const double camera[static 3]);
/* Several, after each of which the camera goes on by `step`. */
void journey_walk(struct journey *j, double camera[static 3], const double step[static 3], uint32_t frames);
/* The same without a step. */
void journey_stay(struct journey *j, const double camera[static 3], uint32_t frames);

/* Bytes of a buffer of the last frame's; 0 if there is no such. */
uint64_t journey_buffer_size(const struct journey *j, const char *name);

/* Names of the passes that ran in no journey so far, with spaces between them. */
const char *journey_passes_missing(void);
/* How many journeys have been closed. */
uint32_t journey_count(void);

#endif
