/* SPDX-License-Identifier: MIT
 * Stage 4: distances of a cascade, exactly or by a jump flood. */
#include "internal.h"

static uint32_t groups_of(uint64_t elements)
{
    return (uint32_t)((elements + SDFGI_GROUP_LINEAR - 1) / SDFGI_GROUP_LINEAR);
}

static void record_exact(struct frame *frame, uint32_t c)
{
    struct sdfgi *gi = frame->gi;
    const uint64_t cells = gi->resources->extent.cells;
    struct sdfgi_pass_args args = { .cascade = c };
    pass_begin(frame, PASS_OCCUPANCY);
    pass_dispatch(frame, PASS_OCCUPANCY, &args, groups_of(cells / 64), 1, 1);
    args.step = 1;
    pass_dispatch(frame, PASS_OCCUPANCY, &args, groups_of(cells / 4096), 1, 1);
    gi->passes[PASS_OCCUPANCY].work += cells;
    pass_end(frame);

    pass_begin(frame, PASS_DISTANCE_EXACT);
    pass_dispatch_cells(frame, PASS_DISTANCE_EXACT, &args);
    pass_end(frame);
}

static void flood_step(struct frame *frame, struct sdfgi_pass_args *args, uint32_t length)
{
    args->step = length;
    pass_dispatch_cells(frame, PASS_FLOOD_STEP, args);
    args->source = 1 - args->source;
}

/* Steps from half the resolution down to 1, then once more 2 and 1, which brings the largest error from over
 * a cell to about 0.1 (HARD_CASES, jump flood facts). */
static void record_flood(struct frame *frame, uint32_t c)
{
    struct sdfgi_pass_args args = { .cascade = c };
    pass_begin(frame, PASS_FLOOD_SEED);
    pass_dispatch_cells(frame, PASS_FLOOD_SEED, &args);
    pass_end(frame);

    pass_begin(frame, PASS_FLOOD_STEP);
    for (uint32_t length = frame->gi->settings.resolution / 2; length > 0; length /= 2)
        flood_step(frame, &args, length);
    flood_step(frame, &args, 2);
    flood_step(frame, &args, 1);
    pass_end(frame);

    pass_begin(frame, PASS_FLOOD_DISTANCE);
    pass_dispatch_cells(frame, PASS_FLOOD_DISTANCE, &args);
    pass_end(frame);
}

void distance_field_record(struct frame *frame, uint32_t c)
{
    if (frame->gi->plan[PASS_FLOOD_STEP].run)
        record_flood(frame, c);
    else
        record_exact(frame, c);
}
