/* SPDX-License-Identifier: MIT
 * A world to walk through, and whether what a walk left behind is what a fresh context makes. */
#ifndef TEST_SCROLL_SCENE_H
#define TEST_SCROLL_SCENE_H

#include "gi_test.h"

/* True in suite `full`. */
bool scroll_is_full(void);
/* 64, or with SDFGI_TEST_FULL the default, 128: for the rows of HARD_CASES. */
uint32_t scroll_resolution(void);

/* Two cascades of `resolution` cells, 0.25 m, that settle in few frames. */
struct sdfgi_settings scroll_settings(uint32_t resolution);
/* Light cells gather for themselves. All are visited in each frame, and a cycle has so few visits, or twice
 * as many in suite `full`: with one, what cells show is steady at once; with more, neighbours differ
 * less. */
void scroll_use_cells(struct sdfgi_settings *settings, uint32_t visits);

/* Ground, boxes, lamps and loose triangles within `reach` metres of `center`, a sun, a point light and a sky.
 */
void scroll_world(struct gi_test *t, const double center[static 3], double reach);
/* The same without ground: a step takes two thirds of the time on lavapipe. */
void scroll_air(struct gi_test *t, const double center[static 3], double reach);

/* A box that is `2 half` wide inside, red, green and white, open towards +z, with a lamp. */
void scroll_colored_box(struct gi_test *t, const double center[static 3], double half);

/* Moves the camera; the host's origin stays, so that lights are rounded alike. */
void scroll_stand(struct gi_test *t, const double position[static 3]);
/* All cascades are made anew, where those of `walked` are: within their hysteresis, the way decides which
 * place they take. */
void scroll_place_as(struct gi_test *fresh, const struct gi_test *walked);
/* Updates until nothing is left to do for cascades; returns after how many frames. */
uint32_t scroll_settle(struct gi_test *t);

/* What cascades hold, light aside: bits, distances, albedo, emission, normals, masks, where probes stand,
 * which cells are light cells, their list with direct light, and, where there are any, depths around probes.
 * The first returns how many elements differ, and says which. */
uint64_t scroll_differences(struct gi_test *walked, struct gi_test *fresh, const char *what);
void scroll_require_equal(struct gi_test *walked, struct gi_test *fresh, const char *what);
/* The same without direct light. */
void scroll_require_equal_but_light(struct gi_test *walked, struct gi_test *fresh, const char *what);

#endif
