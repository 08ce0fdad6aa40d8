/* SPDX-License-Identifier: MIT
 * Depth and normal prepass: holes of masked materials, and normal and roughness for screen-space consumers.
 */
#version 460
#extension GL_GOOGLE_include_directive : require
#define SDFGI_NEVER (gl_FragCoord.z > 2.0)
#include "lib/on_cpu.glsl"
#include "host/host_material.glsl"

layout(push_constant) uniform host_push_block
{
    host_push pushes[1];
};
#define push pushes[SDFGI_ZERO]

layout(location = 1) in vec3 in_normal;
layout(location = 2) in vec4 in_tangent;
layout(location = 3) in vec4 in_uv;
layout(location = 4) in vec4 in_color;
layout(location = 0) out vec4 out_normal;

void main()
{
    if (material_has(HOST_MATERIAL_MASK) && material_base_color(in_uv, in_color).a < material.surface.w)
        discard;
    const bool front_facing = gl_FrontFacing == (push.params.x > 0.0);
    const vec2 surface = material_has(HOST_MATERIAL_LAMBERT) ? vec2(0.0, 1.0) : material_surface(in_uv).xy;
    const float roughness = material_signed_roughness(surface.x, surface.y);
    out_normal = vec4(material_normal(in_uv, in_normal, in_tangent, front_facing), roughness);
}
