/* SPDX-License-Identifier: MIT
 * Buffers, timers and descriptor sets of a context that is switched on. */
#include "internal.h"

#include <string.h>

#define BUFFER_USAGE                                                                                         \
    (VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT |                               \
     VK_BUFFER_USAGE_TRANSFER_DST_BIT | VK_BUFFER_USAGE_TRANSFER_SRC_BIT |                                   \
     VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT)

static VkResult create_buffer(struct sdfgi *gi, struct resources *r, enum resource resource,
                              const struct extent *extent)
{
    return gpu_buffer_init(&gi->device, &r->buffers[resource], resource_size(resource, extent), BUFFER_USAGE,
                           GPU_DEVICE_LOCAL, resource_name(resource));
}

static VkResult create_buffers(struct sdfgi *gi, struct resources *r)
{
    for (int i = 0; i < RESOURCE_COUNT; i++) {
        const VkResult result = create_buffer(gi, r, (enum resource)i, &r->extent);
        if (result != VK_SUCCESS)
            return result;
    }
    return gpu_buffer_init(&gi->device, &r->readback, readback_size(gi->frames_in_flight),
                           VK_BUFFER_USAGE_TRANSFER_DST_BIT, GPU_HOST_READ, "sdfgi readback");
}

static VkResult create_pool(struct sdfgi *gi, struct resources *r)
{
    const uint32_t gathers = gi->frames_in_flight * SDFGI_MAX_GATHERS;
    const VkDescriptorPoolSize sizes[] = {
        { VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, RESOURCE_COUNT - 1 },
        { VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER, 1 },
        { VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, 2 * gathers },
        { VK_DESCRIPTOR_TYPE_STORAGE_IMAGE, gathers },
    };
    return gi->device.fn.CreateDescriptorPool(gi->device.handle,
                                              &(VkDescriptorPoolCreateInfo){
                                                  .sType = VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO,
                                                  .maxSets = 1 + gathers,
                                                  .poolSizeCount = 4,
                                                  .pPoolSizes = sizes,
                                              },
                                              gi->device.callbacks, &r->pool);
}

static VkResult allocate_set(struct sdfgi *gi, VkDescriptorPool pool, VkDescriptorSetLayout layout,
                             VkDescriptorSet *set)
{
    return gi->device.fn.AllocateDescriptorSets(gi->device.handle,
                                                &(VkDescriptorSetAllocateInfo){
                                                    .sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO,
                                                    .descriptorPool = pool,
                                                    .descriptorSetCount = 1,
                                                    .pSetLayouts = &layout,
                                                },
                                                set);
}

static VkResult create_sets(struct sdfgi *gi, struct resources *r)
{
    VkResult result = create_pool(gi, r);
    if (result == VK_SUCCESS)
        result = allocate_set(gi, r->pool, gi->pipelines.set_layout, &r->set);
    for (uint32_t f = 0; f < gi->frames_in_flight; f++)
        for (uint32_t g = 0; g < SDFGI_MAX_GATHERS && result == VK_SUCCESS; g++)
            result = allocate_set(gi, r->pool, gi->pipelines.gather_layout, &r->gather_sets[f][g]);
    return result;
}

static void write_set(struct sdfgi *gi, struct resources *r)
{
    VkDescriptorBufferInfo buffers[RESOURCE_COUNT];
    VkWriteDescriptorSet writes[RESOURCE_COUNT];
    for (uint32_t i = 0; i < RESOURCE_COUNT; i++) {
        buffers[i] = (VkDescriptorBufferInfo){ r->buffers[i].handle, 0, VK_WHOLE_SIZE };
        writes[i] = (VkWriteDescriptorSet){
            .sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET,
            .dstSet = r->set,
            .dstBinding = i,
            .descriptorCount = 1,
            .descriptorType = resource_descriptor((enum resource)i),
            .pBufferInfo = &buffers[i],
        };
    }
    gi->device.fn.UpdateDescriptorSets(gi->device.handle, RESOURCE_COUNT, writes, 0, NULL);
}

static VkResult create_raster_target(struct sdfgi *gi, struct resources *r, uint32_t extent)
{
    const struct gpu_device *d = &gi->device;
    const VkSubpassDescription subpass = { .pipelineBindPoint = VK_PIPELINE_BIND_POINT_GRAPHICS };
    const VkResult result = d->fn.CreateRenderPass(d->handle,
                                                   &(VkRenderPassCreateInfo){
                                                       .sType = VK_STRUCTURE_TYPE_RENDER_PASS_CREATE_INFO,
                                                       .subpassCount = 1,
                                                       .pSubpasses = &subpass,
                                                   },
                                                   d->callbacks, &r->raster_pass);
    if (result != VK_SUCCESS)
        return result;
    return d->fn.CreateFramebuffer(d->handle,
                                   &(VkFramebufferCreateInfo){
                                       .sType = VK_STRUCTURE_TYPE_FRAMEBUFFER_CREATE_INFO,
                                       .renderPass = r->raster_pass,
                                       .width = extent,
                                       .height = extent,
                                       .layers = 1,
                                   },
                                   d->callbacks, &r->raster_target);
}

