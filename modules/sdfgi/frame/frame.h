/* SPDX-License-Identifier: MIT
 * A frame: planned as a list of work, then recorded, then committed. docs/frame.md tells the same with
 * reasons. */
#ifndef SDFGI_FRAME_H
#define SDFGI_FRAME_H

#include "draw_list.h"
#include "frame_needs.h"
#include "pass/pass_record.h"
#include "volume/volume.h"

/* All that a plan depends on. */
struct frame_input {
    const struct volume_state *state;    /* after the frame before */
    const struct sdfgi_frame_desc *desc; /* checked */
    const struct sdfgi_settings *settings;
    const struct scene *scene;
    const struct journal *journal; /* what changed in the scene */
    struct extent extent;
    const uint32_t *counters; /* of the newest finished frame */
    struct light_lists lists;
    struct volume_gaps gaps;
    bool low_light;           /* light cells are to keep from where they get their light */
    uint32_t low_light_begin; /* sdfgi_low_light_begin */
    bool starts_in_parts;     /* a start from nothing keeps to the budget, too */
    uint32_t threads_per_ray; /* of light_direct: few threads at once should not idle */
    bool software;            /* shaders are those for software drivers */
};

/* Small data that the host writes into buffers. */
enum frame_upload {
    FRAME_UPLOAD_PARAMS = 1,
    FRAME_UPLOAD_LIGHTS = 2,
    FRAME_UPLOAD_MATERIALS = 4,
    FRAME_UPLOAD_RAY_QUEUE = 8, /* empties it */
    FRAME_UPLOAD_INSTANCES = 16,
    FRAME_UPLOAD_VISITS = 32, /* empties their list */
};

struct frame {
    struct volume_state next; /* the state once this frame is recorded */
    struct scroll_plan scroll;
    struct situation situation;
    struct light_bits lights; /* that have changed; all: each cell is lit again */
    struct work_list work;
    struct gather_range gathers[SDFGI_MAX_CASCADES];
    uint32_t gather_count;
    int rescale_power;               /* light is stored with an exposure so many powers of two larger */
    uint32_t uploads;                /* enum frame_upload */
    uint64_t instances_since;        /* revision of the scene: instances that changed later are uploaded */
    bool cycle_ends;                 /* this is the last frame of a sample cycle */
    const char *reasons[PASS_COUNT]; /* why each pass runs, or not */
};

/* Fills `frame` from the input alone: the same input gives the same plan. Needs no device. */
void sdfgi_frame_plan(struct frame *frame, const struct frame_input *input);

/* Records a plan. Changes nothing but the command buffer and what the recorder counts; `draws` is scratch.
 * `slot` and `number` are those of its frame in flight. */
void sdfgi_frame_record(const struct frame *frame, const struct scene *scene, struct pass_recorder *rec,
                        struct draw_list *draws, uint32_t slot, uint32_t number);

/* The state after a recorded plan: what completed is finished, and the sample cycle goes on. */
void sdfgi_frame_next_state(const struct frame *frame, const struct sdfgi_settings *settings,
                            struct volume_state *state);
/* What will come back of a recorded plan. */
struct feedback_slot sdfgi_frame_feedback(const struct frame *frame);
/* Makes a recorded plan the volume's state. */
void sdfgi_frame_commit(const struct frame *frame, const struct sdfgi_settings *settings,
                        struct volume *volume);

#endif
