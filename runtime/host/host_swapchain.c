/* SPDX-License-Identifier: MIT
 * A window's images: made again whenever the window changes, absent while it has no area. */
#include "host_swapchain.h"

#include <stdlib.h>

static bool format_choose(struct host_device *device, VkSurfaceKHR surface, VkSurfaceFormatKHR *out)
{
    VkSurfaceFormatKHR formats[64];
    uint32_t count = HOST_COUNT(formats);
    if (!host_check(device, vkGetPhysicalDeviceSurfaceFormatsKHR(device->physical, surface, &count, formats),
                    "reading the window's formats"))
        return false;
    /* The tone mapper encodes sRGB itself. */
    for (uint32_t i = 0; i < count; i++) {
        if (formats[i].format == VK_FORMAT_B8G8R8A8_UNORM || formats[i].format == VK_FORMAT_R8G8B8A8_UNORM) {
            *out = formats[i];
            return true;
        }
    }
    return host_fail(device, "the window offers no 8-bit RGBA format");
}

bool host_swapchain_init(struct host_device *device, VkSurfaceKHR surface, struct host_swapchain *swapchain)
{
    VkBool32 supported = VK_FALSE;
    swapchain->surface = surface;
    if (!host_check(
            device,
            vkGetPhysicalDeviceSurfaceSupportKHR(device->physical, device->queue_family, surface, &supported),
            "asking about the window"))
        return false;
    if (!supported)
        return host_fail(device, "device '%.100s' cannot draw into windows", device->info.name);
    if (!format_choose(device, surface, &swapchain->format) ||
        !host_pass_picture_create(device, swapchain->format.format, VK_IMAGE_LAYOUT_PRESENT_SRC_KHR,
                                  &swapchain->pass))
        return false;
    const VkSemaphoreCreateInfo info = { .sType = VK_STRUCTURE_TYPE_SEMAPHORE_CREATE_INFO };
    for (int i = 0; i < HOST_SLOTS; i++) {
        if (!host_check(device, vkCreateSemaphore(device->device, &info, NULL, &swapchain->acquired[i]),
                        "creating a semaphore"))
            return false;
    }
    return true;
}

static void images_finish(struct host_device *device, struct host_swapchain *swapchain)
{
    for (uint32_t i = 0; i < swapchain->image_count; i++) {
        vkDestroyFramebuffer(device->device, swapchain->framebuffers[i], NULL);
        vkDestroyImageView(device->device, swapchain->views[i], NULL);
        vkDestroySemaphore(device->device, swapchain->drawn[i], NULL);
        swapchain->framebuffers[i] = VK_NULL_HANDLE;
        swapchain->views[i] = VK_NULL_HANDLE;
        swapchain->drawn[i] = VK_NULL_HANDLE;
    }
    swapchain->image_count = 0;
}

static bool image_init(struct host_device *device, struct host_swapchain *swapchain, VkImage image,
                       uint32_t i)
{
    const VkImageViewCreateInfo view = {
        .sType = VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO,
        .image = image,
        .viewType = VK_IMAGE_VIEW_TYPE_2D,
        .format = swapchain->format.format,
        .subresourceRange = { VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1 },
    };
    const VkFramebufferCreateInfo framebuffer = {
        .sType = VK_STRUCTURE_TYPE_FRAMEBUFFER_CREATE_INFO,
        .renderPass = swapchain->pass,
        .attachmentCount = 1,
        .pAttachments = &swapchain->views[i],
        .width = swapchain->width,
        .height = swapchain->height,
        .layers = 1,
    };
    const VkSemaphoreCreateInfo semaphore = { .sType = VK_STRUCTURE_TYPE_SEMAPHORE_CREATE_INFO };
    return host_check(device, vkCreateImageView(device->device, &view, NULL, &swapchain->views[i]),
                      "creating a view") &&
           host_check(device,
                      vkCreateFramebuffer(device->device, &framebuffer, NULL, &swapchain->framebuffers[i]),
                      "creating a framebuffer") &&
           host_check(device, vkCreateSemaphore(device->device, &semaphore, NULL, &swapchain->drawn[i]),
                      "creating a semaphore");
}

