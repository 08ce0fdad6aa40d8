/* SPDX-License-Identifier: MIT
 * The queue of rays that a frame traces. The scratch buffer holds their indices in the ray cache. The last
 * two records of indirect arguments hold the number of rays, the number of workgroups that trace them, and
 * the number of rays that ran out of steps. */
#ifndef SDFGI_RAY_QUEUE_GLSL
#define SDFGI_RAY_QUEUE_GLSL

#include "pass.glsl"

layout(std430, set = SDFGI_SET_WORK, binding = SDFGI_BINDING_INDIRECT) buffer sdfgi_indirect_buffer
{
    uint sdfgi_indirect[];
};

const uint RAY_QUEUE = 4u * uint(SDFGI_INDIRECT_RAYS);

uint ray_queue_count()
{
    return sdfgi_indirect[RAY_QUEUE + 3u];
}

uint ray_queue_capped()
{
    return sdfgi_indirect[RAY_QUEUE + 4u];
}

/* Counts a ray that ran out of steps. The count is no counter of its own, because passes that add to the
 * counters run beside this one. */
void ray_queue_add_capped()
{
    atomicAdd(sdfgi_indirect[RAY_QUEUE + 4u], 1u);
}

/* Makes room for `count` more rays. Returns the index of the first of them in the queue. */
uint ray_queue_extend(uint count)
{
    const uint first = atomicAdd(sdfgi_indirect[RAY_QUEUE + 3u], count);
    const uint groups = (first + count + SDFGI_GROUP_LINEAR - 1u) / SDFGI_GROUP_LINEAR;
    atomicMax(sdfgi_indirect[RAY_QUEUE], min(groups, uint(SDFGI_MAX_GROUPS)));
    return first;
}

#endif
