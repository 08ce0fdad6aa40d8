/* SPDX-License-Identifier: MIT
 * Volumetric fog: froxels that the view's fog fills, lit by sun, lamps and GI. Nothing here is made, kept or
 * run for a view without fog. */
#include "host_internal.h"
#include "host_math.h"

#include <string.h>

#include "host_fog_air_comp.h"
#include "host_fog_air_software_comp.h"
#include "host_fog_integrate_comp.h"
#include "host_fog_scatter_comp.h"
#include "host_fog_tiles_comp.h"

/* Metres to the far side of the first slice; finer ones hold too little fog to show. */
static const double first_slice_m = 0.5;
/* Slices end where scenes do, within these limits. Beyond them light is that of their end. */
static const double least_range_m = 16.0, most_range_m = 1024.0;
/* What froxels hold for the brightest thing in a scene. Half floats hold 4,000 times as much, and tell 10^-9
 * of it from nothing. */
static const float stored_brightest = 16.0f;

enum { BINDINGS = 5 };

static const VkDescriptorType binding_types[BINDINGS] = {
    VK_DESCRIPTOR_TYPE_STORAGE_IMAGE,          /* froxels */
    VK_DESCRIPTOR_TYPE_STORAGE_IMAGE,          /* air */
    VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, /* air */
    VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, /* depth */
    VK_DESCRIPTOR_TYPE_STORAGE_BUFFER,         /* what columns see */
};

bool host_fog_exists(const struct host_scene *scene)
{
    return scene->fog.density > 0.0f;
}

/* ---- Lifetime --------------------------------------------------------------------------------------- */

static float brightest_of(float brightest, const float color[3])
{
    return fmaxf(brightest, fmaxf(color[0], fmaxf(color[1], color[2])));
}

/* Of sky, lights and what glows. */
static float scene_brightest(const struct host_scene *scene)
{
    float brightest = 0.0f;
    brightest = brightest_of(brightest, scene->sky.zenith);
    brightest = brightest_of(brightest, scene->sky.horizon);
    brightest = brightest_of(brightest, scene->sky.ground);
    brightest = brightest_of(brightest, scene->environment.harmonics.coefficients[0]);
    for (uint32_t i = 0; i < scene->sun_count; i++)
        brightest = brightest_of(brightest, scene->suns[i].intensity);
    for (uint32_t i = 0; i < scene->light_count; i++)
        brightest = brightest_of(brightest, scene->lights[i].intensity);
    for (uint32_t i = 0; i < scene->material_count; i++)
        brightest = brightest_of(brightest, scene->materials[i].gi.emission);
    return brightest > 0.0f ? brightest : 1.0f;
}

static bool layouts_create(struct host_renderer *renderer)
{
    struct host_fog_passes *f = &renderer->fog;
    const VkPushConstantRange none = { 0 };
    if (!host_set_layout_create(renderer->device, binding_types, BINDINGS, VK_SHADER_STAGE_COMPUTE_BIT,
                                &f->set_layout))
        return false;
    const VkDescriptorSetLayout sets[] = { renderer->pipelines.frame_layout, f->set_layout,
                                           host_gi_layout(renderer->gi) };
    return host_pipeline_layout_create(renderer->device, sets, 2, none, &f->layout) &&
           host_pipeline_layout_create(renderer->device, sets, 3, none, &f->air_layout);
}

static bool set_create(struct host_renderer *renderer)
{
    struct host_device *device = renderer->device;
    struct host_fog_passes *f = &renderer->fog;
    VkDescriptorPoolSize sizes[BINDINGS];
    for (int i = 0; i < BINDINGS; i++)
        sizes[i] = (VkDescriptorPoolSize){ binding_types[i], 1 };
    const VkDescriptorPoolCreateInfo pool = { .sType = VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO,
                                              .maxSets = 1,
                                              .poolSizeCount = BINDINGS,
                                              .pPoolSizes = sizes };
    if (!host_check(device, vkCreateDescriptorPool(device->device, &pool, NULL, &f->pool),
                    "creating a descriptor pool"))
        return false;
    const VkDescriptorSetAllocateInfo allocate = { .sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO,
                                                   .descriptorPool = f->pool,
                                                   .descriptorSetCount = 1,
                                                   .pSetLayouts = &f->set_layout };
    return host_check(device, vkAllocateDescriptorSets(device->device, &allocate, &f->set),
                      "allocating a descriptor set");
}

