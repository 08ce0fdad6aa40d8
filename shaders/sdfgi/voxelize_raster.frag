/* SPDX-License-Identifier: MIT
 * One fragment per column of a triangle. It makes the same test and the same stores as voxelize.comp. */
#version 460
#extension GL_GOOGLE_include_directive : require
#define SDFGI_ZERO 0u /* see lib/on_cpu.glsl */
#include "voxelize_common.glsl"

layout(location = 0) flat in uint in_triangle;
layout(location = 1) flat in uint in_instance;

void main()
{
    vec3 v[3];
    triangle t;
    instance_load(in_instance);
    if (triangle_fetch(in_triangle, v, t.index) && triangle_place(t, v)) {
        triangle_setup(t, v);
        const ivec2 column = ivec2(gl_FragCoord.xy) - permute(drawn.anchor, t.axis).xy;
        if (all(greaterThanEqual(column, t.columns.xy)) && all(lessThanEqual(column, t.columns.zw)))
            triangle_store_column(t, column);
    }
}
