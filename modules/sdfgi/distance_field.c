/* SPDX-License-Identifier: MIT
 * Stage 4: distances of a cascade, exactly and in parts, or by a jump flood. */
#include "internal.h"

/* Cells that a pass looks at, as far as the host knows; how many were searched, counters tell. */
static void count_cells(struct frame *frame, enum pass pass, uint32_t layers)
{
    const uint64_t n = frame->gi->settings.resolution;
    frame->gi->passes[pass].work += 4 * layers * n * n;
}

static int32_t clamp_to(int32_t value, int32_t low, int32_t high)
{
    return value < low ? low : value > high ? high : value;
}

/* A box cut to where it can matter: all that lies further away than the cascade is wide is as far as that. */
static void pack_box(const struct cell_box *box, uint32_t resolution, uint corners[static 3])
{
    const int32_t n = (int32_t)resolution;
    for (int i = 0; i < 3; i++) {
        const int32_t low = clamp_to(box->low[i], -n, 2 * n), high = clamp_to(box->high[i], -n, 2 * n);
        corners[i] = ((uint)low & 0xffffu) | (uint)high << 16;
    }
}

static struct sdfgi_distance_prepare_args prepare_args(uint32_t resolution, uint32_t c, const struct distance_part *part)
{
    struct sdfgi_distance_prepare_args args = { .cascade = c, .first_block = part->first };
    for (uint32_t i = 0; i < part->dirty_count; i++)
        if (!cell_box_empty(&part->changed[i]))
            pack_box(&part->changed[i], resolution, args.corners + 3 * args.box_count++);
    return args;
}

/* Workgroups for all columns of cells, and one per column of blocks to look at. */
static void record_prepare(struct frame *frame, const struct sdfgi_distance_prepare_args *args, uint32_t count)
{
    const uint32_t n = frame->gi->settings.resolution;
    pass_begin(frame, PASS_DISTANCE_PREPARE);
    gpu_use(&frame->rec, GPU_USAGE_COMPUTE, pass_reads(PASS_DISTANCE_PREPARE),
            pass_writes(PASS_DISTANCE_PREPARE));
    gpu_push(&frame->rec, frame->gi->pipelines.layout, sizeof *args, args);
    gpu_dispatch(&frame->rec, n * n / SDFGI_GROUP_COLUMNS + n / 4 * count, 1, 1);
    frame->gi->passes[PASS_DISTANCE_PREPARE].dispatches++;
    count_cells(frame, PASS_DISTANCE_PREPARE, n / 4 + count);
    pass_end(frame);
}

static void record_search(struct frame *frame, uint32_t c, const struct distance_part *part)
{
    const uint32_t n = frame->gi->settings.resolution, count = part->count;
    const struct sdfgi_distance_search_args args = { .cascade = c,
                                                     .first_x = 4 * part->first,
                                                     .end_x = 4 * (part->first + count) };
    const uint32_t first_run = args.first_x / SDFGI_LINES,
                   end_run = (args.end_x + SDFGI_LINES - 1) / SDFGI_LINES;
    pass_begin(frame, PASS_DISTANCE_PLANE);
    pass_dispatch(frame, PASS_DISTANCE_PLANE, PASS_ARGS(args), end_run - first_run, 4 * n, 1);
    count_cells(frame, PASS_DISTANCE_PLANE, count);
    pass_end(frame);

    pass_begin(frame, PASS_DISTANCE_EXACT);
    pass_dispatch(frame, PASS_DISTANCE_EXACT, PASS_ARGS(args), n / 2, count, 1);
    count_cells(frame, PASS_DISTANCE_EXACT, count);
    pass_end(frame);
}

static void record_exact(struct frame *frame, uint32_t c, const struct distance_part *part)
{
    const uint32_t n = frame->gi->settings.resolution;
    const struct sdfgi_distance_prepare_args prepare = prepare_args(n, c, part);
    if (part->dirty_count > 0 && prepare.box_count == 0)
        return; /* boxes without a cell */
    record_prepare(frame, &prepare, part->count);
    record_search(frame, c, part);
}

static void flood_step(struct frame *frame, struct sdfgi_flood_args *args, uint32_t jump)
{
    args->jump = jump;
    pass_dispatch_cells(frame, PASS_FLOOD_STEP, PASS_ARGS(*args));
    args->source = 1 - args->source;
}

/* Steps from half the resolution down to 1, then once more 2 and 1, which brings the largest error from over
 * a cell to about 0.1 (HARD_CASES, jump flood facts). */
static void record_flood(struct frame *frame, uint32_t c)
{
    struct sdfgi_flood_args args = { .cascade = c };
    pass_begin(frame, PASS_FLOOD_SEED);
    pass_dispatch_cells(frame, PASS_FLOOD_SEED, PASS_ARGS(args));
    pass_end(frame);

    pass_begin(frame, PASS_FLOOD_STEP);
    for (uint32_t length = frame->gi->settings.resolution / 2; length > 0; length /= 2)
        flood_step(frame, &args, length);
    flood_step(frame, &args, 2);
    flood_step(frame, &args, 1);
    pass_end(frame);

    pass_begin(frame, PASS_FLOOD_DISTANCE);
    pass_dispatch_cells(frame, PASS_FLOOD_DISTANCE, PASS_ARGS(args));
    pass_end(frame);
}

void distance_field_record(struct frame *frame, uint32_t c, const struct distance_part *part)
{
    if (!frame->gi->plan[PASS_FLOOD_STEP].run)
        record_exact(frame, c, part);
    else if (part->first == 0)
        record_flood(frame, c);
}
