/* SPDX-License-Identifier: MIT
 * A user of the window of `sdfgi view`, who does one step after another and takes pictures. */
#ifndef TEST_TOUR_H
#define TEST_TOUR_H

#include "cli/view_editor.h"
#include "x_window.h"

/* The panel covers the left; SCENE is the first column beside it. */
enum { WIDTH = 350, HEIGHT = 300, SCENE = 240, PANEL_X = 120, PANEL_Y = 250, SETTLES = 3000 };

enum action { SETTLE, KEY, SCROLL, CLICK, DRAG, TAKE };

struct step {
    enum action action;
    enum x_key key;
    int picture;
    const char *widget;
};

enum { PICTURES_MAX = 32, PROPERTIES_MAX = 64 };

struct tour {
    const struct step *steps;
    uint32_t count, at, waited;
    struct x_window x;
    bool opened;
    const char *missing; /* a widget that was not there */
    struct x_picture pictures[PICTURES_MAX];
    struct view_editor editor;
    struct host_overlay panel;
    struct host_overlay_frame seen[PICTURES_MAX]; /* of the frame when a picture was taken */
    struct host_overlay_frame now;
    uint64_t held[PICTURES_MAX]; /* device memory of GI when a picture was taken */
    bool listed[PROPERTIES_MAX]; /* properties that the panel has shown */
    uint32_t bars;               /* frames that showed progress */
    struct sdfgi_progress made;  /* when GI was on for the first time */
};

/* Opens a window in which GI is off, and does all steps, of which the last closes it. Failures end the test.
 */
void tour_run(struct tour *tour, const struct step *steps, uint32_t count);

/* Writes what the pictures of a tour show into the folder SDFGI_TEST_PICTURES, where there is one. */
void tour_save(const struct tour *tour);

#endif
