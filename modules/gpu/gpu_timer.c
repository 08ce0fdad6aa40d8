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
                                                           .queryCount = slots * GPU_TIMER_STAMPS,
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
                        struct gpu_timer_span spans[GPU_TIMER_STAMPS], uint32_t *count)
{
    const uint32_t recorded = timer->counts[slot], first = slot * GPU_TIMER_STAMPS;
    *count = 0;
    if (!timer->pool || recorded == 0)
        return VK_SUCCESS;
    uint64_t ticks[GPU_TIMER_STAMPS];
    const VkResult result =
        device->fn.GetQueryPoolResults(device->handle, timer->pool, first, recorded, recorded * sizeof *ticks,
                                       ticks, sizeof *ticks, VK_QUERY_RESULT_64_BIT);
    if (result != VK_SUCCESS)
        return result == VK_NOT_READY ? VK_SUCCESS : result;
    const uint64_t mask =
        device->timestamp_bits >= 64 ? UINT64_MAX : (UINT64_C(1) << device->timestamp_bits) - 1;
    for (uint32_t i = 0; i + 1 < recorded; i++) {
        if (timer->tags[first + i] == GPU_TIMER_NOTHING)
            continue;
        const uint64_t span = (ticks[i + 1] - ticks[i]) & mask;
        spans[(*count)++] = (struct gpu_timer_span){
            .tag = timer->tags[first + i],
            .ns = (uint64_t)((double)span * (double)device->limits.timestampPeriod),
        };
    }
    return VK_SUCCESS;
}

void gpu_timer_begin_frame(struct gpu_timer *timer, uint32_t slot)
{
    timer->slot = slot;
    timer->counts[slot] = 0;
    timer->end = 0;
}

void gpu_timer_reset(struct gpu_timer *timer, struct gpu_recorder *rec, uint32_t most)
{
    const uint32_t count = timer->counts[timer->slot], left = GPU_TIMER_STAMPS - count,
                   reset = most < left ? most : left;
    if (!timer->pool || reset == 0)
        return;
    rec->device->fn.CmdResetQueryPool(rec->cmd, timer->pool, timer->slot * GPU_TIMER_STAMPS + count, reset);
    rec->command_count++;
    timer->end = count + reset;
}

/* A stamp waits for earlier work: spans of passes that a barrier separates do not overlap. The last stamp
 * that was reset begins nothing, because no other one could end that. */
void gpu_timer_stamp(struct gpu_timer *timer, struct gpu_recorder *rec, uint32_t tag)
{
    const uint32_t first = timer->slot * GPU_TIMER_STAMPS;
    uint32_t *count = &timer->counts[timer->slot];
    if (!timer->pool || *count >= timer->end)
        return;
    timer->tags[first + *count] = *count + 1 < timer->end ? tag : GPU_TIMER_NOTHING;
    rec->device->fn.CmdWriteTimestamp(rec->cmd, VK_PIPELINE_STAGE_BOTTOM_OF_PIPE_BIT, timer->pool,
                                      first + *count);
    rec->command_count++;
    (*count)++;
}
