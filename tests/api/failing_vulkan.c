/* SPDX-License-Identifier: MIT */
#include "failing_vulkan.h"

#include "empty.comp.h"

#include <vulkan/vulkan.h>

#include <string.h>

static uint32_t calls, failing_call;
static VkResult failure;
static bool skip_shaders, lose_device;

void failing_vulkan_reset(uint32_t fail_at, VkResult result)
{
    calls = 0;
    failing_call = fail_at;
    failure = result;
}

uint32_t failing_vulkan_calls(void)
{
    return calls;
}

void failing_vulkan_skip_shaders(bool skip)
{
    skip_shaders = skip;
}

void failing_vulkan_lose_device(bool lose)
{
    lose_device = lose;
}

static bool fails(void)
{
    return ++calls == failing_call;
}

/* X(name, parameters, arguments): every function of the library's that allocates and returns a VkResult. */
#define FALLIBLE(X)                                                                                          \
    X(AllocateMemory,                                                                                        \
      (VkDevice device, const VkMemoryAllocateInfo *info, const VkAllocationCallbacks *callbacks,            \
       VkDeviceMemory *out),                                                                                 \
      (device, info, callbacks, out))                                                                        \
    X(CreateBuffer,                                                                                          \
      (VkDevice device, const VkBufferCreateInfo *info, const VkAllocationCallbacks *callbacks,              \
       VkBuffer *out),                                                                                       \
      (device, info, callbacks, out))                                                                        \
    X(CreateImage,                                                                                           \
      (VkDevice device, const VkImageCreateInfo *info, const VkAllocationCallbacks *callbacks,               \
       VkImage *out),                                                                                        \
      (device, info, callbacks, out))                                                                        \
    X(CreateImageView,                                                                                       \
      (VkDevice device, const VkImageViewCreateInfo *info, const VkAllocationCallbacks *callbacks,           \
       VkImageView *out),                                                                                    \
      (device, info, callbacks, out))                                                                        \
    X(CreateSampler,                                                                                         \
      (VkDevice device, const VkSamplerCreateInfo *info, const VkAllocationCallbacks *callbacks,             \
       VkSampler *out),                                                                                      \
      (device, info, callbacks, out))                                                                        \
    X(CreateShaderModule,                                                                                    \
      (VkDevice device, const VkShaderModuleCreateInfo *info, const VkAllocationCallbacks *callbacks,        \
       VkShaderModule *out),                                                                                 \
      (device, info, callbacks, out))                                                                        \
    X(CreateDescriptorSetLayout,                                                                             \
      (VkDevice device, const VkDescriptorSetLayoutCreateInfo *info, const VkAllocationCallbacks *callbacks, \
       VkDescriptorSetLayout *out),                                                                          \
      (device, info, callbacks, out))                                                                        \
    X(CreatePipelineLayout,                                                                                  \
      (VkDevice device, const VkPipelineLayoutCreateInfo *info, const VkAllocationCallbacks *callbacks,      \
       VkPipelineLayout *out),                                                                               \
      (device, info, callbacks, out))                                                                        \
    X(CreateComputePipelines,                                                                                \
      (VkDevice device, VkPipelineCache cache, uint32_t count, const VkComputePipelineCreateInfo *infos,     \
       const VkAllocationCallbacks *callbacks, VkPipeline *out),                                             \
      (device, cache, count, infos, callbacks, out))                                                         \
    X(CreateDescriptorPool,                                                                                  \
      (VkDevice device, const VkDescriptorPoolCreateInfo *info, const VkAllocationCallbacks *callbacks,      \
       VkDescriptorPool *out),                                                                               \
      (device, info, callbacks, out))                                                                        \
    X(AllocateDescriptorSets,                                                                                \
      (VkDevice device, const VkDescriptorSetAllocateInfo *info, VkDescriptorSet *out), (device, info, out)) \
    X(CreateQueryPool,                                                                                       \
      (VkDevice device, const VkQueryPoolCreateInfo *info, const VkAllocationCallbacks *callbacks,           \
       VkQueryPool *out),                                                                                    \
      (device, info, callbacks, out))                                                                        \
    X(BindBufferMemory, (VkDevice device, VkBuffer buffer, VkDeviceMemory memory, VkDeviceSize offset),      \
      (device, buffer, memory, offset))                                                                      \
    X(BindImageMemory, (VkDevice device, VkImage image, VkDeviceMemory memory, VkDeviceSize offset),         \
      (device, image, memory, offset))                                                                       \
    X(MapMemory,                                                                                             \
      (VkDevice device, VkDeviceMemory memory, VkDeviceSize offset, VkDeviceSize size,                       \
       VkMemoryMapFlags flags, void **out),                                                                  \
      (device, memory, offset, size, flags, out))

