/* SPDX-License-Identifier: MIT
 * The host's lookup at a list of points: three vec4 each, position, normal, result; in their w the way to the
 * viewer. */
#version 460
#extension GL_GOOGLE_include_directive : require
#define SDFGI_SET 0
#define SDFGI_ZERO uint(gl_NumWorkGroups.x == 0u) /* see lib/on_cpu.glsl */
#include "sdfgi.glsl"

layout(local_size_x = 64) in;
layout(std430, set = 1, binding = 0) buffer points_buffer
{
    vec4 points[];
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
    const vec4 position = points[3u * i], normal = points[3u * i + 1u];
    const vec3 to_eye = vec3(position.w, normal.w, points[3u * i + 2u].w);
    points[3u * i + 2u].xyz = sdfgi_irradiance(position.xyz, normal.xyz, to_eye);
}
