/* SPDX-License-Identifier: MIT
 * Descriptor sets of meshes and materials. */
#ifndef SDFGI_SCENE_SETS_H
#define SDFGI_SCENE_SETS_H

#include "internal.h"

VkResult scene_sets_mesh(struct sdfgi *gi, struct mesh *mesh);
/* Leaves material->set null if the material has no texture. */
VkResult scene_sets_material(struct sdfgi *gi, struct material *material);
/* Frees a set once no frame in flight can use it. Null is accepted. */
void scene_sets_retire(struct sdfgi *gi, VkDescriptorSet set, VkDescriptorPool pool);
void scene_sets_finish(struct sdfgi *gi);

#endif
