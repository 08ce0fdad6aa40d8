/* SPDX-License-Identifier: MIT
 * Per element: a direction, and x + 100 y + 10000 n for a border texel of a map of n texels; where the
 * direction lies in the map and which texel the border repeats; the direction after a round trip, and solid
 * angle per area. */
#version 460
#extension GL_GOOGLE_include_directive : require
#include "../../shaders/lib/octahedral.glsl"

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
    const int texel = int(data[3u * i].w);
    const int n = texel / 10000;
    const ivec2 source = sdfgi_octahedral_border_source(ivec2(texel % 100, texel / 100 % 100) - 1, n);
    const vec2 at = sdfgi_octahedral_encode(data[3u * i].xyz);
    data[3u * i + 1u] = vec4(at, source);
    data[3u * i + 2u] =
        vec4(sdfgi_octahedral_decode(at), sdfgi_octahedral_solid_angle(sdfgi_octahedral_point(at)));
}
