/* SPDX-License-Identifier: MIT
 * The library's diffuse light at one point of the world, outside any picture. Dispatched as 1 thread. */
#version 460
#extension GL_GOOGLE_include_directive : require
#include "lib/on_cpu.glsl"
#include "host/host_shared.h"
#define SDFGI_SET 1
#include "sdfgi.glsl"

layout(local_size_x = 1) in;

layout(set = 0, binding = 0, std430) writeonly buffer result_block
{
    vec4 irradiance[HOST_MAX_SAMPLES];
};

layout(push_constant) uniform push_block
{
    host_sample_push pushes[1];
};
#define push pushes[SDFGI_ZERO]

void main()
{
    /* There is no viewer: look from a little off the surface. */
    const vec3 to_eye = push.normal.w * push.normal.xyz;
    irradiance[uint(push.position.w)] =
        vec4(sdfgi_irradiance(push.position.xyz, push.normal.xyz, to_eye), 1.0);
}
