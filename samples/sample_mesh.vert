/* SPDX-License-Identifier: MIT
 * Meshes as the camera sees them. */
#version 450
#extension GL_GOOGLE_include_directive : require
#include "sample_frame.glsl"
#include "sample_push.glsl"

layout(location = 0) in vec3 normal_object;
layout(location = 1) in vec3 position_object;
layout(location = 0) out vec3 normal;
layout(location = 1) out vec3 position;

void main()
{
    const vec4 position_world = matrix * vec4(position_object, 1.0);
    position = position_world.xyz;
    normal = transpose(inverse(mat3(matrix))) * normal_object;
    gl_Position = clip_from_world * position_world;
}
