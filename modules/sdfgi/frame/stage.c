/* SPDX-License-Identifier: MIT */
#include "stage.h"

#include <assert.h>

struct work *sdfgi_stage_add(const struct plan_stage *stage, enum pass pass, uint32_t cascade)
{
    const enum need need = sdfgi_pass_row(pass)->need;
    return stage->needs->holds[need]
               ? sdfgi_work_add(&stage->frame->work, pass, cascade, sdfgi_need_reason(need))
               : NULL;
}

uint32_t sdfgi_stage_begin_group(const struct plan_stage *stage)
{
    return stage->frame->work.count;
}

void sdfgi_stage_end_group(const struct plan_stage *stage, uint32_t first)
{
    struct work_list *list = &stage->frame->work;
    assert(first <= list->count);
    list->groups++;
    for (uint32_t i = first; i < list->count; i++)
        list->items[i].group = list->groups;
}

/* Clears parts [first, first + count) of a cascade's marks. */
static void clear_marks(const struct plan_stage *stage, uint32_t c, uint32_t first, uint32_t count)
{
    const struct extent *e = &stage->input->extent;
    const uint64_t part = 4ull * sdfgi_seen_part_words((uint32_t)e->light_cells);
    if (e->gathers)
        sdfgi_work_add_clear(&stage->frame->work, RESOURCE_SEEN, (SDFGI_SEEN_PARTS * c + first) * part,
                             count * part);
}

static void clear_seen_counter(const struct plan_stage *stage, uint32_t c)
{
    if (stage->input->extent.gathers)
        sdfgi_work_add_clear(&stage->frame->work, RESOURCE_COUNTERS, 4 * (SDFGI_COUNTER_CELLS_SEEN + c), 4);
}

static void clear_hit_counter(const struct plan_stage *stage, uint32_t c)
{
    const struct extent *e = &stage->input->extent;
    if (e->gathers)
        sdfgi_work_add_clear(
            &stage->frame->work, RESOURCE_GATHERED,
            sdfgi_gather_counters_offset(e) + 4 * (SDFGI_COUNTER_CELLS_HIT - SDFGI_COUNTER_GATHER + c), 4);
}

void sdfgi_stage_forget_seen(const struct plan_stage *stage, uint32_t c)
{
    clear_marks(stage, c, 0, 1);
    clear_seen_counter(stage, c);
}

void sdfgi_stage_forget_hit(const struct plan_stage *stage, uint32_t c)
{
    clear_marks(stage, c, 2 - sdfgi_gathering_hit_part(&stage->frame->next.gathering), 1);
    clear_hit_counter(stage, c);
}

void sdfgi_stage_forget_watched(const struct plan_stage *stage, uint32_t c)
{
    clear_marks(stage, c, 0, SDFGI_SEEN_PARTS);
    clear_seen_counter(stage, c);
    clear_hit_counter(stage, c);
    sdfgi_gathering_forget_hit(&stage->frame->next.gathering, c);
}

bool sdfgi_frame_lights_all(const struct frame *frame)
{
    return frame->lights.moved == SDFGI_LIGHT_ALL;
}

enum relist sdfgi_frame_relist(const struct frame *frame, uint32_t c)
{
    const struct cascade *cascade = &frame->next.cascades.at[c];
    if (frame->situation.list_grew && !sdfgi_cell_box_empty(&cascade->valid))
        return RELIST_NEW;
    if (!sdfgi_cascade_completes(cascade))
        return RELIST_NOT;
    return sdfgi_cell_box_empty(&cascade->change.kept) ? RELIST_NEW : RELIST_DIRTY;
}
