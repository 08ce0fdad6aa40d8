/* SPDX-License-Identifier: MIT
 * Drives cascades behind a camera, without a context and without a device. */
#ifndef SCROLL_DRIVE_H
#define SCROLL_DRIVE_H

#include "volume/scroll.h"

struct scroll_drive {
    struct scroll scroll;
    struct cascades cascades;
    struct scroll_limits limits;
    struct scroll_plan plan; /* of the last frame */
    bool completed;          /* a cascade completed in it */
};

/* Default settings but for these two. */
struct scroll_drive scroll_drive_begin(uint32_t resolution, uint64_t max_cells);

/* One frame; returns the cells that its pieces cover, which must be those that the plan counts. */
uint64_t scroll_drive_frame(struct scroll_drive *drive, const double camera[static 3]);

/* True if lookups can read so many of the cascade's cells around the camera. */
bool scroll_drive_covers(const struct cascade *cascade, const double camera[static 3], double cells);

struct trip {
    uint64_t median, p99, most;  /* cells a frame */
    uint32_t apart;              /* fewest frames from one that completes a cascade to the next */
    uint32_t frames, covered[4]; /* frames in which a cascade covers 40 of its cells around the camera */
};

/* Frames with the camera at `where(user, i)`; `skip` are not counted: the camera has just set off. Prints
 * what it found. */
struct trip scroll_drive_trip(struct scroll_drive *drive, const char *what, uint32_t skip, uint32_t frames,
                              void (*where)(const void *user, uint32_t i, double camera[static 3]),
                              const void *user);

#endif
