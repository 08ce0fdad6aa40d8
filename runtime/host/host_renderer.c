/* SPDX-License-Identifier: MIT
 * The renderer's lifetime: targets, descriptor sets, slots for frames in flight. */
#include "host_internal.h"
#include "host_texture.h"

#include <stdlib.h>
#include <string.h>

static const char *const aov_names[HOST_AOV_COUNT] = {
    [HOST_AOV_COLOR] = "color",
    [HOST_AOV_DIRECT] = "direct",
    [HOST_AOV_DIFFUSE_INDIRECT] = "diffuse_indirect",
    [HOST_AOV_IRRADIANCE] = "irradiance",
    [HOST_AOV_REFLECTION] = "reflection",
    [HOST_AOV_NORMAL] = "normal",
    [HOST_AOV_DEPTH] = "depth",
    [HOST_AOV_ALBEDO] = "albedo",
    [HOST_AOV_ROUGHNESS] = "roughness",
};

const char *host_aov_name(enum host_aov aov)
{
    return aov_names[aov];
}

enum host_aov host_aov_from_name(const char *name)
{
    for (int i = 0; i < HOST_AOV_COUNT; i++) {
        if (strcmp(aov_names[i], name) == 0)
            return (enum host_aov)i;
    }
    return HOST_AOV_COUNT;
}

/* ---- Targets ---------------------------------------------------------------------------------------- */

static bool framebuffer_create(struct host_renderer *renderer, VkRenderPass pass, const VkImageView *views,
                               uint32_t count, const struct host_image *size, VkFramebuffer *out)
{
    const VkFramebufferCreateInfo info = {
        .sType = VK_STRUCTURE_TYPE_FRAMEBUFFER_CREATE_INFO,
        .renderPass = pass,
        .attachmentCount = count,
        .pAttachments = views,
        .width = size->width,
        .height = size->height,
        .layers = 1,
    };
    return host_check(renderer->device, vkCreateFramebuffer(renderer->device->device, &info, NULL, out),
                      "creating a framebuffer");
}

static bool target_image(struct host_renderer *renderer, VkFormat format, VkImageUsageFlags usage,
                         struct host_image *out)
{
    const struct host_image_desc desc = { .format = format,
                                          .width = renderer->width * renderer->supersample,
                                          .height = renderer->height * renderer->supersample,
                                          .usage = usage | VK_IMAGE_USAGE_SAMPLED_BIT };
    return host_image_create(renderer->device, &desc, out);
}

static bool target_images(struct host_renderer *r)
{
    const VkImageUsageFlags color = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT;
    struct host_targets *t = &r->targets;
    const struct host_image_desc picture = { .format = VK_FORMAT_R8G8B8A8_UNORM,
                                             .width = r->picture_width,
                                             .height = r->height,
                                             .usage = color | VK_IMAGE_USAGE_SAMPLED_BIT };
    for (uint32_t eye = 0; eye < r->eye_count; eye++) {
        if (!target_image(r, r->device->hdr_format, color, &t->eyes[eye].hdr))
            return false;
    }
    return target_image(r, VK_FORMAT_R16G16B16A16_SFLOAT, color, &t->normal) &&
           target_image(r, VK_FORMAT_D32_SFLOAT, VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT, &t->depth) &&
           host_image_create(r->device, &picture, &t->picture);
}

void host_post_set_write(struct host_renderer *renderer, VkDescriptorSet set, const struct host_image *shown)
{
    const VkDescriptorImageInfo image = { renderer->nearest, shown->view,
                                          VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL };
    const VkDescriptorBufferInfo buffer = { renderer->exposure.buffer, 0, VK_WHOLE_SIZE };
    const VkWriteDescriptorSet writes[] = {
        { .sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET,
          .dstSet = set,
          .dstBinding = 0,
          .descriptorCount = 1,
          .descriptorType = VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER,
          .pImageInfo = &image },
        { .sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET,
          .dstSet = set,
          .dstBinding = 1,
          .descriptorCount = 1,
          .descriptorType = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER,
          .pBufferInfo = &buffer },
    };
    vkUpdateDescriptorSets(renderer->device->device, HOST_COUNT(writes), writes, 0, NULL);
}

