/* SPDX-License-Identifier: MIT
 * Stage 6: lists the light cells of a cascade, finds which probes each sees, lights them directly, and adds
 * emission and what the probes bring. */
#include "internal.h"

void light_cache_list_record(struct frame *frame, uint32_t c)
{
    const struct sdfgi_pass_args args = { .cascade = c };
    gpu_use(&frame->rec, GPU_USAGE_TRANSFER, 0, RESOURCE_BIT(COUNTERS));
    gpu_fill(&frame->rec, &frame->gi->resources->buffers[RESOURCE_COUNTERS],
             4 * (SDFGI_COUNTER_LIGHT_CELLS + c), 4, 0);
    pass_begin(frame, PASS_LIGHT_LIST);
    pass_dispatch_cells(frame, PASS_LIGHT_LIST, &args);
    pass_end(frame);
    pass_begin(frame, PASS_LIGHT_ARGS);
    pass_dispatch(frame, PASS_LIGHT_ARGS, &args, 1, 1, 1);
    frame->gi->passes[PASS_LIGHT_ARGS].work++;
    pass_end(frame);
    if (!frame->gi->plan[PASS_CELL_MASK].run)
        return;
    pass_begin(frame, PASS_CELL_MASK);
    pass_dispatch_light_cells(frame, PASS_CELL_MASK, &args);
    pass_end(frame);
}

static void record_light_cells(struct frame *frame, enum pass pass, const struct sdfgi_pass_args *args)
{
    pass_begin(frame, pass);
    pass_dispatch_light_cells(frame, pass, args);
    pass_end(frame);
}

void light_cache_direct_record(struct frame *frame, uint32_t c)
{
    record_light_cells(frame, PASS_LIGHT_DIRECT, &(struct sdfgi_pass_args){ .cascade = c });
}

void light_cache_bounce_record(struct frame *frame, uint32_t c)
{
    const bool no_probes = !frame->gi->cascades[c].published;
    record_light_cells(frame, PASS_LIGHT_BOUNCE,
                       &(struct sdfgi_pass_args){ .cascade = c, .fresh = no_probes });
}
