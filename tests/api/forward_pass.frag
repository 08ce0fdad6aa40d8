/* SPDX-License-Identifier: MIT
 * A host's forward shader with every lookup that there is, over points of a floor. Alpha is the host's own
 * light. */
#version 450
#extension GL_GOOGLE_include_directive : require
#define SDFGI_SET 0
#define SDFGI_ZERO uint(gl_FragCoord.z > 2.0) /* see lib/on_cpu.glsl */
#include "sdfgi_reflection.glsl"

layout(location = 0) out vec4 color;

void main()
{
    const vec3 position = vec3((gl_FragCoord.x - 4.0) / 4.0, -1.5, (gl_FragCoord.y - 4.0) / 4.0);
    const vec3 normal = vec3(0.0, 1.0, 0.0), to_eye = vec3(0.0, 1.0, 0.5);
    vec3 light = sdfgi_irradiance(position, normal, to_eye);
    light += sdfgi_irradiance_air(position + normal, normal);
    const sdfgi_surface_light lighting = sdfgi_lighting(position, normal, to_eye, 0.2);
    light += lighting.irradiance + lighting.reflection;
    color = vec4(light, 0.25);
}
