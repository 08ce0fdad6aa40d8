/* SPDX-License-Identifier: MIT
 * Camera, sky and lights from a VIEW.json, or from the scene itself where there is none. */
#ifndef RUNTIME_VIEW_FILE_H
#define RUNTIME_VIEW_FILE_H

#include "host/host_view.h"

#include <stdbool.h>
#include <stddef.h>

struct gltf_scene;

/* Reads the file at `path`. On failure returns false, with one line in `error` that names the file and the
 * key. Otherwise `view` is to be given to view_file_finish. */
bool view_file_load(const char *path, struct host_view *view, char *error, size_t error_size);

/* The first camera of the scene; without one, a camera that sees all of it from above a corner.
 * Where the scene has neither lights nor emission, a sun and a sky are added, since it would be black. Needs
 * no finish. */
void view_file_from_scene(const struct gltf_scene *scene, struct host_view *view);

/* Frees the lights; a zeroed view is accepted. */
void view_file_finish(struct host_view *view);

#endif
