/* SPDX-License-Identifier: MIT
 * The images of a window. */
#ifndef HOST_SWAPCHAIN_H
#define HOST_SWAPCHAIN_H

#include "host_internal.h"

enum { HOST_MAX_SWAPCHAIN_IMAGES = 16 };

struct host_swapchain {
    VkSurfaceKHR surface; /* owned once host_swapchain_init has been called */
    VkSurfaceFormatKHR format;
    VkRenderPass pass;
    VkSwapchainKHR chain;
    uint32_t width, height, image_count; /* no images: the window has no area */
    VkImageView views[HOST_MAX_SWAPCHAIN_IMAGES];
    VkFramebuffer framebuffers[HOST_MAX_SWAPCHAIN_IMAGES];
    VkSemaphore drawn[HOST_MAX_SWAPCHAIN_IMAGES]; /* per image: presenting it waits for this */
    VkSemaphore acquired[HOST_SLOTS];
};

bool host_swapchain_init(struct host_device *device, VkSurfaceKHR surface, struct host_swapchain *swapchain);
/* Makes images of the window's present size; `width` and `height` count where the window leaves them open. */
bool host_swapchain_resize(struct host_device *device, struct host_swapchain *swapchain, uint32_t width,
                           uint32_t height);
void host_swapchain_finish(struct host_device *device, struct host_swapchain *swapchain);

#endif
