/* SPDX-License-Identifier: MIT
 * Checks of what hosts pass. */
#ifndef SDFGI_SCENE_CHECK_H
#define SDFGI_SCENE_CHECK_H

#include "scene.h"

enum { MAX_OBJECTS = (1 << 20) - 2 }; /* of one kind: what a handle can number */

bool sdfgi_check_finite_floats(const float *v, int count);
bool sdfgi_check_finite_doubles(const double *v, int count);
/* Finite, too. */
bool sdfgi_check_non_negative(const float *v, int count);
/* Report that a pool is full or memory short, or that a handle names nothing. */
enum sdfgi_result sdfgi_check_out_of_slots(const struct scene *scene, const char *what, uint32_t limit);
enum sdfgi_result sdfgi_check_unknown_handle(const struct scene *scene, const char *what, uint32_t id);

#endif
