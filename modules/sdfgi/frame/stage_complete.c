/* SPDX-License-Identifier: MIT
 * Stages 5 to 7 where a change completes: probes, light cells and their light. */
#include "stage.h"

#include "shaders/shared/scratch.h"

/* Empties the sums of this cycle, the ray cache and, if no cycle has been completed, the cycle before. */
static void clear_probes(const struct plan_stage *stage, uint32_t c)
{
    const struct extent *e = &stage->input->extent;
    const uint64_t rays = sdfgi_resource_size(RESOURCE_RAYS, e) / e->cascades,
                   sums = sdfgi_resource_size(RESOURCE_SUMS, e) / e->cascades,
                   previous = sdfgi_resource_size(RESOURCE_PREVIOUS, e) / e->cascades;
    struct work_list *list = &stage->frame->work;
    sdfgi_work_add_clear(list, RESOURCE_RAYS, c * rays, rays);
    sdfgi_work_add_clear(list, RESOURCE_SUMS, c * sums, sums);
    if (stage->frame->next.accumulation.phase < LIGHTING_RUNNING)
        sdfgi_work_add_clear(list, RESOURCE_PREVIOUS, c * previous, previous);
}

/* Blocks and rows of the light list; entries need no clearing. */
static void clear_list(const struct plan_stage *stage)
{
    const uint32_t bits = sdfgi_log2(stage->frame->next.cascades.resolution);
    sdfgi_work_add_clear(&stage->frame->work, RESOURCE_SCRATCH, 0,
                         4 * (uint64_t)sdfgi_scratch_light_before(bits));
}

/* The emitters of a cascade, before the light list takes the scratch buffer. */
static void list_emitters(const struct plan_stage *stage, uint32_t c)
{
    if (!stage->needs->holds[NEED_EMITTERS])
        return;
    sdfgi_work_add_clear(&stage->frame->work, RESOURCE_SCRATCH, 0, 4 * SDFGI_SCRATCH_EMITTERS);
    sdfgi_stage_add_phase(stage, PHASE_EMITTERS, &(struct plan_target){ .cascade = c });
}

/* Where light cells are: blocks that have none are not written. */
static void clear_blocks(const struct plan_stage *stage, uint32_t c)
{
    const struct extent *e = &stage->input->extent;
    const uint64_t blocks = sdfgi_resource_size(RESOURCE_LIGHT_BLOCKS, e) / e->cascades;
    sdfgi_work_add_clear(&stage->frame->work, RESOURCE_LIGHT_BLOCKS, c * blocks, blocks);
}

/* A pass over the light cells in dirty blocks, with the workgroups of a record of indirect arguments. How
 * many cells that is comes back frames later: the work is that of the list before. */
static void add_dirty(const struct plan_stage *stage, enum pass pass, uint32_t c, uint32_t record,
                      const union work_args *args)
{
    struct work *work = sdfgi_stage_add(stage, pass, c);
    if (!work)
        return;
    work->indirect = record + c;
    work->args = *args;
    work->units = stage->input->counters[SDFGI_COUNTER_LIGHT_DIRTY + c];
}

static void add_direct(const struct plan_stage *stage, uint32_t c)
{
    const union work_args args = { .light_direct = { .cascade = c,
                                                     .only_dirty = 1,
                                                     .threads_per_ray = stage->input->threads_per_ray,
                                                     .changed = SDFGI_LIGHT_ALL,
                                                     .moved = SDFGI_LIGHT_ALL } };
    add_dirty(stage, PASS_LIGHT_DIRECT, c, SDFGI_INDIRECT_DIRECT, &args);
}

static void add_bounce(const struct plan_stage *stage, uint32_t c)
{
    const union work_args args = {
        .light_bounce = { .cascade = c,
                          .only_dirty = 1,
                          .without_probes = stage->frame->next.accumulation.phase == LIGHTING_DARK }
    };
    add_dirty(stage, PASS_LIGHT_BOUNCE, c, SDFGI_INDIRECT_CELLS, &args);
}

/* Rays of a cascade go on into coarser ones, never into finer: those of the finest cascades, up to the
 * coarsest that completes, may be invalid. Once per frame, with the finest cascade that completes. */
