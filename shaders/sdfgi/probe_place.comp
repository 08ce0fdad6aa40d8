/* SPDX-License-Identifier: MIT
 * Decides where each probe stands: on its lattice corner if the eight cells around are empty, else in the centre of the
 * nearest roomy empty cell, else nowhere (Hu et al. 2021, SDFDDGI, section 3.4: probes leave geometry along the distance
 * field). One thread per probe. */
#version 460
#extension GL_GOOGLE_include_directive : require
#define SDFGI_WRITES_PROBES
#include "pass.glsl"

layout(local_size_x = SDFGI_GROUP_LINEAR) in;
layout(push_constant) uniform sdfgi_push { sdfgi_pass_args args; };

/* Farthest move, in cells: less than half the probe spacing, so that a probe stays the nearest of its lattice point. */
const int REACH = 3;
/* Room beyond this buys nothing; each cell moved costs this much of it. */
const float ENOUGH_ROOM = 2.0;
const float MOVE_COST = 0.25;

bool cell_empty(ivec3 cell)
{
    return !cell_inside(cell) || cell_bits(args.cascade, cell) == uvec2(0u);
}

bool corner_free(ivec3 corner)
{
    for (int i = 0; i < 8; i++)
        if (!cell_empty(corner - ivec3(i & 1, i >> 1 & 1, i >> 2)))
            return false;
    return true;
}

uint place(ivec3 corner)
{
    uint state = SDFGI_PROBE_DEAD;
    float best = -1e30;
    for (int i = 0; i < 8 * REACH * REACH * REACH; i++) {
        const ivec3 offset = ivec3(i % (2 * REACH), i / (2 * REACH) % (2 * REACH), i / (4 * REACH * REACH)) - REACH;
        const ivec3 cell = corner + offset;
        if (!cell_inside(cell) || cell_bits(args.cascade, cell) != uvec2(0u))
            continue;
        const float moved = length(metric_from_cells(vec3(offset) + 0.5));
        const float score = min(cell_distance(args.cascade, cell), ENOUGH_ROOM) - MOVE_COST * moved;
        if (score > best) {
            best = score;
            state = probe_pack_moved(offset);
        }
    }
    return state;
}

void main()
{
    const int side = int(sdfgi_frame.size.z);
    const int i = int(gl_GlobalInvocationID.x);
    if (i >= side * side * side)
        return;
    const ivec3 probe = ivec3(i % side, i / side % side, i / (side * side));
    const ivec3 corner = probe * SDFGI_PROBE_SPACING;
    const uint state = corner_free(corner) ? 0u : place(corner);
    sdfgi_probes[probe_index(args.cascade, probe)] = state;
    if (probe_is_dead(state))
        counter_add(SDFGI_COUNTER_DEAD_PROBES, 1u);
}
