/* SPDX-License-Identifier: MIT
 * What comes back from the GPU, frames_in_flight frames late: counters, timestamps, how far light is from
 * settled. */
#include "internal.h"

#include <string.h>

static void read_counters(struct sdfgi *gi, const struct frame_slot *slot, uint32_t index)
{
    const struct gpu_buffer *readback = &gi->resources->readback;
    if (gpu_buffer_invalidate(&gi->device, readback) != VK_SUCCESS)
        return;
    memcpy(gi->counters, (const uint32_t *)readback->mapped + index * SDFGI_COUNTER_COUNT,
           sizeof gi->counters);
    if (!slot->ring_ends)
        return;
    gi->known_ring = slot->ring;
    memcpy(&gi->known_change, &gi->counters[SDFGI_COUNTER_MAX_CHANGE], sizeof gi->known_change);
    if (slot->ring > gi->disturbed_ring)
        settle_ring(&gi->settling, gi->known_change);
    memcpy(&gi->known_brightest, &gi->counters[SDFGI_COUNTER_MAX_IRRADIANCE], sizeof gi->known_brightest);
}

static void read_timers(struct sdfgi *gi, uint32_t index)
{
    struct gpu_timer_span spans[GPU_TIMER_SPANS];
    const uint32_t count = gpu_timer_read(&gi->device, &gi->resources->timer, index, spans);
    for (uint32_t i = 0; i < count; i++) {
        struct pass_state *pass = &gi->passes[spans[i].tag];
        if (!pass->gpu_ns_valid)
            pass->gpu_ns = 0;
        pass->gpu_ns += spans[i].ns;
        pass->gpu_ns_valid = true;
    }
}

void readback_read(struct sdfgi *gi, uint32_t index)
{
    struct frame_slot *slot = &gi->slots[index];
    if (slot->counted)
        read_counters(gi, slot, index);
    if (slot->timed)
        read_timers(gi, index);
    *slot = (struct frame_slot){ 0 };
}

void readback_record(struct frame *frame)
{
    struct sdfgi *gi = frame->gi;
    const uint64_t bytes = SDFGI_COUNTER_COUNT * sizeof(uint32_t);
    gpu_use(&frame->rec, GPU_USAGE_TRANSFER, RESOURCE_BIT(COUNTERS), 0);
    gpu_copy(&frame->rec, &gi->resources->buffers[RESOURCE_COUNTERS], 0, &gi->resources->readback,
             frame->slot * bytes, bytes);
    gi->slots[frame->slot].counted = true;
}
