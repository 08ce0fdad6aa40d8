/* SPDX-License-Identifier: MIT */
#include "frame_work.h"

#include "stage.h"

/* When counters start again. */
enum cleared { CLEARED_CHANGE, CLEARED_CYCLE };

static const struct {
    uint32_t counter;
    enum cleared cleared;
} counters[] = {
#define ROW(id, cleared, health) { SDFGI_COUNTER_##id, CLEARED_##cleared },
    SDFGI_COUNTERS(ROW)
#undef ROW
};

/* Clears the counters of a row and those between them. A frame that voxelises clears all. */
static void clear_counters(struct work_list *list, enum cleared when)
{
    uint32_t first = SDFGI_COUNTER_SINGLE_COUNT, end = 0;
    for (size_t i = 0; i < sizeof counters / sizeof *counters; i++)
        if (counters[i].cleared >= when) {
            first = counters[i].counter < first ? counters[i].counter : first;
            end = counters[i].counter + 1 > end ? counters[i].counter + 1 : end;
        }
    sdfgi_work_add_clear(list, RESOURCE_COUNTERS, 4 * first, 4 * (end - first));
}

/* Buffers that are new since something emits. */
static void clear_emitters(struct work_list *list, const struct extent *extent)
{
    static const enum resource cleared[] = { RESOURCE_EMITTERS, RESOURCE_RAYS };
    for (size_t i = 0; i < sizeof cleared / sizeof *cleared; i++)
        sdfgi_work_add_clear(list, cleared[i], 0, sdfgi_resource_size(cleared[i], extent));
}

void sdfgi_frame_add_work(struct frame *frame, const struct frame_input *input,
                          const struct situation_needs *needs)
{
    const struct plan_stage stage = { frame, input, needs };
    if (input->gaps.emitters)
        clear_emitters(&frame->work, &input->extent);
    if (frame->situation.low_light_begins || input->gaps.seen)
        sdfgi_work_add_clear(&frame->work, RESOURCE_SEEN, 0,
                             sdfgi_resource_size(RESOURCE_SEEN, &input->extent));
    if (needs->holds[NEED_GENERATE])
        clear_counters(&frame->work, CLEARED_CHANGE);
    else if (frame->next.accumulation.frame == 0)
        clear_counters(&frame->work, CLEARED_CYCLE);
    sdfgi_stage_empty_lists(&stage);
    sdfgi_stage_generate(&stage);
    sdfgi_stage_complete(&stage);
    sdfgi_stage_light(&stage);
}
