/* SPDX-License-Identifier: MIT
 * Vertex stage of the prepass and of the forward pass. */
#version 460
#extension GL_GOOGLE_include_directive : require
#include "host/host_vertex.glsl"

layout(location = 0) out vec3 out_position; /* relative to the frame's origin */
layout(location = 1) out vec3 out_normal;
layout(location = 2) out vec4 out_tangent;
layout(location = 3) out vec4 out_uv; /* both sets */
layout(location = 4) out vec4 out_color;

void main()
{
    const vec3 position = position_from_object();
    out_position = position;
    out_normal = normal_from_object(in_normal);
    out_tangent = vec4(direction_from_object(in_tangent.xyz), in_tangent.w * push.params.x);
    out_uv = vec4(in_uv0, in_uv1);
    out_color = in_color;
    gl_Position = clip_from_position(position);
}
