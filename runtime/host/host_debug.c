/* SPDX-License-Identifier: MIT
 * Debug views of the library, drawn into an image and shown like a picture. */
#include "host_internal.h"

static bool image_create(struct host_renderer *renderer)
{
    struct host_image *image = &host_eye_here(renderer)->debug;
    const struct host_image_desc desc = { .format = VK_FORMAT_R16G16B16A16_SFLOAT,
                                          .width = renderer->width * renderer->supersample,
                                          .height = renderer->height * renderer->supersample,
                                          .usage = VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_SAMPLED_BIT |
                                                   VK_IMAGE_USAGE_TRANSFER_SRC_BIT };
    if (image->image)
        return true;
    /* The set may still be read by frames that showed an image of another size. */
    if (!host_slots_wait(renderer) || !host_image_create(renderer->device, &desc, image))
        return false;
    host_post_set_write(renderer, renderer->debug_sets[renderer->eye], image);
    return true;
}

/* What was shown before may go. */
static void image_change(const struct host_image *image, VkCommandBuffer cmd, bool drawn)
{
    const VkImageLayout layouts[] = { drawn ? VK_IMAGE_LAYOUT_GENERAL : VK_IMAGE_LAYOUT_UNDEFINED,
                                      drawn ? VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL
                                            : VK_IMAGE_LAYOUT_GENERAL };
    const VkPipelineStageFlags readers =
                                   VK_PIPELINE_STAGE_FRAGMENT_SHADER_BIT | VK_PIPELINE_STAGE_TRANSFER_BIT,
                               writer = VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT;
    const VkPipelineStageFlags stages[] = { drawn ? writer : readers, drawn ? readers : writer };
    const VkAccessFlags reads = VK_ACCESS_SHADER_READ_BIT | VK_ACCESS_TRANSFER_READ_BIT,
                        writes = VK_ACCESS_SHADER_WRITE_BIT;
    const VkAccessFlags accesses[] = { drawn ? writes : reads, drawn ? reads : writes };
    host_image_barrier(cmd, image->image, 0, 1, layouts, stages, accesses);
}

static bool eye_record(struct host_renderer *renderer, VkCommandBuffer cmd,
                       const struct host_debug_desc *desc)
{
    if (!image_create(renderer))
        return false;
    const struct host_image *image = &host_eye_here(renderer)->debug;
    struct sdfgi_debug_desc draw = { .output = image->view,
                                     .width = image->width,
                                     .height = image->height,
                                     .view = desc->view,
                                     .exposure = desc->exposure,
                                     .depth = renderer->targets.depth.view,
                                     .normal = renderer->targets.normal.view,
                                     .roughness = renderer->targets.roughness };
    host_camera_fill_inverse(&renderer->camera, draw.inverse_view_projection);
    /* Eyes share what the prepass draws: it holds what the last one saw. */
    if (desc->view == SDFGI_DEBUG_REFLECTION_TIER && renderer->eye_count > 1)
        host_prepass_record(renderer, cmd);
    image_change(image, cmd, false);
    const bool drawn = host_gi_debug(renderer->gi, cmd, &draw);
    image_change(image, cmd, true);
    return drawn;
}

bool host_debug_record(struct host_renderer *renderer, VkCommandBuffer cmd,
                       const struct host_debug_desc *desc)
{
    for (uint32_t eye = 0; eye < renderer->eye_count; eye++) {
        host_eye_begin(renderer, eye);
        if (!eye_record(renderer, cmd, desc))
            return false;
    }
    return true;
}