static uint32_t clamp_u32(uint32_t value, uint32_t low, uint32_t high)
{
    return value < low ? low : value > high ? high : value;
}

static bool chain_create(struct host_device *device, struct host_swapchain *swapchain,
                         const VkSurfaceCapabilitiesKHR *caps)
{
    const VkSwapchainKHR old = swapchain->chain;
    const uint32_t most = caps->maxImageCount > 0 ? caps->maxImageCount : HOST_MAX_SWAPCHAIN_IMAGES;
    const VkSwapchainCreateInfoKHR info = {
        .sType = VK_STRUCTURE_TYPE_SWAPCHAIN_CREATE_INFO_KHR,
        .surface = swapchain->surface,
        .minImageCount = clamp_u32(caps->minImageCount + 1, caps->minImageCount, most),
        .imageFormat = swapchain->format.format,
        .imageColorSpace = swapchain->format.colorSpace,
        .imageExtent = { swapchain->width, swapchain->height },
        .imageArrayLayers = 1,
        .imageUsage = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT,
        .preTransform = caps->currentTransform,
        .compositeAlpha = VK_COMPOSITE_ALPHA_OPAQUE_BIT_KHR,
        .presentMode = VK_PRESENT_MODE_FIFO_KHR,
        .clipped = VK_TRUE,
        .oldSwapchain = old,
    };
    swapchain->chain = VK_NULL_HANDLE;
    const bool ok = host_check(device, vkCreateSwapchainKHR(device->device, &info, NULL, &swapchain->chain),
                               "creating the swapchain");
    vkDestroySwapchainKHR(device->device, old, NULL);
    return ok;
}

bool host_swapchain_resize(struct host_device *device, struct host_swapchain *swapchain, uint32_t width,
                           uint32_t height)
{
    VkSurfaceCapabilitiesKHR caps;
    VkImage images[HOST_MAX_SWAPCHAIN_IMAGES];
    uint32_t count = HOST_MAX_SWAPCHAIN_IMAGES;
    if (!host_check(device, vkDeviceWaitIdle(device->device), "waiting for the device") ||
        !host_check(device,
                    vkGetPhysicalDeviceSurfaceCapabilitiesKHR(device->physical, swapchain->surface, &caps),
                    "reading the window's size"))
        return false;
    images_finish(device, swapchain);
    const bool given = caps.currentExtent.width != UINT32_MAX;
    swapchain->width = given ? caps.currentExtent.width
                             : clamp_u32(width, caps.minImageExtent.width, caps.maxImageExtent.width);
    swapchain->height = given ? caps.currentExtent.height
                              : clamp_u32(height, caps.minImageExtent.height, caps.maxImageExtent.height);
    if (swapchain->width == 0 || swapchain->height == 0)
        return true;
    if (!chain_create(device, swapchain, &caps) ||
        !host_check(device, vkGetSwapchainImagesKHR(device->device, swapchain->chain, &count, images),
                    "reading the swapchain's images"))
        return false;
    for (uint32_t i = 0; i < count; i++) {
        swapchain->image_count = i + 1;
        if (!image_init(device, swapchain, images[i], i))
            return false;
    }
    return true;
}

void host_swapchain_finish(struct host_device *device, struct host_swapchain *swapchain)
{
    vkDeviceWaitIdle(device->device);
    images_finish(device, swapchain);
    for (int i = 0; i < HOST_SLOTS; i++)
        vkDestroySemaphore(device->device, swapchain->acquired[i], NULL);
    vkDestroyRenderPass(device->device, swapchain->pass, NULL);
    vkDestroySwapchainKHR(device->device, swapchain->chain, NULL);
    vkDestroySurfaceKHR(device->instance, swapchain->surface, NULL);
}
