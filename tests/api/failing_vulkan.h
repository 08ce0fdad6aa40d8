/* SPDX-License-Identifier: MIT
 * A loader whose devices fail on demand: the library gets every function through vkGetInstanceProcAddr, so a
 * wrapped one can make the k-th call that may run out of memory do so. */
#ifndef TEST_FAILING_VULKAN_H
#define TEST_FAILING_VULKAN_H

#include <stdbool.h>
#include <stdint.h>

#include <vulkan/vulkan_core.h>

/* Calls that may return `result`, counted from 1 since the last reset; call `fail_at` does, 0 fails none.
 * Those that bring back what frames found out count only when asked for, and then alone. */
void failing_vulkan_reset(uint32_t fail_at, VkResult result);
uint32_t failing_vulkan_calls(void);

void failing_vulkan_readback_fails(bool fails);

/* Contexts created from then on find no memory that is coherent, and have to flush and invalidate. */
void failing_vulkan_hide_coherence(bool hide);

/* Contexts created from then on get pipelines of an empty shader: they take a hundredth of the time. */
void failing_vulkan_skip_shaders(bool skip);

/* Contexts created from then on share pipelines, as shared_pipelines.h says. */
void failing_vulkan_share_pipelines(bool share);

VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL failing_vulkan_get_instance_proc_addr(VkInstance instance,
                                                                               const char *name);

#endif
