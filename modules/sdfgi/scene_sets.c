/* SPDX-License-Identifier: MIT */
#include "scene_sets.h"

#include <string.h>

enum { SETS_PER_POOL = 128 };

static VkResult add_pool(struct sdfgi *gi)
{
    struct set_pool *pool = host_alloc(&gi->allocator, sizeof *pool);
    if (!pool)
        return VK_ERROR_OUT_OF_HOST_MEMORY;
    const VkDescriptorPoolSize sizes[] = {
        { VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 4 * SETS_PER_POOL },
        { VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, 2 * SETS_PER_POOL },
    };
    const VkResult result =
        gi->device.fn.CreateDescriptorPool(gi->device.handle,
                                           &(VkDescriptorPoolCreateInfo){
                                               .sType = VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO,
                                               .flags = VK_DESCRIPTOR_POOL_CREATE_FREE_DESCRIPTOR_SET_BIT,
                                               .maxSets = SETS_PER_POOL,
                                               .poolSizeCount = 2,
                                               .pPoolSizes = sizes,
                                           },
                                           gi->device.callbacks, &pool->handle);
    if (result != VK_SUCCESS) {
        host_free(&gi->allocator, pool);
        return result;
    }
    pool->free = SETS_PER_POOL;
    pool->next = gi->scene.set_pools;
    gi->scene.set_pools = pool;
    return VK_SUCCESS;
}

static struct set_pool *pool_with_room(struct sdfgi *gi)
{
    for (struct set_pool *pool = gi->scene.set_pools; pool; pool = pool->next)
        if (pool->free > 0)
            return pool;
    return NULL;
}

static VkResult allocate(struct sdfgi *gi, VkDescriptorSetLayout layout, VkDescriptorSet *set,
                         VkDescriptorPool *handle)
{
    if (!pool_with_room(gi)) {
        const VkResult result = add_pool(gi);
        if (result != VK_SUCCESS)
            return result;
    }
    struct set_pool *pool = pool_with_room(gi);
    const VkResult result =
        gi->device.fn.AllocateDescriptorSets(gi->device.handle,
                                             &(VkDescriptorSetAllocateInfo){
                                                 .sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO,
                                                 .descriptorPool = pool->handle,
                                                 .descriptorSetCount = 1,
                                                 .pSetLayouts = &layout,
                                             },
                                             set);
    if (result != VK_SUCCESS)
        return result;
    pool->free--;
    *handle = pool->handle;
    return VK_SUCCESS;
}

VkResult scene_sets_mesh(struct sdfgi *gi, struct mesh *mesh)
{
    const VkResult result = allocate(gi, gi->pipelines.mesh_layout, &mesh->set, &mesh->pool);
    if (result != VK_SUCCESS)
        return result;
    /* Shaders do not read what the mesh lacks, but every binding needs a buffer. */
    const VkBuffer positions = mesh->desc.position_buffer;
    const VkBuffer buffers[4] = {
        [SDFGI_BINDING_MESH_POSITIONS] = positions,
        [SDFGI_BINDING_MESH_UVS] = mesh->desc.uv_buffer ? mesh->desc.uv_buffer : positions,
        [SDFGI_BINDING_MESH_COLORS] = mesh->desc.color_buffer ? mesh->desc.color_buffer : positions,
        [SDFGI_BINDING_MESH_INDICES] = mesh->desc.index_buffer ? mesh->desc.index_buffer : positions,
    };
    VkDescriptorBufferInfo infos[4];
    VkWriteDescriptorSet writes[4];
    for (uint32_t i = 0; i < 4; i++) {
        infos[i] = (VkDescriptorBufferInfo){ buffers[i], 0, VK_WHOLE_SIZE };
        writes[i] = (VkWriteDescriptorSet){ .sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET,
                                            .dstSet = mesh->set,
                                            .dstBinding = i,
                                            .descriptorCount = 1,
                                            .descriptorType = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER,
                                            .pBufferInfo = &infos[i] };
    }
    gi->device.fn.UpdateDescriptorSets(gi->device.handle, 4, writes, 0, NULL);
    return VK_SUCCESS;
}

