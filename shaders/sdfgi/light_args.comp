/* SPDX-License-Identifier: MIT
 * Where each row of blocks begins in the list of light cells, how many cells there are, and the indirect arguments of
 * passes over them, with a thread or with eight for each. One workgroup; a thread sums neighbouring rows. */
#version 460
#extension GL_GOOGLE_include_directive : require
#include "light_blocks.glsl"

layout(local_size_x = SDFGI_GROUP_LINEAR) in;
layout(push_constant) uniform sdfgi_push { sdfgi_pass_args args; };
layout(std430, set = 0, binding = SDFGI_BINDING_INDIRECT) buffer sdfgi_indirect_buffer { uint sdfgi_indirect[]; };

void main()
{
    const uint rows = light_row_count(), share = (rows + SDFGI_GROUP_LINEAR - 1u) / SDFGI_GROUP_LINEAR;
    const uint first = min(gl_LocalInvocationIndex * share, rows), end = min(first + share, rows);
    uint sum = 0u;
    for (uint row = first; row < end; row++)
        sum += sdfgi_scratch[light_row_slot(row)];
    const uint total = light_running_sum(sum);
    uint start = total - sum;
    for (uint row = first; row < end; row++) {
        const uint count = sdfgi_scratch[light_row_slot(row)];
        sdfgi_scratch[light_row_slot(row)] = start;
        start += count;
    }
    if (gl_LocalInvocationIndex < SDFGI_GROUP_LINEAR - 1u)
        return;
    sdfgi_counters[SDFGI_COUNTER_LIGHT_CELLS + args.cascade] = total;
    const uint listed = min(total, sdfgi_frame.light.y);
    sdfgi_indirect[4u * args.cascade] = (listed + SDFGI_GROUP_LINEAR - 1u) / SDFGI_GROUP_LINEAR;
    sdfgi_indirect[4u * args.cascade + 1u] = 1u;
    sdfgi_indirect[4u * args.cascade + 2u] = 1u;
    const uint eightfold = 4u * (args.cascade + uint(SDFGI_MAX_CASCADES));
    sdfgi_indirect[eightfold] = (8u * listed + SDFGI_GROUP_LINEAR - 1u) / SDFGI_GROUP_LINEAR;
    sdfgi_indirect[eightfold + 1u] = 1u;
    sdfgi_indirect[eightfold + 2u] = 1u;
}
