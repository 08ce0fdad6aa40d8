/* SPDX-License-Identifier: MIT
 * `sdfgi view`: a window with a camera that flies.
 *
 * G switches global illumination, which is prepared first. F2 walks through the parts of the light, V and
 * Shift V through the debug views, of which 1 to 9 are the first; 0 is the picture. F1 opens an overlay, if
 * there is one, which may take keys and mouse for itself. Escape closes. host_fly.h has the camera's keys. */
#include "host_fly.h"
#include "host_prepare.h"
#include "host_swapchain.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

struct window {
    const struct host_window_desc *desc;
    GLFWwindow *glfw;
    struct host_device *device;
    struct host_scene *scene;
    struct host_renderer *renderer;
    struct host_swapchain swapchain;
    VkPipeline tonemap;
    struct sdfgi_settings settings, wanted; /* in force, and what the user asks for */
    struct host_prepare prepare;
    struct host_fly camera;
    struct host_camera led;      /* where desc->camera leads */
    uint32_t frame;              /* how many have been drawn */
    uint32_t shown;              /* index into parts */
    enum sdfgi_debug_view debug; /* shown instead; SDFGI_DEBUG_VIEW_COUNT: none */
    bool swapchain_stale;
    struct host_overlay_frame overlay; /* of the last frame */
    bool overlay_begun;
    char settings_error[256]; /* why what was asked for last was refused; "": it was not */
    double time_s, title_time_s;
    uint32_t title_frames;
};

static const enum host_aov parts[] = { HOST_AOV_COLOR, HOST_AOV_IRRADIANCE, HOST_AOV_DIFFUSE_INDIRECT,
                                       HOST_AOV_NORMAL, HOST_AOV_ALBEDO };

/* ---- Input ------------------------------------------------------------------------------------------ */

/* The picture is one of the views. */
static enum sdfgi_debug_view debug_step(enum sdfgi_debug_view view, bool back)
{
    const int count = SDFGI_DEBUG_VIEW_COUNT + 1;
    return (enum sdfgi_debug_view)(((int)view + (back ? count - 1 : 1)) % count);
}

static void key_received(GLFWwindow *glfw, int key, int scancode, int action, int mods)
{
    struct window *window = glfwGetWindowUserPointer(glfw);
    (void)scancode;
    if (action != GLFW_PRESS || (window->overlay.takes_keys && key != GLFW_KEY_F1))
        return;
    if (key == GLFW_KEY_F1)
        window->overlay.open = window->overlay_begun && !window->overlay.open;
    if (key == GLFW_KEY_G)
        window->wanted.enabled = !window->wanted.enabled;
    if (key == GLFW_KEY_F2)
        window->shown = (window->shown + 1) % HOST_COUNT(parts);
    if (key == GLFW_KEY_V)
        window->debug = debug_step(window->debug, (mods & GLFW_MOD_SHIFT) != 0);
    if (key == GLFW_KEY_0)
        window->debug = SDFGI_DEBUG_VIEW_COUNT;
    if (key >= GLFW_KEY_1 && key <= GLFW_KEY_9)
        window->debug = (enum sdfgi_debug_view)(key - GLFW_KEY_1);
    if (key == GLFW_KEY_ESCAPE)
        glfwSetWindowShouldClose(glfw, GLFW_TRUE);
}

static void size_changed(GLFWwindow *glfw, int width, int height)
{
    struct window *window = glfwGetWindowUserPointer(glfw);
    (void)width;
    (void)height;
    window->swapchain_stale = true;
}

/* ---- Overlay ---------------------------------------------------------------------------------------- */

static bool overlay_begin(struct window *window)
{
    char error[128] = "";
    const struct host_overlay *overlay = window->desc->overlay;
    const struct host_device *device = window->device;
    const struct host_overlay_vulkan vulkan = { .instance = device->instance,
                                                .physical_device = device->physical,
                                                .device = device->device,
                                                .queue_family = device->queue_family,
                                                .queue = device->queue,
                                                .pipeline_cache = device->cache.handle,
                                                .pass = window->swapchain.pass,
                                                .frames_in_flight = HOST_SLOTS };
    window->overlay_begun =
        overlay && overlay->begin(overlay->user, window->glfw, &vulkan, error, sizeof(error));
    return !overlay || window->overlay_begun || host_fail(window->device, "%s", error);
}

