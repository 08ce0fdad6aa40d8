/* SPDX-License-Identifier: MIT */
#include "gpu.h"

#include <string.h>

VkResult gpu_timer_init(const struct gpu_device *device, struct gpu_timer *timer, uint32_t slots,
                        uint32_t *tags, uint32_t *counts)
{
    *timer = (struct gpu_timer){ .slots = slots, .tags = tags, .counts = counts };
    memset(counts, 0, slots * sizeof *counts);
    if (device->timestamp_bits == 0)
        return VK_SUCCESS;
    const VkResult result = device->fn.CreateQueryPool(device->handle,
                                                       &(VkQueryPoolCreateInfo){
                                                           .sType = VK_STRUCTURE_TYPE_QUERY_POOL_CREATE_INFO,
                                                           .queryType = VK_QUERY_TYPE_TIMESTAMP,
                                                           .queryCount = slots * GPU_TIMER_SPANS * 2,
                                                       },
                                                       device->callbacks, &timer->pool);
    return gpu_named(device, result, VK_OBJECT_TYPE_QUERY_POOL, &timer->pool, "sdfgi times");
}

void gpu_timer_finish(const struct gpu_device *device, struct gpu_timer *timer)
{
    device->fn.DestroyQueryPool(device->handle, timer->pool, device->callbacks);
    timer->pool = VK_NULL_HANDLE;
}

VkResult gpu_timer_read(const struct gpu_device *device, const struct gpu_timer *timer, uint32_t slot,
                        struct gpu_timer_span spans[GPU_TIMER_SPANS], uint32_t *count)
{
    const uint32_t recorded = timer->counts[slot];
    *count = 0;
    if (!timer->pool || recorded == 0)
        return VK_SUCCESS;
    uint64_t ticks[GPU_TIMER_SPANS * 2];
    const VkResult result = device->fn.GetQueryPoolResults(
        device->handle, timer->pool, slot * GPU_TIMER_SPANS * 2, recorded * 2, recorded * 2 * sizeof *ticks,
        ticks, sizeof *ticks, VK_QUERY_RESULT_64_BIT);
    if (result != VK_SUCCESS)
        return result == VK_NOT_READY ? VK_SUCCESS : result;
    const uint64_t mask =
        device->timestamp_bits >= 64 ? UINT64_MAX : (UINT64_C(1) << device->timestamp_bits) - 1;
    for (uint32_t i = 0; i < recorded; i++) {
        const uint64_t span = (ticks[2 * i + 1] - ticks[2 * i]) & mask;
        spans[i].tag = timer->tags[slot * GPU_TIMER_SPANS + i];
        spans[i].ns = (uint64_t)((double)span * (double)device->limits.timestampPeriod);
    }
    *count = recorded;
    return VK_SUCCESS;
}

void gpu_timer_begin_frame(struct gpu_timer *timer, uint32_t slot)
{
    timer->slot = slot;
    timer->count = 0;
    timer->counts[slot] = 0;
}

static uint32_t query(const struct gpu_timer *timer)
{
    return (timer->slot * GPU_TIMER_SPANS + timer->count) * 2;
}

/* Both ends wait for earlier work: spans of passes that a barrier separates do not overlap. */
static void stamp(struct gpu_timer *timer, struct gpu_recorder *rec, uint32_t index)
{
    rec->device->fn.CmdWriteTimestamp(rec->cmd, VK_PIPELINE_STAGE_BOTTOM_OF_PIPE_BIT, timer->pool, index);
    rec->command_count++;
}

void gpu_timer_begin(struct gpu_timer *timer, struct gpu_recorder *rec, uint32_t tag)
{
    if (!timer->pool || timer->count >= GPU_TIMER_SPANS)
        return;
    rec->device->fn.CmdResetQueryPool(rec->cmd, timer->pool, query(timer), 2);
    rec->command_count++;
    timer->tags[timer->slot * GPU_TIMER_SPANS + timer->count] = tag;
    stamp(timer, rec, query(timer));
}

void gpu_timer_end(struct gpu_timer *timer, struct gpu_recorder *rec)
{
    if (!timer->pool || timer->count >= GPU_TIMER_SPANS)
        return;
    stamp(timer, rec, query(timer) + 1);
    timer->count++;
    timer->counts[timer->slot] = timer->count;
}
