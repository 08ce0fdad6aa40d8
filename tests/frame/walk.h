/* SPDX-License-Identifier: MIT
 * Random walks through a random scene, for properties that hold in every frame. */
#ifndef WALK_H
#define WALK_H

#include "drive.h"
#include "test_memory.h"

enum { WALK_BOXES = 24, WALK_LIGHTS = 6 };

struct walk {
    struct drive d;
    struct test_random random;
    double velocity[3]; /* metres a frame */
    uint32_t rest;      /* frames for which nothing happens */
    sdfgi_instance boxes[WALK_BOXES];
    sdfgi_light lights[WALK_LIGHTS];
    uint32_t box_count, light_count;
};

void walk_begin(struct walk *walk, const struct sdfgi_settings *settings, uint32_t seed);
/* Moves the camera, and now and then something else; begins a frame. */
void walk_on(struct walk *walk);

#endif
