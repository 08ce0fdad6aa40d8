/* SPDX-License-Identifier: MIT
 * Looking up GI's light after the prepass, for all opaque pixels at once. */
#include "host_internal.h"

#include <string.h>

static const char *const names[HOST_LOOKUP_COUNT] = {
    [HOST_LOOKUP_FORWARD] = "forward",
    [HOST_LOOKUP_FULL] = "full",
    [HOST_LOOKUP_HALF] = "half",
    [HOST_LOOKUP_QUARTER] = "quarter",
};

const char *host_lookup_name(enum host_lookup lookup)
{
    return names[lookup];
}

enum host_lookup host_lookup_from_name(const char *name)
{
    for (int i = 0; i < HOST_LOOKUP_COUNT; i++) {
        if (strcmp(names[i], name) == 0)
            return (enum host_lookup)i;
    }
    return HOST_LOOKUP_COUNT;
}

bool host_lookup_init(struct host_renderer *renderer, uint32_t width, uint32_t height)
{
    static const enum sdfgi_gather_resolution resolutions[HOST_LOOKUP_COUNT] = {
        [HOST_LOOKUP_FULL] = SDFGI_GATHER_FULL,
        [HOST_LOOKUP_HALF] = SDFGI_GATHER_HALF,
        [HOST_LOOKUP_QUARTER] = SDFGI_GATHER_QUARTER,
    };
    const struct host_lookups *lookups = &renderer->lookups;
    const struct sdfgi_view_desc desc = { .width = width,
                                          .height = height,
                                          .diffuse = resolutions[lookups->diffuse],
                                          .reflection = resolutions[lookups->reflection] };
    for (uint32_t eye = 0; eye < renderer->eye_count && lookups->diffuse != HOST_LOOKUP_FORWARD; eye++) {
        renderer->targets.eyes[eye].view = host_gi_view_create(renderer->gi, &desc);
        if (!renderer->targets.eyes[eye].view)
            return false;
    }
    return true;
}

/* Gives the forward pass the view's pictures. One that there is not is never read. */
static void pictures_bind(struct host_renderer *renderer, const struct host_slot *slot)
{
    struct sdfgi_view_images images;
    sdfgi_view_get_images(host_eye_here(renderer)->view, &images);
    const VkImageLayout layout = VK_IMAGE_LAYOUT_GENERAL;
    const VkDescriptorImageInfo infos[] = {
        { renderer->nearest, images.diffuse, layout },
        { renderer->nearest, images.reflection ? images.reflection : images.diffuse, layout },
    };
    const VkWriteDescriptorSet write = { .sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET,
                                         .dstSet = host_slot_here(renderer, slot)->light_set,
                                         .descriptorCount = HOST_COUNT(infos),
                                         .descriptorType = VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER,
                                         .pImageInfo = infos };
    struct host_frame_data *frame = host_slot_here(renderer, slot)->frame.mapped;
    vkUpdateDescriptorSets(renderer->device->device, 1, &write, 0, NULL);
    frame->camera_position[3] = images.reflection ? 1.0f : 0.0f;
}

bool host_lookup_record(struct host_renderer *renderer, struct host_slot *slot)
{
    const struct host_targets *targets = &renderer->targets;
    if (host_forward_kind(renderer, false) != HOST_FORWARD_GATHERED)
        return true;
    struct sdfgi_resolve_desc desc = { .depth = targets->depth.view,
                                       .normal = targets->normal.view,
                                       .roughness = renderer->left_out.reflections ? VK_NULL_HANDLE
                                                                                   : targets->roughness };
    host_camera_fill_inverse(&renderer->camera, desc.inverse_view_projection);
    if (!host_gi_resolve(renderer->gi, host_eye_here(renderer)->view, slot->cmd, &desc))
        return false;
    pictures_bind(renderer, slot);
    return true;
}
