/* SPDX-License-Identifier: MIT
 * Items of passes that are planned by their row alone: what they run over follows from the domain, their
 * arguments from the argument struct. */
#include "stage.h"

#include "shaders/shared/scratch.h"
#include "volume/change.h"

#include <assert.h>

static const struct change *change_of(const struct plan_stage *stage, const struct plan_target *target)
{
    return &stage->frame->next.cascades.at[target->cascade].change;
}

/* ---- Domains */

/* Cells in the light blocks that a change makes dirty, some of them more than once: those in cages that touch
 * it. */
static uint64_t dirty_cells(const struct plan_stage *stage, const struct plan_target *target)
{
    if (sdfgi_frame_relist(stage->frame, target->cascade) == RELIST_NEW)
        return stage->input->extent.cells;
    const struct change *change = change_of(stage, target);
    const struct cell_box whole = sdfgi_cell_box_whole(stage->frame->next.cascades.resolution);
    uint64_t cells = 0;
    for (uint32_t i = 0; i < change->count; i++) {
        const struct cell_box wide = sdfgi_cell_box_widened(&change->boxes[i], SDFGI_PROBE_SPACING);
        const struct cell_box inside = sdfgi_cell_box_common(&wide, &whole);
        cells += sdfgi_cell_box_cells(&inside);
    }
    return cells;
}

/* What a pass over probes counts for each of them. */
static uint64_t units_of_probe(const struct plan_stage *stage, const struct pass_row *row)
{
    if (row->unit != UNIT_RAYS)
        return 1;
    return row->domain == DOMAIN_ALL_PROBES ? stage->frame->next.params.rays_per_frame
                                            : SDFGI_OCCLUSION_TEXELS * SDFGI_OCCLUSION_TEXELS;
}

/* Rays of a probe in this frame: at random, and towards emitters. */
static uint32_t rays_of_probe(const struct plan_stage *stage)
{
    const struct sdfgi_frame_params *p = &stage->frame->next.params;
    const bool emits = stage->input->extent.emits;
    return p->rays_per_frame + (emits ? sdfgi_scratch_emitter_rays(p->first_sample, p->rays_per_frame) : 0);
}

/* Cells that a pass over layers of blocks looks at. How many it searched, counters tell. */
static uint64_t layer_cells(uint32_t layers, uint64_t resolution)
{
    return 4 * layers * resolution * resolution;
}

static void fill_domain(const struct plan_stage *stage, const struct plan_target *target, struct work *work)
{
    const struct pass_row *row = sdfgi_pass_row(work->pass);
    const struct extent *e = &stage->input->extent;
    const uint32_t n = stage->frame->next.cascades.resolution;
    if (target->piece) {
        work->box = target->piece->box;
        work->made = target->piece->made;
        work->first = target->piece->first;
        work->count = target->piece->count;
    }
    switch (row->domain) {
    case DOMAIN_BOX:
        work->units = sdfgi_cell_box_cells(&work->box) / (row->unit == UNIT_BLOCKS ? 8 : 1);
        break;
    case DOMAIN_DISTANCE_ROWS:
        work->units = layer_cells((target->piece->finds_bits ? n / 4 : 0) + work->count, n);
        break;
    case DOMAIN_DISTANCE_LAYERS:
    case DOMAIN_DISTANCE_COLUMNS:
        work->units = layer_cells(work->count, n);
        break;
    case DOMAIN_PROBES:
        work->units = e->probes * units_of_probe(stage, row);
        break;
    case DOMAIN_ALL_PROBES:
        work->count = (uint32_t)e->cascades;
        work->units = e->probes * e->cascades * units_of_probe(stage, row);
        break;
    case DOMAIN_ALL_RAYS:
        work->count = (uint32_t)e->probes * rays_of_probe(stage);
        work->units = work->count * e->cascades;
        break;
    case DOMAIN_LIGHT_BLOCKS:
        work->units = dirty_cells(stage, target);
        work->count = (uint32_t)(work->units > e->light_cells ? work->units : e->light_cells);
        break;
    case DOMAIN_LIGHT_ROWS:
        work->units = stage->input->counters[SDFGI_COUNTER_LIGHT_CELLS + target->cascade];
        break;
    case DOMAIN_CELLS:
    case DOMAIN_CUBES:
        work->units = e->cells;
        break;
    case DOMAIN_BLOCKS:
    case DOMAIN_CASCADE:
        work->units = row->unit == UNIT_CELLS ? e->cells : e->blocks;
        break;
    case DOMAIN_INSTANCES:
    case DOMAIN_TILE_LIST: /* the recorder counts triangles */
        break;
    case DOMAIN_LIGHT_CELLS:
    case DOMAIN_ALL_LIGHT_CELLS:
    case DOMAIN_SEEN_WORDS:
    case DOMAIN_STORED_LIGHT:
    case DOMAIN_PIXELS:
    case DOMAIN_TILES:
        assert(row->phase == PHASE_OWN);
        break;
    }
}

