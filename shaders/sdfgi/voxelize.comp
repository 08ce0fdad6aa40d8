/* SPDX-License-Identifier: MIT
 * Voxelises a mesh instance into one cascade. args.threads threads share a triangle and divide its columns: one where
 * triangles are smaller than a sub-voxel, many workgroups where two of them cross the whole volume. */
#version 460
#extension GL_GOOGLE_include_directive : require
#include "voxelize_common.glsl"

layout(local_size_x = SDFGI_GROUP_TRIANGLE) in;

void main()
{
    const uint group = gl_WorkGroupID.x + gl_WorkGroupID.z * args.group_width;
    const uint t_index = (group * uint(SDFGI_GROUP_TRIANGLE) + gl_LocalInvocationIndex) / args.threads;
    const uint share = gl_LocalInvocationIndex % args.threads;
    if (t_index >= args.triangle_count)
        return;
    vec3 v[3];
    triangle t;
    if (!triangle_fetch(t_index, v, t.index)) {
        if (share == 0u && gl_WorkGroupID.y == 0u)
            counter_add(SDFGI_COUNTER_TRIANGLES_SKIPPED, 1u);
        return;
    }
    if (!triangle_setup(t, v))
        return;
    const ivec2 size = t.columns.zw - t.columns.xy + 1;
    const uint count = uint(size.x * size.y);
    for (uint i = gl_WorkGroupID.y * args.threads + share; i < count; i += args.slices * args.threads)
        triangle_store_column(t, t.columns.xy + ivec2(int(i) % size.x, int(i) / size.x));
}
