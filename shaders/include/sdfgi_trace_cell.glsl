/* SPDX-License-Identifier: MIT
 * A ray in one cell: the axes of the ray, the occupancy bits of the cell, and the walk from sub-voxel to
 * sub-voxel (Amanatides and Woo 1987). */
#ifndef SDFGI_TRACE_CELL_GLSL
#define SDFGI_TRACE_CELL_GLSL

#include "sdfgi_space.glsl"

/* A stored distance leads from a cell's centre to the centre of a sub-voxel, whose corner is up to sqrt(3) /
 * 8 closer. The flood may store 0.1 too much. */
#define SDFGI_TRACE_MARGIN 0.32
/* Rounding may misplace a ray that runs exactly along an edge by so many sub-voxels. */
#define SDFGI_TRACE_EDGE 0.00025

/* ---- Occupancy bits of one cell */

/* The coordinates of a sub-voxel in its cell, a byte each. A step out of the cell sets the third bit of a
 * byte. */
uint sdfgi_trace_pack_subvoxel(ivec3 subvoxel)
{
    return uint(subvoxel.x | subvoxel.y << 8 | subvoxel.z << 16);
}

const uint SDFGI_TRACE_OUTSIDE_CELL = 0x040404u;

bool sdfgi_trace_is_set(uvec2 bits, uint packed)
{
    const uint shift = (packed & 3u) | (packed >> 6u & 12u) | (packed >> 12u & 16u);
    return (((packed & 0x20000u) == 0u ? bits.x : bits.y) >> shift & 1u) != 0u;
}

/* The bits of the sub-voxels [low, high] of a cell. */
uvec2 sdfgi_trace_box_bits(uvec3 low, uvec3 high)
{
    const uint row = (15u << low.x) & (15u >> 3u - high.x);
    const uint slice = row * 0x1111u & (0xffffu << 4u * low.y) & (0xffffu >> 4u * (3u - high.y));
    const uint slices = (15u << low.z) & (15u >> 3u - high.z);
    return slice * uvec2((slices & 1u) | (slices & 2u) << 15u, (slices >> 2u & 1u) | (slices & 8u) << 13u);
}

/* ---- Axes of a ray */

/* The axis along which a ray leaves a box, and the parameter at which it does. `sides`: where the sides lie
 * towards which it leads. */
int sdfgi_trace_sides_exit(vec3 origin, vec3 inv_dir, vec3 sides, out float t)
{
    const vec3 far = (sides - origin) * inv_dir;
    t = min(far.x, min(far.y, far.z));
    return far.x <= t ? 0 : (far.y <= t ? 1 : 2);
}

/* The same for the box [low, low + size]. */
int sdfgi_trace_box_exit(vec3 origin, vec3 inv_dir, vec3 low, float size, out float t)
{
    return sdfgi_trace_sides_exit(origin, inv_dir, low + size * vec3(greaterThan(inv_dir, vec3(0.0))), t);
}

/* A component of a vector, without indexing: a vector whose index differs between threads goes through
 * memory. */
float sdfgi_trace_component(vec3 v, int axis)
{
    return axis == 0 ? v.x : (axis == 1 ? v.y : v.z);
}

/* A metric direction in cell space, without a component that is 0. */
vec3 sdfgi_trace_cells_direction(vec3 dir)
{
    return sdfgi_nonzero(sdfgi_cells_from_metric(dir));
}

/* 1 or -1 per axis of a direction. */
ivec3 sdfgi_trace_signs(vec3 dir)
{
    return 2 * ivec3(greaterThan(dir, vec3(0.0))) - 1;
}

/* Offset to the next cell along an axis. */
ivec3 sdfgi_trace_offset(ivec3 signs, int axis)
{
    return ivec3(axis == 0, axis == 1, axis == 2) * signs;
}

/* The face through which a ray enters a cell along an axis, numbered as sdfgi_trace_hit::axis. */
uint sdfgi_trace_face(int axis, vec3 dir)
{
    return uint(2 * axis) + (sdfgi_trace_component(dir, axis) > 0.0 ? 1u : 0u);
}

/* ---- The walk through one cell */

/* Walks from sub-voxel to sub-voxel, starting at parameter t. Returns true at a set one; `t` and `axis` tell
 * where the ray entered it or, otherwise, where it left the cell. The other threads of a subgroup wait for
 * the longest walk, so the loop avoids vectors with an index. */
bool sdfgi_trace_walk_subvoxels(uvec2 bits, ivec3 cell, vec3 origin, vec3 dir, vec3 inv_dir, inout float t,
                                inout int axis)
{
    const ivec3 low = cell * SDFGI_SUBVOXELS;
    const ivec3 forward = ivec3(greaterThan(dir, vec3(0.0)));
    /* A ray that enters exactly on an edge could pass between two set sub-voxels that touch only at that
     * edge. It therefore starts a little behind the edge, and visits the sub-voxel beside it first. */
    const vec3 behind = t > 0.0 ? sign(dir) * SDFGI_TRACE_EDGE : vec3(0.0);
    const ivec3 first = clamp(ivec3(floor((origin + dir * t) * 4.0 - behind)) - low, ivec3(0), ivec3(3));
    vec3 next = ((vec3(low + first + forward) * 0.25) - origin) * inv_dir;
    const vec3 delta = abs(inv_dir) * 0.25;
    const ivec3 step = (forward * 2 - 1) * ivec3(1, 1 << 8, 1 << 16);
    uint subvoxel = sdfgi_trace_pack_subvoxel(first);
    for (int i = 0; i < 3 * SDFGI_SUBVOXELS; i++) {
        if (sdfgi_trace_is_set(bits, subvoxel))
            return true;
        const bool x = next.x <= min(next.y, next.z), y = !x && next.y <= next.z;
        t = max(t, x ? next.x : (y ? next.y : next.z));
        axis = x ? 0 : (y ? 1 : 2);
        subvoxel += uint(x ? step.x : (y ? step.y : step.z));
        next.x += x ? delta.x : 0.0;
        next.y += y ? delta.y : 0.0;
        next.z += x || y ? 0.0 : delta.z;
        if ((subvoxel & SDFGI_TRACE_OUTSIDE_CELL) != 0u)
            return false;
    }
    return false;
}

/* The bits of a cell's sub-voxels that a ray may touch between parameter t and its exit: those in the box
 * around that piece of the ray. */
uvec2 sdfgi_trace_bits_near_ray(ivec3 cell, vec3 origin, vec3 dir, float t, float t_exit)
{
    const vec3 edge = sign(dir) * SDFGI_TRACE_EDGE, low = vec3(cell * SDFGI_SUBVOXELS);
    const vec3 from = clamp((origin + dir * t) * 4.0 - edge - low, 0.0, 3.0);
    const vec3 to = clamp((origin + dir * t_exit) * 4.0 + edge - low, 0.0, 3.0);
    return sdfgi_trace_box_bits(uvec3(min(from, to)), uvec3(max(from, to)));
}

#endif
