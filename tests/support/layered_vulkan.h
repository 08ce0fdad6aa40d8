/* SPDX-License-Identifier: MIT
 * A loader for the library in which functions of a test stand for some of the device's. With
 * SDFGI_TEST_AS_GPU in the environment it tells of no software driver. */
#ifndef TEST_LAYERED_VULKAN_H
#define TEST_LAYERED_VULKAN_H

#include <vulkan/vulkan_core.h>

struct layered_function {
    const char *name; /* "vk..." */
    PFN_vkVoidFunction function;
};
#define LAYERED(name, function)                                                                              \
    {                                                                                                        \
        name, (PFN_vkVoidFunction)(function)                                                                 \
    }

/* `functions` ends with an empty row and outlives all devices. A program has one such table at a time. */
PFN_vkGetInstanceProcAddr layered_vulkan_loader(const struct layered_function *functions);
/* The other functions of devices come from `below`. */
PFN_vkGetInstanceProcAddr layered_vulkan_loader_above(const struct layered_function *functions,
                                                      PFN_vkGetDeviceProcAddr below);

#endif
