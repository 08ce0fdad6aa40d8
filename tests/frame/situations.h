/* SPDX-License-Identifier: MIT
 * Situations in which frames are planned. Each shows some frames; what they do is recorded in plans.txt. */
#ifndef SITUATIONS_H
#define SITUATIONS_H

#include "drive.h"
#include "plan_text.h"

struct show {
    struct drive d;
    struct text text;
};

struct situation_row {
    const char *name; /* a claim */
    void (*fn)(struct show *show);
};

struct situation_table {
    const struct situation_row *rows;
    uint32_t count;
};

extern const struct situation_table situations_start, situations_scroll, situations_edit, situations_light,
    situations_settings;

/* ---- What situations are made of */

/* A floor and a lamp in two cascades of 32^3 cells, 8 m and 16 m wide. */
void show_begin(struct show *show);
/* The same with settings of one's own. */
void show_begin_with(struct show *show, const struct sdfgi_settings *settings);
/* The same without the lamp, and without the floor. */
void show_begin_unlit(struct show *show, const struct sdfgi_settings *settings);
void show_begin_empty(struct show *show, const struct sdfgi_settings *settings);

/* Plans frames, shows them and takes them over as done. */
void show_frames(struct show *show, uint32_t count);
/* Which passes the newest frame left out, and why. */
void show_idle(struct show *show);
/* One frame, with the camera moved by metres. */
void show_move(struct show *show, double x, double y, double z);
/* Goes on with a camera that moves by `step` metres a frame until a change begins, and shows that frame. */
void show_until_begun(struct show *show, const double step[static 3]);
/* The same until a cascade's change has reached a stage. */
void show_until(struct show *show, uint32_t cascade, enum change_stage stage, const double step[static 3]);

#define SITUATIONS(name)                                                                                     \
    {                                                                                                        \
        name, sizeof name / sizeof *name                                                                     \
    }

#endif
