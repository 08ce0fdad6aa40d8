/* SPDX-License-Identifier: MIT */
#include "named_vulkan.h"

#include "failing_vulkan.h"
#include "fallible_vulkan.h"

#include <stdio.h>
#include <string.h>

struct named_vulkan named_vulkan;

static void note_made(uint64_t handle, VkObjectType type)
{
    if (named_vulkan.count < NAMED_VULKAN_MOST)
        named_vulkan.objects[named_vulkan.count++] =
            (struct named_vulkan_object){ .handle = handle, .type = type };
}

/* The last one made: handles of what was destroyed are given again. */
static struct named_vulkan_object *find(uint64_t handle, VkObjectType type)
{
    for (uint32_t i = named_vulkan.count; i-- > 0;)
        if (named_vulkan.objects[i].handle == handle && named_vulkan.objects[i].type == type)
            return &named_vulkan.objects[i];
    return NULL;
}

static VKAPI_ATTR VkResult VKAPI_CALL name_object(VkDevice device, const VkDebugUtilsObjectNameInfoEXT *info)
{
    (void)device;
    struct named_vulkan_object *object = find(info->objectHandle, info->objectType);
    if (object)
        snprintf(object->name, sizeof object->name, "%s", info->pObjectName);
    else
        named_vulkan.strays++;
    return VK_SUCCESS;
}

/* X(create macro, name, type): what is made by vkCreate*, one at a time. */
#define KINDS(X)                                                                                             \
    X(Buffer, BUFFER)                                                                                        \
    X(BufferView, BUFFER_VIEW)                                                                               \
    X(DescriptorPool, DESCRIPTOR_POOL)                                                                       \
    X(DescriptorSetLayout, DESCRIPTOR_SET_LAYOUT)                                                            \
    X(Framebuffer, FRAMEBUFFER)                                                                              \
    X(Image, IMAGE)                                                                                          \
    X(ImageView, IMAGE_VIEW)                                                                                 \
    X(PipelineLayout, PIPELINE_LAYOUT)                                                                       \
    X(QueryPool, QUERY_POOL)                                                                                 \
    X(RenderPass, RENDER_PASS)                                                                               \
    X(Sampler, SAMPLER)                                                                                      \
    X(ShaderModule, SHADER_MODULE)

#define WATCH(id, type, parameters, arguments)                                                               \
    static PFN_vk##id real_##id;                                                                             \
    static VKAPI_ATTR VkResult VKAPI_CALL watched_##id parameters                                            \
    {                                                                                                        \
        const VkResult result = real_##id arguments;                                                         \
        if (result == VK_SUCCESS)                                                                            \
            note_made((uint64_t)*out, VK_OBJECT_TYPE_##type);                                                \
        return result;                                                                                       \
    }
#define WATCH_KIND(kind, type)                                                                               \
    WATCH(Create##kind, type,                                                                                \
          (VkDevice device, const Vk##kind##CreateInfo *info, const VkAllocationCallbacks *callbacks,        \
           Vk##kind *out),                                                                                   \
          (device, info, callbacks, out))
#define WATCH_PIPELINES(kind)                                                                                \
    WATCH(Create##kind##Pipelines, PIPELINE,                                                                 \
          (VkDevice device, VkPipelineCache cache, uint32_t count,                                           \
           const Vk##kind##PipelineCreateInfo *infos, const VkAllocationCallbacks *callbacks,                \
           VkPipeline *out),                                                                                 \
          (device, cache, count, infos, callbacks, out))
KINDS(WATCH_KIND)
WATCH_PIPELINES(Compute)
WATCH_PIPELINES(Graphics)
WATCH(AllocateMemory, DEVICE_MEMORY,
      (VkDevice device, const VkMemoryAllocateInfo *info, const VkAllocationCallbacks *callbacks,
       VkDeviceMemory *out),
      (device, info, callbacks, out))
WATCH(AllocateDescriptorSets, DESCRIPTOR_SET,
      (VkDevice device, const VkDescriptorSetAllocateInfo *info, VkDescriptorSet *out), (device, info, out))

static PFN_vkGetDeviceProcAddr real_get_device_proc_addr;

static VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL get_device_proc_addr(VkDevice device, const char *name)
{
    const PFN_vkVoidFunction real = real_get_device_proc_addr(device, name);
#define CHOOSE(id)                                                                                           \
    if (strcmp(name, "vk" #id) == 0) {                                                                       \
        real_##id = (PFN_vk##id)real;                                                                        \
        return (PFN_vkVoidFunction)watched_##id;                                                             \
    }
#define CHOOSE_KIND(kind, type) CHOOSE(Create##kind)
    KINDS(CHOOSE_KIND)
    CHOOSE(CreateComputePipelines)
    CHOOSE(CreateGraphicsPipelines)
    CHOOSE(AllocateMemory)
    CHOOSE(AllocateDescriptorSets)
    if (strncmp(name, "vkCreate", 8) == 0 && strcmp(name, "vkCreateRenderPass2") != 0)
        snprintf(named_vulkan.unwatched, sizeof named_vulkan.unwatched, "%s", name);
    if (strncmp(name, "vkAllocate", 10) == 0)
        snprintf(named_vulkan.unwatched, sizeof named_vulkan.unwatched, "%s", name);
    return real;
}

VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL named_vulkan_get_instance_proc_addr(VkInstance instance,
                                                                             const char *name)
{
    const PFN_vkVoidFunction real = failing_vulkan_get_instance_proc_addr(instance, name);
    if (strcmp(name, "vkSetDebugUtilsObjectNameEXT") == 0)
        return (PFN_vkVoidFunction)name_object;
    if (strcmp(name, "vkGetDeviceProcAddr") != 0)
        return real;
    real_get_device_proc_addr = (PFN_vkGetDeviceProcAddr)real;
    return (PFN_vkVoidFunction)get_device_proc_addr;
}
