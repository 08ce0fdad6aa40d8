/* SPDX-License-Identifier: MIT
 * The same as lookup.hlsl. */
#version 450
#extension GL_GOOGLE_include_directive : require
#define SDFGI_SET 0
#define SDFGI_ZERO uint(gl_NumWorkGroups.x == 0u) /* see lib/on_cpu.glsl */
#include "sdfgi_reflection.glsl"

layout(local_size_x = 64) in;
layout(std430, set = 1, binding = 0) buffer points_buffer
{
    vec4 points[];
};
layout(push_constant) uniform push_block
{
    uint count;
};

void main()
{
    const uint row = 4u * gl_GlobalInvocationID.x;
    if (gl_GlobalInvocationID.x >= count)
        return;
    const vec3 position = points[row].xyz, normal = points[row + 1u].xyz, to_eye = points[row + 2u].xyz;
    const sdfgi_surface_light mirrored = sdfgi_lighting(position, normal, to_eye, 0.1);
    points[row].xyz = mirrored.irradiance;
    points[row + 1u].xyz = sdfgi_irradiance_air(position, normal);
    points[row + 2u] = vec4(mirrored.reflection, mirrored.distance_m);
}
