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
    r->beside = runs_beside(r->open, work);
    if (same_pass(r->open, work)) {
        r->open = work;
        return;
    }
    end_label(r);
    gpu_label_begin(&r->gpu, sdfgi_pass_row(work->pass)->name);
    if (!r->beside)
        stamp(r, (uint32_t)work->pass);
    r->open = work;
    if (sdfgi_pass_row(work->pass)->domain == DOMAIN_INSTANCES)
        return; /* the voxeliser binds what each material needs */
    sdfgi_pass_bind_resources(r, VK_PIPELINE_BIND_POINT_COMPUTE);
    gpu_bind_pipeline(&r->gpu, VK_PIPELINE_BIND_POINT_COMPUTE,
                      r->backend->pipelines.passes[work->pass][work->variant]);
}

/* Where a record of indirect arguments begins. */
static uint64_t record_offset(const struct work *work, const struct extent *e)
{
    const bool of_visits = work->records == RESOURCE_SEEN;
    return 16 * work->indirect +
           (of_visits ? 4ull * sdfgi_seen_records((uint32_t)e->light_cells, (uint32_t)e->cascades) : 0);
}

static enum gpu_usage usage_of(const struct work *work)
{
    return work->indirect != WORK_DIRECT ? GPU_USAGE_INDIRECT : GPU_USAGE_COMPUTE;
}

static uint64_t reads_of(const struct work *work)
{
    const uint64_t records = work->indirect != WORK_DIRECT ? UINT64_C(1) << work->records : 0;
    return sdfgi_pass_row(work->pass)->reads | records;
}

/* Declares what an item touches. It waits for what it needs, unless the items with which it runs side by side
 * have done so for all of them. */
static void use(struct pass_recorder *r, enum gpu_usage usage, uint64_t reads, uint64_t writes)
{
    if (r->beside)
        gpu_touch(&r->gpu, usage, reads, writes);
    else
        gpu_use(&r->gpu, usage, reads, writes);
}

static void dispatch(struct pass_recorder *r, const struct work *work)
{
    use(r, usage_of(work), reads_of(work), sdfgi_pass_row(work->pass)->writes);
    if (work->indirect != WORK_DIRECT) {
        gpu_dispatch_indirect(&r->gpu, &r->resources->buffers[work->records],
                              record_offset(work, &r->resources->extent));
        return;
    }
    const struct work_groups groups = sdfgi_work_groups(work, &r->resources->extent, r->backend->software);
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
    use(r, GPU_USAGE_INDIRECT, row->reads, row->writes);
    gpu_dispatch_indirect(&r->gpu, arguments, offset);
}

static bool clears_overlap(const struct work *a, const struct work *b)
{
    return a->resource == b->resource && a->offset < b->offset + b->bytes && b->offset < a->offset + a->bytes;
}

/* Clears that a list begins with and that touch nothing in common. */
static uint32_t clears_at_once(const struct work *items, uint32_t count)
{
    for (uint32_t i = 0; i < count; i++) {
        if (items[i].kind != WORK_CLEAR)
            return i;
        for (uint32_t k = 0; k < i; k++)
            if (clears_overlap(&items[i], &items[k]))
                return i;
    }
    return count;
}

static void record_clears(struct pass_recorder *r, const struct work *items, uint32_t count)
{
    uint64_t written = 0;
    for (uint32_t i = 0; i < count; i++)
        written |= UINT64_C(1) << items[i].resource;
    sdfgi_pass_close(r);
    gpu_use(&r->gpu, GPU_USAGE_TRANSFER, 0, written);
    for (uint32_t i = 0; i < count; i++)
        gpu_fill(&r->gpu, &r->resources->buffers[items[i].resource], items[i].offset, items[i].bytes, 0);
}

/* Items that a list begins with and that run side by side. */
static uint32_t passes_at_once(const struct work *items, uint32_t count)
{
    uint32_t passes = 1;
    while (passes < count && runs_beside(&items[0], &items[passes]))
        passes++;
    return passes;
}

/* The barrier comes after the stamp, because software drivers take the time when they wait. */
void sdfgi_pass_begin_beside(struct pass_recorder *r, const struct work *items, uint32_t count)
{
    uint64_t reads = 0, writes = 0;
    for (uint32_t i = 0; i < count; i++) {
        reads |= reads_of(&items[i]);
        writes |= sdfgi_pass_row(items[i].pass)->writes;
    }
    sdfgi_pass_open(r, items);
    gpu_order(&r->gpu, GPU_USAGE_INDIRECT, reads, writes);
}

static void record_passes(struct pass_recorder *r, const struct work *items, uint32_t count)
{
    sdfgi_pass_begin_beside(r, items, count);
    for (uint32_t i = 0; i < count; i++)
        sdfgi_pass_record(r, &items[i]);
}

uint32_t sdfgi_pass_record_at_once(struct pass_recorder *r, const struct work *items, uint32_t count)
{
    if (items->kind == WORK_CLEAR) {
        const uint32_t clears = clears_at_once(items, count);
        record_clears(r, items, clears);
        return clears;
    }
    const uint32_t passes = passes_at_once(items, count);
    record_passes(r, items, passes);
    return passes;
}
