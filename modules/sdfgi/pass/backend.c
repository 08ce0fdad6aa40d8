/* SPDX-License-Identifier: MIT */
#include "backend.h"

uint32_t sdfgi_backend_slot(const struct backend *backend)
{
    return (uint32_t)(backend->retired.frame % backend->retired.frames_in_flight);
}

uint32_t sdfgi_backend_number(const struct backend *backend)
{
    return (uint32_t)backend->retired.frame;
}

static void hold(struct backend *backend, enum sdfgi_memory_category category, uint64_t bytes)
{
    pthread_mutex_lock(&backend->lock);
    backend->held.bytes[category] += bytes;
    backend->held.total_bytes += bytes;
    pthread_mutex_unlock(&backend->lock);
}

static void let_go(struct backend *backend, enum sdfgi_memory_category category, uint64_t bytes)
{
    pthread_mutex_lock(&backend->lock);
    backend->held.bytes[category] -= bytes;
    backend->held.total_bytes -= bytes;
    pthread_mutex_unlock(&backend->lock);
}

struct sdfgi_memory sdfgi_backend_held(const struct backend *backend)
{
    pthread_mutex_t *lock = (pthread_mutex_t *)&backend->lock;
    pthread_mutex_lock(lock);
    const struct sdfgi_memory held = backend->held;
    pthread_mutex_unlock(lock);
    return held;
}

VkResult sdfgi_backend_buffer_init(struct backend *backend, struct gpu_buffer *buffer, uint64_t size,
                                   VkBufferUsageFlags usage, enum gpu_placement placement,
                                   enum sdfgi_memory_category category, const char *name)
{
    const VkResult result = gpu_buffer_init(&backend->device, buffer, size, usage, placement, category, name);
    if (result != VK_SUCCESS)
        return result;
    hold(backend, category, size);
    return VK_SUCCESS;
}

void sdfgi_backend_buffer_finish(struct backend *backend, struct gpu_buffer *buffer,
                                 enum sdfgi_memory_category category)
{
    if (buffer->handle)
        let_go(backend, category, buffer->size);
    gpu_buffer_finish(&backend->device, buffer);
}

VkResult sdfgi_backend_image_init(struct backend *backend, struct gpu_image *image, VkFormat format,
                                  uint32_t width, uint32_t height, VkImageUsageFlags usage,
                                  enum sdfgi_memory_category category, const char *name)
{
    const VkResult result =
        gpu_image_init(&backend->device, image, format, width, height, 1, usage, category, name);
    if (result != VK_SUCCESS)
        return result;
    hold(backend, category, image->size);
    return VK_SUCCESS;
}

void sdfgi_backend_image_finish(struct backend *backend, struct gpu_image *image,
                                enum sdfgi_memory_category category)
{
    if (image->handle)
        let_go(backend, category, image->size);
    gpu_image_finish(&backend->device, image);
}

VkResult sdfgi_backend_pool_create(const struct backend *backend, const char *name, uint32_t sets,
                                   const VkDescriptorPoolSize *sizes, uint32_t count,
                                   VkDescriptorPoolCreateFlags flags, VkDescriptorPool *pool)
{
    const VkResult result = backend->device.fn.CreateDescriptorPool(
        backend->device.handle,
        &(VkDescriptorPoolCreateInfo){ .sType = VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO,
                                       .flags = flags,
                                       .maxSets = sets,
                                       .poolSizeCount = count,
                                       .pPoolSizes = sizes },
        backend->device.callbacks, pool);
    return gpu_named(&backend->device, result, VK_OBJECT_TYPE_DESCRIPTOR_POOL, pool, name);
}

VkResult sdfgi_backend_set_allocate(const struct backend *backend, const char *name, VkDescriptorPool pool,
                                    VkDescriptorSetLayout layout, VkDescriptorSet *set)
{
    const VkResult result = backend->device.fn.AllocateDescriptorSets(
        backend->device.handle,
        &(VkDescriptorSetAllocateInfo){ .sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO,
                                        .descriptorPool = pool,
                                        .descriptorSetCount = 1,
                                        .pSetLayouts = &layout },
        set);
    return gpu_named(&backend->device, result, VK_OBJECT_TYPE_DESCRIPTOR_SET, set, name);
}