static bool sampler_create(struct host_renderer *renderer)
{
    const VkSamplerCreateInfo info = { .sType = VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO,
                                       .magFilter = VK_FILTER_LINEAR,
                                       .minFilter = VK_FILTER_LINEAR,
                                       .addressModeU = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE,
                                       .addressModeV = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE,
                                       .addressModeW = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE };
    return host_check(renderer->device,
                      vkCreateSampler(renderer->device->device, &info, NULL, &renderer->fog.sampler),
                      "creating a sampler");
}

static bool pipelines_create(struct host_renderer *renderer)
{
    struct host_fog_passes *f = &renderer->fog;
    return host_pipeline_compute_create(renderer->device, HOST_CODE(host_fog_tiles_comp), f->layout,
                                        &f->tiles) &&
           host_pipeline_compute_create(renderer->device, HOST_CODE(host_fog_scatter_comp), f->layout,
                                        &f->scatter) &&
           host_pipeline_compute_create(renderer->device, HOST_CODE(host_fog_integrate_comp), f->layout,
                                        &f->integrate);
}

bool host_fog_init(struct host_renderer *renderer)
{
    const struct host_scene *scene = renderer->scene;
    struct host_fog_passes *f = &renderer->fog;
    if (!host_fog_exists(scene))
        return true;
    f->scale = stored_brightest / scene_brightest(scene);
    /* From beside a scene its far end is three times its radius away. */
    f->range_m = fmin(fmax(3.0 * scene->radius, least_range_m), most_range_m);
    return layouts_create(renderer) && set_create(renderer) && sampler_create(renderer) &&
           pipelines_create(renderer);
}

void host_fog_finish(struct host_renderer *renderer)
{
    struct host_fog_passes *f = &renderer->fog;
    VkDevice device = renderer->device->device;
    const VkPipeline pipelines[] = { f->tiles, f->air, f->scatter, f->integrate };
    for (size_t i = 0; i < HOST_COUNT(pipelines); i++)
        vkDestroyPipeline(device, pipelines[i], NULL);
    vkDestroyPipelineLayout(device, f->layout, NULL);
    vkDestroyPipelineLayout(device, f->air_layout, NULL);
    vkDestroyDescriptorPool(device, f->pool, NULL);
    vkDestroyDescriptorSetLayout(device, f->set_layout, NULL);
    vkDestroySampler(device, f->sampler, NULL);
    *f = (struct host_fog_passes){ 0 };
}

/* ---- Froxels ---------------------------------------------------------------------------------------- */

static uint32_t divide_up(uint32_t value, uint32_t divisor)
{
    return (value + divisor - 1) / divisor;
}

/* Pixels of the target along a froxel's side. */
static uint32_t tile_side(const struct host_renderer *renderer)
{
    const struct host_image *target = &renderer->targets.eyes[0].hdr;
    const uint32_t longest = target->width > target->height ? target->width : target->height;
    const uint32_t least = divide_up(longest, renderer->device->limits.maxImageDimension3D - 1);
    const uint32_t wanted = HOST_FOG_TILE * renderer->supersample;
    return wanted > least ? wanted : least;
}

