/* SPDX-License-Identifier: MIT
 * The rays that a frame traces: their places in the ray cache, in the scratch buffer; how many they are, the
 * workgroups that trace them, and how many needed too many steps, in the last two records of indirect
 * arguments. */
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

/* Not among the counters: other passes that run beside add to those. */
void ray_queue_add_capped()
{
    atomicAdd(sdfgi_indirect[RAY_QUEUE + 4u], 1u);
}

/* Makes room for `count` more; returns the first one's place. */
uint ray_queue_extend(uint count)
{
    const uint first = atomicAdd(sdfgi_indirect[RAY_QUEUE + 3u], count);
    const uint groups = (first + count + SDFGI_GROUP_LINEAR - 1u) / SDFGI_GROUP_LINEAR;
    atomicMax(sdfgi_indirect[RAY_QUEUE], min(groups, uint(SDFGI_MAX_GROUPS)));
    return first;
}

#endif
