/* SPDX-License-Identifier: MIT
 * Per element: a direction, the sky's irradiance over pi on a surface that faces it, and its radiance from
 * there. The zenith is red, the horizon green and the ground blue. */
#version 460
#extension GL_GOOGLE_include_directive : require
#include "../../shaders/lib/sky.glsl"

layout(local_size_x = 64) in;
layout(std430, set = 1, binding = 0) buffer data_buffer
{
    vec4 data[];
};
layout(push_constant) uniform push
{
    uint count;
};

void main()
{
    const uint i = gl_GlobalInvocationID.x;
    if (i >= count)
        return;
    const vec3 zenith = vec3(1.0, 0.0, 0.0), horizon = vec3(0.0, 1.0, 0.0), ground = vec3(0.0, 0.0, 1.0);
    data[3u * i + 1u].rgb = sdfgi_sky_irradiance(data[3u * i].y, zenith, horizon, ground);
    data[3u * i + 2u].rgb = sdfgi_sky_radiance(data[3u * i].y, zenith, horizon, ground);
}