static bool roughness_view(struct host_renderer *renderer)
{
    const VkImageViewCreateInfo info = { .sType = VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO,
                                         .image = renderer->targets.normal.image,
                                         .viewType = VK_IMAGE_VIEW_TYPE_2D,
                                         .format = VK_FORMAT_R16G16B16A16_SFLOAT,
                                         .components = { .r = VK_COMPONENT_SWIZZLE_A },
                                         .subresourceRange = { VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1 } };
    return host_check(renderer->device,
                      vkCreateImageView(renderer->device->device, &info, NULL, &renderer->targets.roughness),
                      "creating an image view");
}

static bool eye_init(struct host_renderer *renderer, uint32_t index)
{
    struct host_eye *eye = &renderer->targets.eyes[index];
    const VkImageView forward[] = { eye->hdr.view, renderer->targets.depth.view };
    host_post_set_write(renderer, renderer->post_sets[index], &eye->hdr);
    return framebuffer_create(renderer, renderer->passes.forward, forward, 2, &eye->hdr, &eye->forward);
}

bool host_targets_init(struct host_renderer *renderer)
{
    struct host_targets *t = &renderer->targets;
    if (!target_images(renderer) || !roughness_view(renderer) ||
        !host_lookup_init(renderer, t->depth.width, t->depth.height))
        return false;
    const VkImageView prepass[] = { t->normal.view, t->depth.view };
    if (!framebuffer_create(renderer, renderer->passes.prepass, prepass, 2, &t->depth, &t->prepass) ||
        !framebuffer_create(renderer, renderer->passes.picture, &t->picture.view, 1, &t->picture,
                            &t->picture_framebuffer))
        return false;
    for (uint32_t eye = 0; eye < renderer->eye_count; eye++) {
        if (!eye_init(renderer, eye))
            return false;
    }
    return host_fog_targets_init(renderer);
}

static void eye_finish(struct host_renderer *renderer, struct host_eye *eye)
{
    vkDestroyFramebuffer(renderer->device->device, eye->forward, NULL);
    host_image_destroy(renderer->device, &eye->hdr);
    host_image_destroy(renderer->device, &eye->debug);
    if (eye->view)
        host_gi_view_destroy(renderer->gi, eye->view);
}

void host_targets_finish(struct host_renderer *renderer)
{
    struct host_targets *t = &renderer->targets;
    VkDevice device = renderer->device->device;
    vkDestroyFramebuffer(device, t->prepass, NULL);
    vkDestroyFramebuffer(device, t->picture_framebuffer, NULL);
    host_image_destroy(renderer->device, &t->normal);
    host_image_destroy(renderer->device, &t->depth);
    host_image_destroy(renderer->device, &t->picture);
    vkDestroyImageView(device, t->roughness, NULL);
    for (int eye = 0; eye < HOST_EYES; eye++)
        eye_finish(renderer, &t->eyes[eye]);
    host_fog_targets_finish(renderer);
    *t = (struct host_targets){ 0 };
    renderer->has_frame = false;
}

/* ---- Slots and sets --------------------------------------------------------------------------------- */

static bool pool_create(struct host_renderer *renderer)
{
    const VkDescriptorPoolSize sizes[] = {
        { VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER, HOST_SLOTS * HOST_EYES },
        { VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, (2 * HOST_SLOTS + 2) * HOST_EYES },
        { VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, (5 * HOST_SLOTS + 2) * HOST_EYES + 2 },
    };
    const VkDescriptorPoolCreateInfo info = { .sType = VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO,
                                              .maxSets = (2 * HOST_SLOTS + 2) * HOST_EYES + 1,
                                              .poolSizeCount = HOST_COUNT(sizes),
                                              .pPoolSizes = sizes };
    return host_check(renderer->device,
                      vkCreateDescriptorPool(renderer->device->device, &info, NULL, &renderer->pool),
                      "creating a descriptor pool");
}

