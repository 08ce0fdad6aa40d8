/* SPDX-License-Identifier: MIT
 * The blend region: what lookups sample of a cascade.
 *
 * When a cascade scrolls, its valid region loses a slab on one side at once and gains one on the other later.
 * Neither may show. So the region's border recedes with the camera on the side that the next scroll takes
 * away, and nothing of a slab is sampled any more when it goes; on the other side the border advances slowly
 * into what was gained. On the side that the camera leaves, the border leaves some cells free: axes that are
 * due one after the other can then scroll together, some of them past the camera, and a cascade scrolls
 * hardly more often than its fastest axis alone. */
#ifndef SDFGI_BLEND_H
#define SDFGI_BLEND_H

#include "scroll.h"

/* Leaves cells free on the sides that the camera leaves. */
void sdfgi_blend_reserve(struct cascades *cascades, const struct scroll *scroll);
/* Moves all borders towards where the camera and the valid regions would have them: at once if `jumps`, and
 * in cascades that follow a cut. Counts those that have not arrived. */
void sdfgi_blend_move(struct cascades *cascades, struct scroll *scroll, bool jumps);

#endif
