/* SPDX-License-Identifier: MIT
 * Where sub-voxels of a change went and came: other distances can only differ near there. Of each cascade, boxes of cells around
 * all that went and around all that came, one of each per strip across the cascade, in cells of the place that it moves to. */
#ifndef SDFGI_CONTENT_GLSL
#define SDFGI_CONTENT_GLSL

#include "pass.glsl"

/* Six words per box: how far it reaches from SDFGI_CONTENT_ORIGIN downwards, and upwards. Zeroes are no box, maxima its growth. */
layout(std430, set = 0, binding = SDFGI_BINDING_CONTENT) buffer sdfgi_content_buffer
{
    uint sdfgi_content[];
};

const uint CONTENT_WENT = 0u;
const uint CONTENT_CAME = uint(SDFGI_CONTENT_STRIPS);

uint content_slot(uint cascade, uint box)
{
    return 6u * (cascade * 2u * uint(SDFGI_CONTENT_STRIPS) + box);
}

/* ---- What a workgroup finds, so that few atomics meet in one place: thousands of cells raising the same six words took longer
 * than everything else that region_clear does. */

shared uint content_found[6 * SDFGI_CONTENT_STRIPS];

/* Called by all threads, before any has found something. */
void content_begin()
{
    for (uint i = gl_LocalInvocationIndex; i < 6u * uint(SDFGI_CONTENT_STRIPS); i += gl_WorkGroupSize.x)
        content_found[i] = 0u;
    barrier();
}

/* Adds the cells [low, high), all of one strip; strips lie one behind the other along an axis. */
void content_find(int axis, ivec3 low, ivec3 high)
{
    const int strip = clamp(low[axis] * SDFGI_CONTENT_STRIPS >> int(sdfgi_frame.size.y), 0, SDFGI_CONTENT_STRIPS - 1);
    for (int i = 0; i < 3; i++) {
        atomicMax(content_found[6 * strip + i], uint(SDFGI_CONTENT_ORIGIN - low[i]));
        atomicMax(content_found[6 * strip + 3 + i], uint(SDFGI_CONTENT_ORIGIN + high[i]));
    }
}

/* Called by all threads: adds what they found to what went or came. Testing first spares atomics once more. */
void content_end(uint cascade, uint what)
{
    barrier();
    const uint slot = content_slot(cascade, what);
    for (uint i = gl_LocalInvocationIndex; i < 6u * uint(SDFGI_CONTENT_STRIPS); i += gl_WorkGroupSize.x)
        if (content_found[i] > sdfgi_content[slot + i])
            atomicMax(sdfgi_content[slot + i], content_found[i]);
}

/* ---- What all of them found */

bool content_any(uint cascade, uint box)
{
    return sdfgi_content[content_slot(cascade, box)] != 0u;
}

ivec3 content_low(uint cascade, uint box)
{
    const uint slot = content_slot(cascade, box);
    return SDFGI_CONTENT_ORIGIN - ivec3(sdfgi_content[slot], sdfgi_content[slot + 1u], sdfgi_content[slot + 2u]);
}

ivec3 content_high(uint cascade, uint box)
{
    const uint slot = content_slot(cascade, box) + 3u;
    return ivec3(sdfgi_content[slot], sdfgi_content[slot + 1u], sdfgi_content[slot + 2u]) - SDFGI_CONTENT_ORIGIN;
}

#endif