static void overlay_step(struct window *window, double frame_s)
{
    struct host_overlay_frame *frame = &window->overlay;
    struct sdfgi_report report;
    if (!window->overlay_begun)
        return;
    host_gi_get_report(window->renderer->gi, &report);
    frame->settings = window->wanted;
    frame->error = window->settings_error[0] ? window->settings_error : NULL;
    frame->debug = window->debug;
    frame->possible = host_renderer_possible_effects(window->renderer);
    frame->report = &report;
    frame->gpu_ns = window->renderer->times.frame_ns;
    frame->frame_s = frame_s;
    window->desc->overlay->frame(window->desc->overlay->user, frame);
    frame->report = NULL;
    window->wanted = frame->settings;
    window->debug = frame->debug;
    host_renderer_leave_out(window->renderer, &frame->left_out);
}

/* ---- Settings --------------------------------------------------------------------------------------- */

static bool settings_equal(const struct sdfgi_settings *a, const struct sdfgi_settings *b)
{
    return memcmp(a, b, sizeof(*a)) == 0;
}

/* Settings that the library refuses, for want of memory say, leave those before in force. */
static void settings_apply(struct window *window)
{
    window->settings_error[0] = '\0';
    if (host_renderer_set_settings(window->renderer, &window->wanted)) {
        window->settings = window->wanted;
        return;
    }
    snprintf(window->settings_error, sizeof(window->settings_error), "%s", window->device->error);
    window->wanted = window->settings;
}

/* What the user asks for takes effect at once, but for the switch from off to on: what that needs is made
 * beside the frames first, so that none of them waits for it. */
static void settings_follow(struct window *window)
{
    const bool switches_on = window->wanted.enabled && !window->settings.enabled;
    const bool ready = switches_on ? host_prepare_step(&window->prepare, &window->wanted)
                                   : host_prepare_stop(&window->prepare);
    if (ready && !settings_equal(&window->wanted, &window->settings))
        settings_apply(window);
}

/* ---- Frame ------------------------------------------------------------------------------------------ */

/* Follows the window's size; leaves the swapchain without images while there is nothing to see. */
static bool follow_size(struct window *window)
{
    int width = 0, height = 0;
    glfwGetFramebufferSize(window->glfw, &width, &height);
    if (!host_swapchain_resize(window->device, &window->swapchain, (uint32_t)width, (uint32_t)height))
        return false;
    window->swapchain_stale = false;
    if (window->swapchain.image_count == 0)
        return true;
    return host_renderer_resize(window->renderer, window->swapchain.width, window->swapchain.height);
}

/* False on failure; *ready says whether there is an image to draw into. */
static bool acquire(struct window *window, VkSemaphore semaphore, uint32_t *image, bool *ready)
{
    const VkResult result = vkAcquireNextImageKHR(window->device->device, window->swapchain.chain, UINT64_MAX,
                                                  semaphore, VK_NULL_HANDLE, image);
    *ready = result == VK_SUCCESS || result == VK_SUBOPTIMAL_KHR;
    window->swapchain_stale = window->swapchain_stale || result != VK_SUCCESS;
    return result == VK_ERROR_OUT_OF_DATE_KHR || host_check(window->device, result, "acquiring an image");
}

/* There are no views of what is switched off. */
static bool shows_debug(const struct window *window)
{
    return window->debug < SDFGI_DEBUG_VIEW_COUNT && host_gi_set(window->renderer->gi);
}

/* With the exposure of the pictures before. */
static bool record_debug(struct window *window, VkCommandBuffer cmd)
{
    struct host_debug_desc desc = { .view = window->debug };
    memcpy(&desc.exposure, window->renderer->exposure.mapped, sizeof(float));
    return !shows_debug(window) || host_debug_record(window->renderer, cmd, &desc);
}

static void record_shown(struct window *window, VkCommandBuffer cmd)
{
    /* Reflectances and directions are shown as they are. */
    const enum host_aov shown = parts[window->shown];
    const bool fixed = shown == HOST_AOV_NORMAL || shown == HOST_AOV_ALBEDO;
    if (shows_debug(window))
        host_debug_show(window->renderer, cmd, window->tonemap);
    else
        host_tonemap_record(window->renderer, cmd, window->tonemap, fixed ? 1.0f : 0.0f);
}

static bool record_picture(struct window *window, VkCommandBuffer cmd, uint32_t image)
{
    const struct host_swapchain *swapchain = &window->swapchain;
    const VkRenderPassBeginInfo begin = {
        .sType = VK_STRUCTURE_TYPE_RENDER_PASS_BEGIN_INFO,
        .renderPass = swapchain->pass,
        .framebuffer = swapchain->framebuffers[image],
        .renderArea = { { 0, 0 }, { swapchain->width, swapchain->height } },
    };
    host_exposure_record(window->renderer, cmd);
    if (!record_debug(window, cmd)) {
        vkEndCommandBuffer(cmd);
        return false;
    }
    vkCmdBeginRenderPass(cmd, &begin, VK_SUBPASS_CONTENTS_INLINE);
    record_shown(window, cmd);
    if (window->overlay_begun)
        window->desc->overlay->record(window->desc->overlay->user, cmd);
    vkCmdEndRenderPass(cmd);
    return true;
}

