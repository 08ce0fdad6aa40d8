/* SPDX-License-Identifier: MIT
 * Lamps that flicker: fire, neon tubes. Their light goes to and fro in each frame, but its mean hardly
 * changes; what is known of it then stays of use. */
#ifndef SDFGI_FLICKER_H
#define SDFGI_FLICKER_H

#include <sdfgi/sdfgi.h>

/* How a lamp has shone of late. */
struct lamp_habit {
    float usual[3];  /* mean over some 64 frames of its power */
    float lately[3]; /* and over some 16 */
    float restless;  /* the share of some 64 frames in which it has changed */
    uint64_t frame;  /* of its last change */
};

/* A lamp is made in a frame. */
struct lamp_habit sdfgi_habit_begin(const struct sdfgi_light_desc *lamp, uint64_t frame);
/* Takes in that a lamp becomes another one in a frame. Returns by which part the mean of its light changes in
 * the time of an epoch if it flickers; else 1: what is known of its light is outdated. */
float sdfgi_habit_change(struct lamp_habit *habit, const struct sdfgi_light_desc *before,
                         const struct sdfgi_light_desc *after, uint64_t frame);

#endif
