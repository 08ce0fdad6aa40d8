/* SPDX-License-Identifier: MIT
 * Textures with mip levels, and samplers. An image that is read both as colour and as data exists twice. */
#include "host_internal.h"
#include "host_texture.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const VkPipelineStageFlags transfer_stages[] = { VK_PIPELINE_STAGE_TRANSFER_BIT,
                                                        VK_PIPELINE_STAGE_TRANSFER_BIT };

static uint32_t mip_count(uint32_t width, uint32_t height)
{
    uint32_t count = 1;
    for (uint32_t size = width > height ? width : height; size > 1; size /= 2)
        count++;
    return count;
}

static int32_t mip_size(uint32_t size, uint32_t mip)
{
    const uint32_t result = size >> mip;
    return (int32_t)(result > 0 ? result : 1);
}

/* Fills level `mip` from the one above, which it leaves as a transfer source. */
static void record_mip(VkCommandBuffer cmd, const struct host_image *image, uint32_t mip)
{
    host_image_barrier(
        cmd, image->image, mip - 1, 1,
        (const VkImageLayout[]){ VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL },
        transfer_stages,
        (const VkAccessFlags[]){ VK_ACCESS_TRANSFER_WRITE_BIT, VK_ACCESS_TRANSFER_READ_BIT });
    const VkImageBlit blit = {
        .srcSubresource = { VK_IMAGE_ASPECT_COLOR_BIT, mip - 1, 0, 1 },
        .srcOffsets = { { 0, 0, 0 },
                        { mip_size(image->width, mip - 1), mip_size(image->height, mip - 1), 1 } },
        .dstSubresource = { VK_IMAGE_ASPECT_COLOR_BIT, mip, 0, 1 },
        .dstOffsets = { { 0, 0, 0 }, { mip_size(image->width, mip), mip_size(image->height, mip), 1 } },
    };
    vkCmdBlitImage(cmd, image->image, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, image->image,
                   VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1, &blit, VK_FILTER_LINEAR);
}

static void record_upload(VkCommandBuffer cmd, const struct host_image *image, VkBuffer staging)
{
    static const VkPipelineStageFlags from_top[] = { VK_PIPELINE_STAGE_TOP_OF_PIPE_BIT,
                                                     VK_PIPELINE_STAGE_TRANSFER_BIT };
    static const VkPipelineStageFlags to_all[] = { VK_PIPELINE_STAGE_TRANSFER_BIT,
                                                   VK_PIPELINE_STAGE_ALL_COMMANDS_BIT };
    static const VkAccessFlags to_shader[] = { VK_ACCESS_TRANSFER_WRITE_BIT | VK_ACCESS_TRANSFER_READ_BIT,
                                               VK_ACCESS_SHADER_READ_BIT };
    host_image_barrier(
        cmd, image->image, 0, image->mips,
        (const VkImageLayout[]){ VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL }, from_top,
        (const VkAccessFlags[]){ 0, VK_ACCESS_TRANSFER_WRITE_BIT });
    const VkBufferImageCopy region = { .imageSubresource = { VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1 },
                                       .imageExtent = { image->width, image->height, 1 } };
    vkCmdCopyBufferToImage(cmd, staging, image->image, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1, &region);
    for (uint32_t mip = 1; mip < image->mips; mip++)
        record_mip(cmd, image, mip);
    if (image->mips > 1)
        host_image_barrier(cmd, image->image, 0, image->mips - 1,
                           (const VkImageLayout[]){ VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL,
                                                    VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL },
                           to_all, to_shader);
    host_image_barrier(cmd, image->image, image->mips - 1, 1,
                       (const VkImageLayout[]){ VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL,
                                                VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL },
                       to_all, to_shader);
}

static bool upload_texels(struct host_device *device, const struct host_image *image, const void *texels)
{
    struct host_buffer staging;
    const size_t size = (size_t)4 * image->width * image->height;
    if (!host_buffer_create(device, size, VK_BUFFER_USAGE_TRANSFER_SRC_BIT, true, &staging))
        return false;
    memcpy(staging.mapped, texels, size);
    VkCommandBuffer cmd = host_commands_begin(device);
    if (cmd)
        record_upload(cmd, image, staging.buffer);
    const bool ok = cmd && host_commands_finish(device, cmd);
    host_buffer_destroy(device, &staging);
    return ok;
}

