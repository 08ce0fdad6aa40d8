/* SPDX-License-Identifier: MIT
 * Dirty bounds of a change: boxes of cells around the sub-voxels that it removed, and around those that it
 * added. Distances and hits can only differ near these boxes. Each cascade is cut into strips across one
 * axis, and each strip has one box of either kind. Cells count from the low corner that the cascade has after
 * the change. */
#ifndef SDFGI_DIRTY_BOUNDS_GLSL
#define SDFGI_DIRTY_BOUNDS_GLSL

#include "pass.glsl"

/* The first six words of each box: how far it reaches from SDFGI_BOUNDS_ORIGIN downwards, and then upwards,
 * along x, y and z. Six zeroes are an empty box, and a box grows by maxima. */
layout(std430, set = SDFGI_SET_WORK, binding = SDFGI_BINDING_BOUNDS) buffer sdfgi_bounds_buffer
{
    uint sdfgi_bounds[];
};

/* First box of either kind: one box per strip follows. */
const uint BOUNDS_REMOVED = 0u;
const uint BOUNDS_ADDED = uint(SDFGI_BOUNDS_STRIPS);

uint bounds_slot(uint cascade, uint box)
{
    return uint(SDFGI_BOUNDS_STRIDE) * (cascade * 2u * uint(SDFGI_BOUNDS_STRIPS) + box);
}

/* Adds the cells [low, high) to the boxes of a kind; strips follow one another along `axis`. Most cells lie
 * in their box already, so a test spares most atomics. All six words are read before any is tested, so that
 * the reads overlap. */
void bounds_add(uint cascade, uint kind, int axis, ivec3 low, ivec3 high)
{
    const int strip = clamp(low[axis] * SDFGI_BOUNDS_STRIPS >> int(sdfgi_frame.resolution_log2), 0,
                            SDFGI_BOUNDS_STRIPS - 1);
    const uint slot = bounds_slot(cascade, kind + uint(strip));
    const uvec3 down = uvec3(SDFGI_BOUNDS_ORIGIN - low), up = uvec3(SDFGI_BOUNDS_ORIGIN + high);
    const uvec3 had_down = uvec3(sdfgi_bounds[slot], sdfgi_bounds[slot + 1u], sdfgi_bounds[slot + 2u]);
    const uvec3 had_up = uvec3(sdfgi_bounds[slot + 3u], sdfgi_bounds[slot + 4u], sdfgi_bounds[slot + 5u]);
    for (uint i = 0u; i < 3u; i++) {
        if (had_down[i] < down[i])
            atomicMax(sdfgi_bounds[slot + i], down[i]);
        if (had_up[i] < up[i])
            atomicMax(sdfgi_bounds[slot + 3u + i], up[i]);
    }
}

/* False for an empty box. */
bool bounds_any(uint cascade, uint box)
{
    return sdfgi_bounds[bounds_slot(cascade, box)] != 0u;
}

ivec3 bounds_low(uint cascade, uint box)
{
    const uint slot = bounds_slot(cascade, box);
    return SDFGI_BOUNDS_ORIGIN - ivec3(sdfgi_bounds[slot], sdfgi_bounds[slot + 1u], sdfgi_bounds[slot + 2u]);
}

ivec3 bounds_high(uint cascade, uint box)
{
    const uint slot = bounds_slot(cascade, box) + 3u;
    return ivec3(sdfgi_bounds[slot], sdfgi_bounds[slot + 1u], sdfgi_bounds[slot + 2u]) - SDFGI_BOUNDS_ORIGIN;
}

#endif
