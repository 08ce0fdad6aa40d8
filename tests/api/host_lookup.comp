/* SPDX-License-Identifier: MIT
 * Every lookup that there is, with whatever the caller passes. Eight vec4 each: position and roughness,
 * normal and number of rays, way to the viewer; then the irradiance of sdfgi_irradiance, that of
 * sdfgi_lighting, the reflection and its distance, the light of the air. */
#version 460
#extension GL_GOOGLE_include_directive : require
#define SDFGI_SET  0
#define SDFGI_ZERO uint(gl_NumWorkGroups.x == 0u) /* see lib/on_cpu.glsl */
/* Of this thread's lookup. */
uint rays, shift;
#define SDFGI_REFLECTION_RAYS  rays
#define SDFGI_REFLECTION_SHIFT shift
#include "sdfgi_reflection.glsl"

layout(local_size_x = 64) in;
layout(std430, set = 1, binding = 0) buffer lookups_buffer
{
    vec4 lookups[];
};
layout(push_constant) uniform push
{
    uint count;
};

void main()
{
    const uint i = 8u * gl_GlobalInvocationID.x;
    if (gl_GlobalInvocationID.x >= count)
        return;
    const vec4 position = lookups[i];
    rays = uint(max(lookups[i + 1u].w, 0.0));
    shift = bitfieldReverse(gl_GlobalInvocationID.x);
    const vec3 normal = lookups[i + 1u].xyz, to_eye = lookups[i + 2u].xyz;
    lookups[i + 3u] = vec4(sdfgi_irradiance(position.xyz, normal, to_eye), 0.0);
    const sdfgi_surface_light light = sdfgi_lighting(position.xyz, normal, to_eye, position.w);
    lookups[i + 4u] = vec4(light.irradiance, 0.0);
    lookups[i + 5u] = vec4(light.reflection, light.distance_m);
    const sdfgi_air_light air = sdfgi_light_air(position.xyz, normal);
    lookups[i + 6u] = vec4(air.mean, air.known);
    lookups[i + 7u] = vec4(air.towards, 0.0);
}