static bool present(struct window *window, uint32_t image)
{
    const VkPresentInfoKHR info = {
        .sType = VK_STRUCTURE_TYPE_PRESENT_INFO_KHR,
        .waitSemaphoreCount = 1,
        .pWaitSemaphores = &window->swapchain.drawn[image],
        .swapchainCount = 1,
        .pSwapchains = &window->swapchain.chain,
        .pImageIndices = &image,
    };
    const VkResult result = vkQueuePresentKHR(window->device->queue, &info);
    window->swapchain_stale = window->swapchain_stale || result != VK_SUCCESS;
    return result == VK_ERROR_OUT_OF_DATE_KHR || host_check(window->device, result, "presenting");
}

static void tell_progress(struct window *window)
{
    struct sdfgi_report report;
    const struct host_frame frame = { window->frame++, window->renderer->times.frame_ns, &report };
    if (!window->desc->progress)
        return;
    host_gi_get_report(window->renderer->gi, &report);
    if (!window->desc->progress(window->desc->user, &frame))
        glfwSetWindowShouldClose(window->glfw, GLFW_TRUE);
}

static bool draw(struct window *window)
{
    struct host_renderer *renderer = window->renderer;
    const struct host_camera camera = window->desc->camera ? window->led : host_fly_camera(&window->camera);
    const uint64_t slot_number = renderer->submit_count % HOST_SLOTS;
    uint32_t image = 0;
    bool ready = false;
    /* The slot's fence says that the semaphore of its last frame is free again. */
    if (!host_slot_wait(renderer, &renderer->slots[slot_number]) ||
        !acquire(window, window->swapchain.acquired[slot_number], &image, &ready))
        return false;
    if (!ready)
        return true;
    const VkSemaphore semaphores[] = { window->swapchain.acquired[slot_number],
                                       window->swapchain.drawn[image] };
    host_scene_move_lights(window->scene, &window->desc->lights, window->frame);
    struct host_slot *slot = host_renderer_frame_begin(renderer, &camera, parts[window->shown]);
    if (!slot || !record_picture(window, slot->cmd, image))
        return false;
    if (!host_slot_submit(renderer, slot, semaphores) || !present(window, image))
        return false;
    tell_progress(window);
    return true;
}

static const char *gi_state(const struct window *window, char *text, size_t size)
{
    struct sdfgi_report report;
    if (!window->prepare.runs)
        return window->settings_error[0] ? "refused" : window->settings.enabled ? "on" : "off";
    host_gi_get_report(window->renderer->gi, &report);
    const struct sdfgi_progress *made = &report.prepared;
    snprintf(text, size, "%u %% made", made->total > 0 ? 100 * made->made / made->total : 0);
    return text;
}

static void show_title(struct window *window)
{
    const double now_s = glfwGetTime();
    char title[160], state[32];
    window->title_frames++;
    if (now_s - window->title_time_s < 0.25)
        return;
    snprintf(title, sizeof(title), "sdfgi - %.1f ms a frame, %.1f ms on the GPU - GI %s - %s",
             1e3 * (now_s - window->title_time_s) / window->title_frames,
             1e-6 * (double)window->renderer->times.frame_ns, gi_state(window, state, sizeof(state)),
             shows_debug(window) ? sdfgi_debug_view_name(window->debug)
                                 : host_aov_name(parts[window->shown]));
    glfwSetWindowTitle(window->glfw, title);
    window->title_time_s = now_s;
    window->title_frames = 0;
}

static bool step(struct window *window)
{
    const double now_s = glfwGetTime(), frame_s = now_s - window->time_s;
    host_fly_step(&window->camera, window->glfw, fmin(frame_s, 0.1), !window->overlay.takes_keys,
                  !window->overlay.takes_mouse);
    window->time_s = now_s;
    if (window->swapchain_stale && !follow_size(window))
        return false;
    if (window->swapchain.image_count == 0) {
        window->swapchain_stale = true;
        glfwWaitEventsTimeout(0.1);
        return true;
    }
    if (window->desc->camera && !window->desc->camera(window->desc->user, window->frame, &window->led)) {
        glfwSetWindowShouldClose(window->glfw, GLFW_TRUE);
        return true;
    }
    overlay_step(window, frame_s);
    settings_follow(window);
    if (!draw(window))
        return false;
    show_title(window);
    return true;
}

/* ---- Lifetime --------------------------------------------------------------------------------------- */