static VkDescriptorImageInfo image_info(const struct sdfgi_texture *texture)
{
    const VkImageLayout layout = texture->layout ? texture->layout : VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL;
    return (VkDescriptorImageInfo){ texture->sampler, texture->view, layout };
}

VkResult scene_sets_material(struct sdfgi *gi, struct material *material)
{
    const struct sdfgi_texture *albedo = &material->desc.albedo_texture,
                               *emission = &material->desc.emission_texture;
    if (!albedo->view && !emission->view)
        return VK_SUCCESS;
    VkResult result = pipelines_make_textured(gi);
    if (result == VK_SUCCESS)
        result = allocate(gi, gi->pipelines.material_layout, &material->set, &material->pool);
    if (result != VK_SUCCESS)
        return result;
    /* Where only one texture exists it stands in for the other, which shaders then do not read. */
    const VkDescriptorImageInfo infos[2] = {
        image_info(albedo->view ? albedo : emission),
        image_info(emission->view ? emission : albedo),
    };
    VkWriteDescriptorSet writes[2];
    for (uint32_t i = 0; i < 2; i++)
        writes[i] = (VkWriteDescriptorSet){ .sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET,
                                            .dstSet = material->set,
                                            .dstBinding = i,
                                            .descriptorCount = 1,
                                            .descriptorType = VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER,
                                            .pImageInfo = &infos[i] };
    gi->device.fn.UpdateDescriptorSets(gi->device.handle, 2, writes, 0, NULL);
    return VK_SUCCESS;
}

static bool retired_reserve(struct sdfgi *gi)
{
    struct scene *scene = &gi->scene;
    if (scene->retired_count < scene->retired_capacity)
        return true;
    const uint32_t capacity = scene->retired_capacity ? 2 * scene->retired_capacity : 64;
    struct retired_set *bigger = host_alloc(&gi->allocator, capacity * sizeof *bigger);
    if (!bigger)
        return false;
    if (scene->retired_count > 0)
        memcpy(bigger, scene->retired, scene->retired_count * sizeof *bigger);
    host_free(&gi->allocator, scene->retired);
    scene->retired = bigger;
    scene->retired_capacity = capacity;
    return true;
}

void scene_sets_retire(struct sdfgi *gi, VkDescriptorSet set, VkDescriptorPool pool)
{
    /* Without memory to remember it, the set stays with its pool until the context is destroyed. */
    if (set && retired_reserve(gi))
        gi->scene.retired[gi->scene.retired_count++] = (struct retired_set){ set, pool, gi->frame };
}

static void free_set(struct sdfgi *gi, const struct retired_set *retired)
{
    gi->device.fn.FreeDescriptorSets(gi->device.handle, retired->pool, 1, &retired->set);
    for (struct set_pool *pool = gi->scene.set_pools; pool; pool = pool->next)
        if (pool->handle == retired->pool)
            pool->free++;
}

void scene_collect(struct sdfgi *gi)
{
    struct scene *scene = &gi->scene;
    uint32_t kept = 0;
    for (uint32_t i = 0; i < scene->retired_count; i++) {
        if (gi->frame >= scene->retired[i].frame + gi->frames_in_flight)
            free_set(gi, &scene->retired[i]);
        else
            scene->retired[kept++] = scene->retired[i];
    }
    scene->retired_count = kept;
}

void scene_sets_finish(struct sdfgi *gi)
{
    for (struct set_pool *pool = gi->scene.set_pools, *next; pool; pool = next) {
        next = pool->next;
        gi->device.fn.DestroyDescriptorPool(gi->device.handle, pool->handle, gi->device.callbacks);
        host_free(&gi->allocator, pool);
    }
    host_free(&gi->allocator, gi->scene.retired);
}
