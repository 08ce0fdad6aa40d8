/* SPDX-License-Identifier: MIT
 * What a frame calls for: one condition per need of the pass table. Pure. */
#ifndef SDFGI_FRAME_NEEDS_H
#define SDFGI_FRAME_NEEDS_H

#include "pass/pass_rows.h"

/* What is known about the scene and this frame when its work is planned. */
struct situation {
    bool voxels_due, geometry_due; /* voxels of cells; of cells that an instance touches */
    bool distances_due;
    bool completes;        /* a change of a cascade completes */
    bool scroll_completes; /* one that was not an edit */
    bool from_nothing;     /* no cascade was complete before */
    bool list_grew;        /* light lists were lost: they are written again */
    bool rescales;         /* light is stored with another exposure than before */
    bool gains_digits;     /* with a larger one: direct light is made again for the digits it had lost */
    bool lists_emitters;   /* something emits, and there is room for emitter lists */
    bool low_light_begins; /* light cells keep from where they get their light from now on */
    bool has_lights;
    bool lights_changed; /* or gain digits */
    bool relights;       /* light cells wait to be lit again */
    bool light_waits;    /* light goes on in the next frame */
    bool lists_stay;     /* some light list is not written anew */
    bool cells;          /* light cells send rays of their own */
    bool gathers;        /* they do so in this frame */
    bool gathering;      /* their light follows what they gather, and the probes no more */
    bool rays_missing;   /* some of this frame's rays are not cached */
    bool shows;          /* probes show in this frame what they have gathered */
    bool converged;
    bool raster, flood, occlusion, masks; /* methods that the settings choose */
};

struct situation_needs {
    bool holds[NEED_COUNT];
};

struct situation_needs sdfgi_frame_needs(const struct situation *situation);

/* Static texts for the report: why a pass with this need runs; why it does not although GI is on. */
const char *sdfgi_need_reason(enum need need);
const char *sdfgi_need_reason_not(enum need need);

#endif
