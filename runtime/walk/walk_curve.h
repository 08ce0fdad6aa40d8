/* SPDX-License-Identifier: MIT
 * The curve of a path, measured: where the camera is and looks after so many metres. */
#ifndef RUNTIME_WALK_CURVE_H
#define RUNTIME_WALK_CURVE_H

#include "walk_path.h"

/* Fills stations and length_m from the points. False when memory runs out. */
bool walk_curve_measure(struct walk_path *walk);

#endif
