/* SPDX-License-Identifier: MIT
 * What columns of froxels need to know of the picture's depth: see host_fog_seen.glsl. Dispatched as 1 thread
 * per column. */
#version 460
#extension GL_GOOGLE_include_directive : require
#include "lib/on_cpu.glsl"
#include "host/host_frame.glsl"
#include "host/host_fog_space.glsl"

layout(local_size_x = HOST_FOG_COLUMNS, local_size_y = HOST_FOG_COLUMNS) in;

layout(set = HOST_SET_FOG, binding = 3) uniform sampler2D depth_image;
layout(set = HOST_SET_FOG, binding = 4, std430) writeonly buffer seen_block
{
    vec4 seen[];
};

/* Linear over planes; 0 for the sky and beyond the picture. */
float depth_at(ivec2 pixel)
{
    return any(lessThan(pixel, ivec2(0))) || any(greaterThanEqual(pixel, ivec2(frame.fog_grid.xy)))
               ? 0.0
               : texelFetch(depth_image, pixel, 0).r;
}

/* Four pixels at a time. Where a side is odd the last four begin a pixel before it ends. */
float least_depth(ivec2 first, ivec2 end)
{
    vec4 least = vec4(1.0);
    for (int y = first.y; y < end.y; y += 2) {
        for (int x = first.x; x < end.x; x += 2) {
            const vec2 middle = vec2(min(ivec2(x, y), end - 2) + 1);
            least = min(least, textureGather(depth_image, middle / frame.fog_grid.xy));
        }
    }
    return min(min(least.x, least.y), min(least.z, least.w));
}

/* Change of depth per pixel, to the side on which there is a surface; if there are two, the smaller one,
 * which is not that of a silhouette. */
float slope_at(ivec2 pixel, ivec2 step)
{
    const float here = depth_at(pixel), next = depth_at(pixel + step), last = depth_at(pixel - step);
    const float ahead = next > 0.0 ? next - here : 0.0, behind = last > 0.0 ? here - last : 0.0;
    const bool both = next > 0.0 && last > 0.0;
    return both ? (abs(ahead) < abs(behind) ? ahead : behind) : ahead + behind;
}

void main()
{
    const ivec2 column = ivec2(gl_GlobalInvocationID.xy), columns = fog_columns();
    if (any(greaterThanEqual(column, columns)))
        return;
    const int side = int(frame.fog_grid.z);
    const ivec2 pixel = min(side * column, ivec2(frame.fog_grid.xy) - 1);
    const float least = least_depth(pixel, min(pixel + side, ivec2(frame.fog_grid.xy)));
    const vec2 slope = vec2(slope_at(pixel, ivec2(1, 0)), slope_at(pixel, ivec2(0, 1)));
    /* The column is at a corner of the pixel, or a little beyond the picture. */
    const float depth = depth_at(pixel) + dot(slope, vec2(side * column - pixel) - 0.5);
    seen[column.x + columns.x * column.y] = vec4(least, depth, float(side) * slope);
}