static bool set_allocate(struct host_renderer *renderer, VkDescriptorSetLayout layout, VkDescriptorSet *out)
{
    const VkDescriptorSetAllocateInfo info = { .sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO,
                                               .descriptorPool = renderer->pool,
                                               .descriptorSetCount = 1,
                                               .pSetLayouts = &layout };
    return host_check(renderer->device, vkAllocateDescriptorSets(renderer->device->device, &info, out),
                      "allocating a descriptor set");
}

static void frame_set_write(struct host_renderer *renderer, const struct host_slot *slot,
                            const struct host_slot_eye *eye)
{
    const VkDescriptorBufferInfo buffers[] = { { eye->frame.buffer, 0, VK_WHOLE_SIZE },
                                               { slot->lights.buffer, 0, VK_WHOLE_SIZE },
                                               { slot->layers.buffer, 0, VK_WHOLE_SIZE } };
    const VkDescriptorImageInfo images[] = {
        { renderer->shadows.sampler, renderer->shadows.sun_map.view,
          VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL },
        { renderer->shadows.sampler, renderer->shadows.punctual_map.view,
          VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL },
    };
    const VkWriteDescriptorSet writes[] = {
        { .sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET,
          .dstSet = eye->set,
          .dstBinding = 0,
          .descriptorCount = 1,
          .descriptorType = VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER,
          .pBufferInfo = &buffers[0] },
        { .sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET,
          .dstSet = eye->set,
          .dstBinding = 1,
          .descriptorCount = 2,
          .descriptorType = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER,
          .pBufferInfo = &buffers[1] },
        { .sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET,
          .dstSet = eye->set,
          .dstBinding = 3,
          .descriptorCount = 2,
          .descriptorType = VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER,
          .pImageInfo = images },
    };
    vkUpdateDescriptorSets(renderer->device->device, HOST_COUNT(writes), writes, 0, NULL);
}

static bool slot_eye_init(struct host_renderer *renderer, const struct host_slot *slot,
                          struct host_slot_eye *eye)
{
    if (!host_buffer_create(renderer->device, sizeof(struct host_frame_data),
                            VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT, true, &eye->frame) ||
        !set_allocate(renderer, renderer->pipelines.frame_layout, &eye->set) ||
        (renderer->lookups.diffuse != HOST_LOOKUP_FORWARD &&
         !set_allocate(renderer, renderer->pipelines.light_layout, &eye->light_set)))
        return false;
    frame_set_write(renderer, slot, eye);
    return true;
}

static bool slot_init(struct host_renderer *renderer, struct host_slot *slot)
{
    struct host_device *device = renderer->device;
    const VkFenceCreateInfo fence = { .sType = VK_STRUCTURE_TYPE_FENCE_CREATE_INFO };
    const VkCommandBufferAllocateInfo commands = {
        .sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO,
        .commandPool = device->pool,
        .level = VK_COMMAND_BUFFER_LEVEL_PRIMARY,
        .commandBufferCount = 1,
    };
    const VkDeviceSize light_bytes = sizeof(struct host_light_data) * renderer->scene->light_count;
    const VkDeviceSize layer_bytes = sizeof(struct host_layer_data) * renderer->shadows.layer_count;
    if (!host_check(device, vkCreateFence(device->device, &fence, NULL, &slot->fence), "creating a fence") ||
        !host_check(device, vkAllocateCommandBuffers(device->device, &commands, &slot->cmd),
                    "allocating a command buffer") ||
        !host_buffer_create(device, light_bytes, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, true, &slot->lights) ||
        !host_buffer_create(device, layer_bytes, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, true, &slot->layers))
        return false;
    for (uint32_t eye = 0; eye < renderer->eye_count; eye++) {
        if (!slot_eye_init(renderer, slot, &slot->eyes[eye]))
            return false;
    }
    return true;
}

