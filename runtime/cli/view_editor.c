/* SPDX-License-Identifier: MIT */
#include "view_editor.h"

#include <editor.h>

static bool begin(void *user, struct GLFWwindow *window, const struct host_overlay_vulkan *vulkan,
                  char *error, size_t error_size)
{
    struct view_editor *view = user;
    const struct editor_vulkan with = { .instance = vulkan->instance,
                                        .physical_device = vulkan->physical_device,
                                        .device = vulkan->device,
                                        .queue_family = vulkan->queue_family,
                                        .queue = vulkan->queue,
                                        .pipeline_cache = vulkan->pipeline_cache,
                                        .pass = vulkan->pass,
                                        .frames_in_flight = vulkan->frames_in_flight };
    view->editor = editor_create(window, &with, error, error_size);
    return view->editor != NULL;
}

/* Those of the host's effects that the picture may have. */
static uint32_t switches_fill(const struct host_overlay_frame *host, struct editor_switch switches[static 2])
{
    uint32_t count = 0;
    if (host->possible.reflections)
        switches[count++] =
            (struct editor_switch){ .name = "Reflections",
                                    .text = "What smooth opaque surfaces reflect. Off, they "
                                            "reflect as much as rough ones. The time has that of "
                                            "diffuse light in it, which is looked up beside rays.",
                                    .passes = { "reflect_tiles", "reflect_rays", "reflect_filter" },
                                    .on = !host->left_out.reflections };
    if (host->possible.fog)
        switches[count++] = (struct editor_switch){ .name = "Fog",
                                                    .text = "The fog of the view file, lit by sun, lamps "
                                                            "and indirect light.",
                                                    .on = !host->left_out.fog };
    return count;
}

/* In the order in which they were filled. */
static void switches_read(const struct editor_switch *switches, struct host_overlay_frame *host)
{
    if (host->possible.reflections)
        host->left_out.reflections = !(switches++)->on;
    if (host->possible.fog)
        host->left_out.fog = !switches->on;
}

static void frame(void *user, struct host_overlay_frame *host)
{
    struct view_editor *view = user;
    struct editor_switch switches[2];
    struct editor_frame shown = { .open = host->open,
                                  .settings = host->settings,
                                  .view = host->debug,
                                  .report = host->report,
                                  .gpu_ns = host->gpu_ns,
                                  .frame_s = host->frame_s,
                                  .error = host->error,
                                  .switches = switches,
                                  .switch_count = switches_fill(host, switches) };
    editor_show(view->editor, &shown);
    host->open = shown.open;
    host->settings = shown.settings;
    host->debug = shown.view;
    switches_read(switches, host);
    host->takes_mouse = shown.takes_mouse;
    host->takes_keys = shown.takes_keys;
}

static void record(void *user, VkCommandBuffer cmd)
{
    const struct view_editor *view = user;
    editor_record(view->editor, cmd);
}

static void end(void *user)
{
    struct view_editor *view = user;
    editor_destroy(view->editor);
    view->editor = NULL;
}

struct host_overlay view_editor_overlay(struct view_editor *editor)
{
    return (struct host_overlay){ begin, frame, record, end, editor };
}
