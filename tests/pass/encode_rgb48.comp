/* SPDX-License-Identifier: MIT
 * Per element: a colour, and the same after a round trip, with the bits beyond the 48th in w. */
#version 460
#extension GL_GOOGLE_include_directive : require
#include "../../shaders/lib/rgb48.glsl"

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
    const uvec2 packed = sdfgi_rgb48_encode(data[2u * i].rgb);
    data[2u * i + 1u] = vec4(sdfgi_rgb48_decode(packed), float(packed.y >> 16u));
}
