/* SPDX-License-Identifier: MIT
 * Parts of a view as text: options of the command line, and strings in a VIEW.json. All return false with
 * what was expected in `error`, which goes on after the name of the option or the key: `is "blue", expected
 * ...`. The view is as it was then. */
#ifndef RUNTIME_VIEW_OPTION_H
#define RUNTIME_VIEW_OPTION_H

#include "host/host_view.h"

#include <stdbool.h>
#include <stddef.h>

struct gltf_scene;

typedef bool view_option(const char *text, struct host_view *view, char *error, size_t error_size);

/* "none", "day", one radiance, three (R,G,B), or nine (zenith, horizon, ground). An environment gives way. */
view_option view_option_sky;

/* "none", "day", X,Y,Z (the way the light travels), or X,Y,Z,R,G,B (with the irradiance). */
view_option view_option_sun;

/* X,Y,Z,LX,LY,LZ (position and what it looks at), with the vertical angle of view in degrees as a seventh
 * number if wanted; the index or the name of one of the scene's perspective cameras; or "auto". */
bool view_option_camera(const char *text, const struct gltf_scene *scene, double aspect,
                        struct host_view *view, char *error, size_t error_size);

/* Reads a picture of all directions into view->environment, which view_file_finish frees. The sky's colours
 * and the default sun give way to it. */
view_option view_option_environment;

#endif