static void sets_write(struct host_renderer *renderer)
{
    struct host_fog_passes *f = &renderer->fog;
    const VkDescriptorImageInfo images[] = {
        { VK_NULL_HANDLE, f->volume.view, VK_IMAGE_LAYOUT_GENERAL },
        { VK_NULL_HANDLE, f->blocks.view, VK_IMAGE_LAYOUT_GENERAL },
        { f->sampler, f->blocks.view, VK_IMAGE_LAYOUT_GENERAL },
        { renderer->nearest, renderer->targets.depth.view, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL },
    };
    const VkDescriptorBufferInfo seen = { f->seen.buffer, 0, VK_WHOLE_SIZE };
    VkWriteDescriptorSet writes[BINDINGS];
    for (uint32_t i = 0; i < BINDINGS; i++)
        writes[i] = (VkWriteDescriptorSet){ .sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET,
                                            .dstSet = f->set,
                                            .dstBinding = i,
                                            .descriptorCount = 1,
                                            .descriptorType = binding_types[i],
                                            .pImageInfo = i < HOST_COUNT(images) ? &images[i] : NULL,
                                            .pBufferInfo = &seen };
    vkUpdateDescriptorSets(renderer->device->device, BINDINGS, writes, 0, NULL);
    const VkDescriptorImageInfo froxels = { f->sampler, f->volume.view, VK_IMAGE_LAYOUT_GENERAL };
    for (uint32_t i = 0; i < HOST_SLOTS * renderer->eye_count; i++) {
        const struct host_slot *slot = &renderer->slots[i % HOST_SLOTS];
        const VkWriteDescriptorSet write = { .sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET,
                                             .dstSet = slot->eyes[i / HOST_SLOTS].set,
                                             .dstBinding = HOST_FOG_BINDING,
                                             .descriptorCount = 1,
                                             .descriptorType = VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER,
                                             .pImageInfo = &froxels };
        vkUpdateDescriptorSets(renderer->device->device, 1, &write, 0, NULL);
    }
}

/* A column for each corner of a tile, or one for several. */
static bool volume_create(struct host_renderer *renderer, uint32_t columns, uint32_t depth,
                          struct host_image *out)
{
    const struct host_image *target = &renderer->targets.eyes[0].hdr;
    const uint32_t side = renderer->fog.tile_side;
    const struct host_image_desc desc = { .format = VK_FORMAT_R16G16B16A16_SFLOAT,
                                          .width = divide_up(divide_up(target->width, side) + 1, columns),
                                          .height = divide_up(divide_up(target->height, side) + 1, columns),
                                          .depth = depth,
                                          .usage = VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_SAMPLED_BIT };
    return host_image_create(renderer->device, &desc, out);
}

bool host_fog_targets_init(struct host_renderer *renderer)
{
    struct host_fog_passes *f = &renderer->fog;
    if (!host_fog_exists(renderer->scene))
        return true;
    f->tile_side = tile_side(renderer);
    if (!volume_create(renderer, 1, HOST_FOG_SLICES + 1, &f->volume) ||
        !volume_create(renderer, HOST_FOG_AIR, HOST_FOG_SLICES / HOST_FOG_AIR, &f->blocks) ||
        !host_buffer_create(renderer->device, sizeof(float[4]) * f->volume.width * f->volume.height,
                            VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, false, &f->seen))
        return false;
    sets_write(renderer);
    return true;
}

void host_fog_targets_finish(struct host_renderer *renderer)
{
    host_image_destroy(renderer->device, &renderer->fog.volume);
    host_image_destroy(renderer->device, &renderer->fog.blocks);
    host_buffer_destroy(renderer->device, &renderer->fog.seen);
}

/* ---- Frames ----------------------------------------------------------------------------------------- */

static bool is_lit_by_gi(const struct host_renderer *renderer)
{
    return host_forward_kind(renderer, true) == HOST_FORWARD_GI;
}

bool host_fog_prepare(struct host_renderer *renderer)
{
    struct host_fog_passes *f = &renderer->fog;
    if (!host_fog_exists(renderer->scene) || !is_lit_by_gi(renderer) || f->air)
        return true;
    return host_pipeline_compute_create(renderer->device, HOST_LOOKUP_CODE(renderer->gi, host_fog_air, comp),
                                        f->air_layout, &f->air);
}

void host_fog_fill(const struct host_renderer *renderer, struct host_frame_data *out)
{
    const struct host_fog *fog = &renderer->scene->fog;
    const struct host_fog_passes *f = &renderer->fog;
    if (!host_fog_exists(renderer->scene))
        return;
    memcpy(out->fog_medium, fog->albedo, sizeof(fog->albedo));
    out->fog_medium[3] = fog->anisotropy;
    out->fog_density[0] = renderer->left_out.fog ? 0.0f : fog->density;
    out->fog_density[1] = (float)(fog->height_m - renderer->camera.origin[1]);
    out->fog_density[2] = fog->height_falloff;
    out->fog_density[3] = f->scale;
    out->fog_slices[0] = (float)first_slice_m;
    out->fog_slices[1] = (float)(log2(f->range_m / first_slice_m) / (HOST_FOG_SLICES - 1));
    out->fog_slices[2] = (float)f->range_m;
    out->fog_grid[0] = (float)renderer->targets.eyes[0].hdr.width;
    out->fog_grid[1] = (float)renderer->targets.eyes[0].hdr.height;
    out->fog_grid[2] = (float)f->tile_side;
    out->fog_grid[3] = is_lit_by_gi(renderer) ? 1.0f : 0.0f;
}

