/* SPDX-License-Identifier: MIT
 * Stage 6: lists the light cells of a cascade, finds which probes each sees, lights them directly, and adds
 * emission and what the probes bring. */
#include "internal.h"

/* Room beyond what is needed, so that a scene that grows a little does not grow the list each time. */
#define SPARE_SHARE 8

static uint64_t most_light_cells(const struct sdfgi *gi)
{
    uint64_t most = 0;
    for (uint32_t c = 0; c < gi->settings.cascades; c++)
        if (gi->counters[SDFGI_COUNTER_LIGHT_CELLS + c] > most)
            most = gi->counters[SDFGI_COUNTER_LIGHT_CELLS + c];
    return most;
}

void light_cache_make_room(struct sdfgi *gi)
{
    struct resources *r = gi->resources;
    const uint64_t needed = most_light_cells(gi), wanted = needed + needed / SPARE_SHARE;
    const uint64_t room = wanted < r->extent.light_cells_max ? wanted : r->extent.light_cells_max;
    if (needed <= r->extent.light_cells || needed == r->light_cells_refused)
        return;
    if (room > r->extent.light_cells && resources_grow_light_cells(gi, room)) {
        for (uint32_t c = 0; c < gi->settings.cascades; c++)
            gi->cascades[c].relist = true;
        return;
    }
    if (r->light_cells_refused == 0)
        message(gi, SDFGI_MESSAGE_LIGHT_CELLS_OVERFLOW,
                "sdfgi_update: %llu light cells in a cascade, room for %llu, and no memory for more",
                (unsigned long long)needed, (unsigned long long)r->extent.light_cells);
    r->light_cells_refused = needed;
}

/* Blocks of 4^3 cells get a mask of two words, rows of blocks a count: see light_blocks.glsl. */
static void record_list(struct frame *frame, const struct sdfgi_pass_args *args)
{
    struct sdfgi *gi = frame->gi;
    const uint64_t blocks = gi->resources->extent.cells / 64, rows = blocks / SDFGI_GROUP_LINEAR;
    pass_clear(frame, RESOURCE_SCRATCH, 8 * blocks, 4 * rows);
    pass_begin(frame, PASS_LIGHT_MARK);
    pass_dispatch_cells(frame, PASS_LIGHT_MARK, args);
    pass_end(frame);
    pass_begin(frame, PASS_LIGHT_ARGS);
    pass_dispatch(frame, PASS_LIGHT_ARGS, args, 1, 1, 1);
    gi->passes[PASS_LIGHT_ARGS].work++;
    pass_end(frame);
    pass_begin(frame, PASS_LIGHT_LIST);
    pass_dispatch(frame, PASS_LIGHT_LIST, args, (uint32_t)rows, 1, 1);
    gi->passes[PASS_LIGHT_LIST].work += gi->counters[SDFGI_COUNTER_LIGHT_CELLS + args->cascade];
    pass_end(frame);
}

void light_cache_list_record(struct frame *frame, uint32_t c)
{
    const struct sdfgi_pass_args args = { .cascade = c, .fresh = frame->gi->cascades[c].relist };
    record_list(frame, &args);
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
