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

/* The last frame's shaders have read the image; what they read may go. The forward pass reads it even where
 * no gather writes it: shaders that show a part of the light alone leave out what they read. */
static void image_prepare(VkCommandBuffer cmd, const struct host_image *image)
{
    static const VkImageLayout layouts[] = { VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_GENERAL };
    static const VkPipelineStageFlags stages[] = { VK_PIPELINE_STAGE_FRAGMENT_SHADER_BIT,
                                                   VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT |
                                                       VK_PIPELINE_STAGE_FRAGMENT_SHADER_BIT };
    static const VkAccessFlags accesses[] = { VK_ACCESS_SHADER_READ_BIT,
                                              VK_ACCESS_SHADER_WRITE_BIT | VK_ACCESS_SHADER_READ_BIT };
    host_image_barrier(cmd, image->image, 0, 1, layouts, stages, accesses);
}

/* Columns. A clip position (x, y, z, 1) becomes (z camera + near (x right tan_x - y up tan_y + forward), z).
 */
static void fill_inverse(const struct host_camera_frame *camera, float m[static 16])
{
    for (int i = 0; i < 3; i++) {
        m[i] = (float)(camera->near_m * camera->tan_x * camera->right[i]);
        m[4 + i] = (float)(-camera->near_m * camera->tan_y * camera->up[i]);
        m[8 + i] = (float)(camera->position[i] - camera->origin[i]);
        m[12 + i] = (float)(camera->near_m * camera->forward[i]);
    }
    m[11] = 1.0f;
}

static bool is_shown(enum host_aov aov)
{
    return aov == HOST_AOV_COLOR || aov == HOST_AOV_DIFFUSE_INDIRECT || aov == HOST_AOV_IRRADIANCE;
}

bool host_lookup_record(struct host_renderer *renderer, VkCommandBuffer cmd)
{
    static const enum sdfgi_gather_resolution resolutions[HOST_LOOKUP_COUNT] = {
        [HOST_LOOKUP_FULL] = SDFGI_GATHER_FULL,
        [HOST_LOOKUP_HALF] = SDFGI_GATHER_HALF,
        [HOST_LOOKUP_QUARTER] = SDFGI_GATHER_QUARTER,
    };
    const struct host_targets *targets = &renderer->targets;
    if (host_forward_kind(renderer, false) != HOST_FORWARD_GATHERED)
        return true;
    image_prepare(cmd, &targets->irradiance);
    if (!is_shown(renderer->shown))
        return true;
    struct sdfgi_gather_desc desc = { .depth = targets->depth.view,
                                      .normal = targets->normal.view,
                                      .output = targets->irradiance.view,
                                      .width = targets->irradiance.width,
                                      .height = targets->irradiance.height,
                                      .resolution = resolutions[renderer->lookup] };
    fill_inverse(&renderer->camera, desc.inverse_view_projection);
    return host_gi_gather(renderer->gi, cmd, &desc);
}
