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

enum relist sdfgi_frame_relist(const struct frame *frame, uint32_t c)
{
    const struct cascade *cascade = &frame->next.cascades.at[c];
    if (frame->situation.list_grew)
        return RELIST_NEW;
    if (!sdfgi_cascade_completes(cascade))
        return RELIST_NOT;
    return sdfgi_cell_box_empty(&cascade->change.kept) ? RELIST_NEW : RELIST_DIRTY;
}
