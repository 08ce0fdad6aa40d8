/* SPDX-License-Identifier: MIT
 * A plan as text: a line for the frame, and one for each item of its list of work. */
#ifndef PLAN_TEXT_H
#define PLAN_TEXT_H

#include "frame/frame.h"

/* Grows as it is added to; zeros are an empty text. */
struct text {
    char *at;
    size_t size, room;
};

void text_append(struct text *text, const char *part, size_t length);
void text_add(struct text *text, const char *format, ...) __attribute__((format(printf, 2, 3)));
void text_free(struct text *text);

/* `cycle_frames`: of the settings. */
void plan_text_add(struct text *text, const struct frame *frame, uint32_t cycle_frames);
/* Passes without an item, and why they do not run. */
void plan_text_add_idle(struct text *text, const struct frame *frame);

#endif
