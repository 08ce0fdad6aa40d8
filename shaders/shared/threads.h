/* SPDX-License-Identifier: MIT
 * How many threads share an element, where the host has to know. */
#ifndef SDFGI_SHARED_THREADS_H
#define SDFGI_SHARED_THREADS_H

#include "types.h"
#include "constants.h"

/* Threads of ray_invalidate that share the rays of a probe on software drivers. A thread looks at all boxes
 * first, so that 32 rays each are best. These drivers end a shader whose loops go round too often: where
 * there are very many rays, all threads of a workgroup share them. */
SDFGI_FUNCTION uint sdfgi_invalidate_threads(uint rays)
{
    const uint threads = (rays + 31u) / 32u, most = SDFGI_GROUP_LINEAR;
    return threads < most ? threads : most;
}

#endif
