/* SPDX-License-Identifier: MIT
 * Shadow maps of point and spot lights, and the images of all shadow maps. The scene is static, so a map is
 * drawn once and kept while its light is among the nearest; lights beyond the budget shine without shadows.
 */
#include "host_internal.h"
#include "host_math.h"

#include <stdlib.h>
#include <string.h>

enum { CUBE_FACES = 6, SPOTS_RESERVED = 16 };

static const double near_m = 0.01;

/* ---- Images ----------------------------------------------------------------------------------------- */

static bool map_create(struct host_renderer *renderer, uint32_t size, uint32_t layers, struct host_image *map,
                       VkImageView *views, VkFramebuffer *targets)
{
    struct host_device *device = renderer->device;
    const struct host_image_desc desc = { .format = VK_FORMAT_D32_SFLOAT,
                                          .width = layers > 0 ? size : 1,
                                          .height = layers > 0 ? size : 1,
                                          .layers = layers,
                                          .array_view = true,
                                          .usage = VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT |
                                                   VK_IMAGE_USAGE_SAMPLED_BIT };
    if (!host_image_create(device, &desc, map))
        return false;
    for (uint32_t i = 0; i < layers; i++) {
        const VkImageViewCreateInfo view = {
            .sType = VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO,
            .image = map->image,
            .viewType = VK_IMAGE_VIEW_TYPE_2D,
            .format = map->format,
            .subresourceRange = { VK_IMAGE_ASPECT_DEPTH_BIT, 0, 1, i, 1 },
        };
        const VkFramebufferCreateInfo target = {
            .sType = VK_STRUCTURE_TYPE_FRAMEBUFFER_CREATE_INFO,
            .renderPass = renderer->passes.shadow,
            .attachmentCount = 1,
            .pAttachments = &views[i],
            .width = size,
            .height = size,
            .layers = 1,
        };
        if (!host_check(device, vkCreateImageView(device->device, &view, NULL, &views[i]),
                        "creating a view") ||
            !host_check(device, vkCreateFramebuffer(device->device, &target, NULL, &targets[i]),
                        "creating a framebuffer"))
            return false;
    }
    return true;
}

/* Layers that are never drawn are still part of the array that shaders see: give all of them a layout. */
static void map_prepare(VkCommandBuffer cmd, const struct host_image *map)
{
    const VkImageMemoryBarrier barrier = {
        .sType = VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER,
        .dstAccessMask = VK_ACCESS_SHADER_READ_BIT,
        .oldLayout = VK_IMAGE_LAYOUT_UNDEFINED,
        .newLayout = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL,
        .srcQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
        .dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
        .image = map->image,
        .subresourceRange = { VK_IMAGE_ASPECT_DEPTH_BIT, 0, 1, 0, map->layers },
    };
    vkCmdPipelineBarrier(cmd, VK_PIPELINE_STAGE_TOP_OF_PIPE_BIT, VK_PIPELINE_STAGE_FRAGMENT_SHADER_BIT, 0, 0,
                         NULL, 0, NULL, 1, &barrier);
}

static bool maps_prepare(struct host_renderer *renderer)
{
    VkCommandBuffer cmd = host_commands_begin(renderer->device);
    if (!cmd)
        return false;
    map_prepare(cmd, &renderer->shadows.sun_map);
    map_prepare(cmd, &renderer->shadows.punctual_map);
    return host_commands_finish(renderer->device, cmd);
}

static bool sampler_create(struct host_renderer *renderer)
{
    const VkSamplerCreateInfo info = { .sType = VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO,
                                       .addressModeU = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE,
                                       .addressModeV = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE,
                                       .addressModeW = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE };
    return host_check(renderer->device,
                      vkCreateSampler(renderer->device->device, &info, NULL, &renderer->shadows.sampler),
                      "creating a sampler");
}

/* ---- Budget ----------------------------------------------------------------------------------------- */

/* Runs of layers: first those of cubes, six each, then those of single maps. */
static void budget_split(const struct host_scene *scene, uint32_t *cubes, uint32_t *singles)
{
    uint32_t cube_count = 0;
    for (uint32_t i = 0; i < scene->light_count; i++)
        cube_count += scene->lights[i].cube;
    const uint32_t single_count = scene->light_count - cube_count;
    const uint32_t reserved = single_count < SPOTS_RESERVED ? single_count : SPOTS_RESERVED;
    const uint32_t cube_limit = (HOST_MAX_LAYERS - reserved) / CUBE_FACES;
    *cubes = cube_count < cube_limit ? cube_count : cube_limit;
    const uint32_t single_limit = HOST_MAX_LAYERS - CUBE_FACES * *cubes;
    *singles = single_count < single_limit ? single_count : single_limit;
}

