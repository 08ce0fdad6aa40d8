/* SPDX-License-Identifier: MIT
 * Lists the empty cells with an occupied face neighbour. One thread per cell. The order of the list is not fixed;
 * nothing that is stored in volumes depends on it. */
#version 460
#extension GL_GOOGLE_include_directive : require
#define SDFGI_WRITES_LIGHT
#include "light_cells.glsl"

layout(local_size_x = SDFGI_GROUP_CELLS, local_size_y = SDFGI_GROUP_CELLS, local_size_z = SDFGI_GROUP_CELLS) in;
layout(push_constant) uniform sdfgi_push { sdfgi_pass_args args; };

shared uint group_count;
shared uint group_base;

bool is_light_cell(ivec3 cell)
{
    const float distance = cell_distance(args.cascade, cell);
    /* Further than this no face neighbour can hold a sub-voxel: sqrt(1.375^2 + 2 * 0.375^2) and the flood's 0.1. */
    return distance < 1.6 && cell_bits(args.cascade, cell) == uvec2(0u) && light_cell_facing(args.cascade, cell) != 0u;
}

void main()
{
    if (gl_LocalInvocationIndex == 0u)
        group_count = 0u;
    barrier();
    const ivec3 cell = ivec3(gl_GlobalInvocationID);
    const bool listed = is_light_cell(cell);
    const uint local = listed ? atomicAdd(group_count, 1u) : 0u;
    barrier();
    if (gl_LocalInvocationIndex == 0u && group_count > 0u)
        group_base = atomicAdd(sdfgi_counters[SDFGI_COUNTER_LIGHT_CELLS + args.cascade], group_count);
    barrier();
    const uint entry = group_base + local;
    if (!listed || entry >= sdfgi_frame.light.y)
        return;
    const uint slot = light_cell_slot(args.cascade, entry);
    sdfgi_light_cells[slot] = texel_index(cell_texel(args.cascade, cell));
    light_cell_store_direct(slot, uvec2(0u, SDFGI_LIGHT_VALID));
    sdfgi_light[cell_index(args.cascade, cell)] = uvec2(0u, SDFGI_LIGHT_VALID);
}
