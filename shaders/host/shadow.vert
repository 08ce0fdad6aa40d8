/* SPDX-License-Identifier: MIT
 * Vertex stage of shadow maps. */
#version 460
#extension GL_GOOGLE_include_directive : require
#include "host/host_vertex.glsl"

layout(location = 3) out vec4 out_uv;
layout(location = 4) out vec4 out_color;

void main()
{
    out_uv = vec4(in_uv0, in_uv1);
    out_color = in_color;
    gl_Position = clip_from_position(position_from_object());
}
