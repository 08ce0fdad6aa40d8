/* SPDX-License-Identifier: MIT
 * A loader that keeps a list of what is made with its devices, and of the names that debuggers are given. */
#ifndef TEST_NAMED_VULKAN_H
#define TEST_NAMED_VULKAN_H

#include <stdbool.h>
#include <stdint.h>

#include <vulkan/vulkan_core.h>

enum { NAMED_VULKAN_NAME = 64, NAMED_VULKAN_MOST = 4096 };

struct named_vulkan_object {
    uint64_t handle;
    VkObjectType type;
    char name[NAMED_VULKAN_NAME]; /* empty: it has none */
};

struct named_vulkan {
    struct named_vulkan_object objects[NAMED_VULKAN_MOST];
    uint32_t count;
    uint32_t strays; /* names given to what was not made here, or was made as something else */
    char unwatched[NAMED_VULKAN_NAME]; /* a function asked for that makes things and is not in the list */
};

/* All that was made since the program began. */
extern struct named_vulkan named_vulkan;

/* Shaders are left out of pipelines, as in failing_vulkan.h. */
VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL named_vulkan_get_instance_proc_addr(VkInstance instance,
                                                                             const char *name);

#endif
