/* SPDX-License-Identifier: MIT
 * One triangle that covers the screen, at the far plane of reversed depth. */
#version 460

layout(location = 0) out vec2 out_ndc;

void main()
{
    out_ndc = vec2(gl_VertexIndex == 1 ? 3.0 : -1.0, gl_VertexIndex == 2 ? 3.0 : -1.0);
    gl_Position = vec4(out_ndc, 0.0, 1.0);
}