/* ---- Arguments */

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

static struct sdfgi_region_args region_args(const struct change *change, uint32_t c,
                                            const struct cell_box *box)
{
    return (struct sdfgi_region_args){
        .low = { box->low[0], box->low[1], box->low[2] },
        .cascade = c,
        .high = { box->high[0], box->high[1], box->high[2] },
        .bounds_axis = sdfgi_change_bounds_axis(change),
        .before = { change->before[0], change->before[1], change->before[2] },
    };
}

/* Without boxes everything is dirty: nothing is kept. */
static struct sdfgi_distance_prepare_args prepare_args(const struct change *change, const struct work *work,
                                                       bool finds_bits, uint32_t resolution)
{
    const uint32_t groups = resolution * resolution / sdfgi_pass_row(work->pass)->group;
    struct sdfgi_distance_prepare_args args = { .cascade = work->cascade,
                                                .first_block = work->first,
                                                .row_groups = finds_bits ? groups : 0 };
    const uint32_t count = sdfgi_cell_box_empty(&change->kept) ? 0 : change->count;
    for (uint32_t i = 0; i < count; i++)
        if (!sdfgi_cell_box_empty(&change->boxes[i]))
            pack_box(&change->boxes[i], (int32_t)resolution, args.corners + 3 * args.box_count++);
    return args;
}

static void fill_args(const struct plan_stage *stage, const struct plan_target *target, struct work *work)
{
    const struct frame *frame = stage->frame;
    const struct change *change = change_of(stage, target);
    const uint32_t c = target->cascade;
    switch (sdfgi_pass_row(work->pass)->args) {
    case ARGS_cascade:
        work->args.cascade.cascade = c;
        break;
    case ARGS_region:
        work->args.region = region_args(change, c, &work->box);
        break;
    case ARGS_distance_prepare:
        work->args.distance_prepare =
            prepare_args(change, work, target->piece->finds_bits, frame->next.cascades.resolution);
        break;
    case ARGS_distance_search:
        work->args.distance_search =
            (struct sdfgi_distance_search_args){ c, 4 * work->first, 4 * (work->first + work->count) };
        break;
    case ARGS_light_mark:
        work->args.light_mark =
            (struct sdfgi_light_mark_args){ .cascade = c,
                                            .rebuild = sdfgi_frame_relist(frame, c) == RELIST_NEW };
        break;
    case ARGS_probe_blend:
        work->args.probe_blend = (struct sdfgi_probe_blend_args){
            .cycle_ends = frame->cycle_ends,
            .marks = frame->cycle_ends && sdfgi_accumulation_marks(&frame->next.accumulation),
            .without_history = frame->next.accumulation.phase < LIGHTING_RUNNING,
        };
        break;
    case ARGS_none:
    case ARGS_voxelize: /* the recorder fills them in for each instance */
        break;
    case ARGS_flood:
    case ARGS_light_direct:
    case ARGS_light_bounce:
    case ARGS_visit_list:
    case ARGS_cell_gather:
    case ARGS_cell_filter:
    case ARGS_light_rescale:
    case ARGS_gather:
    case ARGS_debug_view:
    case ARGS_COUNT:
        assert(sdfgi_pass_row(work->pass)->phase == PHASE_OWN);
        break;
    }
}

/* ---- Phases */

/* Voxelisers need not run where there is only air. */
static bool is_void(const struct plan_stage *stage, enum pass pass, const struct plan_target *target)
{
    if (sdfgi_pass_row(pass)->domain != DOMAIN_INSTANCES)
        return false;
    const struct cascade *cascade = &stage->frame->next.cascades.at[target->cascade];
    const struct box box = sdfgi_cascade_world_box(cascade, &target->piece->box);
    return !sdfgi_scene_touches(stage->input->scene, &box);
}

void sdfgi_stage_add_pass(const struct plan_stage *stage, enum pass pass, const struct plan_target *target)
{
    if (is_void(stage, pass, target))
        return;
    struct work *work = sdfgi_stage_add(stage, pass, target->cascade);
    if (!work)
        return;
    fill_domain(stage, target, work);
    fill_args(stage, target, work);
}

void sdfgi_stage_add_phase(const struct plan_stage *stage, enum pass_phase phase,
                           const struct plan_target *target)
{
    for (int i = 0; i < PASS_COUNT; i++)
        if (sdfgi_pass_row((enum pass)i)->phase == phase)
            sdfgi_stage_add_pass(stage, (enum pass)i, target);
}
