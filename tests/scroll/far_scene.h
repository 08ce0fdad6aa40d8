/* SPDX-License-Identifier: MIT
 * A small scene that can stand anywhere: a floor, walls, boxes and a roof, lit by sun, sky, a point light and
 * a spot, all of which throw shadows. Every length is a multiple of 1/64 m, so that it is exact in doubles
 * millions of metres out as well. */
#ifndef TEST_FAR_SCENE_H
#define TEST_FAR_SCENE_H

#include "host_view.h"

/* Writes the scene with everything moved by `shift` into the folder of files.h; the path of its glTF file. */
const char *far_scene_write(const double shift[3]);

/* The camera and lights of the same place. */
struct host_view far_scene_view(const double shift[3], struct host_light lights[2]);

#endif
