// SPDX-License-Identifier: MIT
// Every row of the table of settings: a widget by its type, and what the row says about it.
#include "panel.h"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace
{

enum { VALUE_BYTES = 64 };

void show_bool(panel &panel, editor_frame &frame, const sdfgi_property_info &info)
{
    bool value = sdfgi_settings_get(&frame.settings, info.name) != 0;
    if (ImGui::Checkbox(value ? "on" : "off", &value))
        panel_set(panel, frame, info.name, value ? "true" : "false");
}

/* The next of some words between commas; false at the end. */
bool next_word(const char **words, char word[VALUE_BYTES])
{
    *words += std::strspn(*words, ", ");
    const size_t length = std::strcspn(*words, ",");
    if (length == 0 || length >= VALUE_BYTES)
        return false;
    std::memcpy(word, *words, length);
    word[length] = '\0';
    *words += length;
    return true;
}

void show_choices(panel &panel, editor_frame &frame, const sdfgi_property_info &info)
{
    char value[VALUE_BYTES] = "", word[VALUE_BYTES];
    sdfgi_settings_format(&frame.settings, info.name, value, sizeof value);
    if (!ImGui::BeginCombo("##value", value))
        return;
    for (const char *words = info.choices; next_word(&words, word);) {
        if (ImGui::Selectable(word, std::strcmp(word, value) == 0))
            panel_set(panel, frame, info.name, word);
        panel_place_add(panel, "choice", word);
    }
    ImGui::EndCombo();
}

/* Sliders over several powers of ten are logarithmic. */
ImGuiSliderFlags slider_flags(const sdfgi_property_info &info)
{
    const bool wide = info.minimum > 0 && info.maximum / info.minimum >= 1000;
    return ImGuiSliderFlags_AlwaysClamp | (wide ? ImGuiSliderFlags_Logarithmic : 0);
}

bool slide(const sdfgi_property_info &info, double *value)
{
    if (info.type == SDFGI_PROPERTY_INT) {
        int number = static_cast<int>(std::lround(*value));
        const bool moved = ImGui::SliderInt("##value", &number, static_cast<int>(info.minimum),
                                            static_cast<int>(info.maximum), "%d", slider_flags(info));
        *value = number;
        return moved;
    }
    float number = static_cast<float>(*value);
    const bool moved = ImGui::SliderFloat("##value", &number, static_cast<float>(info.minimum),
                                          static_cast<float>(info.maximum), "%.4g", slider_flags(info));
    *value = static_cast<double>(number);
    return moved;
}

/* What rebuilds everything is applied when the slider is let go. */
void show_number(panel &panel, editor_frame &frame, const sdfgi_property_info &info, panel_edit &edit)
{
    char text[VALUE_BYTES];
    double value = edit.active ? edit.value : sdfgi_settings_get(&frame.settings, info.name);
    const bool moved = slide(info, &value);
    edit = { ImGui::IsItemActive(), value };
    if (info.recreates ? !ImGui::IsItemDeactivatedAfterEdit() : !moved)
        return;
    snprintf(text, sizeof text, "%.9g", value);
    panel_set(panel, frame, info.name, text);
}

void show_widget(panel &panel, editor_frame &frame, const sdfgi_property_info &info, panel_edit &edit)
{
    ImGui::SetNextItemWidth(std::min(300.0f, ImGui::GetContentRegionAvail().x));
    if (info.type == SDFGI_PROPERTY_BOOL)
        show_bool(panel, frame, info);
    else if (info.choices[0] != '\0')
        show_choices(panel, frame, info);
    else
        show_number(panel, frame, info, edit);
    panel_place_add(panel, "property", info.name);
}

/* What the table says about it. */
void show_text(const sdfgi_property_info &info)
{
    panel_small_print("%s", info.description);
    if (info.choices[0] != '\0')
        panel_small_print("One of %s.", info.choices);
    else if (info.type != SDFGI_PROPERTY_BOOL)
        panel_small_print("%g to %g%s%s.", info.minimum, info.maximum, info.unit[0] ? " " : "", info.unit);
    if (info.buys[0] != '\0')
        panel_small_print("Buys: %s", info.buys);
    if (info.costs[0] != '\0')
        panel_small_print("Costs: %s", info.costs);
}

} // namespace

void panel_properties(panel &panel, editor_frame &frame)
{
    const sdfgi_property_info *info;
    if (!panel.error.empty())
        panel_warning("%s", panel.error.c_str());
    for (uint32_t i = 0; i < PANEL_PROPERTIES_MAX && (info = sdfgi_property_get_info(i)); i++) {
        ImGui::PushID(info->name);
        ImGui::TextUnformatted(info->name);
        ImGui::SameLine();
        ImGui::TextDisabled("%s%s", info->recreates ? "rebuilds all" : "live",
                            info->derived ? ", sets another" : "");
        ImGui::Indent();
        show_widget(panel, frame, *info, panel.edits[i]);
        show_text(*info);
        ImGui::Unindent();
        ImGui::Separator();
        ImGui::PopID();
    }
}
