/* SPDX-License-Identifier: MIT */
#ifndef RAYCAST_PARALLEL_H
#define RAYCAST_PARALLEL_H

#include <stdint.h>

typedef void parallel_fn(void *context, uint32_t item);

/* Number of processors of this machine, at least 1. */
uint32_t raycast_parallel_processor_count(void);

/* Call fn once for every item in [0, count), on up to `threads` threads, in any order; returns when all are
 * done. The caller's thread works too, so that a machine that refuses more threads still gets there. */
void raycast_parallel_for(uint32_t threads, uint32_t count, parallel_fn *fn, void *context);

#endif
