/* SPDX-License-Identifier: MIT
 * Rules that every plan keeps. Each fails the test where a plan breaks it. */
#ifndef PLAN_RULES_H
#define PLAN_RULES_H

#include "drive.h"

/* The same input gives the same plan, and stays as it is. */
void plan_rules_pure(const struct drive *d);
/* A pass with items has the reason for running, one without has the other; and where a need holds, there are
 * items. */
void plan_rules_reasons(const struct frame *frame);
/* Items of a group are neighbours, and none touches what another one writes. */
void plan_rules_groups(const struct work_list *work);
/* A barrier comes before a group or after it: none has a pass wait for those beside it, nor a clear for
 * others that touch something else. One comes between clears that overlap. Times begin before the barrier. */
void plan_rules_barriers(const struct drive *d, const struct frame *frame);
/* Voxels and distances keep to the budget. */
void plan_rules_budget(const struct frame *frame, const struct sdfgi_settings *settings);
/* Boxes and ranges lie inside what they are part of; every device takes the dispatches. */
void plan_rules_ranges(const struct drive *d, const struct frame *frame);

/* What a change has made so far. */
struct plan_coverage {
    uint8_t *bricks[SDFGI_MAX_CASCADES]; /* of 8^3 cells: how often they have been voxelised */
    uint32_t layers[SDFGI_MAX_CASCADES]; /* that have distances */
    uint32_t completed;                  /* changes, in all */
};

/* From its first frame to its last, a change makes all that its boxes hold, and every layer once. */
void plan_rules_cover(struct plan_coverage *coverage, const struct frame *frame);
void plan_coverage_free(struct plan_coverage *coverage);

#endif