#define WRAPPER(name, parameters, arguments)                                                                 \
    static PFN_vk##name real_##name;                                                                         \
    static VKAPI_ATTR VkResult VKAPI_CALL failing_##name parameters                                          \
    {                                                                                                        \
        return fails() ? failure : real_##name arguments;                                                    \
    }
FALLIBLE(WRAPPER)
#undef WRAPPER

static VKAPI_ATTR VkResult VKAPI_CALL create_empty_pipeline(VkDevice device, VkPipelineCache cache,
                                                            uint32_t count,
                                                            const VkComputePipelineCreateInfo *infos,
                                                            const VkAllocationCallbacks *callbacks,
                                                            VkPipeline *out)
{
    const VkShaderModuleCreateInfo code = { .sType = VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO,
                                            .codeSize = sizeof empty_comp,
                                            .pCode = empty_comp };
    VkComputePipelineCreateInfo info = infos[0]; /* the library makes them one by one */
    VkResult result =
        count == 1 ? vkCreateShaderModule(device, &code, NULL, &info.stage.module) : VK_ERROR_UNKNOWN;
    if (result != VK_SUCCESS)
        return result;
    result = vkCreateComputePipelines(device, cache, 1, &info, callbacks, out);
    vkDestroyShaderModule(device, info.stage.module, NULL);
    return result;
}

static VKAPI_ATTR VkResult VKAPI_CALL lose_query_results(VkDevice device, VkQueryPool pool, uint32_t first,
                                                         uint32_t count, size_t size, void *data,
                                                         VkDeviceSize stride, VkQueryResultFlags flags)
{
    return lose_device ? VK_ERROR_DEVICE_LOST
                       : vkGetQueryPoolResults(device, pool, first, count, size, data, stride, flags);
}

static PFN_vkVoidFunction real_function(VkDevice device, const char *name)
{
    if (skip_shaders && strcmp(name, "vkCreateComputePipelines") == 0)
        return (PFN_vkVoidFunction)create_empty_pipeline;
    return vkGetDeviceProcAddr(device, name);
}

static VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL get_device_proc_addr(VkDevice device, const char *name)
{
#define CHOOSE(id, parameters, arguments)                                                                    \
    if (strcmp(name, "vk" #id) == 0) {                                                                       \
        real_##id = (PFN_vk##id)real_function(device, name);                                                 \
        return (PFN_vkVoidFunction)failing_##id;                                                             \
    }
    FALLIBLE(CHOOSE)
#undef CHOOSE
    if (strcmp(name, "vkGetQueryPoolResults") == 0)
        return (PFN_vkVoidFunction)lose_query_results;
    return vkGetDeviceProcAddr(device, name);
}

VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL failing_vulkan_get_instance_proc_addr(VkInstance instance,
                                                                               const char *name)
{
    if (strcmp(name, "vkGetDeviceProcAddr") == 0)
        return (PFN_vkVoidFunction)get_device_proc_addr;
    return vkGetInstanceProcAddr(instance, name);
}
