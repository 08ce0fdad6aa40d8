/* SPDX-License-Identifier: MIT
 * The stages of a frame: each adds its items to the list of work. */
#ifndef SDFGI_STAGE_H
#define SDFGI_STAGE_H

#include "frame.h"

/* What a stage needs to add its items. */
struct plan_stage {
    struct frame *frame;
    const struct frame_input *input;
    const struct situation_needs *needs;
};

/* What items are about: a cascade, or a piece of its change. */
struct plan_target {
    uint32_t cascade;
    const struct scroll_piece *piece; /* NULL: all of the cascade */
};

/* Adds the passes of a phase that the needs call for, in the order of the table. */
void sdfgi_stage_add_phase(const struct plan_stage *stage, enum pass_phase phase,
                           const struct plan_target *target);
/* Adds one of them, if the needs call for it. */
void sdfgi_stage_add_pass(const struct plan_stage *stage, enum pass pass, const struct plan_target *target);

/* True if light cells have new light from their own rays in this frame. */
bool sdfgi_stage_bounces(const struct plan_stage *stage);
/* The piece of distances whose passes run beside those of light, each in the group of another: alone each
 * takes mostly the time that it waits. NULL if there is none, or several, or if something in this frame needs
 * the distances. */
const struct scroll_piece *sdfgi_stage_piece_beside(const struct plan_stage *stage);

/* Adds an item by hand. NULL if nothing calls for the pass in this frame. */
struct work *sdfgi_stage_add(const struct plan_stage *stage, enum pass pass, uint32_t cascade);
/* Items added from here on, until `sdfgi_stage_end_group`, run side by side. They touch nothing in common. */
uint32_t sdfgi_stage_begin_group(const struct plan_stage *stage);
void sdfgi_stage_end_group(const struct plan_stage *stage, uint32_t first);

/* Light lists of cascades whose rebuild begins: no entry of them may be read until it completes. */
void sdfgi_stage_empty_lists(const struct plan_stage *stage);
/* Stages 3 and 4: voxels and distances that are due. */
void sdfgi_stage_generate(const struct plan_stage *stage);
/* Stages 5 to 7 for cascades whose change completes, or whose light list was lost. */
void sdfgi_stage_complete(const struct plan_stage *stage);
/* Stages 6 and 7 for all cascades: direct light that changed, rays, probes, light that bounces. */
void sdfgi_stage_light(const struct plan_stage *stage);

/* Forgets which light cells of a cascade were seen, as a view may have turned; which of them rays have hit,
 * as far as new marks are concerned; and all of it, as entries of the list change. */
void sdfgi_stage_forget_seen(const struct plan_stage *stage, uint32_t cascade);
void sdfgi_stage_forget_hit(const struct plan_stage *stage, uint32_t cascade);
void sdfgi_stage_forget_watched(const struct plan_stage *stage, uint32_t cascade);

/* True if lights have changed in such a way that all cells are lit again. */
bool sdfgi_frame_lights_all(const struct frame *frame);
/* What happens to the light list of a cascade. */
enum relist sdfgi_frame_relist(const struct frame *frame, uint32_t cascade);

#endif
