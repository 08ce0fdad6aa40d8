/* SPDX-License-Identifier: MIT
 * Records plans with a device that only notes in which order commands come. */
#include "plan_rules.h"

#include "pass/pass_record.h"
#include "require.h"

#include <string.h>

static struct {
    uint32_t commands; /* of those that run at once, so far */
    bool late;         /* a barrier came between two of them */
    bool waits;        /* the newest command is a barrier */
    bool late_stamp;   /* a timestamp came after their barrier */
    bool overlaps;     /* fills write the same without a barrier between them */
    struct {
        VkBuffer buffer;
        VkDeviceSize offset, end;
    } fills[SDFGI_MAX_WORK]; /* since the newest barrier */
    uint32_t fill_count;
} noted;

static void VKAPI_CALL pipeline_barrier(VkCommandBuffer cmd, VkPipelineStageFlags from,
                                        VkPipelineStageFlags to, VkDependencyFlags flags,
                                        uint32_t memory_count, const VkMemoryBarrier *memory,
                                        uint32_t buffer_count, const VkBufferMemoryBarrier *buffers,
                                        uint32_t image_count, const VkImageMemoryBarrier *images)
{
    (void)cmd, (void)from, (void)to, (void)flags, (void)memory_count, (void)memory, (void)buffer_count;
    (void)buffers, (void)image_count, (void)images;
    noted.late = noted.late || noted.commands > 0;
    noted.waits = true;
    noted.fill_count = 0;
}

static void command(void)
{
    noted.commands++;
    noted.waits = false;
}

static void VKAPI_CALL fill_buffer(VkCommandBuffer cmd, VkBuffer buffer, VkDeviceSize offset,
                                   VkDeviceSize size, uint32_t value)
{
    (void)cmd, (void)value;
    for (uint32_t i = 0; i < noted.fill_count; i++)
        noted.overlaps =
            noted.overlaps || (noted.fills[i].buffer == buffer && noted.fills[i].offset < offset + size &&
                               offset < noted.fills[i].end);
    noted.fills[noted.fill_count].buffer = buffer;
    noted.fills[noted.fill_count].offset = offset;
    noted.fills[noted.fill_count++].end = offset + size;
    command();
}

static void VKAPI_CALL dispatch(VkCommandBuffer cmd, uint32_t x, uint32_t y, uint32_t z)
{
    (void)cmd, (void)x, (void)y, (void)z;
    command();
}

static void VKAPI_CALL dispatch_indirect(VkCommandBuffer cmd, VkBuffer buffer, VkDeviceSize offset)
{
    (void)cmd, (void)buffer, (void)offset;
    command();
}

static void VKAPI_CALL bind_pipeline(VkCommandBuffer cmd, VkPipelineBindPoint point, VkPipeline pipeline)
{
    (void)cmd, (void)point, (void)pipeline;
}

static void VKAPI_CALL bind_sets(VkCommandBuffer cmd, VkPipelineBindPoint point, VkPipelineLayout layout,
                                 uint32_t first, uint32_t count, const VkDescriptorSet *sets,
                                 uint32_t offset_count, const uint32_t *offsets)
{
    (void)cmd, (void)point, (void)layout, (void)first, (void)count, (void)sets, (void)offset_count;
    (void)offsets;
}

static void VKAPI_CALL push_constants(VkCommandBuffer cmd, VkPipelineLayout layout, VkShaderStageFlags stages,
                                      uint32_t offset, uint32_t size, const void *values)
{
    (void)cmd, (void)layout, (void)stages, (void)offset, (void)size, (void)values;
}

static void VKAPI_CALL reset_queries(VkCommandBuffer cmd, VkQueryPool pool, uint32_t first, uint32_t count)
{
    (void)cmd, (void)pool, (void)first, (void)count;
}

static void VKAPI_CALL write_timestamp(VkCommandBuffer cmd, VkPipelineStageFlagBits stage, VkQueryPool pool,
                                       uint32_t query)
{
    (void)cmd, (void)stage, (void)pool, (void)query;
    noted.late_stamp = noted.late_stamp || noted.waits;
}

static void take_device(struct gpu_device *device)
{
    device->fn.CmdPipelineBarrier = pipeline_barrier;
    device->fn.CmdFillBuffer = fill_buffer;
    device->fn.CmdDispatch = dispatch;
    device->fn.CmdDispatchIndirect = dispatch_indirect;
    device->fn.CmdBindPipeline = bind_pipeline;
    device->fn.CmdBindDescriptorSets = bind_sets;
    device->fn.CmdPushConstants = push_constants;
    device->fn.CmdResetQueryPool = reset_queries;
    device->fn.CmdWriteTimestamp = write_timestamp;
}

/* Voxelisers need meshes of a device: no draw of theirs is recorded, but what it touches is. */
static uint32_t record_some(struct pass_recorder *r, const struct work *items, uint32_t count)
{
    const struct pass_row *row = sdfgi_pass_row(items->pass);
    if (items->kind == WORK_CLEAR || row->domain != DOMAIN_INSTANCES)
        return sdfgi_pass_record_at_once(r, items, count);
    gpu_use(&r->gpu, row->kind == PASS_KIND_COMPUTE ? GPU_USAGE_COMPUTE : GPU_USAGE_GRAPHICS, row->reads,
            row->writes);
    return 1;
}

void plan_rules_barriers(const struct drive *d, const struct frame *frame)
{
    static struct backend backend;
    static struct resources resources;
    static struct pass_recorder recorder;
    const struct work_list *list = &frame->work;
    take_device(&backend.device);
    memset(&noted, 0, sizeof noted);
    for (uint32_t i = 0; i < RESOURCE_COUNT; i++)
        resources.buffers[i].handle = (VkBuffer)(uintptr_t)(i + 1);
    resources.extent = d->extent;
    resources.timer.pool = (VkQueryPool)(uintptr_t)1;
    resources.timer.tags = resources.timer_tags;
    resources.timer.counts = resources.timer_counts;
    gpu_timer_begin_frame(&resources.timer, 0);
    sdfgi_pass_recorder_begin(&recorder, &backend, &resources, NULL, sdfgi_pass_stamps(list));
    for (uint32_t i = 0; i < list->count;) {
        const struct work *first = &list->items[i];
        noted.commands = 0;
        noted.late = noted.late_stamp = noted.waits = false;
        i += record_some(&recorder, first, list->count - i);
        if (noted.late || noted.late_stamp)
            require_fail(__FILE__, __LINE__, "a barrier comes between %s and %s",
                         first->kind == WORK_CLEAR ? "a clear" : sdfgi_pass_row(first->pass)->name,
                         noted.late ? "those beside it" : "its time");
        REQUIRE_TRUE(!noted.overlaps);
        if (i < list->count && first->group != 0)
            REQUIRE_CMP(list->items[i].group, !=, first->group);
    }
    sdfgi_pass_recorder_end(&recorder);
}
