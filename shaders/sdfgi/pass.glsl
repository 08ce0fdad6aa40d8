/* SPDX-License-Identifier: MIT
 * What every pass of the library includes: push constants, counters, and the buffers that several passes use
 * but hosts do not bind. */
#ifndef SDFGI_PASS_GLSL
#define SDFGI_PASS_GLSL

#include "../include/sdfgi_space.glsl"
#include "../shared/args.h"
#include "../shared/counters.h"
#include "../shared/scratch.h"
#include "push.glsl"
#include "texels.glsl"

/* Several groups of passes use this buffer in turn: see shared/scratch.h. */
layout(std430, set = SDFGI_SET_WORK, binding = SDFGI_BINDING_SCRATCH) buffer sdfgi_scratch_buffer
{
    uint sdfgi_scratch[];
};

#ifdef SDFGI_WRITES_INDIRECT
#define SDFGI_ACCESS_INDIRECT
#else
#define SDFGI_ACCESS_INDIRECT readonly
#endif

/* Records of SDFGI_INDIRECT_*. */
layout(std430, set = SDFGI_SET_WORK,
       binding = SDFGI_BINDING_INDIRECT) SDFGI_ACCESS_INDIRECT buffer sdfgi_indirect_buffer
{
    uint sdfgi_indirect[];
};

/* The number of items of a record. */
uint indirect_number(uint record)
{
    return sdfgi_indirect[4u * record + 3u];
}

layout(std430, set = SDFGI_SET_WORK, binding = SDFGI_BINDING_COUNTERS) buffer sdfgi_counters_buffer
{
    uint sdfgi_counters[];
};

void counter_add(uint counter, uint value)
{
    atomicAdd(sdfgi_counters[counter], value);
}

#endif
