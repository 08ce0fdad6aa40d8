/* SPDX-License-Identifier: MIT
 * Per element: mean and mean of squares of depth, and how far a receiver lies behind the mean; its visibility
 * in w. */
#version 460
#extension GL_GOOGLE_include_directive : require
#include "../../shaders/lib/chebyshev.glsl"

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
    if (i < count)
        data[i].w = sdfgi_chebyshev(data[i].xy, data[i].z);
}
