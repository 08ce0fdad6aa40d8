/* SPDX-License-Identifier: MIT
 * Stages 3 and 4: voxels and distances. */
#include "frame_work.h"

#include "volume/change.h"

/* ---- Voxels */

static union work_args region_args(const struct change *change, uint32_t c, const struct cell_box *box)
{
    return (union work_args){ .region = {
                                  .low = { box->low[0], box->low[1], box->low[2] },
                                  .cascade = c,
                                  .high = { box->high[0], box->high[1], box->high[2] },
                                  .bounds_axis = change_bounds_axis(change),
                                  .before = { change->before[0], change->before[1], change->before[2] },
                              } };
}

/* `cells_per_unit`: of what the pass counts as work. */
static void add_region_part(const struct plan_stage *stage, enum pass pass, uint32_t c,
                            const struct cell_box *box, uint32_t cells_per_unit)
{
    struct work *work = stage_add(stage, pass, c);
    work->box = *box;
    work->units = cell_box_cells(box) / cells_per_unit;
    work->args = region_args(&stage->frame->next.cascades.at[c].change, c, box);
}

/* Whole slices, as many as fit the workgroups that every device takes: a cascade of 256^3 cells is one
 * workgroup too many for region_clear. */
static int32_t region_part_length(enum pass pass, const struct cell_box *box, int axis)
{
    const uint64_t most = (uint64_t)pass_row(pass)->group * SDFGI_MAX_GROUPS;
    const uint64_t layer = cell_box_cells(box) / (uint64_t)(box->high[axis] - box->low[axis]);
    const uint64_t length = most / layer / SDFGI_PROBE_SPACING * SDFGI_PROBE_SPACING;
    return length < SDFGI_MAX_GROUPS ? (int32_t)length : SDFGI_MAX_GROUPS;
}

static void add_region(const struct plan_stage *stage, enum pass pass, const struct scroll_piece *piece,
                       uint32_t cells_per_unit)
{
    const int axis = cell_box_longest_axis(&piece->box);
    const int32_t length = region_part_length(pass, &piece->box, axis), high = piece->box.high[axis];
    struct cell_box part = piece->box;
    for (; part.low[axis] < high; part.low[axis] = part.high[axis]) {
        part.high[axis] = high - part.low[axis] > length ? part.low[axis] + length : high;
        add_region_part(stage, pass, piece->cascade, &part, cells_per_unit);
    }
}

static void add_voxelizer(const struct plan_stage *stage, enum pass pass, const struct scroll_piece *piece)
{
    const struct cascade *cascade = &stage->frame->next.cascades.at[piece->cascade];
    const struct box box = cascade_world_box(cascade, &piece->box);
    if (!scene_touches(stage->input->scene, &box))
        return;
    struct work *work = stage_add(stage, pass, piece->cascade);
    if (work)
        work->box = piece->box;
}

static void add_voxels(const struct plan_stage *stage, const struct scroll_piece *piece)
{
    const struct change *change = &stage->frame->next.cascades.at[piece->cascade].change;
    if (piece->begins && change_bounds_axis(change) >= 0)
        work_add_clear(&stage->frame->work, RESOURCE_BOUNDS, (uint64_t)piece->cascade * SDFGI_BOUNDS_BYTES,
                       SDFGI_BOUNDS_BYTES);
    add_region(stage, PASS_REGION_CLEAR, piece, 4);
    add_voxelizer(stage, PASS_VOXELIZE, piece);
    add_voxelizer(stage, PASS_VOXELIZE_RASTER, piece);
    add_region(stage, PASS_VOXEL_RESOLVE, piece, 8);
}

/* ---- Distances, exact
 *
 * Distances come out equal, bit for bit, to those made of the same bits as a whole. Only blocks are searched that a
 * change may have reached. */

static int32_t clamp_to(int32_t value, int32_t low, int32_t high)
{
    return value < low ? low : value > high ? high : value;
}

