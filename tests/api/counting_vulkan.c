/* SPDX-License-Identifier: MIT */
#include "counting_vulkan.h"

#include <vulkan/vulkan.h>

#include <stdatomic.h>
#include <string.h>

static atomic_uint pipelines, memory, objects;

struct counting_vulkan counting_vulkan_get(void)
{
    return (struct counting_vulkan){ pipelines, memory, objects };
}

#define PIPELINES(kind)                                                                                      \
    static VKAPI_ATTR VkResult VKAPI_CALL create_##kind(                                                     \
        VkDevice device, VkPipelineCache cache, uint32_t count, const Vk##kind##PipelineCreateInfo *infos,   \
        const VkAllocationCallbacks *callbacks, VkPipeline *out)                                             \
    {                                                                                                        \
        pipelines += count;                                                                                  \
        return vkCreate##kind##Pipelines(device, cache, count, infos, callbacks, out);                       \
    }
PIPELINES(Compute)
PIPELINES(Graphics)

#define OBJECT(kind)                                                                                         \
    static VKAPI_ATTR VkResult VKAPI_CALL create_##kind(VkDevice device, const Vk##kind##CreateInfo *info,   \
                                                        const VkAllocationCallbacks *callbacks,              \
                                                        Vk##kind *out)                                       \
    {                                                                                                        \
        objects++;                                                                                           \
        return vkCreate##kind(device, info, callbacks, out);                                                 \
    }
OBJECT(Buffer)
OBJECT(Image)
OBJECT(DescriptorPool)
OBJECT(QueryPool)

static VKAPI_ATTR VkResult VKAPI_CALL allocate_memory(VkDevice device, const VkMemoryAllocateInfo *info,
                                                      const VkAllocationCallbacks *callbacks,
                                                      VkDeviceMemory *out)
{
    memory++;
    return vkAllocateMemory(device, info, callbacks, out);
}

static const struct {
    const char *name;
    PFN_vkVoidFunction function;
} own[] = {
    { "vkCreateComputePipelines", (PFN_vkVoidFunction)create_Compute },
    { "vkCreateGraphicsPipelines", (PFN_vkVoidFunction)create_Graphics },
    { "vkCreateBuffer", (PFN_vkVoidFunction)create_Buffer },
    { "vkCreateImage", (PFN_vkVoidFunction)create_Image },
    { "vkCreateDescriptorPool", (PFN_vkVoidFunction)create_DescriptorPool },
    { "vkCreateQueryPool", (PFN_vkVoidFunction)create_QueryPool },
    { "vkAllocateMemory", (PFN_vkVoidFunction)allocate_memory },
};

static VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL get_device_proc_addr(VkDevice device, const char *name)
{
    for (size_t i = 0; i < sizeof own / sizeof *own; i++)
        if (strcmp(own[i].name, name) == 0)
            return own[i].function;
    return vkGetDeviceProcAddr(device, name);
}

VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL counting_vulkan_loader(VkInstance instance, const char *name)
{
    if (strcmp(name, "vkGetDeviceProcAddr") == 0)
        return (PFN_vkVoidFunction)get_device_proc_addr;
    return vkGetInstanceProcAddr(instance, name);
}
