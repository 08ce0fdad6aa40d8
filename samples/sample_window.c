/* SPDX-License-Identifier: MIT */
#include "sample_window.h"

#ifdef SAMPLE_WITH_WINDOW

#include <stdlib.h>

#include <GLFW/glfw3.h>

enum { MAX_IMAGES = 8 };

struct sample_window {
    GLFWwindow *window;
    VkSurfaceKHR surface;
    VkSwapchainKHR swapchain;
    struct sample_image images[MAX_IMAGES];
    uint32_t count, at; /* images, and the one that is drawn */
    VkSemaphore acquired[SAMPLE_FRAMES], drawn[MAX_IMAGES];
};

struct sample_window *sample_window_open(bool wanted, uint32_t width, uint32_t height)
{
    if (!wanted)
        return NULL;
    struct sample_window *w = calloc(1, sizeof *w);
    sample_require(w && glfwInit() && glfwVulkanSupported(), "opening a window");
    glfwWindowHint(GLFW_CLIENT_API, GLFW_NO_API);
    w->window = glfwCreateWindow((int)width, (int)height, "libsdfgi", NULL, NULL);
    sample_require(w->window != NULL, "opening a window");
    return w;
}

const char *const *sample_window_instance_extensions(const struct sample_window *w, uint32_t *count)
{
    *count = 0;
    return w ? (const char *const *)glfwGetRequiredInstanceExtensions(count) : NULL;
}

const char *const *sample_window_device_extensions(const struct sample_window *w, uint32_t *count)
{
    static const char *const swapchain[] = { VK_KHR_SWAPCHAIN_EXTENSION_NAME };
    *count = w ? 1 : 0;
    return swapchain;
}

static VkSemaphore semaphore(struct sample_gpu *gpu)
{
    const VkSemaphoreCreateInfo info = { .sType = VK_STRUCTURE_TYPE_SEMAPHORE_CREATE_INFO };
    VkSemaphore made;
    SAMPLE_CHECK(vkCreateSemaphore(gpu->device, &info, NULL, &made));
    SAMPLE_KEEP(gpu, SEMAPHORE, made);
    return made;
}

static void begin(struct sample_window *w, struct sample_gpu *gpu)
{
    VkBool32 can_show = VK_FALSE;
    SAMPLE_CHECK(glfwCreateWindowSurface(gpu->instance, w->window, NULL, &w->surface));
    SAMPLE_CHECK(
        vkGetPhysicalDeviceSurfaceSupportKHR(gpu->physical_device, gpu->queue_family, w->surface, &can_show));
    sample_require(can_show, "showing pictures from this queue");
    for (int i = 0; i < SAMPLE_FRAMES; i++)
        w->acquired[i] = semaphore(gpu);
    for (int i = 0; i < MAX_IMAGES; i++)
        w->drawn[i] = semaphore(gpu);
}

/* A swapchain of the window's size. False while the window has none. */
static bool make_swapchain(struct sample_window *w, struct sample_gpu *gpu)
{
    VkSurfaceCapabilitiesKHR can;
    SAMPLE_CHECK(vkGetPhysicalDeviceSurfaceCapabilitiesKHR(gpu->physical_device, w->surface, &can));
    int width, height;
    glfwGetFramebufferSize(w->window, &width, &height);
    if (can.currentExtent.width == UINT32_MAX)
        can.currentExtent = (VkExtent2D){ (uint32_t)width, (uint32_t)height };
    if (can.currentExtent.width == 0 || can.currentExtent.height == 0)
        return false;
    const VkSwapchainKHR old = w->swapchain;
    VkSwapchainCreateInfoKHR info = { .sType = VK_STRUCTURE_TYPE_SWAPCHAIN_CREATE_INFO_KHR,
                                      .surface = w->surface,
                                      .minImageCount = can.minImageCount,
                                      .imageFormat = VK_FORMAT_B8G8R8A8_SRGB,
                                      .imageColorSpace = VK_COLOR_SPACE_SRGB_NONLINEAR_KHR,
                                      .imageExtent = can.currentExtent,
                                      .imageArrayLayers = 1,
                                      .imageUsage = VK_IMAGE_USAGE_TRANSFER_DST_BIT,
                                      .preTransform = can.currentTransform,
                                      .compositeAlpha = VK_COMPOSITE_ALPHA_OPAQUE_BIT_KHR,
                                      .presentMode = VK_PRESENT_MODE_FIFO_KHR,
                                      .clipped = VK_TRUE,
                                      .oldSwapchain = old };
    SAMPLE_CHECK(vkCreateSwapchainKHR(gpu->device, &info, NULL, &w->swapchain));
    if (old)
        vkDestroySwapchainKHR(gpu->device, old, NULL);
    VkImage images[MAX_IMAGES];
    w->count = MAX_IMAGES;
    sample_require(vkGetSwapchainImagesKHR(gpu->device, w->swapchain, &w->count, images) == VK_SUCCESS,
                   "MAX_IMAGES are too few");
    for (uint32_t i = 0; i < w->count; i++)
        w->images[i] = (struct sample_image){ images[i], VK_NULL_HANDLE, info.imageFormat,
                                              info.imageExtent.width, info.imageExtent.height };
    return true;
}

