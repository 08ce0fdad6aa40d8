/* SPDX-License-Identifier: MIT */
#include "gpu.h"

#include <string.h>

bool gpu_functions_load_instance(struct gpu_functions *fn, VkInstance instance, PFN_vkGetInstanceProcAddr get)
{
    bool complete = true;
#define LOAD(name)                                                                                           \
    fn->name = (PFN_vk##name)get(instance, "vk" #name);                                                      \
    complete = complete && fn->name;
    GPU_INSTANCE_FUNCTIONS(LOAD)
#undef LOAD
    fn->SetDebugUtilsObjectNameEXT =
        (PFN_vkSetDebugUtilsObjectNameEXT)get(instance, "vkSetDebugUtilsObjectNameEXT");
    fn->CmdBeginDebugUtilsLabelEXT =
        (PFN_vkCmdBeginDebugUtilsLabelEXT)get(instance, "vkCmdBeginDebugUtilsLabelEXT");
    fn->CmdEndDebugUtilsLabelEXT =
        (PFN_vkCmdEndDebugUtilsLabelEXT)get(instance, "vkCmdEndDebugUtilsLabelEXT");
    return complete;
}

static bool load_device(struct gpu_functions *fn, VkDevice device)
{
    bool complete = true;
#define LOAD(name)                                                                                           \
    fn->name = (PFN_vk##name)fn->GetDeviceProcAddr(device, "vk" #name);                                      \
    complete = complete && fn->name;
    GPU_DEVICE_FUNCTIONS(LOAD)
#undef LOAD
    return complete;
}

static void load_queue_family(struct gpu_device *device, VkPhysicalDevice physical, uint32_t family)
{
    VkQueueFamilyProperties families[16];
    uint32_t count = 16;
    device->fn.GetPhysicalDeviceQueueFamilyProperties(physical, &count, families);
    device->queue_flags = family < count ? families[family].queueFlags : 0;
    device->timestamp_bits = family < count ? families[family].timestampValidBits : 0;
}

VkResult gpu_device_init(struct gpu_device *device, VkInstance instance, VkPhysicalDevice physical,
                         VkDevice handle, uint32_t queue_family, PFN_vkGetInstanceProcAddr get,
                         const VkAllocationCallbacks *callbacks)
{
    memset(device, 0, sizeof *device);
    if (!gpu_functions_load_instance(&device->fn, instance, get) || !load_device(&device->fn, handle))
        return VK_ERROR_INITIALIZATION_FAILED;
    device->handle = handle;
    device->callbacks = callbacks;
    device->fn.GetPhysicalDeviceMemoryProperties(physical, &device->memory);
    VkPhysicalDeviceProperties properties;
    device->fn.GetPhysicalDeviceProperties(physical, &properties);
    device->limits = properties.limits;
    device->is_cpu = properties.deviceType == VK_PHYSICAL_DEVICE_TYPE_CPU;
    device->fn.GetPhysicalDeviceFeatures(physical, &device->features);
    load_queue_family(device, physical, queue_family);
    return VK_SUCCESS;
}

VkResult gpu_named(const struct gpu_device *device, VkResult result, VkObjectType type, const void *handle,
                   const char *name)
{
    if (result != VK_SUCCESS || !device->fn.SetDebugUtilsObjectNameEXT)
        return result;
    VkDebugUtilsObjectNameInfoEXT info = { .sType = VK_STRUCTURE_TYPE_DEBUG_UTILS_OBJECT_NAME_INFO_EXT,
                                           .objectType = type,
                                           .pObjectName = name };
    memcpy(&info.objectHandle, handle, sizeof info.objectHandle); /* all but dispatchable ones have 64 bits */
    device->fn.SetDebugUtilsObjectNameEXT(device->handle, &info); /* a name that is missing harms nobody */
    return VK_SUCCESS;
}
