// SPDX-License-Identifier: MIT
// A button per effect that can be switched, and the choice of what is shown.
#include "panel.h"

#include <cstring>

namespace
{

/* What an effect of the library is switched by, and the passes that serve it. */
struct effect {
    const char *label, *property, *off, *on;
    const char *passes[4];
};

const effect effects[] = {
    { "GI", "sdfgi_enabled", "false", "true", {} },
    { "Sky light", "sdfgi_read_sky_light", "false", "true", {} },
    { "Bounces", "sdfgi_bounce_feedback", "0", "1", { "light_bounce" } },
    { "Occlusion", "sdfgi_use_occlusion", "false", "true", { "cell_mask", "occlusion_trace" } },
    { "Surface rays", "sdfgi_surface_light", "probes", "cells", { "cell_gather", "cell_filter" } },
    { "Lobes", "sdfgi_rough_lobes", "false", "true", { "reflect_lobes" } },
};

bool is_on(const effect &effect, const sdfgi_settings &settings)
{
    char text[64];
    return sdfgi_settings_format(&settings, effect.property, text, sizeof text) &&
           std::strcmp(text, effect.off) != 0;
}

const char *description(const char *property)
{
    const sdfgi_property_info *info;
    for (uint32_t i = 0; (info = sdfgi_property_get_info(i)); i++)
        if (std::strcmp(info->name, property) == 0)
            return info->description;
    return "";
}

/* Which of the passes ran, and why, or why not. */
void explain(const char *const passes[4], const sdfgi_report &report)
{
    for (int k = 0; k < 4 && passes[k]; k++)
        for (uint32_t i = 0; i < report.pass_count; i++)
            if (std::strcmp(report.passes[i].name, passes[k]) == 0)
                ImGui::Text("%s %s: %s", passes[k], report.passes[i].ran ? "ran" : "did not run",
                            report.passes[i].reason);
}

void show_tooltip(const editor_switch &button, const sdfgi_report &report)
{
    ImGui::BeginTooltip();
    ImGui::PushTextWrapPos(400);
    ImGui::TextUnformatted(button.text);
    explain(button.passes, report);
    ImGui::PopTextWrapPos();
    ImGui::EndTooltip();
}

/* In the same line as the button before, if it fits. True if it was clicked. */
bool show_button(const editor_switch &button, const sdfgi_report &report, bool first)
{
    const ImGuiStyle &style = ImGui::GetStyle();
    const float right = ImGui::GetWindowPos().x + ImGui::GetWindowContentRegionMax().x,
                width = ImGui::CalcTextSize(button.name).x + 2 * style.FramePadding.x + style.ItemSpacing.x;
    if (!first && ImGui::GetItemRectMax().x + width < right)
        ImGui::SameLine();
    ImGui::PushStyleColor(ImGuiCol_Button,
                          button.on ? ImVec4(0.15f, 0.45f, 0.2f, 1) : ImVec4(0.3f, 0.3f, 0.3f, 1));
    const bool clicked = ImGui::Button(button.name);
    ImGui::PopStyleColor();
    if (ImGui::IsItemHovered())
        show_tooltip(button, report);
    return clicked;
}

/* Off, or on again as it was. */
void toggle(panel &panel, editor_frame &frame, const effect &effect, bool on)
{
    char value[64] = "";
    std::string &before = panel.before[effect.property];
    if (!on)
        before = sdfgi_settings_format(&frame.settings, effect.property, value, sizeof value) ? value : "";
    panel_set(panel, frame, effect.property, !on ? effect.off : before.empty() ? effect.on : before.c_str());
}

void show_effect(panel &panel, editor_frame &frame, const effect &effect)
{
    editor_switch button = { effect.label, description(effect.property), {}, is_on(effect, frame.settings) };
    std::memcpy(button.passes, effect.passes, sizeof button.passes);
    if (show_button(button, *frame.report, &effect == effects))
        toggle(panel, frame, effect, !button.on);
    panel_place_add(panel, "effect", effect.property);
}

void show_radio(panel &panel, editor_frame &frame, sdfgi_debug_view view, const char *name, const char *text)
{
    if (ImGui::RadioButton(name, frame.view == view))
        frame.view = view;
    panel_place_add(panel, "view", name);
    ImGui::SameLine(170);
    panel_small_print("%s", text);
}

} // namespace

void panel_effects(panel &panel, editor_frame &frame)
{
    for (const effect &effect : effects)
        show_effect(panel, frame, effect);
    for (uint32_t i = 0; i < frame.switch_count; i++) {
        editor_switch &own = frame.switches[i];
        if (show_button(own, *frame.report, false))
            own.on = !own.on;
        panel_place_add(panel, "effect", own.name);
    }
}

void panel_views(panel &panel, editor_frame &frame)
{
    if (!frame.report->active)
        panel_small_print("GI is off: there is nothing but the picture.");
    show_radio(panel, frame, SDFGI_DEBUG_VIEW_COUNT, "picture", "what the host draws");
    for (int i = 0; i < SDFGI_DEBUG_VIEW_COUNT; i++) {
        const auto view = static_cast<sdfgi_debug_view>(i);
        show_radio(panel, frame, view, sdfgi_debug_view_name(view), sdfgi_debug_view_text(view));
    }
}
