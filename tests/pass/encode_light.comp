/* SPDX-License-Identifier: MIT
 * Per element: six colours, and the same after packing as a light cell. */
#version 460
#extension GL_GOOGLE_include_directive : require
#include "../../shaders/shared/constants.h"
#include "../../shaders/lib/rgbe.glsl"
#include "../../shaders/lib/light_pack.glsl"
#include "../../shaders/lib/random.glsl"

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
    vec3 axes[6];
    for (uint a = 0u; a < 6u; a++)
        axes[a] = data[12u * i + a].rgb;
    const uvec2 cell = sdfgi_light_pack(axes, sdfgi_random_hash(i));
    const float valid = (cell.y & SDFGI_LIGHT_VALID) != 0u ? 1.0 : 0.0;
    for (uint a = 0u; a < 6u; a++)
        data[12u * i + 6u + a] = vec4(sdfgi_light_unpack_axis(cell, a), valid);
}
