/* SPDX-License-Identifier: MIT
 * Light at points of the air by all the ways in which hosts ask for it. Seven vec4 each: position, direction;
 * then mean and whether it is known, towards, the air's irradiance, that of a surface, and that of a surface
 * which reflects. */
#version 460
#extension GL_GOOGLE_include_directive : require
#define SDFGI_SET 0
#define SDFGI_ZERO uint(gl_NumWorkGroups.x == 0u) /* see lib/on_cpu.glsl */
#include "sdfgi_reflection.glsl"

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
    const uint i = 7u * gl_GlobalInvocationID.x;
    if (gl_GlobalInvocationID.x >= count)
        return;
    const vec3 position = points[i].xyz, direction = points[i + 1u].xyz;
    const sdfgi_air_light light = sdfgi_light_air(position, direction);
    points[i + 2u] = vec4(light.mean, light.known);
    points[i + 3u] = vec4(light.towards, 0.0);
    points[i + 4u] = vec4(sdfgi_irradiance_air(position, direction), 0.0);
    points[i + 5u] = vec4(sdfgi_irradiance(position, direction, 0.1 * direction), 0.0);
    points[i + 6u] = vec4(sdfgi_lighting(position, direction, 0.1 * direction, 0.5).irradiance, 0.0);
}
