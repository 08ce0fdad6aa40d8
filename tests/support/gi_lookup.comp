/* SPDX-License-Identifier: MIT
 * The host's lookup at a list of points: three vec4 each, position, normal, result. The viewer is 0.1 m in front of each. */
#version 460
#extension GL_GOOGLE_include_directive : require
#define SDFGI_SET 0
#include "sdfgi.glsl"

layout(local_size_x = 64) in;
layout(std430, set = 1, binding = 0) buffer points_buffer { vec4 points[]; };
layout(push_constant) uniform push { uint count; };

void main()
{
    const uint i = gl_GlobalInvocationID.x;
    if (i >= count)
        return;
    const vec3 position = points[3u * i].xyz, normal = points[3u * i + 1u].xyz;
    points[3u * i + 2u].xyz = sdfgi_irradiance(position, normal, 0.1 * normal);
}
