/* SPDX-License-Identifier: MIT
 * A loader whose devices fail on demand: the library gets every function through vkGetInstanceProcAddr, so a
 * wrapped one can make the k-th call that may run out of memory do so. */
#ifndef TEST_FAILING_VULKAN_H
#define TEST_FAILING_VULKAN_H

#include <stdbool.h>
#include <stdint.h>

#include <vulkan/vulkan_core.h>

/* Calls that may fail, counted from 1 since the last reset; call `fail_at` returns `result`, 0 fails none. */
void failing_vulkan_reset(uint32_t fail_at, VkResult result);
uint32_t failing_vulkan_calls(void);

/* Whether contexts find their device lost when they read times. */
void failing_vulkan_lose_device(bool lose);

/* Contexts created from then on get pipelines of an empty shader: they take a hundredth of the time. */
void failing_vulkan_skip_shaders(bool skip);

VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL failing_vulkan_get_instance_proc_addr(VkInstance instance,
                                                                               const char *name);

#endif