bool sample_window_acquire(struct sample_window *w, struct sample_gpu *gpu)
{
    if (!w)
        return true;
    if (!w->surface)
        begin(w, gpu);
    /* The semaphore has been waited for once the frame that used it has finished. */
    const uint64_t turn = gpu->frame % SAMPLE_FRAMES;
    SAMPLE_CHECK(vkWaitForFences(gpu->device, 1, &gpu->frames[turn].fence, VK_TRUE, UINT64_MAX));
    for (;;) {
        glfwPollEvents();
        if (glfwWindowShouldClose(w->window))
            return false;
        const VkResult result = w->swapchain
                                    ? vkAcquireNextImageKHR(gpu->device, w->swapchain, UINT64_MAX,
                                                            w->acquired[turn], VK_NULL_HANDLE, &w->at)
                                    : VK_ERROR_OUT_OF_DATE_KHR;
        if (result >= 0)
            return true;
        sample_require(result == VK_ERROR_OUT_OF_DATE_KHR, "acquiring an image of the window");
        SAMPLE_CHECK(vkDeviceWaitIdle(gpu->device));
        if (!make_swapchain(w, gpu))
            glfwWaitEvents();
    }
}

void sample_window_show(struct sample_window *w, struct sample_gpu *gpu, const struct sample_image *image)
{
    if (!w) {
        sample_frame_submit(gpu, VK_NULL_HANDLE, VK_NULL_HANDLE);
        return;
    }
    const VkCommandBuffer cmd = gpu->frames[gpu->frame % SAMPLE_FRAMES].cmd;
    const VkSemaphore acquired = w->acquired[gpu->frame % SAMPLE_FRAMES];
    const struct sample_image *shown = &w->images[w->at];
    const VkImageBlit all = { { VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1 },
                              { { 0, 0, 0 }, { (int32_t)image->width, (int32_t)image->height, 1 } },
                              { VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1 },
                              { { 0, 0, 0 }, { (int32_t)shown->width, (int32_t)shown->height, 1 } } };
    const VkImageLayout from = VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL,
                        to = VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL;
    sample_image_barrier(cmd, shown, VK_IMAGE_LAYOUT_UNDEFINED, to);
    vkCmdBlitImage(cmd, image->image, from, shown->image, to, 1, &all, VK_FILTER_LINEAR);
    sample_image_barrier(cmd, shown, to, VK_IMAGE_LAYOUT_PRESENT_SRC_KHR);
    sample_frame_submit(gpu, acquired, w->drawn[w->at]);
    const VkPresentInfoKHR info = { .sType = VK_STRUCTURE_TYPE_PRESENT_INFO_KHR,
                                    .waitSemaphoreCount = 1,
                                    .pWaitSemaphores = &w->drawn[w->at],
                                    .swapchainCount = 1,
                                    .pSwapchains = &w->swapchain,
                                    .pImageIndices = &w->at };
    const VkResult result = vkQueuePresentKHR(gpu->queue, &info);
    sample_require(result >= 0 || result == VK_ERROR_OUT_OF_DATE_KHR, "showing an image of the window");
}

void sample_window_close(struct sample_window *w, struct sample_gpu *gpu)
{
    if (!w)
        return;
    if (w->swapchain)
        vkDestroySwapchainKHR(gpu->device, w->swapchain, NULL);
    if (w->surface)
        vkDestroySurfaceKHR(gpu->instance, w->surface, NULL);
    glfwDestroyWindow(w->window);
    glfwTerminate();
    free(w);
}

#else

struct sample_window *sample_window_open(bool wanted, uint32_t width, uint32_t height)
{
    (void)width;
    (void)height;
    sample_require(!wanted, "opening a window: the samples were built without GLFW");
    return NULL;
}

const char *const *sample_window_instance_extensions(const struct sample_window *window, uint32_t *count)
{
    (void)window;
    *count = 0;
    return NULL;
}

const char *const *sample_window_device_extensions(const struct sample_window *window, uint32_t *count)
{
    return sample_window_instance_extensions(window, count);
}

bool sample_window_acquire(struct sample_window *window, struct sample_gpu *gpu)
{
    (void)window;
    (void)gpu;
    return true;
}

void sample_window_show(struct sample_window *window, struct sample_gpu *gpu,
                        const struct sample_image *image)
{
    (void)window;
    (void)image;
    sample_frame_submit(gpu, VK_NULL_HANDLE, VK_NULL_HANDLE);
}

void sample_window_close(struct sample_window *window, struct sample_gpu *gpu)
{
    (void)window;
    (void)gpu;
}

#endif
