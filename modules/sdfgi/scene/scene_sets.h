/* SPDX-License-Identifier: MIT
 * Descriptor sets of meshes and materials. */
#ifndef SDFGI_SCENE_SETS_H
#define SDFGI_SCENE_SETS_H

#include "scene.h"

VkResult sdfgi_scene_sets_mesh(struct scene *scene, struct mesh *mesh);
/* Leaves material->set null if the material has no texture. */
VkResult sdfgi_scene_sets_material(struct scene *scene, struct material *material);
/* Frees a set once no frame in flight can use it. NULL is accepted. */
void sdfgi_scene_sets_retire(struct scene *scene, struct object_set *set);
void sdfgi_scene_sets_finish(struct scene *scene);

#endif
