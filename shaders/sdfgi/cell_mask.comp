/* SPDX-License-Identifier: MIT
 * The visibility bits of light cells: which of the eight probes of its cage a cell sees, found by a ray to
 * each. Eight threads per light cell in a dirty block. No dirty box touches the cages of the other light
 * cells, so they see what they saw before. */
#version 460
#extension GL_GOOGLE_include_directive : require
#define SDFGI_WRITES_MASKS
#include "../lib/on_cpu.glsl"
#include "light_blocks.glsl"
#include "visibility.glsl"
#include "workgroup.glsl"
#include "../include/sdfgi_trace.glsl"

layout(local_size_x = SDFGI_GROUP_LINEAR) in;
SDFGI_PUSH(sdfgi_cascade_args);

const uint CELLS = uint(SDFGI_GROUP_LINEAR) / 8u;
shared uint visibility_bits[CELLS];

bool sees(ivec3 cell, ivec3 cage, ivec3 corner)
{
    const ivec3 base = cage * SDFGI_PROBE_SPACING;
    const uint state = sdfgi_probes_at(sdfgi_probe_index(args.cascade, cage + corner));
    return !sdfgi_probe_is_dead(state) &&
           sdfgi_trace_visible_from(args.cascade, base, vec3(cell - base) + LIGHT_CELL_EYE,
                                    sdfgi_probe_position(corner, state));
}

void main()
{
    const uint lane = gl_LocalInvocationIndex, k = lane & 7u, n = workgroup_index() * CELLS + lane / 8u;
    const bool listed = n < indirect_number(uint(SDFGI_INDIRECT_MASKS) + args.cascade) &&
                        sdfgi_scratch_at(light_dirty_slot(n)) < sdfgi_frame.light_cell_room;
    const ivec3 cell =
        light_cell_from_index(args.cascade, listed ? sdfgi_scratch_at(light_dirty_slot(n) + 1u) : 0u);
    const ivec3 cage = cell / SDFGI_PROBE_SPACING;
    const uint index = sdfgi_cell_index(args.cascade, cell), shift = 8u * (index & 3u);
    if (k == 0u)
        visibility_bits[lane / 8u] = 0u;
    barrier();
    if (listed && sees(cell, cage, ivec3(k & 1u, k >> 1u & 1u, k >> 2u)))
        atomicOr(visibility_bits[lane / 8u], 1u << k);
    barrier();
    if (!listed || k > 0u)
        return;
    atomicAnd(sdfgi_masks[index >> 2u], ~(0xffu << shift));
    atomicOr(sdfgi_masks[index >> 2u], visibility_bits[lane / 8u] << shift);
}
