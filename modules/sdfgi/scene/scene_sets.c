/* SPDX-License-Identifier: MIT */
#include "scene_sets.h"

#include "shaders/shared/bindings.h"

#include <assert.h>
#include <string.h>

enum { SETS_PER_POOL = 128 };

static VkResult add_pool(struct scene *scene)
{
    struct set_pool *pool = sdfgi_hooks_alloc_zeroed(&scene->backend->hooks, sizeof *pool);
    if (!pool)
        return VK_ERROR_OUT_OF_HOST_MEMORY;
    const VkDescriptorPoolSize sizes[] = {
        { VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 4 * SETS_PER_POOL },
        { VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, 2 * SETS_PER_POOL },
    };
    const VkResult result =
        sdfgi_backend_pool_create(scene->backend, "sdfgi scene", SETS_PER_POOL, sizes, 2,
                                  VK_DESCRIPTOR_POOL_CREATE_FREE_DESCRIPTOR_SET_BIT, &pool->handle);
    if (result != VK_SUCCESS) {
        sdfgi_hooks_free(&scene->backend->hooks, pool);
        return result;
    }
    pool->free = SETS_PER_POOL;
    pool->next = scene->set_pools;
    scene->set_pools = pool;
    return VK_SUCCESS;
}

static struct set_pool *pool_with_room(const struct scene *scene)
{
    for (struct set_pool *pool = scene->set_pools; pool; pool = pool->next)
        if (pool->free > 0)
            return pool;
    return NULL;
}

static VkResult allocate(struct scene *scene, const char *name, VkDescriptorSetLayout layout,
                         struct object_set *set)
{
    if (!pool_with_room(scene)) {
        const VkResult result = add_pool(scene);
        if (result != VK_SUCCESS)
            return result;
    }
    set->pool = pool_with_room(scene);
    const VkResult result =
        sdfgi_backend_set_allocate(scene->backend, name, set->pool->handle, layout, &set->set);
    if (result == VK_SUCCESS)
        set->pool->free--;
    return result;
}

static VkResult create(struct scene *scene, const char *name, VkDescriptorSetLayout layout,
                       struct object_set **out)
{
    struct object_set *set = sdfgi_hooks_alloc_zeroed(&scene->backend->hooks, sizeof *set);
    if (!set)
        return VK_ERROR_OUT_OF_HOST_MEMORY;
    const VkResult result = allocate(scene, name, layout, set);
    if (result != VK_SUCCESS) {
        sdfgi_hooks_free(&scene->backend->hooks, set);
        return result;
    }
    *out = set;
    return VK_SUCCESS;
}

VkResult sdfgi_scene_sets_mesh(struct scene *scene, struct mesh *mesh)
{
    const struct gpu_device *device = &scene->backend->device;
    const VkResult result = create(scene, "sdfgi mesh", scene->backend->pipelines.mesh, &mesh->set);
    if (result != VK_SUCCESS)
        return result;
    /* Shaders do not read what the mesh lacks, but every binding needs a buffer. */
    VkDescriptorBufferInfo infos[MESH_STREAMS];
    VkWriteDescriptorSet writes[MESH_STREAMS];
    for (uint32_t i = 0; i < MESH_STREAMS; i++) {
        const struct mesh_stream *stream =
            &mesh->streams[mesh->streams[i].buffer ? i : SDFGI_BINDING_MESH_POSITIONS];
        infos[i] = (VkDescriptorBufferInfo){ stream->buffer, sdfgi_mesh_stream_bound_offset(stream),
                                             sdfgi_mesh_stream_bound_size(stream) };
        writes[i] = (VkWriteDescriptorSet){ .sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET,
                                            .dstSet = mesh->set->set,
                                            .dstBinding = i,
                                            .descriptorCount = 1,
                                            .descriptorType = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER,
                                            .pBufferInfo = &infos[i] };
    }
    device->fn.UpdateDescriptorSets(device->handle, MESH_STREAMS, writes, 0, NULL);
    return VK_SUCCESS;
}

/* ---- Textures */

/* Shaders choose the level. Filters along the slope of a surface, which hosts' samplers may have, would add
 * nothing to it, and a software driver takes a thousand times as long with them. */
