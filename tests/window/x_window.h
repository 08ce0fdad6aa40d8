/* SPDX-License-Identifier: MIT
 * A window of this process as a user has it: keys and clicks go in through the X server, pictures come out.
 */
#ifndef TEST_X_WINDOW_H
#define TEST_X_WINDOW_H

#include <stdbool.h>
#include <stdint.h>

enum x_key { X_KEY_F1, X_KEY_F2, X_KEY_V, X_KEY_SHIFT_V, X_KEY_0, X_KEY_3, X_KEY_G, X_KEY_ESCAPE };

struct x_window {
    void *display;
    unsigned long window;
    unsigned long time; /* of the last event that was sent */
};

/* Finds the window whose title begins with "sdfgi". Failures end the test. */
void x_window_open(struct x_window *x);
void x_window_close(struct x_window *x);

void x_window_press(struct x_window *x, enum x_key key);
/* Moves the pointer; presses or lets go of the left button where it is. */
void x_window_point(struct x_window *x, float at_x, float at_y);
void x_window_button(struct x_window *x, bool down);
/* Turns the wheel by one notch, to see what is further down. */
void x_window_wheel(struct x_window *x);

struct x_picture {
    uint32_t width, height;
    uint32_t *pixels; /* 0xRRGGBB, rows from the top; for free() */
};

struct x_picture x_window_capture(struct x_window *x);
/* Share of the pixels with x in [from, to) that differ. */
double x_picture_differ(const struct x_picture *a, const struct x_picture *b, uint32_t from, uint32_t to);

#endif