/* At most 192 MiB: few lights get finer maps. */
static uint32_t map_size(uint32_t layers)
{
    return layers <= 12 ? 2048 : layers <= 48 ? 1024 : 512;
}

bool host_shadows_init(struct host_renderer *renderer)
{
    struct host_shadows *s = &renderer->shadows;
    const struct host_scene *scene = renderer->scene;
    budget_split(scene, &s->cube_runs, &s->single_runs);
    s->layer_count = CUBE_FACES * s->cube_runs + s->single_runs;
    s->light_layer = host_device_alloc(renderer->device, scene->light_count, sizeof(*s->light_layer));
    s->wanted = host_device_alloc(renderer->device, scene->light_count, sizeof(*s->wanted));
    for (int i = 0; i < HOST_MAX_LAYERS; i++)
        s->run_light[i] = -1;
    for (uint32_t i = 0; i < scene->light_count && s->light_layer; i++)
        s->light_layer[i] = -1;
    return s->light_layer && s->wanted && sampler_create(renderer) &&
           map_create(renderer, HOST_SUN_MAP_SIZE, HOST_CASCADES * scene->sun_count, &s->sun_map,
                      s->sun_views, s->sun_targets) &&
           map_create(renderer, map_size(s->layer_count), s->layer_count, &s->punctual_map, s->punctual_views,
                      s->punctual_targets) &&
           maps_prepare(renderer);
}

void host_shadows_finish(struct host_renderer *renderer)
{
    struct host_shadows *s = &renderer->shadows;
    VkDevice device = renderer->device->device;
    for (int i = 0; i < HOST_SUN_LAYERS; i++) {
        vkDestroyFramebuffer(device, s->sun_targets[i], NULL);
        vkDestroyImageView(device, s->sun_views[i], NULL);
    }
    for (int i = 0; i < HOST_MAX_LAYERS; i++) {
        vkDestroyFramebuffer(device, s->punctual_targets[i], NULL);
        vkDestroyImageView(device, s->punctual_views[i], NULL);
    }
    vkDestroySampler(device, s->sampler, NULL);
    host_image_destroy(renderer->device, &s->sun_map);
    host_image_destroy(renderer->device, &s->punctual_map);
    free(s->light_layer);
    free(s->wanted);
}

/* ---- Faces ------------------------------------------------------------------------------------------ */

/* Axes of a face, and the tangent of half its angle, a little wider than needed so that the filter stays
 * inside. */
static double face_axes(const struct host_scene_light *light, uint32_t face, uint32_t size, double right[3],
                        double up[3], double forward[3])
{
    if (light->cube) {
        for (uint32_t i = 0; i < 3; i++)
            forward[i] = i == face / 2 ? (face % 2 == 0 ? 1.0 : -1.0) : 0.0;
    } else {
        memcpy(forward, light->direction, 3 * sizeof(double));
    }
    host_frame3(forward, right, up);
    return (light->cube ? 1.0 : tan((double)light->outer_rad)) * size / (size - 6.0);
}

static void layer_fill(const struct host_scene_light *light, uint32_t face, uint32_t size,
                       struct host_layer_data *out)
{
    double right[3], up[3], forward[3];
    const double tangent = face_axes(light, face, size, right, up, forward);
    for (int i = 0; i < 3; i++) {
        out->right[i] = (float)(right[i] / tangent);
        out->up[i] = (float)(up[i] / tangent);
        out->forward[i] = (float)forward[i];
    }
    out->right[3] = (float)near_m;
    out->up[3] = (float)(2.0 * tangent / size);
    out->forward[3] = 0.0f;
}

static void face_frustum(const struct host_scene_light *light, const struct host_layer_data *layer,
                         struct host_frustum *out)
{
    *out = (struct host_frustum){ .count = 5 };
    memcpy(out->origin, light->position, sizeof(out->origin));
    for (int side = 0; side < 4; side++) {
        const float *axis = side / 2 == 0 ? layer->right : layer->up;
        const double sign = side % 2 == 0 ? 1.0 : -1.0;
        for (int i = 0; i < 3; i++)
            out->planes[side][i] = (double)layer->forward[i] + sign * (double)axis[i];
        host_normalize3(out->planes[side]);
    }
    for (int i = 0; i < 3; i++)
        out->planes[4][i] = (double)layer->forward[i];
}