static bool renderer_open(struct window *window, const struct host_window_desc *desc)
{
    VkSurfaceKHR surface = VK_NULL_HANDLE;
    if (!host_check(window->device,
                    glfwCreateWindowSurface(window->device->instance, window->glfw, NULL, &surface),
                    "creating the window's surface") ||
        !host_swapchain_init(window->device, surface, &window->swapchain))
        return false;
    int width = 0, height = 0;
    glfwGetFramebufferSize(window->glfw, &width, &height);
    const struct host_renderer_desc renderer = { .width = width > 0 ? (uint32_t)width : 1,
                                                 .height = height > 0 ? (uint32_t)height : 1,
                                                 .settings = desc->settings,
                                                 .lookups = desc->lookups,
                                                 .eye_distance_m = desc->eye_distance_m,
                                                 .log = desc->log };
    window->scene = host_scene_create(window->device, desc->gltf, desc->view);
    window->renderer = window->scene ? host_renderer_create(window->device, window->scene, &renderer) : NULL;
    if (!window->renderer)
        return false;
    host_renderer_get_settings(window->renderer, &window->settings);
    window->wanted = window->settings;
    window->prepare.gi = host_gi_context(window->renderer->gi);
    window->debug = desc->debug ? *desc->debug : SDFGI_DEBUG_VIEW_COUNT;
    host_fly_init(&window->camera, &desc->view->camera, window->scene->radius);
    window->swapchain_stale = true;
    return host_pipeline_tonemap_create(window->device, &window->renderer->pipelines, window->swapchain.pass,
                                        &window->tonemap) &&
           overlay_begin(window);
}

static void renderer_close(struct window *window)
{
    host_prepare_finish(&window->prepare);
    vkDeviceWaitIdle(window->device->device);
    if (window->overlay_begun)
        window->desc->overlay->end(window->desc->overlay->user);
    vkDestroyPipeline(window->device->device, window->tonemap, NULL);
    host_renderer_destroy(window->renderer);
    host_scene_destroy(window->scene);
    if (window->swapchain.surface)
        host_swapchain_finish(window->device, &window->swapchain);
}

static bool device_run(struct window *window, const struct host_window_desc *desc, char *error,
                       size_t error_size)
{
    if (desc->device_info)
        host_device_get_info(window->device, desc->device_info);
    bool ok = renderer_open(window, desc);
    window->time_s = window->title_time_s = glfwGetTime();
    for (uint32_t frame = 0; ok && !glfwWindowShouldClose(window->glfw); frame++) {
        if (desc->frames > 0 && frame >= desc->frames)
            break;
        glfwPollEvents();
        if (desc->stop && desc->stop())
            break;
        ok = step(window);
    }
    if (!ok)
        snprintf(error, error_size, "%s", window->device->error);
    renderer_close(window);
    const uint32_t messages = host_device_validation_count(window->device);
    if (ok && messages > 0)
        snprintf(error, error_size, "the validation layer had %u messages", messages);
    return ok && messages == 0;
}

static bool window_run(struct window *window, const struct host_window_desc *desc, char *error,
                       size_t error_size)
{
    uint32_t count = 0;
    const char **extensions = glfwGetRequiredInstanceExtensions(&count);
    if (!glfwVulkanSupported() || !extensions) {
        snprintf(error, error_size, "this window system cannot show Vulkan pictures");
        return false;
    }
    glfwWindowHint(GLFW_CLIENT_API, GLFW_NO_API);
    window->glfw = glfwCreateWindow(desc->width > 0 ? (int)desc->width : 1280,
                                    desc->height > 0 ? (int)desc->height : 720, "sdfgi", NULL, NULL);
    if (!window->glfw) {
        snprintf(error, error_size, "the window could not be opened");
        return false;
    }
    glfwSetWindowUserPointer(window->glfw, window);
    glfwSetKeyCallback(window->glfw, key_received);
    glfwSetFramebufferSizeCallback(window->glfw, size_changed);
    const struct host_device_desc device = { .select = desc->device_select,
                                             .cache_folder = desc->cache_folder,
                                             .validation = desc->validation,
                                             .instance_extensions = extensions,
                                             .instance_extension_count = count };
    window->device = host_device_create(&device, error, error_size);
    const bool ok = window->device && device_run(window, desc, error, error_size);
    host_device_destroy(window->device);
    glfwDestroyWindow(window->glfw);
    return ok;
}

bool host_window_run(const struct host_window_desc *desc, char *error, size_t error_size)
{
    struct window *window = calloc(1, sizeof(*window));
    if (window)
        window->desc = desc;
    if (!window || !glfwInit()) {
        snprintf(error, error_size,
                 window ? "no window system: is DISPLAY or WAYLAND_DISPLAY set?" : "out of host memory");
        free(window);
        return false;
    }
    const bool ok = window_run(window, desc, error, error_size);
    glfwTerminate();
    free(window);
    return ok;
}
