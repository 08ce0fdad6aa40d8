/* SPDX-License-Identifier: MIT
 * What comes back from the GPU, frames_in_flight frames late: counters, times, how far light is from
 * converged. */
#include "volume.h"

#include <string.h>

static float float_of(uint32_t bits)
{
    float value;
    memcpy(&value, &bits, sizeof value);
    return value;
}

/* False if the frame has not run. */
static bool read_counters(struct volume *volume, const struct feedback_slot *slot, uint32_t index)
{
    const struct gpu_buffer *readback = &volume->resources->readback;
    const uint32_t *words = (const uint32_t *)readback->memory.mapped + index * SDFGI_READBACK_WORDS;
    uint32_t *counters = volume->feedback.counters;
    if (gpu_buffer_invalidate(&volume->backend->device, readback) != VK_SUCCESS)
        return true;
    if (words[SDFGI_COUNTER_COUNT] != slot->number)
        return false;
    memcpy(counters, words, sizeof volume->feedback.counters);
    if (slot->ended_cycle > 0)
        sdfgi_accumulation_add_known(&volume->state.accumulation, slot->ended_cycle,
                                     float_of(counters[SDFGI_COUNTER_MAX_CHANGE]),
                                     float_of(counters[SDFGI_COUNTER_MAX_DRIFT]));
    for (uint32_t c = 0; c < volume->state.cascades.count; c++)
        if (slot->ended_gathers[c] > 0)
            sdfgi_gathering_add_known(&volume->state.gathering, c, slot->ended_gathers[c],
                                      &(struct gather_change){
                                          .most = float_of(counters[SDFGI_COUNTER_CELL_CHANGE + c]),
                                          .changing = counters[SDFGI_COUNTER_CELLS_CHANGING + c],
                                          .drift = float_of(counters[SDFGI_COUNTER_CELL_DRIFT + c]),
                                          .cells = counters[SDFGI_COUNTER_LIGHT_CELLS + c],
                                      });
    return true;
}

static VkResult read_times(struct volume *volume, uint32_t index)
{
    struct gpu_timer_span spans[GPU_TIMER_STAMPS];
    uint32_t count;
    const VkResult result =
        gpu_timer_read(&volume->backend->device, &volume->resources->timer, index, spans, &count);
    for (uint32_t i = 0; i < count; i++) {
        struct feedback_time *time = &volume->feedback.times[spans[i].tag];
        time->ns = spans[i].ns + (time->is_new ? time->ns : 0);
        time->is_new = true;
    }
    return result;
}

VkResult sdfgi_volume_read_back(struct volume *volume, uint32_t index, bool *has_run)
{
    VkResult result = VK_SUCCESS;
    struct feedback_slot *slot = &volume->feedback.slots[index];
    for (int i = 0; i < PASS_COUNT; i++)
        volume->feedback.times[i].is_new = false;
    *has_run = slot->content != FEEDBACK_TIMES_AND_COUNTERS || read_counters(volume, slot, index);
    if (*has_run && slot->content != FEEDBACK_NOTHING)
        result = read_times(volume, index);
    *slot = (struct feedback_slot){ .content = FEEDBACK_NOTHING };
    return result;
}