static void face_draw(struct host_renderer *renderer, VkCommandBuffer cmd,
                      const struct host_scene_light *light, uint32_t layer)
{
    const struct host_layer_data *axes = &renderer->shadows.layers[layer];
    const uint32_t size = renderer->shadows.punctual_map.width;
    const VkClearValue clear = { .depthStencil = { 0.0f, 0 } };
    const VkRenderPassBeginInfo begin = {
        .sType = VK_STRUCTURE_TYPE_RENDER_PASS_BEGIN_INFO,
        .renderPass = renderer->passes.shadow,
        .framebuffer = renderer->shadows.punctual_targets[layer],
        .renderArea = { { 0, 0 }, { size, size } },
        .clearValueCount = 1,
        .pClearValues = &clear,
    };
    float clip[4][4] = { { 0 } };
    memcpy(clip[0], axes->right, 3 * sizeof(float));
    memcpy(clip[1], axes->up, 3 * sizeof(float));
    memcpy(clip[3], axes->forward, 3 * sizeof(float));
    clip[2][3] = (float)near_m;
    struct host_frustum frustum;
    face_frustum(light, axes, &frustum);
    vkCmdBeginRenderPass(cmd, &begin, VK_SUBPASS_CONTENTS_INLINE);
    host_viewport_set(cmd, 0, size, size);
    host_draw_shadow(renderer, cmd, &frustum, light->position, &clip[0][0]);
    vkCmdEndRenderPass(cmd);
}

/* ---- Choice ----------------------------------------------------------------------------------------- */

static double distance_squared(const struct host_renderer *renderer, uint32_t light)
{
    double d[3];
    for (int i = 0; i < 3; i++)
        d[i] = renderer->scene->lights[light].position[i] - renderer->camera.position[i];
    return host_dot3(d, d);
}

/* Marks the `count` nearest lights of one kind. */
static void choose_nearest(struct host_renderer *renderer, bool cube, uint32_t count)
{
    const struct host_scene *scene = renderer->scene;
    bool *wanted = renderer->shadows.wanted;
    for (uint32_t n = 0; n < count; n++) {
        int64_t best = -1;
        double best_distance = INFINITY;
        for (uint32_t i = 0; i < scene->light_count; i++) {
            if (scene->lights[i].cube != cube || wanted[i] || distance_squared(renderer, i) >= best_distance)
                continue;
            best = i;
            best_distance = distance_squared(renderer, i);
        }
        if (best >= 0)
            wanted[best] = true;
    }
}

static uint32_t run_first_layer(const struct host_shadows *s, uint32_t run)
{
    return run < s->cube_runs ? CUBE_FACES * run : CUBE_FACES * s->cube_runs + (run - s->cube_runs);
}

static void run_fill(struct host_renderer *renderer, VkCommandBuffer cmd, uint32_t run, uint32_t light)
{
    struct host_shadows *s = &renderer->shadows;
    const struct host_scene_light *l = &renderer->scene->lights[light];
    const uint32_t first = run_first_layer(s, run), faces = l->cube ? CUBE_FACES : 1;
    s->run_light[run] = (int32_t)light;
    s->light_layer[light] = (int32_t)first;
    for (uint32_t face = 0; face < faces; face++) {
        layer_fill(l, face, s->punctual_map.width, &s->layers[first + face]);
        face_draw(renderer, cmd, l, first + face);
    }
}

/* Frees the maps of lights that are wanted no more, then gives free ones to those that have none. */
static void runs_assign(struct host_renderer *renderer, VkCommandBuffer cmd)
{
    struct host_shadows *s = &renderer->shadows;
    const uint32_t runs = s->cube_runs + s->single_runs;
    for (uint32_t run = 0; run < runs; run++) {
        const int32_t light = s->run_light[run];
        if (light < 0 || s->wanted[light])
            continue;
        s->light_layer[light] = -1;
        s->run_light[run] = -1;
    }
    for (uint32_t i = 0; i < renderer->scene->light_count; i++) {
        if (!s->wanted[i] || s->light_layer[i] >= 0)
            continue;
        const bool cube = renderer->scene->lights[i].cube;
        uint32_t run = cube ? 0 : s->cube_runs;
        const uint32_t end = cube ? s->cube_runs : runs;
        while (run < end && s->run_light[run] >= 0)
            run++;
        if (run < end)
            run_fill(renderer, cmd, run, i);
    }
}

void host_shadows_record(struct host_renderer *renderer, VkCommandBuffer cmd)
{
    struct host_shadows *s = &renderer->shadows;
    memset(s->wanted, 0, renderer->scene->light_count * sizeof(*s->wanted));
    choose_nearest(renderer, true, s->cube_runs);
    choose_nearest(renderer, false, s->single_runs);
    runs_assign(renderer, cmd);
    host_sun_record(renderer, cmd);
}
