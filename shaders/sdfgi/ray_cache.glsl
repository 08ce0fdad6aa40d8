/* SPDX-License-Identifier: MIT
 * The ray cache: where each ray of a probe's sample cycle ends. A word holds the texel of the light cell that
 * the ray reads, its cascade and the axis to read, plus 1; or one of the codes SDFGI_RAY_*. */
#ifndef SDFGI_RAY_CACHE_GLSL
#define SDFGI_RAY_CACHE_GLSL

#include "pass.glsl"

/* SDFGI_RAY_UNKNOWN is a hit that is not cached. */
layout(std430, set = SDFGI_SET_WORK, binding = SDFGI_BINDING_RAYS) buffer sdfgi_rays_buffer
{
    uint sdfgi_rays[];
};

uint ray_pack(uint cascade, ivec3 cell, uint axis)
{
    return (sdfgi_cell_index(cascade, cell) | axis << (3u * sdfgi_frame.resolution_log2 + 3u)) + 1u;
}

/* Index of the light cell that a hit reads, and the axis to read. */
uint ray_light_index(uint code, out uint axis)
{
    const uint bits = 3u * sdfgi_frame.resolution_log2 + 3u;
    axis = (code - 1u) >> bits;
    return (code - 1u) & ((1u << bits) - 1u);
}

ivec3 ray_cell(uint code, out uint cascade)
{
    uint axis;
    const uint index = ray_light_index(code, axis);
    cascade = index >> (3u * sdfgi_frame.resolution_log2);
    return sdfgi_cell_from_texel(cascade, sdfgi_texel_from_index(index));
}

/* False too for a hit whose light cell has left the valid region of its cascade: another cell may be stored
 * in its place. */
bool ray_is_cached(uint code)
{
    if (code == SDFGI_RAY_UNKNOWN)
        return false;
    if (code >= SDFGI_RAY_CAPPED)
        return true;
    uint cascade;
    const ivec3 cell = ray_cell(code, cascade);
    return sdfgi_cell_is_valid(cascade, cell);
}

#endif
