// SPDX-License-Identifier: MIT
// The panel as a whole: Dear ImGui with its backends for GLFW and Vulkan, and the window with its tabs.
#include "editor.h"

#include "panel.h"

#include <backends/imgui_impl_glfw.h>
#include <backends/imgui_impl_vulkan.h>

#include <algorithm>
#include <cstdarg>
#include <cstdio>
#include <cstring>
#include <new>

struct editor {
    editor_vulkan vulkan;
    VkDescriptorPool pool;
    VkCommandPool commands;
    bool has_glfw, has_vulkan; /* the backends are up */
    bool laid_out;             /* there is something to record */
    VkResult failure;          /* of a call of the backend's, which it tells in no other way */
    struct panel panel;
};

namespace
{

void note_result(VkResult result)
{
    if (result != VK_SUCCESS)
        static_cast<editor *>(ImGui::GetIO().UserData)->failure = result;
}

/* ---- Making it */

bool pool_create(editor &e)
{
    const VkDescriptorPoolSize size = { VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, 1 };
    VkDescriptorPoolCreateInfo info = {};
    info.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO;
    info.flags = VK_DESCRIPTOR_POOL_CREATE_FREE_DESCRIPTOR_SET_BIT;
    info.maxSets = 1;
    info.poolSizeCount = 1;
    info.pPoolSizes = &size;
    VkCommandPoolCreateInfo commands = {};
    commands.sType = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO;
    commands.queueFamilyIndex = e.vulkan.queue_family;
    return vkCreateDescriptorPool(e.vulkan.device, &info, nullptr, &e.pool) == VK_SUCCESS &&
           vkCreateCommandPool(e.vulkan.device, &commands, nullptr, &e.commands) == VK_SUCCESS;
}

bool backends_init(editor &e, GLFWwindow *window)
{
    ImGui_ImplVulkan_InitInfo info = {};
    info.Instance = e.vulkan.instance;
    info.PhysicalDevice = e.vulkan.physical_device;
    info.Device = e.vulkan.device;
    info.QueueFamily = e.vulkan.queue_family;
    info.Queue = e.vulkan.queue;
    info.PipelineCache = e.vulkan.pipeline_cache;
    info.DescriptorPool = e.pool;
    info.MinImageCount = 2;
    info.ImageCount = std::max(2u, e.vulkan.frames_in_flight + 1); /* so many buffers take turns */
    info.MSAASamples = VK_SAMPLE_COUNT_1_BIT;
    info.CheckVkResultFn = note_result;
    e.has_glfw = ImGui_ImplGlfw_InitForVulkan(window, true);
    e.has_vulkan = e.has_glfw && ImGui_ImplVulkan_Init(&info, e.vulkan.pass);
    return e.has_vulkan && e.failure == VK_SUCCESS;
}

/* Uploads the font, and waits for it. */
bool font_upload(editor &e)
{
    VkCommandBuffer cmd;
    VkCommandBufferAllocateInfo allocate = {};
    allocate.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO;
    allocate.commandPool = e.commands;
    allocate.commandBufferCount = 1;
    VkCommandBufferBeginInfo begin = {};
    begin.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO;
    VkSubmitInfo submit = {};
    submit.sType = VK_STRUCTURE_TYPE_SUBMIT_INFO;
    submit.commandBufferCount = 1;
    submit.pCommandBuffers = &cmd;
    const bool done = vkAllocateCommandBuffers(e.vulkan.device, &allocate, &cmd) == VK_SUCCESS &&
                      vkBeginCommandBuffer(cmd, &begin) == VK_SUCCESS &&
                      ImGui_ImplVulkan_CreateFontsTexture(cmd) && vkEndCommandBuffer(cmd) == VK_SUCCESS &&
                      vkQueueSubmit(e.vulkan.queue, 1, &submit, VK_NULL_HANDLE) == VK_SUCCESS &&
                      vkQueueWaitIdle(e.vulkan.queue) == VK_SUCCESS;
    ImGui_ImplVulkan_DestroyFontUploadObjects();
    return done && e.failure == VK_SUCCESS;
}

/* ---- Laying it out */

/* How much of what GI needs has been made, while it is made ahead of the switch. */
void show_progress(panel &panel, const sdfgi_progress &prepared)
{
    char text[64];
    snprintf(text, sizeof text, "GI: %u of %u pipelines and buffers", prepared.made, prepared.total);
    ImGui::ProgressBar(static_cast<float>(prepared.made) / static_cast<float>(prepared.total), ImVec2(-1, 0),
                       text);
    panel_place_add(panel, "progress", "GI");
}

void show_summary(panel &panel, const editor_frame &frame)
{
    const double frame_ms = 1e3 * frame.frame_s, gpu_ms = 1e-6 * static_cast<double>(frame.gpu_ns);
    ImGui::TextWrapped("%.1f ms a frame, %.1f ms on the GPU, light %s", frame_ms, gpu_ms,
                       !frame.report->active     ? "off"
                       : frame.report->converged ? "converged"
                                                 : "on its way");
    if (!frame.report->active && frame.report->prepared.total > 0)
        show_progress(panel, frame.report->prepared);
    if (frame.error)
        panel_warning("refused: %s", frame.error);
}

void show_tabs(panel &panel, editor_frame &frame)
{
    static const struct {
        const char *name;
        panel_part *show;
    } tabs[] = { { "Views", panel_views },
                 { "Properties", panel_properties },
                 { "Passes", panel_passes },
                 { "Health", panel_health },
                 { "Memory", panel_memory } };
    for (const auto &tab : tabs) {
        const bool open = ImGui::BeginTabItem(tab.name);
        panel_place_add(panel, "tab", tab.name);
        if (!open)
            continue;
        ImGui::BeginChild("content");
        tab.show(panel, frame);
        ImGui::EndChild();
        ImGui::EndTabItem();
    }
}

void show_window(panel &panel, editor_frame &frame)
{
    const ImVec2 display = ImGui::GetIO().DisplaySize;
    ImGui::SetNextWindowPos(ImVec2(8, 8), ImGuiCond_Once);
    ImGui::SetNextWindowSize(ImVec2(std::min(460.0f, 0.65f * display.x), display.y - 16), ImGuiCond_Once);
    ImGui::SetNextWindowBgAlpha(0.92f);
    if (ImGui::Begin("sdfgi", &frame.open)) {
        show_summary(panel, frame);
        panel_effects(panel, frame);
        if (ImGui::BeginTabBar("tabs")) {
            show_tabs(panel, frame);
            ImGui::EndTabBar();
        }
    }
    ImGui::End();
}

} // namespace

