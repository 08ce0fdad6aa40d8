// SPDX-License-Identifier: MIT
// What the library reports of a frame: passes with reasons and times, health, memory.
#include "panel.h"

#include <algorithm>
#include <cinttypes>
#include <cstdio>

namespace
{

const double bytes_per_mib = 1024.0 * 1024.0;

void plot(const char *id, const panel_times &times, int next, ImVec2 size)
{
    ImGui::PlotLines(id, times.ms, PANEL_FRAMES, next, nullptr, 0, FLT_MAX, size);
}

float newest(const panel_times &times, int next)
{
    return times.ms[(next + PANEL_FRAMES - 1) % PANEL_FRAMES];
}

/* A curve, name and milliseconds in a line, and below it why. */
void show_pass(const panel &panel, int index, const sdfgi_pass_report &pass)
{
    const ImVec4 color = ImGui::GetStyleColorVec4(pass.ran ? ImGuiCol_Text : ImGuiCol_TextDisabled);
    ImGui::PushID(index);
    plot("##times", panel.passes[index], panel.next, ImVec2(80, 16));
    ImGui::SameLine();
    ImGui::TextColored(color, "%7.3f ms %s", static_cast<double>(newest(panel.passes[index], panel.next)),
                       pass.name);
    ImGui::Indent();
    panel_small_print("%s", pass.reason);
    if (pass.ran)
        panel_small_print("%u dispatches, %" PRIu64 " %s", pass.dispatches, pass.work, pass.work_unit);
    ImGui::Unindent();
    ImGui::PopID();
}

void show_total(const panel &panel, const sdfgi_report &report)
{
    const float most = *std::max_element(panel.all.ms, panel.all.ms + PANEL_FRAMES);
    ImGui::TextWrapped("All passes: %.2f ms, %.2f at most, %u commands",
                       static_cast<double>(newest(panel.all, panel.next)), static_cast<double>(most),
                       report.command_count);
    plot("##all", panel.all, panel.next, ImVec2(ImGui::GetContentRegionAvail().x, 70));
}

} // namespace

void panel_times_add(panel &panel, const sdfgi_report &report)
{
    float sum = 0;
    for (uint32_t i = 0; i < report.pass_count; i++) {
        const sdfgi_pass_report &pass = report.passes[i];
        const float ms = pass.gpu_ns_valid ? 1e-6f * static_cast<float>(pass.gpu_ns) : 0;
        panel.passes[i].ms[panel.next] = ms;
        sum += ms;
    }
    panel.all.ms[panel.next] = sum;
    panel.next = (panel.next + 1) % PANEL_FRAMES;
}

/* Those that ran first. */
void panel_passes(panel &panel, editor_frame &frame)
{
    const sdfgi_report &report = *frame.report;
    show_total(panel, report);
    for (bool ran : { true, false })
        for (uint32_t i = 0; i < report.pass_count; i++)
            if (report.passes[i].ran == ran)
                show_pass(panel, static_cast<int>(i), report.passes[i]);
}

void panel_health(panel &, editor_frame &frame)
{
    const sdfgi_report &report = *frame.report;
    const sdfgi_scroll_report &scroll = report.scroll;
    ImGui::TextWrapped("%s, %.0f %% of the way", report.converged ? "converged" : "on its way",
                       100.0 * static_cast<double>(report.converged_fraction));
    ImGui::TextWrapped("cascades: %u changing, %u too slow for the camera", scroll.cascades_changing,
                       scroll.cascades_waiting);
    ImGui::TextWrapped("cells: %" PRIu64 " due, %" PRIu64 " done in this frame, %" PRIu64 " allowed",
                       scroll.pending_cells, scroll.cells, scroll.budget_cells);
    ImGui::Separator();
    if (report.health_count == 0)
        panel_small_print("Nothing is wrong.");
    for (uint32_t i = 0; i < report.health_count; i++) {
        panel_warning("%" PRIu64 " times", report.health[i].count);
        ImGui::Indent();
        ImGui::TextWrapped("%s", report.health[i].hint);
        ImGui::Unindent();
    }
}

void panel_memory(panel &, editor_frame &frame)
{
    const sdfgi_memory &memory = frame.report->memory;
    const double total = static_cast<double>(std::max<uint64_t>(memory.total_bytes, 1));
    for (int i = 0; i < SDFGI_MEMORY_CATEGORY_COUNT; i++) {
        char text[64];
        const double bytes = static_cast<double>(memory.bytes[i]);
        snprintf(text, sizeof text, "%.1f MiB", bytes / bytes_per_mib);
        ImGui::TextUnformatted(sdfgi_memory_category_name(static_cast<sdfgi_memory_category>(i)));
        ImGui::SameLine(90);
        ImGui::ProgressBar(static_cast<float>(bytes / total), ImVec2(-1, 0), text);
    }
    ImGui::Text("all: %.1f MiB", static_cast<double>(memory.total_bytes) / bytes_per_mib);
}