static void add_ray_invalidate(const struct plan_stage *stage, uint32_t c)
{
    const struct cascades *cascades = &stage->frame->next.cascades;
    uint32_t finest = SDFGI_MAX_CASCADES, count = 0;
    for (uint32_t i = cascades->count; i-- > 0;)
        if (sdfgi_cascade_completes(&cascades->at[i])) {
            finest = i;
            count = count > i + 1 ? count : i + 1;
        }
    if (c != finest || stage->frame->situation.from_nothing || stage->frame->situation.list_grew)
        return;
    struct work *work = sdfgi_stage_add(stage, PASS_RAY_INVALIDATE, 0);
    work->count = count;
    work->units = stage->input->extent.probes * sdfgi_extent_probe_words(&stage->input->extent) * count;
}

static void empty_list(const struct plan_stage *stage, uint32_t c)
{
    static const uint32_t counters[] = { SDFGI_COUNTER_LIGHT_CELLS, SDFGI_COUNTER_LIGHT_DIRTY },
                          records[] = { SDFGI_INDIRECT_CELLS, SDFGI_INDIRECT_MASKS };
    for (size_t i = 0; i < sizeof counters / sizeof *counters; i++) {
        sdfgi_work_add_clear(&stage->frame->work, RESOURCE_COUNTERS, 4 * (counters[i] + c), 4);
        sdfgi_work_add_clear(&stage->frame->work, RESOURCE_INDIRECT, 16 * (records[i] + c) + 12, 4);
    }
    clear_blocks(stage, c);
    sdfgi_stage_forget_watched(stage, c);
}

void sdfgi_stage_empty_lists(const struct plan_stage *stage)
{
    const struct frame *frame = stage->frame;
    for (uint32_t c = 0; c < frame->next.cascades.count; c++) {
        const struct change *change = &frame->next.cascades.at[c].change;
        if ((frame->scroll.begun >> c & 1) && change->cause == CHANGE_REBUILD &&
            change->stage != CHANGE_COMPLETES)
            empty_list(stage, c);
    }
}

/* Probes and light cells of a cascade. The order of passes is such that neighbours touch nothing in common:
 * no barrier comes between them. */
static void complete_cascade(const struct plan_stage *stage, uint32_t c)
{
    const bool completes = sdfgi_cascade_completes(&stage->frame->next.cascades.at[c]);
    const struct plan_target target = { .cascade = c };
    const union work_args mask = { .cascade = { c } };
    if (completes) {
        sdfgi_stage_add_phase(stage, PHASE_BOXES, &target);
        list_emitters(stage, c);
    }
    clear_list(stage);

    const uint32_t first = sdfgi_stage_begin_group(stage);
    sdfgi_stage_add_phase(stage, PHASE_MARK, &target);
    if (completes)
        sdfgi_stage_add_phase(stage, PHASE_PLACE, &target);
    sdfgi_stage_end_group(stage, first);

    clear_blocks(stage, c);
    sdfgi_stage_forget_watched(stage, c);
    sdfgi_stage_add_phase(stage, PHASE_LIST, &target);

    const uint32_t second = sdfgi_stage_begin_group(stage);
    add_direct(stage, c);
    add_dirty(stage, PASS_CELL_MASK, c, SDFGI_INDIRECT_MASKS, &mask);
    if (completes)
        sdfgi_stage_add_phase(stage, PHASE_SEED, &target);
    add_ray_invalidate(stage, c);
    sdfgi_stage_end_group(stage, second);

    add_bounce(stage, c);
}

/* Counters of a list that another one replaces. */
static void clear_gather_counters(const struct plan_stage *stage)
{
    const struct extent *e = &stage->input->extent;
    if (e->gathers)
        sdfgi_work_add_clear(&stage->frame->work, RESOURCE_GATHERED, sdfgi_gather_counters_offset(e),
                             sizeof(uint32_t) * (SDFGI_COUNTER_COUNT - SDFGI_COUNTER_GATHER));
}

/* Coarse cascades first, from which new probes of finer ones take their start. */
void sdfgi_stage_complete(const struct plan_stage *stage)
{
    const struct frame *frame = stage->frame;
    if (!stage->needs->holds[NEED_LIST])
        return;
    if (frame->situation.from_nothing || frame->situation.list_grew)
        clear_gather_counters(stage);
    for (uint32_t c = frame->next.cascades.count; c-- > 0;) {
        if (frame->situation.from_nothing || frame->situation.list_grew)
            clear_probes(stage, c);
        if (sdfgi_frame_relist(frame, c) != RELIST_NOT)
            complete_cascade(stage, c);
    }
}
