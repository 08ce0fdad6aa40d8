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

/* What sdfgi_prepare has made and is making. All but `making` is guarded by backend.lock. */
struct preparation {
    struct resources *making; /* belongs to the thread that prepares */
    struct resources *ready;  /* complete, and used by nobody yet */
    struct sdfgi_settings wanted;
    bool keeps;    /* volumes of the wanted settings outlive switching off */
    bool in_force; /* there are volumes, in use or kept, of these settings: */
    struct sdfgi_settings in_force_settings;
    struct sdfgi_progress progress;
};

struct sdfgi {
    struct backend backend;
    struct scene scene;
    struct volume volume;
    struct views views;
    struct views debug_views; /* apart: their sets name no pictures of the host's but the output */
    struct sdfgi_settings settings;
    struct preparation preparation;
    struct blank_set blank; /* for lookups while there is no light to show */
    struct frame frame;     /* this frame's; holds nothing between frames but what the report needs */
    struct pass_recorder recorder;
    struct draw_list draws;                /* of the part that is being voxelised */
    struct pass_report passes[PASS_COUNT]; /* of the last update */
    uint32_t command_count;
    float exposure_hint;   /* of the last update */
    bool can_cancel;       /* the last update has not been cancelled */
    bool has_settled;      /* light had with the last update */
    uint32_t updates_lost; /* that never ran, as far as is known */
};

/* Volumes that have been prepared for the settings, which are the caller's from then on; NULL if none have.
 */
struct resources *sdfgi_preparation_take(struct sdfgi *gi, const struct sdfgi_settings *settings);
/* Notes which volumes there are, for the thread that prepares. */
void sdfgi_preparation_note(struct sdfgi *gi);
/* True if the volumes are to be kept while GI is off. */
bool sdfgi_preparation_keeps(struct sdfgi *gi);
/* Releases volumes that were kept when GI was switched off, if nobody wants them any more. */
void sdfgi_preparation_drop(struct sdfgi *gi);
struct sdfgi_progress sdfgi_prepared(const struct sdfgi *gi);
void sdfgi_preparation_finish(struct sdfgi *gi);

/* Records a pass over a picture whose set has been written, and adds it to the report. */
void sdfgi_picture_record(struct sdfgi *gi, VkCommandBuffer cmd, const struct sdfgi_view *view,
                          const struct work *work);

#endif