static void slot_finish(struct host_renderer *renderer, struct host_slot *slot)
{
    struct host_device *device = renderer->device;
    vkDestroyFence(device->device, slot->fence, NULL);
    if (slot->cmd)
        vkFreeCommandBuffers(device->device, device->pool, 1, &slot->cmd);
    for (int eye = 0; eye < HOST_EYES; eye++)
        host_buffer_destroy(device, &slot->eyes[eye].frame);
    host_buffer_destroy(device, &slot->lights);
    host_buffer_destroy(device, &slot->layers);
}

static bool queries_create(struct host_renderer *renderer)
{
    const VkQueryPoolCreateInfo info = { .sType = VK_STRUCTURE_TYPE_QUERY_POOL_CREATE_INFO,
                                         .queryType = VK_QUERY_TYPE_TIMESTAMP,
                                         .queryCount = HOST_STAMP_COUNT * HOST_SLOTS };
    return renderer->device->timestamp_mask == 0 ||
           host_check(renderer->device,
                      vkCreateQueryPool(renderer->device->device, &info, NULL, &renderer->queries),
                      "creating a query pool");
}

/* Automatic until there is a picture. */
static bool exposure_init(struct host_renderer *renderer)
{
    if (!host_buffer_create(renderer->device, 16, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, true,
                            &renderer->exposure))
        return false;
    memset(renderer->exposure.mapped, 0, 16);
    return true;
}

static bool post_sets_allocate(struct host_renderer *renderer)
{
    const VkDescriptorSetLayout layout = renderer->pipelines.post_layout;
    for (uint32_t eye = 0; eye < renderer->eye_count; eye++) {
        if (!set_allocate(renderer, layout, &renderer->post_sets[eye]) ||
            !set_allocate(renderer, layout, &renderer->debug_sets[eye]))
            return false;
    }
    return true;
}

static bool post_init(struct host_renderer *renderer)
{
    const VkSamplerCreateInfo nearest = { .sType = VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO };
    return host_check(renderer->device,
                      vkCreateSampler(renderer->device->device, &nearest, NULL, &renderer->nearest),
                      "creating a sampler") &&
           exposure_init(renderer) && post_sets_allocate(renderer);
}

static bool environment_set_init(struct host_renderer *renderer)
{
    if (!renderer->scene->environment.exists)
        return true;
    if (!set_allocate(renderer, renderer->pipelines.light_layout, &renderer->environment_set))
        return false;
    host_environment_set_write(renderer->scene, renderer->environment_set);
    return true;
}

static bool scratch_init(struct host_renderer *renderer)
{
    const uint32_t count = renderer->scene->instance_count;
    renderer->blend_order = host_device_alloc(renderer->device, count, sizeof(*renderer->blend_order));
    renderer->blend_distance = host_device_alloc(renderer->device, count, sizeof(*renderer->blend_distance));
    return renderer->blend_order && renderer->blend_distance;
}

/* ---- Lifetime --------------------------------------------------------------------------------------- */

static bool desc_valid(struct host_device *device, const struct host_renderer_desc *desc,
                       uint32_t supersample)
{
    const uint32_t limit = 16384 / supersample;
    if (supersample > 4)
        return host_fail(device, "supersampling by %u: 1 to 4 is possible", supersample);
    if (desc->width < 1 || desc->height < 1 || desc->width > limit || desc->height > limit)
        return host_fail(device, "a picture of %ux%u: 1 to %u along each side is possible", desc->width,
                         desc->height, limit);
    return true;
}

static void set_size(struct host_renderer *renderer, uint32_t width, uint32_t height)
{
    renderer->picture_width = width;
    renderer->width = (width + renderer->eye_count - 1) / renderer->eye_count;
    renderer->height = height;
}