static VkResult require_sampler(struct scene *scene, const struct sdfgi_texture *texture)
{
    const struct gpu_device *device = &scene->backend->device;
    VkSampler *sampler = &scene->samplers[texture->address_u][texture->address_v];
    if (*sampler || !texture->view)
        return VK_SUCCESS;
    const VkResult result =
        device->fn.CreateSampler(device->handle,
                                 &(VkSamplerCreateInfo){ .sType = VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO,
                                                         .magFilter = VK_FILTER_LINEAR,
                                                         .minFilter = VK_FILTER_LINEAR,
                                                         .mipmapMode = VK_SAMPLER_MIPMAP_MODE_LINEAR,
                                                         .addressModeU = texture->address_u,
                                                         .addressModeV = texture->address_v,
                                                         .maxLod = VK_LOD_CLAMP_NONE },
                                 device->callbacks, sampler);
    return gpu_named(device, result, VK_OBJECT_TYPE_SAMPLER, sampler, "sdfgi texture");
}

static void destroy_samplers(struct scene *scene)
{
    const struct gpu_device *device = &scene->backend->device;
    for (int u = 0; u < ADDRESS_MODES; u++)
        for (int v = 0; v < ADDRESS_MODES; v++)
            if (scene->samplers[u][v])
                device->fn.DestroySampler(device->handle, scene->samplers[u][v], device->callbacks);
    memset(scene->samplers, 0, sizeof scene->samplers);
}

static VkDescriptorImageInfo image_info(const struct scene *scene, const struct sdfgi_texture *texture)
{
    const VkImageLayout layout = texture->layout ? texture->layout : VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL;
    return (VkDescriptorImageInfo){ scene->samplers[texture->address_u][texture->address_v], texture->view,
                                    layout };
}

static void write_textures(const struct scene *scene, const struct material *material)
{
    const struct gpu_device *device = &scene->backend->device;
    const struct sdfgi_texture *albedo = &material->desc.albedo_texture,
                               *emission = &material->desc.emission_texture;
    /* Where only one texture exists it stands in for the other, which shaders then do not read. */
    const VkDescriptorImageInfo infos[2] = {
        image_info(scene, albedo->view ? albedo : emission),
        image_info(scene, emission->view ? emission : albedo),
    };
    VkWriteDescriptorSet writes[2];
    for (uint32_t i = 0; i < 2; i++)
        writes[i] = (VkWriteDescriptorSet){ .sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET,
                                            .dstSet = material->set->set,
                                            .dstBinding = i,
                                            .descriptorCount = 1,
                                            .descriptorType = VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER,
                                            .pImageInfo = &infos[i] };
    device->fn.UpdateDescriptorSets(device->handle, 2, writes, 0, NULL);
}

VkResult sdfgi_scene_sets_material(struct scene *scene, struct material *material)
{
    if (!material->desc.albedo_texture.view && !material->desc.emission_texture.view)
        return VK_SUCCESS;
    VkResult result = sdfgi_pipelines_require(scene->backend, PASS_VOXELIZE, 1);
    if (result == VK_SUCCESS)
        result = require_sampler(scene, &material->desc.albedo_texture);
    if (result == VK_SUCCESS)
        result = require_sampler(scene, &material->desc.emission_texture);
    if (result == VK_SUCCESS)
        result = create(scene, "sdfgi material", scene->backend->pipelines.material, &material->set);
    if (result != VK_SUCCESS)
        return result;
    write_textures(scene, material);
    return VK_SUCCESS;
}

static void destroy(struct gpu_retired *item, void *user)
{
    struct scene *scene = user;
    struct object_set *set = (struct object_set *)item;
    const struct gpu_device *device = &scene->backend->device;
    device->fn.FreeDescriptorSets(device->handle, set->pool->handle, 1, &set->set);
    set->pool->free++;
    assert(set->pool->free <= SETS_PER_POOL);
    sdfgi_hooks_free(&scene->backend->hooks, set);
}

_Static_assert(offsetof(struct object_set, retired) == 0, "destroy() finds the set by its first member");

void sdfgi_scene_sets_retire(struct scene *scene, struct object_set *set)
{
    if (set)
        gpu_retire(&scene->backend->retired, &set->retired, destroy, scene);
}

void sdfgi_scene_sets_finish(struct scene *scene)
{
    const struct gpu_device *device = &scene->backend->device;
    for (struct set_pool *pool = scene->set_pools, *next; pool; pool = next) {
        next = pool->next;
        device->fn.DestroyDescriptorPool(device->handle, pool->handle, device->callbacks);
        sdfgi_hooks_free(&scene->backend->hooks, pool);
    }
    scene->set_pools = NULL;
    destroy_samplers(scene);
}
