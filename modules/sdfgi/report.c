/* SPDX-License-Identifier: MIT
 * sdfgi_get_report. */
#include "internal.h"

#include <math.h>
#include <string.h>

_Static_assert((int)PASS_COUNT <= (int)SDFGI_MAX_PASSES, "the report has room for every pass");

static void report_passes(const struct sdfgi *gi, struct sdfgi_report *report)
{
    report->pass_count = PASS_COUNT;
    for (int i = 0; i < PASS_COUNT; i++)
        report->passes[i] = (struct sdfgi_pass_report){
            .name = pass_name((enum pass)i),
            .ran = gi->passes[i].dispatches > 0,
            .reason = gi->plan[i].reason ? gi->plan[i].reason : "no frame has been recorded",
            .dispatches = gi->passes[i].dispatches,
            .work = gi->passes[i].work,
            .work_unit = pass_unit((enum pass)i),
            .gpu_ns = gi->passes[i].gpu_ns,
            .gpu_ns_valid = gi->passes[i].gpu_ns_valid,
        };
}

static void add_memory(const struct resources *r, struct sdfgi_memory *memory)
{
    for (int i = 0; i < RESOURCE_COUNT; i++)
        memory->bytes[resource_category((enum resource)i)] += r->buffers[i].size;
    memory->bytes[SDFGI_MEMORY_READBACK] += r->readback.size;
}

static void report_memory(const struct sdfgi *gi, struct sdfgi_memory *memory)
{
    if (gi->resources)
        add_memory(gi->resources, memory);
    for (const struct resources *r = gi->retired; r; r = r->next_retired)
        add_memory(r, memory);
    for (int i = 0; i < SDFGI_MEMORY_CATEGORY_COUNT; i++)
        memory->total_bytes += memory->bytes[i];
}

static void add_health(struct sdfgi_report *report, enum sdfgi_message code, uint64_t count)
{
    if (count > 0)
        report->health[report->health_count++] = (struct sdfgi_health){ code, count, message_hint(code) };
}

static bool has_light(const struct sdfgi *gi)
{
    static const struct sdfgi_sky none;
    const bool sky = gi->settings.read_sky_light && memcmp(&gi->scene.sky, &none, sizeof none) != 0;
    return gi->scene.lights.count > 0 || gi->emission_unit > 0 || sky;
}

static void report_health(const struct sdfgi *gi, struct sdfgi_report *report)
{
    if (!gi->active)
        return;
    const uint32_t *n = gi->counters;
    uint64_t overflow = 0, cells = 0;
    for (uint32_t c = 0; c < gi->settings.cascades; c++) {
        const uint64_t count = n[SDFGI_COUNTER_LIGHT_CELLS + c], room = gi->resources->extent.light_cells;
        cells += count;
        overflow += count > room ? count - room : 0;
    }
    add_health(report, SDFGI_MESSAGE_NO_GEOMETRY, gi->known_ring > 0 && cells == 0);
    add_health(report, SDFGI_MESSAGE_NO_LIGHTS, !has_light(gi));
    add_health(report, SDFGI_MESSAGE_LIGHT_CELLS_OVERFLOW, overflow);
    add_health(report, SDFGI_MESSAGE_TRIANGLES_SKIPPED, n[SDFGI_COUNTER_TRIANGLES_SKIPPED]);
    add_health(report, SDFGI_MESSAGE_VALUE_CLAMPED, n[SDFGI_COUNTER_VALUES_CLAMPED]);
    add_health(report, SDFGI_MESSAGE_BOUNCE_CLAMPED, n[SDFGI_COUNTER_BOUNCE_CLAMPED]);
    add_health(report, SDFGI_MESSAGE_TRACE_CAP_REACHED, n[SDFGI_COUNTER_TRACE_CAPS]);
    add_health(report, SDFGI_MESSAGE_UNLIT_HITS, n[SDFGI_COUNTER_UNLIT_HITS]);
}

/* Change shrinks by about the same factor from ring to ring: its logarithm measures the way. */
static float converged_fraction(const struct sdfgi *gi)
{
    if (gi->converged)
        return border_rests(gi) ? 1.0f : 0.99f;
    if (gi->known_ring <= gi->disturbed_ring || gi->known_change >= 1.0f)
        return 0.0f;
    const float way = logf(fmaxf(gi->known_change, 1e-6f)) / logf(SDFGI_CONVERGED_CHANGE);
    return fminf(fmaxf(way, 0.0f), 0.99f);
}

static void report_scroll(const struct sdfgi *gi, struct sdfgi_scroll_report *scroll)
{
    scroll->steps_begun = gi->schedule.steps_begun;
    scroll->cells = gi->schedule.cells;
    scroll->budget_cells = gi->settings.max_scroll_cells;
    for (uint32_t c = 0; c < gi->settings.cascades; c++) {
        scroll->pending_cells += gi->cascades[c].change.cells_left;
        scroll->cascades_changing += gi->cascades[c].change.active;
        scroll->cascades_waiting += gi->cascades[c].waits;
    }
}

void sdfgi_get_report(const sdfgi *gi, struct sdfgi_report *report)
{
    memset(report, 0, sizeof *report);
    report->update_count = gi->update_count;
    report->active = gi->active;
    report->converged = gi->active && gi->converged && border_rests(gi);
    report->converged_fraction = gi->active ? converged_fraction(gi) : 0.0f;
    report->command_count = gi->command_count;
    report_passes(gi, report);
    report_memory(gi, &report->memory);
    report_health(gi, report);
    if (gi->resources)
        report_scroll(gi, &report->scroll);
}