/* What the last frame left may go. */
static void images_prepare(VkCommandBuffer cmd, const struct host_fog_passes *f)
{
    static const VkImageLayout layouts[] = { VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_GENERAL };
    static const VkPipelineStageFlags stages[] = {
        VK_PIPELINE_STAGE_FRAGMENT_SHADER_BIT | VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT,
        VK_PIPELINE_STAGE_FRAGMENT_SHADER_BIT | VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT
    };
    static const VkAccessFlags accesses[] = { VK_ACCESS_SHADER_READ_BIT | VK_ACCESS_SHADER_WRITE_BIT,
                                              VK_ACCESS_SHADER_READ_BIT | VK_ACCESS_SHADER_WRITE_BIT };
    host_image_barrier(cmd, f->volume.image, 0, 1, layouts, stages, accesses);
    host_image_barrier(cmd, f->blocks.image, 0, 1, layouts, stages, accesses);
}

/* A pass over an image, of whose width and height a group takes `side`. `depth`: groups along the third axis.
 */
static void pass_record(VkCommandBuffer cmd, VkPipeline pipeline, const struct host_image *image,
                        uint32_t side, uint32_t depth)
{
    vkCmdBindPipeline(cmd, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline);
    vkCmdDispatch(cmd, divide_up(image->width, side), divide_up(image->height, side), depth);
}

/* What passes have written is there for those that follow, and for what draws. */
static void barrier_record(VkCommandBuffer cmd)
{
    static const VkMemoryBarrier after = { .sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER,
                                           .srcAccessMask = VK_ACCESS_SHADER_WRITE_BIT,
                                           .dstAccessMask =
                                               VK_ACCESS_SHADER_READ_BIT | VK_ACCESS_SHADER_WRITE_BIT };
    vkCmdPipelineBarrier(cmd, VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT,
                         VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT | VK_PIPELINE_STAGE_FRAGMENT_SHADER_BIT, 0, 1,
                         &after, 0, NULL, 0, NULL);
}

static void air_record(struct host_renderer *renderer, VkCommandBuffer cmd)
{
    const struct host_fog_passes *f = &renderer->fog;
    const VkDescriptorSet gi_set = host_gi_set(renderer->gi);
    vkCmdBindDescriptorSets(cmd, VK_PIPELINE_BIND_POINT_COMPUTE, f->air_layout, HOST_SET_GI, 1, &gi_set, 0,
                            NULL);
    pass_record(cmd, f->air, &f->blocks, HOST_FOG_THREADS,
                divide_up(HOST_FOG_SLICES / HOST_FOG_AIR, HOST_FOG_THREADS));
}

void host_fog_record(struct host_renderer *renderer, VkCommandBuffer cmd, VkDescriptorSet frame_set)
{
    const struct host_fog_passes *f = &renderer->fog;
    const VkDescriptorSet sets[] = { frame_set, f->set };
    /* Shaders that show a part of the light alone read froxels, too, and leave out what they read. */
    images_prepare(cmd, f);
    if (renderer->shown != HOST_AOV_COLOR || renderer->left_out.fog)
        return;
    const VkPipelineLayout layout = is_lit_by_gi(renderer) ? f->air_layout : f->layout;
    vkCmdBindDescriptorSets(cmd, VK_PIPELINE_BIND_POINT_COMPUTE, layout, HOST_SET_FRAME, HOST_COUNT(sets),
                            sets, 0, NULL);
    pass_record(cmd, f->tiles, &f->volume, HOST_FOG_COLUMNS, 1);
    barrier_record(cmd);
    if (is_lit_by_gi(renderer))
        air_record(renderer, cmd);
    pass_record(cmd, f->scatter, &f->volume, HOST_FOG_THREADS, HOST_FOG_SLICES / HOST_FOG_THREADS);
    barrier_record(cmd);
    pass_record(cmd, f->integrate, &f->volume, HOST_FOG_COLUMNS, 1);
    barrier_record(cmd);
}