bool host_texture_create(struct host_device *device, VkFormat format, uint32_t width, uint32_t height,
                         uint32_t mips, const void *texels, struct host_image *out)
{
    const struct host_image_desc desc = {
        .format = format,
        .width = width,
        .height = height,
        .mips = mips,
        .usage =
            VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT,
    };
    return host_image_create(device, &desc, out) && upload_texels(device, out, texels);
}

static bool texture_create(struct host_device *device, const struct gltf_image *source, bool srgb,
                           struct host_image *out)
{
    return host_texture_create(device, srgb ? VK_FORMAT_R8G8B8A8_SRGB : VK_FORMAT_R8G8B8A8_UNORM,
                               source->width, source->height, mip_count(source->width, source->height),
                               source->texels, out);
}

VkSamplerAddressMode host_address_mode(enum gltf_wrap wrap)
{
    switch (wrap) {
    case GLTF_WRAP_MIRROR:
        return VK_SAMPLER_ADDRESS_MODE_MIRRORED_REPEAT;
    case GLTF_WRAP_CLAMP:
        return VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE;
    default:
        return VK_SAMPLER_ADDRESS_MODE_REPEAT;
    }
}

static bool sampler_get(struct host_device *device, struct host_textures *textures,
                        const struct gltf_texture *texture, VkSampler *out)
{
    const bool min_nearest = texture->min_filter == GLTF_FILTER_NEAREST;
    const bool mag_nearest = texture->mag_filter == GLTF_FILTER_NEAREST;
    const uint32_t index =
        (uint32_t)texture->wrap_u * 12 + (uint32_t)texture->wrap_v * 4 + 2 * min_nearest + mag_nearest;
    /* Filtering along the slope of the surface is slow in software and cheap in hardware. */
    const bool anisotropy = device->anisotropy && !min_nearest && strcmp(device->info.type, "cpu") != 0;
    const VkSamplerCreateInfo info = {
        .sType = VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO,
        .magFilter = mag_nearest ? VK_FILTER_NEAREST : VK_FILTER_LINEAR,
        .minFilter = min_nearest ? VK_FILTER_NEAREST : VK_FILTER_LINEAR,
        .mipmapMode = min_nearest ? VK_SAMPLER_MIPMAP_MODE_NEAREST : VK_SAMPLER_MIPMAP_MODE_LINEAR,
        .addressModeU = host_address_mode(texture->wrap_u),
        .addressModeV = host_address_mode(texture->wrap_v),
        .anisotropyEnable = anisotropy,
        .maxAnisotropy = anisotropy ? fminf(8.0f, device->limits.maxSamplerAnisotropy) : 1.0f,
        .maxLod = VK_LOD_CLAMP_NONE,
    };
    if (!textures->samplers[index] &&
        !host_check(device, vkCreateSampler(device->device, &info, NULL, &textures->samplers[index]),
                    "creating a sampler"))
        return false;
    *out = textures->samplers[index];
    return true;
}

bool host_textures_init(struct host_device *device, struct host_textures *textures,
                        const struct gltf_scene *gltf)
{
    static uint8_t white[4] = { 255, 255, 255, 255 };
    textures->image_count = gltf->image_count;
    textures->images = host_device_alloc(device, (size_t)2 * gltf->image_count, sizeof(*textures->images));
    return textures->images &&
           texture_create(device, &(struct gltf_image){ .width = 1, .height = 1, .texels = white }, false,
                          &textures->white);
}

bool host_textures_get(struct host_device *device, struct host_textures *textures,
                       const struct gltf_scene *gltf, const struct gltf_texture_ref *ref, bool srgb,
                       VkDescriptorImageInfo *out)
{
    static const struct gltf_texture none = { .image = -1 };
    const struct gltf_texture *texture = ref->texture >= 0 ? &gltf->textures[ref->texture] : &none;
    *out = (VkDescriptorImageInfo){ .imageView = textures->white.view,
                                    .imageLayout = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL };
    if (!sampler_get(device, textures, texture, &out->sampler))
        return false;
    if (texture->image < 0)
        return true;
    struct host_image *image = &textures->images[2 * texture->image + srgb];
    if (!image->view && !texture_create(device, &gltf->images[texture->image], srgb, image))
        return false;
    out->imageView = image->view;
    return true;
}

void host_textures_finish(struct host_device *device, struct host_textures *textures)
{
    for (uint32_t i = 0; textures->images && i < 2 * textures->image_count; i++)
        host_image_destroy(device, &textures->images[i]);
    host_image_destroy(device, &textures->white);
    for (int i = 0; i < HOST_SAMPLER_COUNT; i++)
        vkDestroySampler(device->device, textures->samplers[i], NULL);
    free(textures->images);
}
