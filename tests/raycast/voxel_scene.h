/* SPDX-License-Identifier: MIT
 * Built scenes as a voxel renderer would hold them: sub-voxels by definition (6-separating, half a sub-voxel
 * behind what does not emit), means per block.
 */
#ifndef TESTS_RAYCAST_VOXEL_SCENE_H
#define TESTS_RAYCAST_VOXEL_SCENE_H

#include "meshes.h"
#include "scenes.h"

enum { VOXEL_RESOLUTION = 32 };

struct voxel_scene {
    struct raycast_voxels voxels;
    uint64_t *bits[RAYCAST_MAX_CASCADES];
    struct raycast_block *blocks[RAYCAST_MAX_CASCADES];
};

/* Cascades of VOXEL_RESOLUTION cells a side around the origin, the finest with cells of `cell_m`. Instances
 * must not be moved. A block emits to the sides that its emissive triangles face. */
void voxel_scene_init(struct voxel_scene *v, const struct built_scene *s, double cell_m, double y_scale,
                      uint32_t cascades);
void voxel_scene_finish(struct voxel_scene *v);

/* Adds a mesh with flat normals and the newest material, and destroys it. */
void scene_add_mesh(struct built_scene *s, struct test_mesh mesh);

#endif
