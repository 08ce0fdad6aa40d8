/* SPDX-License-Identifier: MIT
 * The changes of a cascade: how each cause begins, and its stages. */
#ifndef SDFGI_CHANGE_H
#define SDFGI_CHANGE_H

#include "cascade.h"

/* Rebuilds all of a cascade. Its blend region grows out from the camera. */
void sdfgi_change_begin_rebuild(struct cascade *cascade, uint32_t resolution, const double camera[static 3]);
/* Moves a cascade to `origin` and keeps what both places share; rebuilds it if that is nothing, or out of
 * date. */
void sdfgi_change_begin_scroll(struct cascade *cascade, uint32_t resolution, const int64_t origin[static 3],
                               const double camera[static 3]);
/* Makes the boxes again in which geometry changed; does nothing if they hold no cell. */
void sdfgi_change_begin_edit(struct cascade *cascade, uint32_t resolution);

/* Goes on to a later stage. */
void sdfgi_change_enter(struct change *change, enum change_stage stage);
/* After the frame that completed it: nothing changes any more. */
void sdfgi_change_finish(struct change *change);

/* The part of box `i` that lies inside the cascade. */
struct cell_box sdfgi_change_box(const struct change *change, uint32_t i, uint32_t resolution);
/* The next box with cells in the cascade, from change->box on; change->count if there is none. */
uint32_t sdfgi_change_next_box(const struct change *change, uint32_t resolution);

/* Axis across which the boxes around removed and added sub-voxels lie in strips
 * (shaders/sdfgi/dirty_bounds.glsl): scrolls are cut across. -1: nothing is kept, so nobody asks for the
 * boxes. */
int32_t sdfgi_change_bounds_axis(const struct change *change);

#endif
