/* SPDX-License-Identifier: MIT
 * Plans frames one after the other, without a device: what comes back of a frame is made up. */
#ifndef DRIVE_H
#define DRIVE_H

#include "frame/frame.h"

enum { DRIVE_FRAMES_IN_FLIGHT = 2 };

/* A frame on its way. */
struct drive_slot {
    struct feedback_slot feedback;
    uint32_t counters[SDFGI_COUNTER_COUNT];
};

struct drive {
    struct sdfgi_settings settings;
    struct sdfgi_frame_desc desc; /* of the next frame */
    struct backend backend;       /* hooks alone */
    struct scene scene;
    struct journal journal;
    struct volume_state state;
    struct extent extent;
    uint32_t mesh; /* a cube from 0 to 1 */
    sdfgi_material material;
    struct drive_slot slots[DRIVE_FRAMES_IN_FLIGHT];
    uint64_t frames;                          /* begun so far */
    uint32_t counters[SDFGI_COUNTER_COUNT];   /* of the newest frame that came back */
    uint32_t light_cells[SDFGI_MAX_CASCADES]; /* in each list, from the next frame on */
    float change;                             /* of light, in the sample cycles that end from now on */
    bool list_grew;                           /* the light lists are empty before the next frame */
    bool emitters_added;                      /* the emitter lists are new in this frame */
    bool starts_in_parts;                     /* the host has asked for it */
    struct frame frame;                       /* the newest */
};

/* Small cascades, and a sample cycle of four frames. */
struct sdfgi_settings drive_settings(uint32_t cascades, uint32_t resolution);
/* An empty scene, and nothing stored. */
void drive_begin(struct drive *d, const struct sdfgi_settings *settings);
void drive_end(struct drive *d);

/* A box of geometry in the world. */
sdfgi_instance drive_add_box(struct drive *d, const double low[static 3], const double high[static 3],
                             enum sdfgi_mobility mobility);
/* Moves a box. */
void drive_move_box(struct drive *d, sdfgi_instance box, const double low[static 3],
                    const double high[static 3]);
/* A lamp above the origin. */
struct sdfgi_light_desc drive_lamp(void);
sdfgi_light drive_add_light(struct drive *d, const struct sdfgi_light_desc *desc);
void drive_set_emission(struct drive *d, float radiance);

/* What the next frame plans; changes nothing but `frame`. */
void drive_plan(const struct drive *d, struct frame *frame);
/* Takes in what comes back, plans a frame and takes it over as done. */
void drive_frame(struct drive *d);
/* The same in steps: takes in what comes back, and begins the next frame. */
void drive_begin_frame(struct drive *d);
/* Takes over `d->frame` as done. */
void drive_commit(struct drive *d);

void drive_frames(struct drive *d, uint32_t count);
/* One frame, with the camera moved by metres. */
void drive_move(struct drive *d, double x, double y, double z);
/* Goes on until a frame has nothing to do and borders have come to rest. */
void drive_converge(struct drive *d);

#endif
