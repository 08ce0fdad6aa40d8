/* SPDX-License-Identifier: MIT */
#include "volume.h"

#include <assert.h>
#include <string.h>

/* Room beyond what is needed, so that a scene that grows a little does not grow the list each time. */
#define SPARE_PART 8

void sdfgi_volume_init(struct volume *volume, struct backend *backend, struct scene *scene)
{
    volume->backend = backend;
    sdfgi_scene_add_journal(scene, &volume->journal);
}

void sdfgi_volume_finish(struct volume *volume)
{
    sdfgi_resources_retire(volume->backend, volume->resources);
    volume->resources = NULL;
}

void sdfgi_volume_reset(struct volume *volume, struct resources *resources,
                        const struct sdfgi_settings *settings)
{
    if (volume->resources && volume->resources->used)
        sdfgi_resources_retire(volume->backend, volume->resources);
    else
        sdfgi_resources_destroy(volume->backend, volume->resources);
    volume->resources = resources;
    sdfgi_volume_forget(volume, settings);
}

void sdfgi_volume_forget(struct volume *volume, const struct sdfgi_settings *settings)
{
    struct volume_state *state = &volume->state;
    memset(state, 0, sizeof *state);
    memset(&volume->feedback, 0, sizeof volume->feedback);
    volume->undo.valid = false;
    volume->gaps = (struct volume_gaps){ .emitters = volume->resources && volume->resources->extent.emits };
    sdfgi_journal_clear(&volume->journal);
    sdfgi_cascades_init(&state->cascades, settings);
    sdfgi_scroll_init(&state->scroll);
    state->content = sdfgi_box_nothing();
    sdfgi_accumulation_init(&state->accumulation);
    sdfgi_relight_init(&state->relight);
    sdfgi_gathering_init(&state->gathering);
}

void sdfgi_volume_pause(struct volume *volume)
{
    volume->state.paused = volume->undo.state.paused = true;
}

void sdfgi_volume_cancel(struct volume *volume)
{
    struct volume_undo *undo = &volume->undo;
    if (!undo->valid)
        return;
    undo->valid = false;
    volume->state = undo->state;
    volume->gaps = undo->gaps;
    volume->feedback.slots[sdfgi_backend_slot(volume->backend)] = (struct feedback_slot){ 0 };
    sdfgi_journal_prepend(&volume->journal, &undo->journal);
}

void sdfgi_volume_invalidate(struct volume *volume)
{
    sdfgi_accumulation_invalidate(&volume->state.accumulation);
    sdfgi_accumulation_invalidate(&volume->undo.state.accumulation);
}

static bool overlaps_any(const struct cascades *cascades, const struct box *box)
{
    for (uint32_t c = 0; c < cascades->count; c++)
        if (sdfgi_cascade_overlaps(&cascades->at[c], cascades->resolution, box))
            return true;
    return false;
}

/* True if no cascade has a place yet: all light cells will be new. */
static bool none_is_placed(const struct cascades *cascades)
{
    for (uint32_t c = 0; c < cascades->count; c++)
        if (cascades->at[c].place != CASCADE_UNPLACED)
            return false;
    return true;
}

/* Which cells the changes of a journal wake, but for those of geometry. */
static void wake_cells(const struct journal *journal, const struct cascades *cascades,
                       struct gathering *gathering)
{
    if (journal->notes & JOURNAL_EVERYTHING || none_is_placed(cascades)) {
        sdfgi_gathering_outdate(gathering);
        return;
    }
    for (uint32_t i = 0; i < journal->emitters.count; i++)
        if (overlaps_any(cascades, &journal->emitters.boxes[i]))
            sdfgi_gathering_emitter(gathering, &journal->emitters.boxes[i]);
    if (journal->drift > 0)
        sdfgi_gathering_drift(gathering, journal->drift);
    if (journal->notes & JOURNAL_LAMPS)
        sdfgi_gathering_change(gathering, NULL);
    if (journal->flicker > 0)
        sdfgi_gathering_flicker(gathering, journal->flicker);
}

void sdfgi_volume_apply_journal(const struct journal *journal, struct volume_state *state)
{
    bool invalidates =
        journal->lights.changed != 0 || journal->drift > 0 || journal->notes & JOURNAL_EVERYTHING;
    for (uint32_t c = 0; c < state->cascades.count; c++) {
        struct cascade *cascade = &state->cascades.at[c];
        if (journal->notes & JOURNAL_EVERYTHING)
            sdfgi_cascade_outdate(cascade);
        for (uint32_t i = 0; i < journal->box_count; i++)
            if (sdfgi_cascade_add_edit(cascade, state->cascades.resolution, &journal->boxes[i])) {
                sdfgi_gathering_change(&state->gathering, &journal->boxes[i]);
                invalidates = true;
            }
    }
    if (!invalidates)
        return;
    sdfgi_accumulation_invalidate(&state->accumulation);
    wake_cells(journal, &state->cascades, &state->gathering);
}

void sdfgi_volume_note_content(const struct scene *scene, struct volume_state *state)
{
    const struct box now = sdfgi_tree_bounds(&scene->tree);
    const bool changing = !sdfgi_cascades_are_current(&state->cascades);
    if (changing)
        state->content = sdfgi_box_around(&state->content, &now);
    else if (state->content_shrinks)
        state->content = now;
    state->content_shrinks = changing;
}

