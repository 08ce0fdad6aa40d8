/* SPDX-License-Identifier: MIT
 * The queue of rays that a frame traces. The scratch buffer holds their indices in the ray cache. The last
 * record of indirect arguments holds the number of rays, and that of the workgroups that trace them. */
#ifndef SDFGI_RAY_QUEUE_GLSL
#define SDFGI_RAY_QUEUE_GLSL

#include "pass.glsl"

uint ray_queue_count()
{
    return indirect_number(uint(SDFGI_INDIRECT_RAYS));
}

#ifdef SDFGI_WRITES_INDIRECT
/* Makes room for `count` more rays. Returns the index of the first of them in the queue. */
uint ray_queue_extend(uint count)
{
    const uint first = atomicAdd(sdfgi_indirect[4u * uint(SDFGI_INDIRECT_RAYS) + 3u], count);
    const uint groups = (first + count + SDFGI_GROUP_LINEAR - 1u) / SDFGI_GROUP_LINEAR;
    atomicMax(sdfgi_indirect[4u * uint(SDFGI_INDIRECT_RAYS)], min(groups, uint(SDFGI_MAX_GROUPS)));
    return first;
}
#endif

#endif
