/* SPDX-License-Identifier: MIT
 * Holes of masked and blended materials in shadow maps. */
#version 460
#extension GL_GOOGLE_include_directive : require
#define SDFGI_NEVER (gl_FragCoord.z > 2.0)
#include "lib/on_cpu.glsl"
#include "host/host_material.glsl"

layout(location = 3) in vec4 in_uv;
layout(location = 4) in vec4 in_color;

void main()
{
    const float cutoff = material_has(HOST_MATERIAL_BLEND) ? 0.5 : material.surface.w;
    if (material_base_color(in_uv, in_color).a < cutoff)
        discard;
}
