/* SPDX-License-Identifier: MIT */
#include "pass_record.h"

#include <assert.h>
#include <string.h>

static bool same_pass(const struct work *a, const struct work *b)
{
    return a && a->pass == b->pass && a->group == b->group;
}

/* Passes that run side by side have one time, that of the first: timestamps between them would have each wait
 * for the one before. */
static bool runs_beside(const struct work *a, const struct work *b)
{
    return a && b->group != 0 && a->group == b->group;
}

uint32_t sdfgi_pass_stamps(const struct work_list *list)
{
    const struct work *open = NULL;
    uint32_t stamps = 1;
    for (uint32_t i = 0; i < list->count; i++) {
        const struct work *work = &list->items[i];
        const bool is_pass = work->kind == WORK_PASS;
        if (is_pass ? !same_pass(open, work) && !runs_beside(open, work) : open != NULL)
            stamps++;
        open = is_pass ? work : NULL;
    }
    return stamps;
}

void sdfgi_pass_recorder_begin(struct pass_recorder *r, const struct backend *backend,
                               struct resources *resources, VkCommandBuffer cmd, uint32_t stamps)
{
    memset(r, 0, sizeof *r);
    r->stamps_left = stamps;
    r->backend = backend;
    r->resources = resources;
    r->timer = &resources->timer;
    gpu_recorder_begin(&r->gpu, &backend->device, cmd);
}

/* All layouts agree in these two sets, so that they stay bound while passes change. */
void sdfgi_pass_bind_resources(struct pass_recorder *r, VkPipelineBindPoint point)
{
    if (r->bound >> point & 1)
        return;
    for (uint32_t i = 0; i < RESOURCE_SET_COUNT; i++)
        gpu_bind_set(&r->gpu, point, r->backend->pipelines.layouts[PASS_SET_NONE], i, r->resources->sets[i]);
    r->bound |= 1u << point;
}

/* From here on the device's time is that of `tag`. */
static void stamp(struct pass_recorder *r, uint32_t tag)
{
    if (!r->stamped)
        gpu_timer_reset(r->timer, &r->gpu, r->stamps_left);
    assert(r->stamps_left > 0);
    r->stamps_left--;
    gpu_timer_stamp(r->timer, &r->gpu, tag);
    r->stamped = true;
    r->timed = tag != GPU_TIMER_NOTHING;
}

static void end_label(struct pass_recorder *r)
{
    if (r->open)
        gpu_label_end(&r->gpu);
    r->open = NULL;
}

void sdfgi_pass_close(struct pass_recorder *r)
{
    end_label(r);
    if (r->timed)
        stamp(r, GPU_TIMER_NOTHING);
}

void sdfgi_pass_recorder_end(struct pass_recorder *r)
{
    sdfgi_pass_close(r);
    gpu_recorder_end(&r->gpu);
}

void sdfgi_pass_open(struct pass_recorder *r, const struct work *work)
{
    if (same_pass(r->open, work)) {
        r->open = work;
        return;
    }
    const bool beside = runs_beside(r->open, work);
    end_label(r);
    gpu_label_begin(&r->gpu, sdfgi_pass_row(work->pass)->name);
    if (!beside)
        stamp(r, (uint32_t)work->pass);
    r->open = work;
    if (sdfgi_pass_row(work->pass)->kind != PASS_KIND_COMPUTE)
        return; /* the voxeliser binds what each material needs */
    sdfgi_pass_bind_resources(r, VK_PIPELINE_BIND_POINT_COMPUTE);
    gpu_bind_pipeline(&r->gpu, VK_PIPELINE_BIND_POINT_COMPUTE, r->backend->pipelines.passes[work->pass][0]);
}

/* Where a record of indirect arguments begins. */
static uint64_t record_offset(const struct work *work, const struct extent *e)
{
    const bool of_visits = work->records == RESOURCE_SEEN;
    return 16 * work->indirect +
           (of_visits ? 4ull * sdfgi_seen_records((uint32_t)e->light_cells, (uint32_t)e->cascades) : 0);
}

static void dispatch(struct pass_recorder *r, const struct work *work)
{
    const struct pass_row *row = sdfgi_pass_row(work->pass);
    if (work->indirect != WORK_DIRECT) {
        gpu_use(&r->gpu, GPU_USAGE_INDIRECT, row->reads | UINT64_C(1) << work->records, row->writes);
        gpu_dispatch_indirect(&r->gpu, &r->resources->buffers[work->records],
                              record_offset(work, &r->resources->extent));
        return;
    }
    const struct work_groups groups = sdfgi_work_groups(work, &r->resources->extent, r->backend->software);
    gpu_use(&r->gpu, GPU_USAGE_COMPUTE, row->reads, row->writes);
    gpu_dispatch(&r->gpu, groups.x, groups.y, groups.z);
}

static void begin_item(struct pass_recorder *r, const struct work *work)
{
    const struct pass_row *row = sdfgi_pass_row(work->pass);
    assert(work->kind == WORK_PASS && row->domain != DOMAIN_INSTANCES);
    sdfgi_pass_open(r, work);
    if (row->args_size > 0)
        gpu_push(&r->gpu, r->backend->pipelines.layouts[row->set], row->args_size, &work->args);
    r->tally[work->pass].dispatches++;
    r->tally[work->pass].units += work->units;
}

void sdfgi_pass_record(struct pass_recorder *r, const struct work *work)
{
    begin_item(r, work);
    dispatch(r, work);
}

void sdfgi_pass_record_indirect(struct pass_recorder *r, const struct work *work,
                                const struct gpu_buffer *arguments, uint64_t offset)
{
    const struct pass_row *row = sdfgi_pass_row(work->pass);
    begin_item(r, work);
    gpu_use(&r->gpu, GPU_USAGE_INDIRECT, row->reads, row->writes);
    gpu_dispatch_indirect(&r->gpu, arguments, offset);
}

void sdfgi_pass_record_clear(struct pass_recorder *r, const struct work *work)
{
    assert(work->kind == WORK_CLEAR);
    sdfgi_pass_close(r);
    gpu_use(&r->gpu, GPU_USAGE_TRANSFER, 0, UINT64_C(1) << work->resource);
    gpu_fill(&r->gpu, &r->resources->buffers[work->resource], work->offset, work->bytes, 0);
}
