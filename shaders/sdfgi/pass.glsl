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

/* Several groups of passes use this buffer in turn: see shared/scratch.h. */
layout(std430, set = SDFGI_SET_WORK, binding = SDFGI_BINDING_SCRATCH) buffer sdfgi_scratch_buffer
{
    uint sdfgi_scratch[];
};

layout(std430, set = SDFGI_SET_WORK, binding = SDFGI_BINDING_COUNTERS) buffer sdfgi_counters_buffer
{
    uint sdfgi_counters[];
};

void counter_add(uint counter, uint value)
{
    atomicAdd(sdfgi_counters[counter], value);
}

#endif
