/* SPDX-License-Identifier: MIT */
#include "layered_vulkan.h"

#include <stdlib.h>
#include <string.h>

#include <vulkan/vulkan.h>

static const struct layered_function *layer;
static PFN_vkGetDeviceProcAddr below_layer;

static VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL get_device_proc_addr(VkDevice device, const char *name)
{
    for (const struct layered_function *f = layer; f->name; f++)
        if (strcmp(f->name, name) == 0)
            return f->function;
    return below_layer(device, name);
}

/* A software driver passes for a GPU: the library then runs its shaders for GPUs. */
static VKAPI_ATTR void VKAPI_CALL properties_of_gpu(VkPhysicalDevice device,
                                                    VkPhysicalDeviceProperties *properties)
{
    vkGetPhysicalDeviceProperties(device, properties);
    properties->deviceType = VK_PHYSICAL_DEVICE_TYPE_DISCRETE_GPU;
}

static VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL get_instance_proc_addr(VkInstance instance, const char *name)
{
    if (strcmp(name, "vkGetDeviceProcAddr") == 0)
        return (PFN_vkVoidFunction)get_device_proc_addr;
    if (strcmp(name, "vkGetPhysicalDeviceProperties") == 0 && getenv("SDFGI_TEST_AS_GPU"))
        return (PFN_vkVoidFunction)properties_of_gpu;
    return vkGetInstanceProcAddr(instance, name);
}

PFN_vkGetInstanceProcAddr layered_vulkan_loader_above(const struct layered_function *functions,
                                                      PFN_vkGetDeviceProcAddr below)
{
    layer = functions;
    below_layer = below;
    return get_instance_proc_addr;
}

PFN_vkGetInstanceProcAddr layered_vulkan_loader(const struct layered_function *functions)
{
    return layered_vulkan_loader_above(functions, vkGetDeviceProcAddr);
}
