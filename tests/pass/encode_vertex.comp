/* SPDX-License-Identifier: MIT
 * Per element: how to read an attribute, five words that hold it, a word of nothing, and what was read. */
#version 460
#extension GL_GOOGLE_include_directive : require
#define SDFGI_ZERO 0u /* see lib/on_cpu.glsl */
#include "../../shaders/lib/vertex_fetch.glsl"

layout(local_size_x = 64) in;
layout(std430, set = 1, binding = 0) buffer data_buffer
{
    uint data[];
};
layout(push_constant) uniform push
{
    uint count;
};

const uint WORDS = 12u;

SDFGI_FETCH_FUNCTION(fetch_data, data, 4)
SDFGI_FETCH_INDEX_FUNCTION(fetch_index, data)

void main()
{
    const uint i = gl_GlobalInvocationID.x;
    if (i >= count)
        return;
    const uint fetch = data[WORDS * i], byte = 4u * (WORDS * i + 1u) + (fetch & SDFGI_FETCH_OFFSET_MASK);
    uvec4 read = uvec4(0u);
    if (SDFGI_FETCH_GET_COMPONENTS(fetch) > 0u)
        read = floatBitsToUint(fetch_data(fetch, byte));
    else
        read.x = fetch_index(SDFGI_FETCH_GET_BITS(fetch), byte);
    for (uint k = 0u; k < 4u; k++)
        data[WORDS * i + 8u + k] = read[k];
}
