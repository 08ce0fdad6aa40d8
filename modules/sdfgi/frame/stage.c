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

void sdfgi_stage_forget_seen(const struct plan_stage *stage, uint32_t c)
{
    const struct extent *e = &stage->input->extent;
    const uint64_t seen = sdfgi_resource_size(RESOURCE_SEEN, e) / e->cascades;
    if (!e->gathers)
        return;
    sdfgi_work_add_clear(&stage->frame->work, RESOURCE_SEEN, c * seen, seen);
    sdfgi_work_add_clear(&stage->frame->work, RESOURCE_COUNTERS, 4 * (SDFGI_COUNTER_CELLS_SEEN + c), 4);
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
