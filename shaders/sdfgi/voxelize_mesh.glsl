/* SPDX-License-Identifier: MIT
 * What the voxeliser reads of a mesh: its triangles, and whether they are as the host said. */
#ifndef SDFGI_VOXELIZE_MESH_GLSL
#define SDFGI_VOXELIZE_MESH_GLSL

#define SDFGI_WRITES_BITS
#define SDFGI_WRITES_LIGHT
#define SDFGI_WRITES_SCRATCH
#include "voxelize_instance.glsl"
#include "../lib/finite.glsl"
#include "../lib/vertex_fetch.glsl"

layout(std430, set = SDFGI_SET_MESH, binding = SDFGI_BINDING_MESH_POSITIONS) readonly buffer mesh_positions
{
    uint positions[];
};
layout(std430, set = SDFGI_SET_MESH, binding = SDFGI_BINDING_MESH_UVS) readonly buffer mesh_uvs
{
    uint uvs[];
};
layout(std430, set = SDFGI_SET_MESH, binding = SDFGI_BINDING_MESH_COLORS) readonly buffer mesh_colors
{
    uint colors[];
};
layout(std430, set = SDFGI_SET_MESH, binding = SDFGI_BINDING_MESH_INDICES) readonly buffer mesh_indices
{
    uint indices[];
};

/* In sub-voxels. Beyond this floats cannot place an edge to within a sub-voxel. */
const float MAX_COORDINATE = 1e9;
/* Of a texture's coordinates and of a vertex's colour: sums and products of such stay finite. */
const float MAX_UV = 1e9, MAX_COLOR = 65504.0;

/* A corner of a box of cells. */
ivec3 unpacked_corner(uint packed)
{
    return ivec3(uvec3(packed, packed >> 10u, packed >> 20u) & 1023u);
}

/* The same in sub-voxels from the anchor. */
ivec3 box_corner(uint packed)
{
    return unpacked_corner(packed) * SDFGI_SUBVOXELS - drawn.anchor;
}

SDFGI_FETCH_FUNCTION(fetch_position, positions, 3)
SDFGI_FETCH_FUNCTION(fetch_uv, uvs, 2)
SDFGI_FETCH_FUNCTION(fetch_color, colors, 4)
SDFGI_FETCH_INDEX_FUNCTION(fetch_index, indices)

/* Where a vertex has an attribute. */
uint vertex_byte(uint fetch, uint stride, uint vertex)
{
    return (fetch & SDFGI_FETCH_OFFSET_MASK) + vertex * stride;
}

uint mesh_index(uint i)
{
    const uint bits = args.flags & SDFGI_MESH_INDEX_BITS;
    uint index = i;
    if (bits > 0u)
        index = fetch_index(bits, (args.flags >> SDFGI_MESH_INDEX_OFFSET_SHIFT & 255u) + i * (bits >> 3u));
    return index + args.vertex_offset;
}

vec3 mesh_position(uint vertex)
{
    const uint byte = vertex_byte(args.position_fetch, args.position_stride, vertex);
    const vec4 p = vec4(fetch_position(args.position_fetch, byte).xyz, 1.0);
    return vec3(dot(drawn.rows[0], p), dot(drawn.rows[1], p), dot(drawn.rows[2], p));
}

/* False if a vertex is out of range or not finite. All vertices are read before any is tested, so that the
 * reads overlap. */
bool triangle_fetch(uint t, out vec3 v[3], out uint index[3])
{
    bool valid = true;
    for (int i = int(SDFGI_ZERO); i < 3; i++)
        index[i] = mesh_index(3u * t + uint(i));
    for (int i = int(SDFGI_ZERO); i < 3; i++) {
        v[i] = mesh_position(min(index[i], args.vertex_count - 1u));
        valid = valid && index[i] < args.vertex_count &&
                max(abs(v[i].x), max(abs(v[i].y), abs(v[i].z))) < MAX_COORDINATE;
    }
    return valid;
}

/* A cell, and what rounding makes of a place so far from the anchor. */
vec3 bounds_slack(vec3 from_anchor)
{
    return float(SDFGI_SUBVOXELS) + abs(from_anchor) * (1.0 / 1048576.0);
}

/* True if a vertex lies outside the instance's bounds, within the cascade or beyond a side of it that the
 * bounds do not reach. */
bool triangle_leaves_bounds(vec3 v[3])
{
    const ivec3 size = ivec3(sdfgi_space_resolution() * SDFGI_SUBVOXELS);
    const vec3 first = vec3(-drawn.anchor), last = vec3(size - drawn.anchor);
    const vec3 low = clamp(min(v[0], min(v[1], v[2])), first, last),
               high = clamp(max(v[0], max(v[1], v[2])), first, last);
    vec3 bounds_low, bounds_high;
    instance_bounds(bounds_low, bounds_high);
    return any(lessThan(low, clamp(bounds_low - bounds_slack(bounds_low), first, last))) ||
           any(greaterThan(high, clamp(bounds_high + bounds_slack(bounds_high), first, last)));
}

/* Counts a triangle that is skipped, or that the host's bounds miss. */
void triangle_count_faults(bool valid, vec3 v[3])
{
    if (drawn.checked)
        return;
    if (!valid)
        counter_add(SDFGI_COUNTER_TRIANGLES_SKIPPED, 1u);
    else if (triangle_leaves_bounds(v))
        counter_add(SDFGI_COUNTER_OUT_OF_BOUNDS, 1u);
}

/* Of the corners; 0 where the mesh has none. */
vec2[3] corner_uvs(uint index[3])
{
    vec2 at[3] = vec2[3](vec2(0.0), vec2(0.0), vec2(0.0));
    const uint count = args.uv_fetch != 0u ? 3u : 0u;
    for (uint i = 0u; i < count; i++) {
        const vec2 v = fetch_uv(args.uv_fetch, vertex_byte(args.uv_fetch, args.uv_stride, index[i])).xy;
        at[i] = vec2(sdfgi_finite_clamp(v.x, -MAX_UV, MAX_UV), sdfgi_finite_clamp(v.y, -MAX_UV, MAX_UV));
    }
    return at;
}

vec4[3] corner_colors(uint index[3])
{
    vec4 at[3] = vec4[3](vec4(0.0), vec4(0.0), vec4(0.0));
    const uint count = args.color_fetch != 0u ? 3u : 0u;
    for (uint i = 0u; i < count; i++) {
        const vec4 v =
            fetch_color(args.color_fetch, vertex_byte(args.color_fetch, args.color_stride, index[i]));
        at[i] = vec4(sdfgi_finite_color(v.rgb, MAX_COLOR), sdfgi_finite_clamp(v.a, 0.0, MAX_COLOR));
    }
    return at;
}

#endif
