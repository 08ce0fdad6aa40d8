/* SPDX-License-Identifier: MIT
 * Where each row of blocks begins in the list of light cells, how many cells there are, and the indirect arguments of
 * passes over those in renewed blocks, with a thread or with eight for each. One workgroup; a thread sums neighbouring
 * rows. */
#version 460
#extension GL_GOOGLE_include_directive : require
#include "light_blocks.glsl"
#include "light_sums.glsl"

layout(local_size_x = SDFGI_GROUP_LINEAR) in;
layout(push_constant) uniform sdfgi_push { sdfgi_pass_args args; };
layout(std430, set = 0, binding = SDFGI_BINDING_INDIRECT) buffer sdfgi_indirect_buffer { uint sdfgi_indirect[]; };

uvec2 row_words(uint row)
{
    const uint slot = light_row_slot(row);
    return uvec2(sdfgi_scratch[slot], sdfgi_scratch[slot + 1u]);
}

void write_groups(uint record, uint threads)
{
    sdfgi_indirect[4u * record] = (threads + SDFGI_GROUP_LINEAR - 1u) / SDFGI_GROUP_LINEAR;
    sdfgi_indirect[4u * record + 1u] = 1u;
    sdfgi_indirect[4u * record + 2u] = 1u;
}

void main()
{
    const uint rows = light_row_count(), share = (rows + SDFGI_GROUP_LINEAR - 1u) / SDFGI_GROUP_LINEAR;
    const uint first = min(gl_LocalInvocationIndex * share, rows), end = min(first + share, rows);
    uvec2 sum = uvec2(0u);
    for (uint row = first; row < end; row++)
        sum += row_words(row);
    const uvec2 total = light_running_sum(sum);
    uvec2 start = total - sum;
    for (uint row = first; row < end; row++) {
        const uvec2 count = row_words(row);
        const uint slot = light_row_slot(row);
        sdfgi_scratch[slot] = start.x;
        sdfgi_scratch[slot + 1u] = start.y;
        start += count;
    }
    if (gl_LocalInvocationIndex < SDFGI_GROUP_LINEAR - 1u)
        return;
    sdfgi_counters[SDFGI_COUNTER_LIGHT_CELLS + args.cascade] = total.x;
    sdfgi_counters[SDFGI_COUNTER_LIGHT_RENEWED + args.cascade] = total.y;
    const uint renewed = min(total.y, sdfgi_frame.light.y);
    write_groups(args.cascade, renewed);
    write_groups(args.cascade + uint(SDFGI_MAX_CASCADES), 8u * renewed);
}
