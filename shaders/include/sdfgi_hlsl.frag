/* SPDX-License-Identifier: MIT
 * All that hosts call, in a shader that is never drawn with: `spirv-cross --hlsl` makes an include for HLSL
 * and Slang of it. docs/integration.md has the commands. */
#version 450
#extension GL_GOOGLE_include_directive : require
#include "sdfgi_reflection.glsl"

layout(location = 0) in vec3 sdfgi_position;
layout(location = 1) in vec3 sdfgi_normal;
layout(location = 2) in vec3 sdfgi_to_eye;
layout(location = 3) in float sdfgi_roughness;
layout(location = 0) out vec3 sdfgi_result;

void main()
{
    sdfgi_result = sdfgi_irradiance(sdfgi_position, sdfgi_normal, sdfgi_to_eye);
    sdfgi_result += sdfgi_irradiance_air(sdfgi_position, sdfgi_normal);
    sdfgi_result += sdfgi_lighting(sdfgi_position, sdfgi_normal, sdfgi_to_eye, sdfgi_roughness).reflection;
}
