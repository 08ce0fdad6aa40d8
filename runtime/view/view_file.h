/* SPDX-License-Identifier: MIT
 * Camera, sky and lights from a VIEW.json, or from the scene itself where there is none. */
#ifndef RUNTIME_VIEW_FILE_H
#define RUNTIME_VIEW_FILE_H

#include "host/host_view.h"

#include <stdbool.h>
#include <stddef.h>

struct gltf_camera;
struct gltf_scene;

/* Reads the file at `path`. On failure returns false, with one line in `error` that names the file and the
 * key. Otherwise `view` is to be given to view_file_finish. */
bool view_file_load(const char *path, struct host_view *view, char *error, size_t error_size);

/* The first camera of the scene; without one, that of view_frame.h for pictures of that width over height.
 * Light as below. Needs no finish. */
void view_file_from_scene(const struct gltf_scene *scene, double aspect, struct host_view *view);

/* A sky and a sun where the scene has no lights, and does not glow enough to be seen by that. */
void view_light_from_scene(const struct gltf_scene *scene, struct host_view *view);
extern const struct host_sky view_day_sky;
extern const struct host_sun view_day_sun;

/* A camera of the scene, perspective or orthographic. */
void view_camera_from_file(const struct gltf_camera *from, struct host_camera *camera);

/* Frees the lights and the environment; a zeroed view is accepted. */
void view_file_finish(struct host_view *view);

#endif
