/* SPDX-License-Identifier: MIT
 * Where sub-voxels of a change went and came: other distances can only differ near there. Of each cascade, boxes of cells around
 * all that went and around all that came, one of each per strip across the cascade, in cells of the place that it moves to. */
#ifndef SDFGI_CONTENT_GLSL
#define SDFGI_CONTENT_GLSL

#include "pass.glsl"

/* The first six words of each box: how far it reaches from SDFGI_CONTENT_ORIGIN downwards, and upwards. Zeroes are no box,
 * maxima its growth. */
layout(std430, set = 0, binding = SDFGI_BINDING_CONTENT) buffer sdfgi_content_buffer
{
    uint sdfgi_content[];
};

const uint CONTENT_WENT = 0u;
const uint CONTENT_CAME = uint(SDFGI_CONTENT_STRIPS);

uint content_slot(uint cascade, uint box)
{
    return uint(SDFGI_CONTENT_STRIDE) * (cascade * 2u * uint(SDFGI_CONTENT_STRIPS) + box);
}

/* Adds the cells [low, high) to what went or came; strips lie one behind the other along an axis. Testing first spares contended
 * atomics; all six words are read before any is tested. */
void content_add(uint cascade, uint what, int axis, ivec3 low, ivec3 high)
{
    const int strip = clamp(low[axis] * SDFGI_CONTENT_STRIPS >> int(sdfgi_frame.size.y), 0, SDFGI_CONTENT_STRIPS - 1);
    const uint slot = content_slot(cascade, what + uint(strip));
    const uvec3 down = uvec3(SDFGI_CONTENT_ORIGIN - low), up = uvec3(SDFGI_CONTENT_ORIGIN + high);
    const uvec3 had_down = uvec3(sdfgi_content[slot], sdfgi_content[slot + 1u], sdfgi_content[slot + 2u]);
    const uvec3 had_up = uvec3(sdfgi_content[slot + 3u], sdfgi_content[slot + 4u], sdfgi_content[slot + 5u]);
    for (uint i = 0u; i < 3u; i++) {
        if (had_down[i] < down[i])
            atomicMax(sdfgi_content[slot + i], down[i]);
        if (had_up[i] < up[i])
            atomicMax(sdfgi_content[slot + 3u + i], up[i]);
    }
}

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
