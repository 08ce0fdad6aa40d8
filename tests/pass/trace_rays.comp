/* SPDX-License-Identifier: MIT
 * Follows rays from cascade 0 on: per ray the origin in cells and the range, the direction, and what was hit:
 * the distance, whether at all, whether the steps ran out, and the face; after the direction, where along x
 * in its cascade the light cell is, -1 if none was found. */
#version 460
#extension GL_GOOGLE_include_directive : require
#include "../../shaders/include/sdfgi_trace.glsl"

layout(local_size_x = 64) in;
layout(std430, set = 1, binding = 0) buffer rays_buffer
{
    vec4 rays[];
};
layout(push_constant) uniform push
{
    uint count;
};

void main()
{
    const uint i = gl_GlobalInvocationID.x;
    if (i >= count)
        return;
    const sdfgi_trace_hit hit = sdfgi_trace_ray(0u, sdfgi_frame.cascade_count - 1u, rays[3u * i].xyz,
                                                rays[3u * i + 1u].xyz, rays[3u * i].w);
    rays[3u * i + 1u].w = hit.has_cell ? float(hit.cell.x) : -1.0;
    rays[3u * i + 2u] = vec4(hit.distance, hit.hit ? 1.0 : 0.0, hit.capped ? 1.0 : 0.0, float(hit.axis));
}
