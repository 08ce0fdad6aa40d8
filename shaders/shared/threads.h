/* SPDX-License-Identifier: MIT
 * How many threads share an element, where the host has to know. */
#ifndef SDFGI_SHARED_THREADS_H
#define SDFGI_SHARED_THREADS_H

#include "types.h"
#include "constants.h"

/* Of a thread of ray_invalidate on software drivers, at least: it looks at all boxes first. */
#define SDFGI_LEAST_INVALIDATE_RAYS 32

/* Rays that such a thread tests. These drivers end a shader whose loops go round too often: a whole workgroup
 * shares very many rays. */
SDFGI_FUNCTION uint sdfgi_invalidate_rays(uint samples)
{
    const uint least = SDFGI_LEAST_INVALIDATE_RAYS,
               share = (samples + SDFGI_GROUP_LINEAR - 1u) / SDFGI_GROUP_LINEAR;
    return share > least ? share : least;
}

/* Threads that share the rays of a probe. Each has some. */
SDFGI_FUNCTION uint sdfgi_invalidate_threads(uint samples)
{
    const uint rays = sdfgi_invalidate_rays(samples);
    return (samples + rays - 1u) / rays;
}

#endif