/* Widgets that are scrolled out of sight are nowhere. */
void panel_place_add(panel &panel, const char *kind, const char *name)
{
    const ImVec2 low = ImGui::GetItemRectMin(), high = ImGui::GetItemRectMax(), at = ImGui::GetWindowPos(),
                 size = ImGui::GetWindowSize();
    const ImVec2 middle((low.x + high.x) / 2, (low.y + high.y) / 2);
    if (middle.x >= at.x && middle.x < at.x + size.x && middle.y >= at.y && middle.y < at.y + size.y)
        panel.places.push_back({ std::string(kind) + ":" + name, middle });
}

void panel_set(panel &panel, editor_frame &frame, const char *property, const char *value)
{
    char error[256] = "";
    sdfgi_settings_set(&frame.settings, property, value, error, sizeof error);
    panel.error = error;
}

static void text_wrapped(ImVec4 color, const char *format, va_list arguments)
{
    ImGui::PushStyleColor(ImGuiCol_Text, color);
    ImGui::TextWrappedV(format, arguments);
    ImGui::PopStyleColor();
}

void panel_small_print(const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    text_wrapped(ImGui::GetStyleColorVec4(ImGuiCol_TextDisabled), format, arguments);
    va_end(arguments);
}

void panel_warning(const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    text_wrapped(ImVec4(1, 0.6f, 0.2f, 1), format, arguments);
    va_end(arguments);
}

struct editor *editor_create(GLFWwindow *window, const editor_vulkan *vulkan, char *error, size_t error_size)
{
    editor *e = new (std::nothrow) editor();
    bool made = false;
    if (e) {
        e->vulkan = *vulkan;
        ImGui::CreateContext();
        ImGui::GetIO().UserData = e;
        ImGui::GetIO().IniFilename = nullptr; /* no file is written */
        made = pool_create(*e) && backends_init(*e, window) && font_upload(*e);
    }
    if (made)
        return e;
    editor_destroy(e);
    snprintf(error, error_size, "the panel could not be made: %s", e ? "Vulkan refused it" : "out of memory");
    return nullptr;
}

void editor_destroy(editor *e)
{
    if (!e)
        return;
    if (e->has_vulkan)
        ImGui_ImplVulkan_Shutdown();
    if (e->has_glfw)
        ImGui_ImplGlfw_Shutdown();
    ImGui::DestroyContext();
    vkDestroyCommandPool(e->vulkan.device, e->commands, nullptr);
    vkDestroyDescriptorPool(e->vulkan.device, e->pool, nullptr);
    delete e;
}

void editor_show(editor *e, editor_frame *frame)
{
    panel_times_add(e->panel, *frame->report);
    frame->takes_mouse = frame->takes_keys = e->laid_out = false;
    e->panel.places.clear();
    if (!frame->open)
        return;
    ImGui_ImplVulkan_NewFrame();
    ImGui_ImplGlfw_NewFrame();
    ImGui::NewFrame();
    show_window(e->panel, *frame);
    ImGui::Render();
    e->laid_out = true;
    frame->takes_mouse = ImGui::GetIO().WantCaptureMouse;
    frame->takes_keys = ImGui::GetIO().WantTextInput;
}

void editor_record(editor *e, VkCommandBuffer cmd)
{
    if (e->laid_out)
        ImGui_ImplVulkan_RenderDrawData(ImGui::GetDrawData(), cmd);
    e->laid_out = false;
}

bool editor_find(const editor *e, const char *name, float place[2])
{
    for (const panel_place &known : e->panel.places) {
        if (known.name != name)
            continue;
        place[0] = known.middle.x;
        place[1] = known.middle.y;
        return true;
    }
    return false;
}