static VkResult create_raster(struct sdfgi *gi, struct resources *r, uint32_t resolution)
{
    const uint32_t extent = resolution * SDFGI_SUBVOXELS;
    VkResult result = create_raster_target(gi, r, extent);
    for (int textured = 0; textured < 2 && result == VK_SUCCESS; textured++)
        result = gpu_raster_pipeline_create(&gi->device, shader_voxelize_raster_vert(),
                                            shader_voxelize_raster_frag(textured),
                                            gi->pipelines.voxelize_layout, r->raster_pass, extent,
                                            "voxelize_raster", &r->raster_pipelines[textured]);
    return result;
}

static VkResult create_all(struct sdfgi *gi, struct resources *r, const struct sdfgi_settings *settings)
{
    VkResult result = create_buffers(gi, r);
    if (result == VK_SUCCESS)
        result = create_sets(gi, r);
    if (result == VK_SUCCESS)
        result = gpu_timer_init(&gi->device, &r->timer, gi->frames_in_flight, r->timer_tags, r->timer_counts);
    if (result == VK_SUCCESS && settings->voxelizer == SDFGI_VOXELIZER_RASTER)
        result = create_raster(gi, r, settings->resolution);
    return result;
}

enum sdfgi_result resources_create(struct sdfgi *gi, const struct sdfgi_settings *settings,
                                   struct resources **out)
{
    struct resources *r = host_alloc(&gi->allocator, sizeof *r);
    if (!r)
        return message_vulkan(gi, VK_ERROR_OUT_OF_HOST_MEMORY, "switching on");
    memset(r, 0, sizeof *r);
    r->extent = extent_from_settings(settings);
    for (int i = 0; i < RESOURCE_COUNT; i++)
        if (resource_size((enum resource)i, &r->extent) > gi->device.limits.maxStorageBufferRange) {
            host_free(&gi->allocator, r);
            return invalid(
                gi, "%s exceeds the device's maxStorageBufferRange: lower sdfgi_resolution or sdfgi_cascades",
                resource_name((enum resource)i));
        }
    const VkResult result = create_all(gi, r, settings);
    if (result != VK_SUCCESS) {
        resources_destroy(gi, r);
        return message_vulkan(gi, result, "switching on");
    }
    write_set(gi, r);
    *out = r;
    return SDFGI_OK;
}

void resources_destroy(struct sdfgi *gi, struct resources *r)
{
    const struct gpu_device *d = &gi->device;
    for (int i = 0; i < RESOURCE_COUNT; i++)
        gpu_buffer_finish(d, &r->buffers[i]);
    gpu_buffer_finish(d, &r->readback);
    gpu_timer_finish(d, &r->timer);
    d->fn.DestroyDescriptorPool(d->handle, r->pool, d->callbacks);
    for (int i = 0; i < 2; i++)
        d->fn.DestroyPipeline(d->handle, r->raster_pipelines[i], d->callbacks);
    d->fn.DestroyFramebuffer(d->handle, r->raster_target, d->callbacks);
    d->fn.DestroyRenderPass(d->handle, r->raster_pass, d->callbacks);
    host_free(&gi->allocator, r);
}

static void retire(struct sdfgi *gi, struct resources *r)
{
    r->retired_at = gi->frame;
    r->next_retired = gi->retired;
    gi->retired = r;
}

void resources_retire(struct sdfgi *gi)
{
    if (gi->resources)
        retire(gi, gi->resources);
    gi->resources = NULL;
}

/* Takes the new list and sets from `fresh`, and leaves the old list and the pool of the old sets there. */
static void exchange_light_cells(struct resources *r, struct resources *fresh)
{
    const struct gpu_buffer list = r->buffers[RESOURCE_LIGHT_CELLS];
    const VkDescriptorPool pool = r->pool;
    r->buffers[RESOURCE_LIGHT_CELLS] = fresh->buffers[RESOURCE_LIGHT_CELLS];
    r->pool = fresh->pool;
    r->set = fresh->set;
    memcpy(r->gather_sets, fresh->gather_sets, sizeof r->gather_sets);
    fresh->buffers[RESOURCE_LIGHT_CELLS] = list;
    fresh->pool = pool;
}

bool resources_grow_light_cells(struct sdfgi *gi, uint64_t light_cells)
{
    struct resources *r = gi->resources;
    struct extent extent = r->extent;
    extent.light_cells = light_cells;
    struct resources *fresh = host_alloc(&gi->allocator, sizeof *fresh);
    if (!fresh)
        return false;
    memset(fresh, 0, sizeof *fresh);
    VkResult result = create_buffer(gi, fresh, RESOURCE_LIGHT_CELLS, &extent);
    if (result == VK_SUCCESS)
        result = create_sets(gi, fresh);
    if (result != VK_SUCCESS) {
        resources_destroy(gi, fresh);
        return false;
    }
    exchange_light_cells(r, fresh);
    r->extent = extent;
    write_set(gi, r);
    retire(gi, fresh);
    return true;
}

void resources_collect(struct sdfgi *gi, bool all)
{
    struct resources **link = &gi->retired;
    while (*link) {
        struct resources *r = *link;
        if (all || gi->frame >= r->retired_at + gi->frames_in_flight) {
            *link = r->next_retired;
            resources_destroy(gi, r);
        } else {
            link = &r->next_retired;
        }
    }
}
