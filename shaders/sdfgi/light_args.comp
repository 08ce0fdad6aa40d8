/* SPDX-License-Identifier: MIT
 * Indirect arguments for passes over light cells. One thread. */
#version 460
#extension GL_GOOGLE_include_directive : require
#include "light_cells.glsl"

layout(local_size_x = 1) in;
layout(push_constant) uniform sdfgi_push { sdfgi_pass_args args; };
layout(std430, set = 0, binding = SDFGI_BINDING_INDIRECT) buffer sdfgi_indirect_buffer { uint sdfgi_indirect[]; };

void main()
{
    const uint groups = (light_cell_count(args.cascade) + SDFGI_GROUP_LINEAR - 1u) / SDFGI_GROUP_LINEAR;
    sdfgi_indirect[4u * args.cascade] = groups;
    sdfgi_indirect[4u * args.cascade + 1u] = 1u;
    sdfgi_indirect[4u * args.cascade + 2u] = 1u;
}
