/* SPDX-License-Identifier: MIT
 * Recording of passes: label, timer, barrier, pipeline, push constants, dispatch, all from the tables. */
#include "internal.h"

void pass_begin(struct frame *frame, enum pass pass)
{
    struct sdfgi *gi = frame->gi;
    gpu_label_begin(&frame->rec, pass_name(pass));
    if (!frame->grouped || !frame->group_timed)
        gpu_timer_begin(&gi->resources->timer, &frame->rec, (uint32_t)pass);
    frame->group_timed = frame->grouped;
    if (pass == PASS_VOXELIZE || pass == PASS_VOXELIZE_RASTER || pass == PASS_GATHER)
        return; /* they bind pipelines and sets of their own */
    gpu_bind_pipeline(&frame->rec, VK_PIPELINE_BIND_POINT_COMPUTE, gi->pipelines.passes[pass]);
    gpu_bind_set(&frame->rec, VK_PIPELINE_BIND_POINT_COMPUTE, gi->pipelines.layout, 0, gi->resources->set);
}

void pass_end(struct frame *frame)
{
    if (!frame->grouped)
        gpu_timer_end(&frame->gi->resources->timer, &frame->rec);
    gpu_label_end(&frame->rec);
}

void pass_group_begin(struct frame *frame)
{
    frame->grouped = true;
}

void pass_group_end(struct frame *frame)
{
    if (frame->group_timed)
        gpu_timer_end(&frame->gi->resources->timer, &frame->rec);
    frame->grouped = frame->group_timed = false;
}

static void pass_prepare(struct frame *frame, enum pass pass, struct pass_args args)
{
    if (args.size > 0)
        gpu_push(&frame->rec, frame->gi->pipelines.layout, args.size, args.data);
    frame->gi->passes[pass].dispatches++;
}

void pass_dispatch(struct frame *frame, enum pass pass, struct pass_args args, uint32_t x,
                   uint32_t y, uint32_t z)
{
    gpu_use(&frame->rec, GPU_USAGE_COMPUTE, pass_reads(pass), pass_writes(pass));
    pass_prepare(frame, pass, args);
    gpu_dispatch(&frame->rec, x, y, z);
}

void pass_dispatch_cells(struct frame *frame, enum pass pass, struct pass_args args)
{
    const uint32_t groups = frame->gi->settings.resolution / SDFGI_GROUP_CELLS;
    pass_dispatch(frame, pass, args, groups, groups, groups);
    frame->gi->passes[pass].work += frame->gi->resources->extent.cells;
}

void pass_dispatch_box(struct frame *frame, enum pass pass, struct pass_args args, const struct cell_box *box,
                       uint32_t per_thread)
{
    const uint64_t cells = cell_box_cells(box), threads = cells / per_thread;
    pass_dispatch(frame, pass, args, (uint32_t)((threads + SDFGI_GROUP_LINEAR - 1) / SDFGI_GROUP_LINEAR), 1,
                  1);
    frame->gi->passes[pass].work += threads;
}

void pass_dispatch_indirect(struct frame *frame, enum pass pass, struct pass_args args,
                            uint32_t record)
{
    gpu_use(&frame->rec, GPU_USAGE_INDIRECT, pass_reads(pass) | RESOURCE_BIT(INDIRECT), pass_writes(pass));
    pass_prepare(frame, pass, args);
    gpu_dispatch_indirect(&frame->rec, &frame->gi->resources->buffers[RESOURCE_INDIRECT], 16 * record);
}

void pass_dispatch_dirty(struct frame *frame, enum pass pass, struct pass_args args, uint32_t cascade)
{
    const uint32_t first = pass == PASS_CELL_MASK      ? SDFGI_INDIRECT_MASKS
                           : pass == PASS_LIGHT_DIRECT ? SDFGI_INDIRECT_DIRECT
                                                       : SDFGI_INDIRECT_CELLS;
    pass_dispatch_indirect(frame, pass, args, first + cascade);
    /* How many cells that is comes back frames later: these are those of the list before. */
    frame->gi->passes[pass].work += frame->gi->counters[SDFGI_COUNTER_LIGHT_DIRTY + cascade];
}

void pass_clear(struct frame *frame, enum resource resource, uint64_t offset, uint64_t bytes)
{
    gpu_use(&frame->rec, GPU_USAGE_TRANSFER, 0, UINT64_C(1) << resource);
    gpu_fill(&frame->rec, &frame->gi->resources->buffers[resource], offset, bytes, 0);
}
