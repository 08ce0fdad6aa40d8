/* SPDX-License-Identifier: MIT */
#include "counting_vulkan.h"

#include "layered_vulkan.h"
#include "shared_pipelines.h"

#include <vulkan/vulkan.h>

#include <stdatomic.h>

static atomic_uint pipelines, memory, objects;
static PFN_vkGetDeviceProcAddr below;

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
        return ((PFN_vkCreate##kind##Pipelines)below(device, "vkCreate" #kind "Pipelines"))(                 \
            device, cache, count, infos, callbacks, out);                                                    \
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

static const struct layered_function counted[] = {
    LAYERED("vkCreateComputePipelines", create_Compute),
    LAYERED("vkCreateGraphicsPipelines", create_Graphics),
    LAYERED("vkCreateBuffer", create_Buffer),
    LAYERED("vkCreateImage", create_Image),
    LAYERED("vkCreateDescriptorPool", create_DescriptorPool),
    LAYERED("vkCreateQueryPool", create_QueryPool),
    LAYERED("vkAllocateMemory", allocate_memory),
    { NULL, NULL },
};

PFN_vkGetInstanceProcAddr counting_vulkan_loader(void)
{
    below = vkGetDeviceProcAddr;
    return layered_vulkan_loader(counted);
}

PFN_vkGetInstanceProcAddr counting_vulkan_loader_sharing(void)
{
    below = shared_pipelines_function;
    return layered_vulkan_loader_above(counted, below);
}
