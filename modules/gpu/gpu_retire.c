/* SPDX-License-Identifier: MIT */
#include "gpu.h"

#include <assert.h>

void gpu_retire(struct gpu_retire_queue *queue, struct gpu_retired *item,
                void (*destroy)(struct gpu_retired *item, void *user), void *user)
{
    assert(destroy);
    *item = (struct gpu_retired){ queue->first, queue->frame, destroy, user };
    queue->first = item;
}

void gpu_retire_collect(struct gpu_retire_queue *queue)
{
    struct gpu_retired **link = &queue->first;
    while (*link) {
        struct gpu_retired *item = *link;
        if (queue->frame >= item->frame + queue->frames_in_flight) {
            *link = item->next;
            item->destroy(item, item->user);
        } else {
            link = &item->next;
        }
    }
}

void gpu_retire_all(struct gpu_retire_queue *queue)
{
    while (queue->first) {
        struct gpu_retired *item = queue->first;
        queue->first = item->next;
        item->destroy(item, item->user);
    }
}
