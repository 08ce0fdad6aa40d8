/* SPDX-License-Identifier: MIT
 *
 * Geometry made of a glTF scene's triangles, in Embree.
 */
#ifndef RAYCAST_TRIANGLES_H
#define RAYCAST_TRIANGLES_H

#include <stddef.h>

#include "geometry.h"

struct gltf_scene;
struct raycast_view;

struct triangles_desc {
    const struct gltf_scene *scene;
    const struct raycast_view *view;
    double origin[3];
    bool cull_back_faces;
};

/* NULL on failure, with one line in `error`. */
struct geometry *triangles_create(const struct triangles_desc *desc, char *error, size_t error_size);

#endif
