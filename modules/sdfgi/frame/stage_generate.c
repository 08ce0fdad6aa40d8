/* SPDX-License-Identifier: MIT
 * Stages 3 and 4: voxels and distances. */
#include "stage.h"

#include "volume/change.h"

#include "shaders/shared/scratch.h"

/* ---- A jump flood cannot be cut: it makes all distances of a cascade at once */

static void add_flood_pass(const struct plan_stage *stage, enum pass pass,
                           const struct sdfgi_flood_args *args)
{
    struct work *work = sdfgi_stage_add(stage, pass, args->cascade);
    work->args.flood = *args;
    work->units = stage->input->extent.cells;
}

static void add_flood_step(const struct plan_stage *stage, struct sdfgi_flood_args *args, uint32_t jump)
{
    args->jump = jump;
    add_flood_pass(stage, PASS_FLOOD_STEP, args);
    args->source = 1 - args->source;
}

/* Jumps from half the resolution down to 1, then once more 2 and 1, which brings the largest error from over
 * a cell to about 0.1 (HARD_CASES, jump flood facts). */
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

/* ---- Pieces */

static void clear_accumulators(const struct plan_stage *stage, const struct cell_box *part)
{
    const uint32_t cells = (uint32_t)sdfgi_cell_box_cells(part);
    sdfgi_work_add_clear(&stage->frame->work, RESOURCE_SCRATCH, 0,
                         4ull * sdfgi_scratch_part_words(cells, stage->input->extent.emits));
}

/* The accumulators have room for a part of a cascade: a piece is made in parts, cut across its longest side.
 */
static void add_parts(const struct plan_stage *stage, const struct scroll_piece *piece)
{
    const uint32_t bits = sdfgi_log2(stage->frame->next.cascades.resolution);
    const int axis = sdfgi_cell_box_longest_axis(&piece->box);
    const uint64_t layer =
        sdfgi_cell_box_cells(&piece->box) / (uint64_t)(piece->box.high[axis] - piece->box.low[axis]);
    const uint64_t room = sdfgi_scratch_part_cells(bits) / layer;
    const int32_t thickness = (int32_t)(room - room % SDFGI_PROBE_SPACING);
    struct scroll_piece part = *piece;
    for (; part.box.low[axis] < piece->box.high[axis]; part.box.low[axis] = part.box.high[axis]) {
        const int32_t left = piece->box.high[axis] - part.box.low[axis];
        part.box.high[axis] = part.box.low[axis] + (left < thickness ? left : thickness);
        part.made = piece->box;
        part.made.high[axis] = part.box.low[axis];
        clear_accumulators(stage, &part.box);
        sdfgi_stage_add_phase(stage, PHASE_VOXELS, &(struct plan_target){ piece->cascade, &part });
    }
}

static void add_voxels(const struct plan_stage *stage, const struct scroll_piece *piece)
{
    const struct change *change = &stage->frame->next.cascades.at[piece->cascade].change;
    if (piece->begins && sdfgi_change_bounds_axis(change) >= 0)
        sdfgi_work_add_clear(&stage->frame->work, RESOURCE_BOUNDS,
                             (uint64_t)piece->cascade * SDFGI_BOUNDS_BYTES, SDFGI_BOUNDS_BYTES);
    add_parts(stage, piece);
}

const struct scroll_piece *sdfgi_stage_piece_beside(const struct plan_stage *stage)
{
    const struct scroll_plan *scroll = &stage->frame->scroll;
    const struct scroll_piece *found = NULL;
    for (uint32_t i = 0; i < scroll->piece_count; i++) {
        if (scroll->pieces[i].kind != PIECE_DISTANCES)
            continue;
        if (found)
            return NULL;
        found = &scroll->pieces[i];
    }
    const bool waits = stage->needs->holds[NEED_EXACT] && !stage->needs->holds[NEED_COMPLETE] &&
                       stage->needs->holds[NEED_TRACE] && sdfgi_stage_bounces(stage);
    return waits ? found : NULL;
}

static void add_distances(const struct plan_stage *stage, const struct scroll_piece *piece)
{
    if (piece == sdfgi_stage_piece_beside(stage))
        return;
    if (!stage->needs->holds[NEED_FLOOD])
        sdfgi_stage_add_phase(stage, PHASE_DISTANCES, &(struct plan_target){ piece->cascade, piece });
    else if (piece->first == 0)
        add_flood(stage, piece->cascade);
}

void sdfgi_stage_generate(const struct plan_stage *stage)
{
    for (uint32_t i = 0; i < stage->frame->scroll.piece_count; i++) {
        const struct scroll_piece *piece = &stage->frame->scroll.pieces[i];
        if (piece->kind == PIECE_VOXELS)
            add_voxels(stage, piece);
        else
            add_distances(stage, piece);
    }
}
