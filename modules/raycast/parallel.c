/* SPDX-License-Identifier: MIT */
#include "parallel.h"

#include <pthread.h>
#include <stdatomic.h>
#include <unistd.h>

#define MAX_THREADS 256

struct work {
    parallel_fn *fn;
    void *context;
    uint32_t count;
    atomic_uint next;
};

uint32_t raycast_parallel_processor_count(void)
{
    const long n = sysconf(_SC_NPROCESSORS_ONLN);
    return n < 1 ? 1 : n > MAX_THREADS ? MAX_THREADS : (uint32_t)n;
}

static void *take_items(void *argument)
{
    struct work *w = argument;
    for (;;) {
        const uint32_t item = atomic_fetch_add(&w->next, 1);
        if (item >= w->count)
            return NULL;
        w->fn(w->context, item);
    }
}

void raycast_parallel_for(uint32_t threads, uint32_t count, parallel_fn *fn, void *context)
{
    struct work w = { .fn = fn, .context = context, .count = count };
    pthread_t helpers[MAX_THREADS];
    uint32_t started = 0;
    while (started + 1 < threads && started + 1 < count && started < MAX_THREADS &&
           pthread_create(&helpers[started], NULL, take_items, &w) == 0)
        started++;
    take_items(&w);
    for (uint32_t i = 0; i < started; i++)
        pthread_join(helpers[i], NULL);
}
