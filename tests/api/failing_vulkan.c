/* SPDX-License-Identifier: MIT */
#include "failing_vulkan.h"

#include "empty.comp.h"
#include "fallible_vulkan.h"
#include "shared_pipelines.h"

#include <vulkan/vulkan.h>

#include <string.h>

static uint32_t calls, failing_call;
static VkResult failure;
static bool skip_shaders, share_pipelines, readback_fails, hide_coherence;

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

void failing_vulkan_share_pipelines(bool share)
{
    share_pipelines = share;
}

void failing_vulkan_readback_fails(bool fails)
{
    readback_fails = fails;
}

void failing_vulkan_hide_coherence(bool hide)
{
    hide_coherence = hide;
}

static bool is_readback(const char *name)
{
    return strcmp(name, "vkGetQueryPoolResults") == 0 || strcmp(name, "vkInvalidateMappedMemoryRanges") == 0;
}

/* Without a failure calls are counted that can run out of device memory: nearly all. */
static bool fails(const char *name, enum fallible_error errors)
{
    const enum fallible_error error = failure == VK_ERROR_DEVICE_LOST          ? FALLIBLE_LOST
                                      : failure == VK_ERROR_OUT_OF_HOST_MEMORY ? FALLIBLE_HOST
                                                                               : FALLIBLE_DEVICE;
    if (is_readback(name) != readback_fails || !(errors & error))
        return false;
    return ++calls == failing_call;
}

#define WRAPPER(name, errors, parameters, arguments)                                                         \
    static PFN_vk##name real_##name;                                                                         \
    static VKAPI_ATTR VkResult VKAPI_CALL failing_##name parameters                                          \
    {                                                                                                        \
        return fails("vk" #name, errors) ? failure : real_##name arguments;                                  \
    }
FALLIBLE_DEVICE_FUNCTIONS(WRAPPER)
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

/* Flushing memory that is coherent is allowed, and does nothing. */
static VKAPI_ATTR void VKAPI_CALL get_memory_properties(VkPhysicalDevice physical,
                                                        VkPhysicalDeviceMemoryProperties *out)
{
    vkGetPhysicalDeviceMemoryProperties(physical, out);
    for (uint32_t i = 0; i < out->memoryTypeCount && hide_coherence; i++)
        out->memoryTypes[i].propertyFlags &= ~(VkMemoryPropertyFlags)VK_MEMORY_PROPERTY_HOST_COHERENT_BIT;
}

static PFN_vkVoidFunction real_function(VkDevice device, const char *name)
{
    if (skip_shaders && strcmp(name, "vkCreateComputePipelines") == 0)
        return (PFN_vkVoidFunction)create_empty_pipeline;
    return share_pipelines ? shared_pipelines_function(device, name) : vkGetDeviceProcAddr(device, name);
}

static VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL get_device_proc_addr(VkDevice device, const char *name)
{
#define CHOOSE(id, errors, parameters, arguments)                                                            \
    if (strcmp(name, "vk" #id) == 0) {                                                                       \
        real_##id = (PFN_vk##id)real_function(device, name);                                                 \
        return (PFN_vkVoidFunction)failing_##id;                                                             \
    }
    FALLIBLE_DEVICE_FUNCTIONS(CHOOSE)
#undef CHOOSE
    return real_function(device, name);
}

VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL failing_vulkan_get_instance_proc_addr(VkInstance instance,
                                                                               const char *name)
{
    if (strcmp(name, "vkGetDeviceProcAddr") == 0)
        return (PFN_vkVoidFunction)get_device_proc_addr;
    if (strcmp(name, "vkGetPhysicalDeviceMemoryProperties") == 0)
        return (PFN_vkVoidFunction)get_memory_properties;
    return vkGetInstanceProcAddr(instance, name);
}
