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

/* What cells are to be multiplied by so that the coarsest cascade, an edge of `coarsest_m` around the camera,
 * holds all of the scene, or that the finest, of `finest_m`, holds no more than it needs. 1 in between. */
double view_cells_scale(const struct gltf_scene *scene, const struct host_camera *camera, double finest_m,
                        double coarsest_m);

#endif