bool sdfgi_volume_has_converged(const struct volume *volume)
{
    return volume->state.accumulation.phase == LIGHTING_CONVERGED && sdfgi_journal_is_empty(&volume->journal);
}

bool sdfgi_volume_has_settled(const struct volume *volume)
{
    return sdfgi_volume_has_converged(volume) && volume->state.scroll.blends_moving == 0;
}

static uint64_t most_light_cells(const struct volume *volume)
{
    uint64_t most = 0;
    for (uint32_t c = 0; c < volume->state.cascades.count; c++)
        if (volume->feedback.counters[SDFGI_COUNTER_LIGHT_CELLS + c] > most)
            most = volume->feedback.counters[SDFGI_COUNTER_LIGHT_CELLS + c];
    return most;
}

void sdfgi_volume_make_room(struct volume *volume)
{
    struct resources *r = volume->resources;
    const uint64_t needed = most_light_cells(volume), wanted = needed + needed / SPARE_PART;
    const uint64_t room = wanted < r->extent.light_cells_max ? wanted : r->extent.light_cells_max;
    if (needed <= r->extent.light_cells || needed == volume->feedback.light_cells_refused)
        return;
    if (room > r->extent.light_cells && sdfgi_resources_grow_light_cells(volume->backend, r, room)) {
        volume->gaps.lists = true;
        return;
    }
    if (volume->feedback.light_cells_refused == 0)
        sdfgi_message_log(
            &volume->backend->hooks, SDFGI_MESSAGE_LIGHT_CELLS_OVERFLOW,
            "sdfgi_update: %llu light cells in a cascade, room for %llu, and no memory for more",
            (unsigned long long)needed, (unsigned long long)r->extent.light_cells);
    volume->feedback.light_cells_refused = needed;
}

void sdfgi_volume_add_emitters(struct volume *volume, bool scene_emits)
{
    volume->feedback.emitters_refused = scene_emits && volume->feedback.emitters_refused;
    if (!scene_emits || volume->resources->extent.emits || volume->feedback.emitters_refused)
        return;
    if (sdfgi_resources_add_emitters(volume->backend, volume->resources)) {
        volume->gaps.emitters = true;
        return;
    }
    volume->feedback.emitters_refused = true;
    sdfgi_message_log(&volume->backend->hooks, SDFGI_MESSAGE_NO_EMITTER_LISTS,
                      "sdfgi_update: no memory for emission: what emits stays dark");
}

bool sdfgi_volume_add_low_light(struct volume *volume, bool wanted)
{
    struct backend *backend = volume->backend;
    struct resources *r = volume->resources;
    volume->feedback.low_light_refused = wanted && volume->feedback.low_light_refused;
    if (!wanted || !r->extent.gathers || volume->feedback.low_light_refused)
        return false;
    const bool made = sdfgi_pipelines_require(backend, PASS_CELL_GATHER, PASS_LOBES) == VK_SUCCESS;
    if (made && r->extent.low_light)
        return true;
    if (made && sdfgi_resources_add_low_light(backend, r)) {
        volume->gaps.seen = true;
        return true;
    }
    volume->feedback.low_light_refused = true;
    sdfgi_message_log(&backend->hooks, SDFGI_MESSAGE_NO_ROUGH_LOBES,
                      "sdfgi_update: no memory for rough lobes: what is rough reflects its irradiance");
    return false;
}

/* A longer buffer is empty. The state before this frame says so, too, which it may be taken back to. */
static void forget_instances(struct volume *volume)
{
    volume->state.instances = 0;
    if (volume->feedback.instances_refused > 0)
        volume->journal.notes |= JOURNAL_EVERYTHING;
    volume->feedback.instances_refused = 0;
}

void sdfgi_volume_add_instances(struct volume *volume, const struct scene *scene)
{
    const struct pool *pool = &scene->instances;
    const uint64_t room = volume->resources->extent.instances;
    if (pool->end <= room || volume->feedback.instances_refused == scene->revision)
        return;
    if (sdfgi_resources_grow_instances(volume->backend, volume->resources, pool->capacity)) {
        forget_instances(volume);
        return;
    }
    if (volume->feedback.instances_refused == 0)
        sdfgi_message_log(&volume->backend->hooks, SDFGI_MESSAGE_OUT_OF_DEVICE_MEMORY,
                          "sdfgi_update: no memory for %u instances: those beyond %llu are left out for now",
                          (unsigned)pool->end, (unsigned long long)room);
    volume->feedback.instances_refused = scene->revision;
}

struct light_lists sdfgi_volume_light_lists(const struct volume *volume)
{
    struct light_lists lists = { .cascades = volume->state.cascades.count,
                                 .room = (uint32_t)volume->resources->extent.light_cells,
                                 .frame = volume->backend->retired.frame,
                                 .frames_in_flight = volume->backend->retired.frames_in_flight };
    memcpy(lists.counted, volume->feedback.counters + SDFGI_COUNTER_LIGHT_CELLS, sizeof lists.counted);
    memcpy(lists.seen, volume->feedback.counters + SDFGI_COUNTER_CELLS_SEEN, sizeof lists.seen);
    memcpy(lists.hit, volume->feedback.counters + SDFGI_COUNTER_CELLS_HIT, sizeof lists.hit);
    return lists;
}
