/* SPDX-License-Identifier: MIT
 * A panel over a host's picture: every setting of the library, its debug views, what the frame did and why,
 * and what went wrong. Of the library it knows the public headers alone, so any host may have it. C, although
 * it is made with Dear ImGui.
 *
 * One panel at a time: Dear ImGui keeps global state. */
#ifndef EDITOR_H
#define EDITOR_H

#include <sdfgi/debug.h>
#include <sdfgi/sdfgi.h>

#ifdef __cplusplus
extern "C" {
#endif

struct GLFWwindow;
struct editor;

/* What the panel draws with. All of it outlives the panel. */
struct editor_vulkan {
    VkInstance instance;
    VkPhysicalDevice physical_device;
    VkDevice device;
    uint32_t queue_family;
    VkQueue queue; /* used by editor_create alone */
    VkPipelineCache pipeline_cache;
    VkRenderPass pass; /* one colour attachment, one subpass */
    uint32_t frames_in_flight;
};

/* An effect of the host's own. */
struct editor_switch {
    const char *name, *text; /* a word or two; what it is */
    const char *passes[4];   /* of the library that serve it; NULL where there are no more */
    bool on;                 /* changed by the user */
};

/* What the panel shows of a frame, and what the user changes in it. */
struct editor_frame {
    bool open;
    struct sdfgi_settings settings;    /* in force; changed by the user */
    enum sdfgi_debug_view view;        /* shown; SDFGI_DEBUG_VIEW_COUNT: the picture; changed by the user */
    const struct sdfgi_report *report; /* of the last update */
    uint64_t gpu_ns;                   /* of the newest finished frame; 0: not known */
    double frame_s;                    /* since the frame before */
    const char *error;                 /* why the host could not apply the last change; NULL: it could */
    struct editor_switch *switches;    /* for as many buttons beside those of the library's effects */
    uint32_t switch_count;
    bool takes_mouse, takes_keys; /* filled in: the pointer is over the panel, or text is typed */
};

/* NULL on failure, with one line in `error`. Callbacks of the window that were set before still get all
 * keys and clicks. */
struct editor *editor_create(struct GLFWwindow *window, const struct editor_vulkan *vulkan, char *error,
                             size_t error_size);
/* The device is idle. Accepts NULL. */
void editor_destroy(struct editor *editor);

/* Lays out the panel of a frame; then once at most: */
void editor_show(struct editor *editor, struct editor_frame *frame);
/* Records it, inside the render pass. */
void editor_record(struct editor *editor, VkCommandBuffer cmd);

/* Where the middle of a widget was in the last frame, in pixels of the window: for tests, and for tours.
 * Names are "tab:Views", "view:solid", "effect:sdfgi_enabled", "effect:Fog", "property:sdfgi_energy",
 * "choice:probes". False if it was not there. */
bool editor_find(const struct editor *editor, const char *name, float place[2]);

#ifdef __cplusplus
}
#endif
#endif
