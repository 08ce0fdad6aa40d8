/* SPDX-License-Identifier: MIT
 * Recording of work: label, timer, barrier, pipeline, push constants, dispatch, all from the tables. */
#ifndef SDFGI_PASS_RECORD_H
#define SDFGI_PASS_RECORD_H

#include "resources.h"

/* What recording a pass amounted to. */
struct pass_tally {
    uint32_t dispatches;
    uint64_t units;
};

struct pass_recorder {
    const struct backend *backend;
    const struct resources *resources;
    struct gpu_timer *timer;
    struct gpu_recorder gpu;
    struct pass_tally tally[PASS_COUNT];
    const struct work *open; /* the newest item of the pass whose label is open; NULL: none */
    uint32_t stamps_left;    /* timestamps that it may still take */
    bool stamped;            /* a stamp has been taken */
    bool timed;              /* a time span is open */
    bool beside;             /* the item opened last runs beside the one before */
    uint32_t bound;          /* a bit per bind point that has the resources' sets */
};

/* Timestamps that recording a list takes. */
uint32_t sdfgi_pass_stamps(const struct work_list *list);
void sdfgi_pass_recorder_begin(struct pass_recorder *r, const struct backend *backend,
                               struct resources *resources, VkCommandBuffer cmd, uint32_t stamps);
void sdfgi_pass_recorder_end(struct pass_recorder *r);

/* Binds LOOKUP and WORK, unless they are bound. */
void sdfgi_pass_bind_resources(struct pass_recorder *r, VkPipelineBindPoint point);

/* Opens label and time span of an item's pass, unless the item before has opened them. */
void sdfgi_pass_open(struct pass_recorder *r, const struct work *work);
/* Closes what is open. */
void sdfgi_pass_close(struct pass_recorder *r);

/* Begins items that run side by side, which the caller then records one by one. They wait at once for what
 * any of them needs: a barrier between them would have the next pass wait for the one before. None needs what
 * another one writes, and what two of them write lies apart. */
void sdfgi_pass_begin_beside(struct pass_recorder *r, const struct work *items, uint32_t count);
/* An item of any domain but DOMAIN_INSTANCES and DOMAIN_TILE_LIST. */
void sdfgi_pass_record(struct pass_recorder *r, const struct work *work);
/* An item whose size a view's buffer holds, at `offset`. */
void sdfgi_pass_record_indirect(struct pass_recorder *r, const struct work *work,
                                const struct gpu_buffer *arguments, uint64_t offset);
/* Records the items that a list begins with and that run at once, without a barrier between them: clears that
 * touch nothing in common, or passes that run side by side. Returns how many these are, at least 1. */
uint32_t sdfgi_pass_record_at_once(struct pass_recorder *r, const struct work *items, uint32_t count);

#endif
