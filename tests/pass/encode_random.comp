/* SPDX-License-Identifier: MIT
 * Per element: an index and a shift as bits, and their point of the sequence. */
#version 460
#extension GL_GOOGLE_include_directive : require
#include "../../shaders/lib/random.glsl"

layout(local_size_x = 64) in;
layout(std430, set = 1, binding = 0) buffer data_buffer
{
    uvec4 data[];
};
layout(push_constant) uniform push
{
    uint count;
};

void main()
{
    const uint i = gl_GlobalInvocationID.x;
    if (i < count)
        data[i].zw = floatBitsToUint(sdfgi_random_r2(data[i].x, data[i].y));
}
