/* SPDX-License-Identifier: MIT
 * sdfgi_get_report. */
#include "context.h"

#include <math.h>
#include <string.h>

_Static_assert((int)PASS_COUNT <= (int)SDFGI_MAX_PASSES, "the report has room for every pass");

static void report_passes(const struct sdfgi *gi, struct sdfgi_report *report)
{
    report->pass_count = PASS_COUNT;
    for (int i = 0; i < PASS_COUNT; i++) {
        const struct pass_report *pass = &gi->passes[i];
        const struct feedback_time *time = &gi->volume.feedback.times[i];
        report->passes[i] = (struct sdfgi_pass_report){
            .name = sdfgi_pass_row((enum pass)i)->name,
            .ran = pass->tally.dispatches > 0,
            .reason = pass->reason ? pass->reason : "no frame has been recorded",
            .dispatches = pass->tally.dispatches,
            .work = pass->tally.units,
            .work_unit = sdfgi_pass_unit_name(sdfgi_pass_row((enum pass)i)->unit),
            .gpu_ns = time->ns,
            .gpu_ns_valid = time->is_new,
        };
    }
}

/* ---- Health */

static void add_health(struct sdfgi_report *report, enum sdfgi_message code, uint64_t count)
{
    if (count > 0)
        report->health[report->health_count++] =
            (struct sdfgi_health){ code, count, sdfgi_message_hint(code) };
}

enum { SDFGI_MESSAGE_NONE = SDFGI_MESSAGE_COUNT };

/* Counters that a message reports. */
static void report_counters(const uint32_t *counters, struct sdfgi_report *report)
{
    static const struct {
        uint32_t counter, code;
    } rows[] = {
#define ROW(id, cleared, health) { SDFGI_COUNTER_##id, SDFGI_MESSAGE_##health },
        SDFGI_COUNTERS(ROW)
#undef ROW
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++)
        if (rows[i].code != SDFGI_MESSAGE_NONE)
            add_health(report, (enum sdfgi_message)rows[i].code, counters[rows[i].counter]);
}

static void report_health(const struct sdfgi *gi, struct sdfgi_report *report)
{
    const struct volume *volume = &gi->volume;
    const uint32_t *counters = volume->feedback.counters;
    uint64_t overflow = 0, cells = 0;
    for (uint32_t c = 0; c < volume->state.cascades.count; c++) {
        const uint64_t count = counters[SDFGI_COUNTER_LIGHT_CELLS + c],
                       room = volume->resources->extent.light_cells;
        cells += count;
        overflow += count > room ? count - room : 0;
    }
    add_health(report, SDFGI_MESSAGE_NO_GEOMETRY, volume->state.accumulation.known_cycle > 0 && cells == 0);
    add_health(report, SDFGI_MESSAGE_NO_LIGHTS,
               !sdfgi_scene_has_light(&gi->scene, gi->settings.read_sky_light));
    add_health(report, SDFGI_MESSAGE_LIGHT_CELLS_OVERFLOW, overflow);
    add_health(report, SDFGI_MESSAGE_UPDATE_LOST, gi->updates_lost);
    report_counters(counters, report);
}

/* ---- Convergence and scrolling */

/* Change shrinks by about the same factor from cycle to cycle: its logarithm measures how far light has come.
 */
static float converged_fraction(const struct volume *volume)
{
    const struct accumulation *a = &volume->state.accumulation;
    if (sdfgi_volume_has_converged(volume))
        return volume->state.scroll.blends_moving == 0 ? 1.0f : 0.99f;
    if (a->known_cycle <= a->invalid_cycle || a->known_change >= 1.0f)
        return 0.0f;
    const float done = logf(fmaxf(a->known_change, 1e-6f)) / logf(ACCUMULATION_CONVERGED_CHANGE);
    return fminf(fmaxf(done, 0.0f), 0.99f);
}

static void report_scroll(const struct sdfgi *gi, struct sdfgi_scroll_report *scroll)
{
    const struct cascades *cascades = &gi->volume.state.cascades;
    scroll->steps_begun = gi->volume.state.scroll.scrolls_begun;
    scroll->cells = gi->frame.scroll.cells;
    scroll->budget_cells = gi->settings.max_scroll_cells;
    for (uint32_t c = 0; c < cascades->count; c++) {
        scroll->pending_cells += cascades->at[c].change.cells_left;
        scroll->cascades_changing += cascades->at[c].change.cause != CHANGE_NONE;
        scroll->cascades_waiting += cascades->at[c].following != CASCADE_KEEPS_UP;
    }
}

void sdfgi_get_report(const sdfgi *gi, struct sdfgi_report *report)
{
    const bool active = sdfgi_is_active(gi);
    memset(report, 0, sizeof *report);
    report->update_count = gi->volume.state.updates;
    report->active = active;
    report->converged = active && sdfgi_volume_has_settled(&gi->volume);
    report->converged_fraction = active ? converged_fraction(&gi->volume) : 0.0f;
    report->command_count = gi->command_count;
    report->memory = sdfgi_backend_held(&gi->backend);
    report->prepared = sdfgi_prepared(gi);
    report_passes(gi, report);
    if (active) {
        report_health(gi, report);
        report_scroll(gi, &report->scroll);
    }
}
