/* SPDX-License-Identifier: MIT
 * Meshes as the lamp sees them. `matrix` leads to its clip space. */
#version 450
#extension GL_GOOGLE_include_directive : require
#include "sample_push.glsl"

layout(location = 1) in vec3 position_object;

void main()
{
    gl_Position = matrix * vec4(position_object, 1.0);
}
