/* SPDX-License-Identifier: MIT
 * All renderers of a test program share the library's pipelines: software drivers make and compile them for
 * seconds. Functions of Vulkan that are defined here stand before the loader's. */
#define _GNU_SOURCE
#include "shared_pipelines.h"

#include <dlfcn.h>
#include <stdint.h>
#include <string.h>

#define NEXT(name) ((PFN_##name)(uintptr_t)dlsym(RTLD_NEXT, #name))

/* Whoever asks for functions of a device gets those that share. Only the library does. */
VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL vkGetInstanceProcAddr(VkInstance instance, const char *name)
{
    if (strcmp(name, "vkGetDeviceProcAddr") == 0)
        return shared_pipelines_loader()(instance, name);
    return NEXT(vkGetInstanceProcAddr)(instance, name);
}

VKAPI_ATTR void VKAPI_CALL vkDestroyDevice(VkDevice device, const VkAllocationCallbacks *callbacks)
{
    shared_pipelines_destroy(device);
    NEXT(vkDestroyDevice)(device, callbacks);
}