/* A box cut to where it can matter: all that lies further away than the cascade is wide is as far as that. */
static void pack_box(const struct cell_box *box, int32_t n, uint corners[static 3])
{
    for (int i = 0; i < 3; i++) {
        const int32_t low = clamp_to(box->low[i], -n, 2 * n), high = clamp_to(box->high[i], -n, 2 * n);
        corners[i] = ((uint)low & 0xffffu) | (uint)high << 16;
    }
}

/* Without boxes everything is dirty: nothing is kept. */
static struct sdfgi_distance_prepare_args prepare_args(const struct change *change, const struct scroll_piece *piece,
                                                       uint32_t resolution)
{
    struct sdfgi_distance_prepare_args args = { .cascade = piece->cascade, .first_block = piece->first };
    const uint32_t count = cell_box_empty(&change->kept) ? 0 : change->count;
    for (uint32_t i = 0; i < count; i++)
        if (!cell_box_empty(&change->boxes[i]))
            pack_box(&change->boxes[i], (int32_t)resolution, args.corners + 3 * args.box_count++);
    return args;
}

/* Cells that a pass looks at, as far as the host knows. How many were searched, counters tell. */
static uint64_t layer_cells(uint32_t layers, uint64_t resolution)
{
    return 4 * layers * resolution * resolution;
}

static void add_exact(const struct plan_stage *stage, const struct scroll_piece *piece)
{
    const uint32_t n = stage->frame->next.cascades.resolution;
    const struct change *change = &stage->frame->next.cascades.at[piece->cascade].change;
    const struct sdfgi_distance_search_args search = { piece->cascade, 4 * piece->first,
                                                       4 * (piece->first + piece->count) };
    static const enum pass passes[] = { PASS_DISTANCE_PREPARE, PASS_DISTANCE_PLANE, PASS_DISTANCE_EXACT };
    for (int i = 0; i < 3; i++) {
        struct work *work = stage_add(stage, passes[i], piece->cascade);
        work->first = piece->first;
        work->count = piece->count;
        work->units = layer_cells(i == 0 ? n / 4 + piece->count : piece->count, n);
        if (i == 0)
            work->args.distance_prepare = prepare_args(change, piece, n);
        else
            work->args.distance_search = search;
    }
}

/* ---- Distances, by a jump flood: it cannot be cut, and makes all of a cascade with the first layer */

static void add_flood_pass(const struct plan_stage *stage, enum pass pass, const struct sdfgi_flood_args *args)
{
    struct work *work = stage_add(stage, pass, args->cascade);
    work->args.flood = *args;
    work->units = stage->input->extent.cells;
}

static void add_flood_step(const struct plan_stage *stage, struct sdfgi_flood_args *args, uint32_t jump)
{
    args->jump = jump;
    add_flood_pass(stage, PASS_FLOOD_STEP, args);
    args->source = 1 - args->source;
}

/* Jumps from half the resolution down to 1, then once more 2 and 1, which brings the largest error from over a cell to about
 * 0.1 (HARD_CASES, jump flood facts). */
static void add_flood(const struct plan_stage *stage, uint32_t c)
{
    struct sdfgi_flood_args args = { .cascade = c };
    add_flood_pass(stage, PASS_FLOOD_SEED, &args);
    for (uint32_t jump = stage->frame->next.cascades.resolution / 2; jump > 0; jump /= 2)
        add_flood_step(stage, &args, jump);
    add_flood_step(stage, &args, 2);
    add_flood_step(stage, &args, 1);
    add_flood_pass(stage, PASS_FLOOD_DISTANCE, &args);
}

void stage_generate(const struct plan_stage *stage)
{
    for (uint32_t i = 0; i < stage->frame->scroll.piece_count; i++) {
        const struct scroll_piece *piece = &stage->frame->scroll.pieces[i];
        if (piece->kind == PIECE_VOXELS)
            add_voxels(stage, piece);
        else if (!stage->needs->holds[NEED_FLOOD])
            add_exact(stage, piece);
        else if (piece->first == 0)
            add_flood(stage, piece->cascade);
    }
}
