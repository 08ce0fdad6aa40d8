/* SPDX-License-Identifier: MIT
 * The Vulkan functions of library and program that can fail, with what Vulkan lets them return: a test can
 * make any call fail. Functions of windows are left out. */
#ifndef FALLIBLE_VULKAN_H
#define FALLIBLE_VULKAN_H

#include <vulkan/vulkan_core.h>

enum fallible_error {
    FALLIBLE_HOST = 1,   /* VK_ERROR_OUT_OF_HOST_MEMORY */
    FALLIBLE_DEVICE = 2, /* VK_ERROR_OUT_OF_DEVICE_MEMORY */
    FALLIBLE_LOST = 4,   /* VK_ERROR_DEVICE_LOST */
    FALLIBLE_MEMORY = FALLIBLE_HOST | FALLIBLE_DEVICE,
    FALLIBLE_ALL = FALLIBLE_MEMORY | FALLIBLE_LOST,
};

/* What it creates is named like the function. */
#define FALLIBLE_CREATE(X, name)                                                                             \
    X(Create##name, FALLIBLE_MEMORY,                                                                         \
      (VkDevice device, const Vk##name##CreateInfo *info, const VkAllocationCallbacks *callbacks,            \
       Vk##name *out),                                                                                       \
      (device, info, callbacks, out))

#define FALLIBLE_CREATE_PIPELINES(X, kind)                                                                   \
    X(Create##kind##Pipelines, FALLIBLE_MEMORY,                                                              \
      (VkDevice device, VkPipelineCache cache, uint32_t count, const Vk##kind##PipelineCreateInfo *infos,    \
       const VkAllocationCallbacks *callbacks, VkPipeline *out),                                             \
      (device, cache, count, infos, callbacks, out))

/* X(name, errors, parameters, arguments): those of an instance, most of them a loader's. */
#define FALLIBLE_INSTANCE_FUNCTIONS(X)                                                                       \
    X(EnumerateInstanceVersion, FALLIBLE_HOST, (uint32_t * version), (version))                              \
    X(EnumerateInstanceLayerProperties, FALLIBLE_MEMORY, (uint32_t * count, VkLayerProperties * out),        \
      (count, out))                                                                                          \
    X(CreateInstance, FALLIBLE_MEMORY,                                                                       \
      (const VkInstanceCreateInfo *info, const VkAllocationCallbacks *callbacks, VkInstance *out),           \
      (info, callbacks, out))                                                                                \
    X(EnumeratePhysicalDevices, FALLIBLE_MEMORY,                                                             \
      (VkInstance instance, uint32_t * count, VkPhysicalDevice * out), (instance, count, out))               \
    X(CreateDevice, FALLIBLE_ALL,                                                                            \
      (VkPhysicalDevice physical, const VkDeviceCreateInfo *info, const VkAllocationCallbacks *callbacks,    \
       VkDevice *out),                                                                                       \
      (physical, info, callbacks, out))

/* X(name, errors, parameters, arguments): those of a device. */
#define FALLIBLE_DEVICE_FUNCTIONS(X)                                                                         \
    FALLIBLE_CREATE(X, Buffer)                                                                               \
    FALLIBLE_CREATE(X, BufferView)                                                                           \
    FALLIBLE_CREATE(X, CommandPool)                                                                          \
    FALLIBLE_CREATE(X, DescriptorPool)                                                                       \
    FALLIBLE_CREATE(X, DescriptorSetLayout)                                                                  \
    FALLIBLE_CREATE(X, Fence)                                                                                \
    FALLIBLE_CREATE(X, Framebuffer)                                                                          \
    FALLIBLE_CREATE(X, Image)                                                                                \
    FALLIBLE_CREATE(X, ImageView)                                                                            \
    FALLIBLE_CREATE(X, PipelineCache)                                                                        \
    FALLIBLE_CREATE(X, PipelineLayout)                                                                       \
    FALLIBLE_CREATE(X, QueryPool)                                                                            \
    FALLIBLE_CREATE(X, RenderPass)                                                                           \
    FALLIBLE_CREATE(X, Sampler)                                                                              \
    FALLIBLE_CREATE(X, ShaderModule)                                                                         \
    FALLIBLE_CREATE_PIPELINES(X, Compute)                                                                    \
    FALLIBLE_CREATE_PIPELINES(X, Graphics)                                                                   \
    X(AllocateMemory, FALLIBLE_MEMORY,                                                                       \
      (VkDevice device, const VkMemoryAllocateInfo *info, const VkAllocationCallbacks *callbacks,            \
       VkDeviceMemory *out),                                                                                 \
      (device, info, callbacks, out))                                                                        \
    X(AllocateCommandBuffers, FALLIBLE_MEMORY,                                                               \
      (VkDevice device, const VkCommandBufferAllocateInfo *info, VkCommandBuffer *out), (device, info, out)) \
    X(AllocateDescriptorSets, FALLIBLE_MEMORY,                                                               \
      (VkDevice device, const VkDescriptorSetAllocateInfo *info, VkDescriptorSet *out), (device, info, out)) \
    X(BeginCommandBuffer, FALLIBLE_MEMORY, (VkCommandBuffer cmd, const VkCommandBufferBeginInfo *info),      \
      (cmd, info))                                                                                           \
    X(EndCommandBuffer, FALLIBLE_MEMORY, (VkCommandBuffer cmd), (cmd))                                       \
    X(BindBufferMemory, FALLIBLE_MEMORY,                                                                     \
      (VkDevice device, VkBuffer buffer, VkDeviceMemory memory, VkDeviceSize offset),                        \
      (device, buffer, memory, offset))                                                                      \
    X(BindImageMemory, FALLIBLE_MEMORY,                                                                      \
      (VkDevice device, VkImage image, VkDeviceMemory memory, VkDeviceSize offset),                          \
      (device, image, memory, offset))                                                                       \
    X(MapMemory, FALLIBLE_MEMORY,                                                                            \
      (VkDevice device, VkDeviceMemory memory, VkDeviceSize offset, VkDeviceSize size,                       \
       VkMemoryMapFlags flags, void **out),                                                                  \
      (device, memory, offset, size, flags, out))                                                            \
    X(FlushMappedMemoryRanges, FALLIBLE_MEMORY,                                                              \
      (VkDevice device, uint32_t count, const VkMappedMemoryRange *ranges), (device, count, ranges))         \
    X(InvalidateMappedMemoryRanges, FALLIBLE_MEMORY,                                                         \
      (VkDevice device, uint32_t count, const VkMappedMemoryRange *ranges), (device, count, ranges))         \
    X(GetPipelineCacheData, FALLIBLE_MEMORY,                                                                 \
      (VkDevice device, VkPipelineCache cache, size_t * size, void *data), (device, cache, size, data))      \
    X(GetQueryPoolResults, FALLIBLE_ALL,                                                                     \
      (VkDevice device, VkQueryPool pool, uint32_t first, uint32_t count, size_t size, void *data,           \
       VkDeviceSize stride, VkQueryResultFlags flags),                                                       \
      (device, pool, first, count, size, data, stride, flags))                                               \
    X(QueueSubmit, FALLIBLE_ALL,                                                                             \
      (VkQueue queue, uint32_t count, const VkSubmitInfo *submits, VkFence fence),                           \
      (queue, count, submits, fence))                                                                        \
    X(QueueWaitIdle, FALLIBLE_ALL, (VkQueue queue), (queue))                                                 \
    X(DeviceWaitIdle, FALLIBLE_ALL, (VkDevice device), (device))                                             \
    X(ResetFences, FALLIBLE_DEVICE, (VkDevice device, uint32_t count, const VkFence *fences),                \
      (device, count, fences))                                                                               \
    X(WaitForFences, FALLIBLE_ALL,                                                                           \
      (VkDevice device, uint32_t count, const VkFence *fences, VkBool32 all, uint64_t timeout_ns),           \
      (device, count, fences, all, timeout_ns))

#define FALLIBLE_FUNCTIONS(X) FALLIBLE_INSTANCE_FUNCTIONS(X) FALLIBLE_DEVICE_FUNCTIONS(X)

#endif
