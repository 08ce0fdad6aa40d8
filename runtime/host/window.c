/* SPDX-License-Identifier: MIT
 * `sdfgi view`: a window with a camera that flies.
 *
 * G switches global illumination, F1 walks through the views, WASD moves, Q and E sink and rise, Shift
 * hurries, a held mouse button turns, Escape closes. */
#define GLFW_INCLUDE_VULKAN
#include <GLFW/glfw3.h>

#include "host_math.h"
#include "host_swapchain.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

struct fly_camera {
    double position[3];
    double yaw, pitch; /* radians; yaw 0 looks along -Z */
    float yfov_rad;
    double speed_m_s;
};

struct window {
    const struct host_window_desc *desc;
    GLFWwindow *glfw;
    struct host_device *device;
    struct host_scene *scene;
    struct host_renderer *renderer;
    struct host_swapchain swapchain;
    VkPipeline tonemap;
    struct sdfgi_settings settings;
    struct fly_camera camera;
    struct host_camera led; /* where desc->camera leads */
    uint32_t frame;         /* how many have been drawn */
    uint32_t shown;         /* index into views */
    bool toggle_gi, swapchain_stale;
    double cursor[2], time_s, title_time_s;
    uint32_t title_frames;
};

static const enum host_aov views[] = { HOST_AOV_COLOR, HOST_AOV_IRRADIANCE, HOST_AOV_DIFFUSE_INDIRECT,
                                       HOST_AOV_NORMAL, HOST_AOV_ALBEDO };

/* ---- Input ------------------------------------------------------------------------------------------ */

