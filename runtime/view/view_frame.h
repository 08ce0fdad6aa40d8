/* SPDX-License-Identifier: MIT
 * A camera for a scene that has none. */
#ifndef RUNTIME_VIEW_FRAME_H
#define RUNTIME_VIEW_FRAME_H

#include "host/host_view.h"

struct gltf_scene;

/* Of some places around the scene, and some in its middle, the one that shows most: the entropy of how the
 * picture is shared among surfaces, after Vazquez et al. 2001, "Viewpoint Selection using Viewpoint Entropy".
 * Around the scene it stands where all of its box fits a picture of that width over height. Keeps the angle
 * of view. */
void view_frame_scene(const struct gltf_scene *scene, double aspect, struct host_camera *camera);

#endif
