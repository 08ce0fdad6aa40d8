/* SPDX-License-Identifier: MIT
 * Drives a schedule without a device. */
#ifndef SCHEDULE_DRIVE_H
#define SCHEDULE_DRIVE_H

#include "context.h"

/* Zeroes a context for its schedule alone: default settings but for the budget. There is one. */
struct sdfgi *schedule_drive_begin(uint32_t budget);

/* One frame; returns the cells that its steps cover, which must be those that the schedule counts. */
uint64_t schedule_drive_frame(struct sdfgi *gi, const double camera[static 3]);

/* True if lookups can read so many of the cascade's cells around the camera. */
bool schedule_drive_covers(const struct cascade *cascade, const double camera[static 3], double cells);

struct journey {
    uint64_t median, p99, most;  /* cells a frame */
    uint32_t apart;              /* fewest frames from one that completes a cascade to the next */
    uint32_t frames, covered[4]; /* frames in which a cascade covers 40 of its cells around the camera */
};

/* Frames with the camera at `where(user, i)`; `skip` are not counted: the camera has just set off. Prints
 * what it found. */
struct journey schedule_drive_journey(struct sdfgi *gi, const char *what, uint32_t skip, uint32_t frames,
                                      void (*where)(const void *user, uint32_t i, double camera[static 3]),
                                      const void *user);

#endif
