/* SPDX-License-Identifier: MIT
 * A loader for the library that counts calls which may stall a frame, by any thread. */
#ifndef TEST_COUNTING_VULKAN_H
#define TEST_COUNTING_VULKAN_H

#include <stdint.h>
#include <vulkan/vulkan_core.h>

struct counting_vulkan {
    uint32_t pipelines; /* made */
    uint32_t memory;    /* allocations of device memory */
    uint32_t objects;   /* buffers, images, and pools of descriptors and queries */
};

/* Since the program began. */
struct counting_vulkan counting_vulkan_get(void);

PFN_vkGetInstanceProcAddr counting_vulkan_loader(void);
/* Counts what is asked for, and shares pipelines as shared_pipelines.h says: for one thread at a time. */
PFN_vkGetInstanceProcAddr counting_vulkan_loader_sharing(void);

#endif