static bool renderer_init(struct host_renderer *r, const struct host_renderer_desc *desc)
{
    r->gi = host_gi_create(r->device, r->scene, desc, HOST_SLOTS);
    if (!r->gi || !host_passes_init(r->device, &r->passes) ||
        !host_pipelines_init(r->scene, &r->passes, host_gi_layout(r->gi), host_fog_exists(r->scene),
                             &r->pipelines) ||
        !host_shadows_init(r) || !pool_create(r) || !queries_create(r) || !post_init(r) ||
        !environment_set_init(r) || !scratch_init(r) || !host_fog_init(r))
        return false;
    for (int i = 0; i < HOST_SLOTS; i++) {
        if (!slot_init(r, &r->slots[i]))
            return false;
    }
    return host_targets_init(r) && host_forward_prepare(r) && host_fog_prepare(r);
}

struct host_renderer *host_renderer_create(struct host_device *device, struct host_scene *scene,
                                           const struct host_renderer_desc *desc)
{
    const uint32_t supersample = desc->supersample > 0 ? desc->supersample : 1;
    if (!desc_valid(device, desc, supersample))
        return NULL;
    struct host_renderer *renderer = host_device_alloc(device, 1, sizeof(*renderer));
    if (!renderer)
        return NULL;
    renderer->device = device;
    renderer->scene = scene;
    renderer->eye_count = desc->eye_distance_m > 0.0f ? HOST_EYES : 1;
    renderer->eye_distance_m = desc->eye_distance_m;
    set_size(renderer, desc->width, desc->height);
    renderer->supersample = supersample;
    renderer->seed = desc->seed;
    renderer->gi_exposure = desc->gi_exposure;
    renderer->lookups = desc->lookups;
    if (!renderer_init(renderer, desc)) {
        host_renderer_destroy(renderer);
        return NULL;
    }
    return renderer;
}

void host_renderer_destroy(struct host_renderer *renderer)
{
    if (!renderer)
        return;
    VkDevice device = renderer->device->device;
    vkDeviceWaitIdle(device);
    host_targets_finish(renderer);
    for (int i = 0; i < HOST_SLOTS; i++)
        slot_finish(renderer, &renderer->slots[i]);
    vkDestroyQueryPool(device, renderer->queries, NULL);
    vkDestroySampler(device, renderer->nearest, NULL);
    vkDestroyDescriptorPool(device, renderer->pool, NULL);
    host_buffer_destroy(renderer->device, &renderer->exposure);
    host_sampler_finish(renderer);
    host_fog_finish(renderer);
    host_shadows_finish(renderer);
    host_pipelines_finish(renderer->device, &renderer->pipelines);
    host_passes_finish(renderer->device, &renderer->passes);
    host_gi_destroy(renderer->gi);
    free(renderer->blend_order);
    free(renderer->blend_distance);
    free(renderer);
}

bool host_renderer_resize(struct host_renderer *renderer, uint32_t width, uint32_t height)
{
    const struct host_renderer_desc desc = { .width = width, .height = height };
    if (!desc_valid(renderer->device, &desc, renderer->supersample) || !host_slots_wait(renderer))
        return false;
    host_targets_finish(renderer);
    set_size(renderer, width, height);
    return host_targets_init(renderer);
}

bool host_renderer_set_settings(struct host_renderer *renderer, const struct sdfgi_settings *settings)
{
    return host_gi_set_settings(renderer->gi, settings);
}

void host_renderer_get_settings(const struct host_renderer *renderer, struct sdfgi_settings *settings)
{
    host_gi_get_settings(renderer->gi, settings);
}

struct host_effects host_renderer_possible_effects(const struct host_renderer *renderer)
{
    return (struct host_effects){ .reflections = renderer->lookups.diffuse != HOST_LOOKUP_FORWARD,
                                  .fog = host_fog_exists(renderer->scene) };
}

void host_renderer_leave_out(struct host_renderer *renderer, const struct host_effects *left_out)
{
    renderer->left_out = *left_out;
}

void host_renderer_get_report(const struct host_renderer *renderer, struct sdfgi_report *report)
{
    host_gi_get_report(renderer->gi, report);
}

uint64_t host_renderer_frame_gpu_ns(const struct host_renderer *renderer)
{
    return renderer->times.frame_ns;
}

void host_renderer_get_times(const struct host_renderer *renderer, struct host_times *times)
{
    *times = renderer->times;
}
