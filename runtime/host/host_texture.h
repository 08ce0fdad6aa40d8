/* SPDX-License-Identifier: MIT
 * Textures of materials, and the picture of all directions. */
#ifndef HOST_TEXTURE_H
#define HOST_TEXTURE_H

#include "host_internal.h"

/* An image of four bytes per texel, with mip levels, ready to be sampled. */
bool host_texture_create(struct host_device *device, VkFormat format, uint32_t width, uint32_t height,
                         uint32_t mips, const void *texels, struct host_image *out);
VkSamplerAddressMode host_address_mode(enum gltf_wrap wrap);
/* Makes image and sampler of a texture reference; `view` gets a white texel where there is none. */
bool host_textures_get(struct host_device *device, struct host_textures *textures,
                       const struct gltf_scene *gltf, const struct gltf_texture_ref *ref, bool srgb,
                       VkDescriptorImageInfo *out);
bool host_textures_init(struct host_device *device, struct host_textures *textures,
                        const struct gltf_scene *gltf);
void host_textures_finish(struct host_device *device, struct host_textures *textures);

bool host_environment_init(struct host_scene *scene, const struct host_environment *from);
void host_environment_finish(struct host_scene *scene);
/* The set has the layout of the pictures of a view's light. */
void host_environment_set_write(const struct host_scene *scene, VkDescriptorSet set);

#endif