static void key_received(GLFWwindow *glfw, int key, int scancode, int action, int mods)
{
    struct window *window = glfwGetWindowUserPointer(glfw);
    (void)scancode;
    (void)mods;
    if (action != GLFW_PRESS)
        return;
    if (key == GLFW_KEY_G)
        window->toggle_gi = true;
    if (key == GLFW_KEY_F1)
        window->shown = (window->shown + 1) % HOST_COUNT(views);
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

static void fly_forward(const struct fly_camera *camera, double out[3])
{
    out[0] = sin(camera->yaw) * cos(camera->pitch);
    out[1] = sin(camera->pitch);
    out[2] = -cos(camera->yaw) * cos(camera->pitch);
}

static void fly_init(struct fly_camera *camera, const struct host_camera *from, double scene_radius)
{
    double forward[3];
    for (int i = 0; i < 3; i++) {
        camera->position[i] = from->position[i];
        forward[i] = from->look_at[i] - from->position[i];
    }
    host_normalize3(forward);
    camera->yaw = atan2(forward[0], -forward[2]);
    camera->pitch = asin(fmin(fmax(forward[1], -1.0), 1.0));
    camera->yfov_rad = from->yfov_rad;
    camera->speed_m_s = fmin(fmax(scene_radius * 0.2, 0.5), 10.0);
}

static double key_axis(GLFWwindow *glfw, int more, int less)
{
    return (glfwGetKey(glfw, more) == GLFW_PRESS) - (glfwGetKey(glfw, less) == GLFW_PRESS);
}

static void fly_turn(struct window *window)
{
    double cursor[2];
    glfwGetCursorPos(window->glfw, &cursor[0], &cursor[1]);
    const bool held = glfwGetMouseButton(window->glfw, GLFW_MOUSE_BUTTON_LEFT) == GLFW_PRESS ||
                      glfwGetMouseButton(window->glfw, GLFW_MOUSE_BUTTON_RIGHT) == GLFW_PRESS;
    if (held) {
        window->camera.yaw += 0.003 * (cursor[0] - window->cursor[0]);
        window->camera.pitch -= 0.003 * (cursor[1] - window->cursor[1]);
        window->camera.pitch = fmin(fmax(window->camera.pitch, -1.55), 1.55);
    }
    memcpy(window->cursor, cursor, sizeof(cursor));
}

static void fly_move(struct window *window, double seconds)
{
    struct fly_camera *camera = &window->camera;
    const bool hurry = glfwGetKey(window->glfw, GLFW_KEY_LEFT_SHIFT) == GLFW_PRESS;
    const double step_m = camera->speed_m_s * (hurry ? 5.0 : 1.0) * seconds;
    const double ahead = key_axis(window->glfw, GLFW_KEY_W, GLFW_KEY_S);
    const double aside = key_axis(window->glfw, GLFW_KEY_D, GLFW_KEY_A);
    const double above = key_axis(window->glfw, GLFW_KEY_E, GLFW_KEY_Q);
    double forward[3];
    fly_forward(camera, forward);
    camera->position[0] += step_m * (ahead * forward[0] + aside * cos(camera->yaw));
    camera->position[1] += step_m * (ahead * forward[1] + above);
    camera->position[2] += step_m * (ahead * forward[2] + aside * sin(camera->yaw));
}

static struct host_camera fly_resolve(const struct fly_camera *camera)
{
    struct host_camera out = { .up = { 0, 1, 0 }, .yfov_rad = camera->yfov_rad };
    double forward[3];
    fly_forward(camera, forward);
    for (int i = 0; i < 3; i++) {
        out.position[i] = camera->position[i];
        out.look_at[i] = camera->position[i] + forward[i];
    }
    return out;
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

static void record_picture(struct window *window, VkCommandBuffer cmd, uint32_t image)
{
    const struct host_swapchain *swapchain = &window->swapchain;
    const VkRenderPassBeginInfo begin = {
        .sType = VK_STRUCTURE_TYPE_RENDER_PASS_BEGIN_INFO,
        .renderPass = swapchain->pass,
        .framebuffer = swapchain->framebuffers[image],
        .renderArea = { { 0, 0 }, { swapchain->width, swapchain->height } },
    };
    /* Reflectances and directions are shown as they are. */
    const enum host_aov shown = views[window->shown];
    const bool fixed = shown == HOST_AOV_NORMAL || shown == HOST_AOV_ALBEDO;
    host_exposure_record(window->renderer, cmd);
    vkCmdBeginRenderPass(cmd, &begin, VK_SUBPASS_CONTENTS_INLINE);
    host_tonemap_record(window->renderer, cmd, window->tonemap, fixed ? 1.0f : 0.0f);
    vkCmdEndRenderPass(cmd);
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
    const struct host_camera camera = window->desc->camera ? window->led : fly_resolve(&window->camera);
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
    struct host_slot *slot = host_renderer_frame_begin(renderer, &camera, views[window->shown]);
    if (!slot)
        return false;
    record_picture(window, slot->cmd, image);
    if (!host_slot_submit(renderer, slot, semaphores) || !present(window, image))
        return false;
    tell_progress(window);
    return true;
}

static void show_title(struct window *window)
{
    const double now_s = glfwGetTime();
    char title[160];
    window->title_frames++;
    if (now_s - window->title_time_s < 0.25)
        return;
    snprintf(title, sizeof(title), "sdfgi - %.1f ms a frame, %.1f ms on the GPU - GI %s - %s",
             1e3 * (now_s - window->title_time_s) / window->title_frames,
             1e-6 * (double)window->renderer->times.frame_ns, window->settings.enabled ? "on" : "off",
             host_aov_name(views[window->shown]));
    glfwSetWindowTitle(window->glfw, title);
    window->title_time_s = now_s;
    window->title_frames = 0;
}

static bool toggle_gi(struct window *window)
{
    window->toggle_gi = false;
    window->settings.enabled = !window->settings.enabled;
    return host_renderer_set_settings(window->renderer, &window->settings);
}

static bool step(struct window *window)
{
    const double now_s = glfwGetTime();
    fly_turn(window);
    fly_move(window, fmin(now_s - window->time_s, 0.1));
    window->time_s = now_s;
    if (window->toggle_gi && !toggle_gi(window))
        return false;
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
                                                 .lookup = desc->lookup,
                                                 .log = desc->log };
    window->scene = host_scene_create(window->device, desc->gltf, desc->view);
    window->renderer = window->scene ? host_renderer_create(window->device, window->scene, &renderer) : NULL;
    if (!window->renderer)
        return false;
    host_renderer_get_settings(window->renderer, &window->settings);
    fly_init(&window->camera, &desc->view->camera, window->scene->radius);
    window->swapchain_stale = true;
    return host_pipeline_tonemap_create(window->device, &window->renderer->pipelines, window->swapchain.pass,
                                        &window->tonemap);
}

static void renderer_close(struct window *window)
{
    vkDeviceWaitIdle(window->device->device);
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
