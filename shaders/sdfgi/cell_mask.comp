/* SPDX-License-Identifier: MIT
 * Which of the eight probes of its cage each light cell sees: a ray through the solid bits to each. One thread per light
 * cell. */
#version 460
#extension GL_GOOGLE_include_directive : require
#define SDFGI_WRITES_MASKS
#include "light_cells.glsl"
#include "../include/sdfgi_trace.glsl"

layout(local_size_x = SDFGI_GROUP_LINEAR) in;
layout(push_constant) uniform sdfgi_push { sdfgi_pass_args args; };

void main()
{
    const uint entry = gl_GlobalInvocationID.x;
    if (entry >= light_cell_count(args.cascade))
        return;
    const uint slot = light_cell_slot(args.cascade, entry);
    const uint texel = sdfgi_light_cells[slot] & 0xffffffu;
    const ivec3 cell = light_cell_position(args.cascade, texel);
    const ivec3 cage = cell / SDFGI_PROBE_SPACING;
    uint mask = 0u;
    for (int k = 0; k < 8; k++) {
        const ivec3 probe = cage + ivec3(k & 1, k >> 1 & 1, k >> 2);
        const uint state = sdfgi_probes[probe_index(args.cascade, probe)];
        if (!probe_is_dead(state) && trace_visible(args.cascade, vec3(cell) + 0.5, probe_position(probe, state)))
            mask |= 1u << k;
    }
    sdfgi_light_cells[slot] = texel | mask << 24u;
    const uint index = cell_index(args.cascade, cell);
    atomicOr(sdfgi_masks[index >> 2u], mask << (8u * (index & 3u)));
}
