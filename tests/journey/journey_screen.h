/* SPDX-License-Identifier: MIT
 * A small screen for sdfgi_gather: a level plane below the origin, seen from above, with holes. */
#ifndef TEST_JOURNEY_SCREEN_H
#define TEST_JOURNEY_SCREEN_H

#include "gi_test.h"

enum { JOURNEY_SCREEN_WIDTH = 19, JOURNEY_SCREEN_HEIGHT = 13 };

struct journey_screen {
    bool made;
    struct gpu_test_image depth, normal, output;
    uint16_t pixels[JOURNEY_SCREEN_HEIGHT * JOURNEY_SCREEN_WIDTH][4];
};

void journey_screen_open(struct journey_screen *screen, struct gi_test *t);
void journey_screen_close(struct journey_screen *screen, struct gi_test *t);

/* Gathers after the last update, and returns the pixels. They stay until the next gather. */
const void *journey_screen_gather(struct journey_screen *screen, struct gi_test *t,
                                  enum sdfgi_gather_resolution resolution);

#endif
