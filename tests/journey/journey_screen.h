/* SPDX-License-Identifier: MIT
 * A small screen for sdfgi_gather, sdfgi_view_resolve and sdfgi_debug_draw: a level plane below the origin,
 * seen from above, with holes. */
#ifndef TEST_JOURNEY_SCREEN_H
#define TEST_JOURNEY_SCREEN_H

#include "gi_test.h"

#include <sdfgi/debug.h>

enum { JOURNEY_SCREEN_WIDTH = 19, JOURNEY_SCREEN_HEIGHT = 13 };

struct journey_screen {
    bool made;
    struct gpu_test_image depth, normal, output;
    sdfgi_view *view;
    uint16_t pixels[JOURNEY_SCREEN_HEIGHT * JOURNEY_SCREEN_WIDTH][4];
};

void journey_screen_open(struct journey_screen *screen, struct gi_test *t);
void journey_screen_close(struct journey_screen *screen, struct gi_test *t);

/* Each draws after the last update, and returns the pixels. They stay until the next one does. */
const void *journey_screen_gather(struct journey_screen *screen, struct gi_test *t,
                                  enum sdfgi_gather_resolution resolution);
/* What surfaces reflect whose roughness is their depth. */
const void *journey_screen_reflect(struct journey_screen *screen, struct gi_test *t);
const void *journey_screen_debug(struct journey_screen *screen, struct gi_test *t,
                                 enum sdfgi_debug_view view);

#endif
