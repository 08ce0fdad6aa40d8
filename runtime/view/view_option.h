/* SPDX-License-Identifier: MIT
 * Parts of a view as text, for the command line. All return false with one line in `error` that says what was
 * expected, and leave the view as it was then. */
#ifndef RUNTIME_VIEW_OPTION_H
#define RUNTIME_VIEW_OPTION_H

#include "host/host_view.h"

#include <stdbool.h>
#include <stddef.h>

struct gltf_scene;

/* "none", "day", one radiance, three (R,G,B), or nine (zenith, horizon, ground). */
bool view_option_sky(const char *text, struct host_view *view, char *error, size_t error_size);

/* "none", "day", X,Y,Z (the way the light travels), or X,Y,Z,R,G,B (with the irradiance). */
bool view_option_sun(const char *text, struct host_view *view, char *error, size_t error_size);

/* X,Y,Z,LX,LY,LZ (position and what it looks at), with the vertical angle of view in degrees as a seventh
 * number if wanted; the index or the name of one of the scene's perspective cameras; or "auto". */
bool view_option_camera(const char *text, const struct gltf_scene *scene, double aspect,
                        struct host_view *view, char *error, size_t error_size);

/* Reads a picture of all directions into view->environment, which view_file_finish frees. The sky's colours
 * and the default sun give way to it. */
bool view_option_environment(const char *path, struct host_view *view, char *error, size_t error_size);

#endif
