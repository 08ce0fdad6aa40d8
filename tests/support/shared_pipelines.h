/* SPDX-License-Identifier: MIT
 * A loader with which contexts on a device share compute pipelines: they ask for the same ones over and over,
 * and a software driver compiles them each time. */
#ifndef TEST_SHARED_PIPELINES_H
#define TEST_SHARED_PIPELINES_H

#include <vulkan/vulkan_core.h>

PFN_vkGetInstanceProcAddr shared_pipelines_loader(void);
/* The functions below that loader, for a layer above them; others are the driver's. One thread at a time may
 * call them. */
PFN_vkVoidFunction shared_pipelines_function(VkDevice device, const char *name);
/* Before the device goes. */
void shared_pipelines_destroy(VkDevice device);

#endif
