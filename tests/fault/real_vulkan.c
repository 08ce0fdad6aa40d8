/* SPDX-License-Identifier: MIT
 * In front of a real Vulkan: the functions that can fail ask fault_vulkan first. The validation layer tells
 * what lives too long, so that nothing is counted here. */
#define _GNU_SOURCE
#define VK_NO_PROTOTYPES
#include "fault.h"

#include <dlfcn.h>
#include <string.h>

/* Of the loader. */
static PFN_vkVoidFunction next(const char *name)
{
    PFN_vkVoidFunction function;
    void *const symbol = dlsym(RTLD_NEXT, name);
    memcpy(&function, &symbol, sizeof function);
    return function;
}

#define FALLIBLE(name, errors, parameters, arguments)                                                        \
    VKAPI_ATTR VkResult VKAPI_CALL vk##name parameters;                                                      \
    VKAPI_ATTR VkResult VKAPI_CALL vk##name parameters                                                       \
    {                                                                                                        \
        const VkResult result = fault_vulkan("vk" #name, errors);                                            \
        return result != VK_SUCCESS ? result : ((PFN_vk##name)next("vk" #name))arguments;                    \
    }
FALLIBLE_FUNCTIONS(FALLIBLE)
#undef FALLIBLE

static PFN_vkVoidFunction own(const char *name)
{
#define CHOOSE(id, errors, parameters, arguments)                                                            \
    if (strcmp(name, "vk" #id) == 0)                                                                         \
        return (PFN_vkVoidFunction)vk##id;
    FALLIBLE_FUNCTIONS(CHOOSE)
#undef CHOOSE
    return NULL;
}

VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL vkGetDeviceProcAddr(VkDevice device, const char *name)
{
    const PFN_vkVoidFunction found = own(name);
    return found ? found : ((PFN_vkGetDeviceProcAddr)next("vkGetDeviceProcAddr"))(device, name);
}

VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL vkGetInstanceProcAddr(VkInstance instance, const char *name)
{
    if (strcmp(name, "vkGetDeviceProcAddr") == 0)
        return (PFN_vkVoidFunction)vkGetDeviceProcAddr;
    const PFN_vkVoidFunction found = own(name);
    return found ? found : ((PFN_vkGetInstanceProcAddr)next("vkGetInstanceProcAddr"))(instance, name);
}

void fault_memory_report(FILE *out)
{
    (void)out;
}

void null_vulkan_report(FILE *out)
{
    (void)out;
}
