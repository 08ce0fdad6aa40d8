/* SPDX-License-Identifier: MIT
 * Projects a triangle along its dominant axis onto a viewport of one pixel per column. The triangle is
 * widened, so that each column in which it may set a sub-voxel gets a fragment. There the test is made. */
#version 460
#extension GL_GOOGLE_include_directive : require
#define SDFGI_ZERO 0u /* see lib/on_cpu.glsl */
#include "voxelize_common.glsl"

layout(location = 0) flat out uint out_triangle;
layout(location = 1) flat out uint out_instance;

/* In pixels: a triangle may set sub-voxels half a pixel beside it. Also twice the edge margin. */
const float WIDEN = 0.5 + 2.0 / 256.0;
/* In pixels. A corner of a needle would have to move further than this, where rasterisers are not exact. A
 * needle draws the box around its columns instead. */
const float FARTHEST_MOVE = 4.0;

/* Moves corner i so that both edges that meet there shift outwards by WIDEN in the L1 sense. */
vec2 widened_corner(triangle t, int i)
{
    const vec3 e0 = t.edges[i], e1 = t.edges[(i + 2) % 3];
    const float c0 = e0.z + WIDEN * (abs(e0.x) + abs(e0.y)), c1 = e1.z + WIDEN * (abs(e1.x) + abs(e1.y));
    const float det = e0.x * e1.y - e0.y * e1.x;
    return vec2(e0.y * c1 - e1.y * c0, e1.x * c0 - e0.x * c1) / det;
}

bool is_needle(triangle t)
{
    bool needle = t.tiny;
    for (int i = 0; i < 3; i++)
        needle = needle || !(distance(widened_corner(t, i), t.v[i].xy) < FARTHEST_MOVE);
    return needle;
}

/* Corner of a right triangle around the box of the columns. */
vec2 columns_corner(triangle t, int corner)
{
    const vec2 low = vec2(t.columns.xy) - 0.5, size = vec2(t.columns.zw - t.columns.xy) + 2.0;
    return low + vec2(corner == 1 ? 2.0 * size.x : 0.0, corner == 2 ? 2.0 * size.y : 0.0);
}

void main()
{
    const uint t_index = uint(gl_VertexIndex) / 3u;
    const int corner = gl_VertexIndex % 3;
    out_triangle = t_index;
    out_instance = uint(gl_InstanceIndex);
    instance_load(out_instance);
    gl_Position = vec4(-2.0, -2.0, 0.5, 1.0);
    vec3 v[3];
    triangle t;
    const bool valid = triangle_fetch(t_index, v, t.index);
    if (corner == 0)
        triangle_count_faults(valid, v);
    if (!valid || !triangle_place(t, v))
        return;
    triangle_setup(t, v);
    const float size = float(sdfgi_space_resolution() * SDFGI_SUBVOXELS);
    const vec2 at = is_needle(t) ? columns_corner(t, corner) : widened_corner(t, corner);
    gl_Position = vec4((at + vec2(permute(drawn.anchor, t.axis).xy)) / size * 2.0 - 1.0, 0.5, 1.0);
}
