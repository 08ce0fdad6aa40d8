/* SPDX-License-Identifier: MIT
 * Per element: a colour, the same after a round trip, and its packed form as a number in w of the first. */
#version 460
#extension GL_GOOGLE_include_directive : require
#include "../../shaders/lib/rgbe.glsl"

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
    const uint packed = sdfgi_rgbe_encode(data[2u * i].rgb);
    data[2u * i].w = uintBitsToFloat(packed);
    data[2u * i + 1u] = vec4(sdfgi_rgbe_decode(packed), 0.0);
}
