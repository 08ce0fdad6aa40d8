/* SPDX-License-Identifier: MIT
 * The volumes that the renderer would trace, for the path tracer. */
#ifndef RUNTIME_REFERENCE_VOXELS_H
#define RUNTIME_REFERENCE_VOXELS_H

#include "host/host.h"

#include <modules/raycast/raycast.h>

struct gltf_scene;

/* Zero-initialised before use. */
struct reference_voxels {
    struct raycast_voxels voxels;
    struct host_volumes volumes;                        /* holds the bits */
    struct raycast_block *blocks[RAYCAST_MAX_CASCADES]; /* holds the rest */
};

/* Voxelises the scene around the view's camera on a device of the user's choice (NULL: as host_device_desc),
 * exactly as a renderer with these settings would. On failure prints one line and returns false. */
bool reference_voxels_read(const struct gltf_scene *gltf, const struct host_view *view,
                           const struct sdfgi_settings *settings, const char *device,
                           struct reference_voxels *out);
void reference_voxels_finish(struct reference_voxels *voxels);

#endif
