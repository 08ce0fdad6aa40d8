/* SPDX-License-Identifier: MIT
 * Distance from each cell's centre to the nearest set sub-voxel's centre, exact and rounded down: the nearest
 * over all layers of sub-voxels along y (lines.glsl) of what distance_plane found in each. Depends on nothing
 * but the bits. Only stale blocks are written; args.first_x and args.end_x as there. One workgroup per four
 * cells along x and two along z: eight lines along y. */
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
#define SDFGI_WRITES_DISTANCE

const uint BATCH = 260u; /* few, for many workgroups at once; a village's layers in one go */

#include "lines.glsl"

layout(push_constant) uniform sdfgi_push
{
    sdfgi_distance_search_args args;
};

const uint PAIRS = LINES / 2u;
const uint PER_THREAD = (BATCH * PAIRS - 1u) / SDFGI_GROUP_LINES + 1u;

int common_bits; /* of what squares along y count, 4, 9 or 16, and what planes store, 16: powers of 2 in
                    common */

void begin()
{
    const int weight = int(distance_y_weight());
    common_bits = findLSB(weight);
    /* Planes bring up to 2^20, and sums are below weight / 8 (8 N)^2 more, less what is common: 23 bits at
     * most. */
    line_begin(weight >> common_bits, 9u);
}

uint first_x()
{
    return args.first_x + 4u * gl_WorkGroupID.y;
}

uint first_z()
{
    return 2u * gl_WorkGroupID.x;
}

bool block_is_stale(uvec2 stale, uint y)
{
    return (stale[y >> 7u] >> (y >> 2u & 31u) & 1u) != 0u;
}

void mark_all(uvec2 stale)
{
    for (uint y = gl_LocalInvocationIndex; y < sdfgi_frame.resolution; y += SDFGI_GROUP_LINES) {
        if (layer_in_reach(stale, int(y >> 2u)))
            line_mark(y, four_layers(y));
        if (block_is_stale(stale, y))
            atomicOr(line_wanted, 1u << y / line_cells_per_slot());
    }
    line_count();
}

int plane_sum(uint place, uint plane)
{
    return line_sum(place, int(plane) * (16 >> common_bits));
}

/* What the planes hold of a batch; a workgroup's lines lie side by side there, two in a word. All is read
 * before any is written: one wait. */
void put_planes(uint count)
{
    uint planes[PER_THREAD];
    [[unroll]] for (uint k = 0u; k < PER_THREAD; k++)
    {
        const uint i = min(gl_LocalInvocationIndex + k * SDFGI_GROUP_LINES, count * PAIRS - 1u);
        planes[k] =
            sdfgi_scratch[plane_slot(line_batch[i / PAIRS], first_x(), first_z()) + (i & (PAIRS - 1u))];
    }
    [[unroll]] for (uint k = 0u; k < PER_THREAD; k++)
    {
        const uint i = gl_LocalInvocationIndex + k * SDFGI_GROUP_LINES, at = i / PAIRS,
                   own = 2u * (i & (PAIRS - 1u));
        if (at < count) {
            line_sums[own * BATCH + at] = plane_sum(line_batch[at], planes[k] & 0xffffu);
            line_sums[(own + 1u) * BATCH + at] = plane_sum(line_batch[at], planes[k] >> 16u);
        }
    }
    barrier();
}

uint encoded(uint y, uint own)
{
    const uint length2 = uint((8 * line_result(y, own) + line_weight) << common_bits) + 32u;
    return line_candidates() == 0u ? sdfgi_distance_reach() : distance_encode(length2);
}

/* Two cells share a word. */
void store_lines(uvec2 stale)
{
    for (uint i = gl_LocalInvocationIndex; i < 4u * sdfgi_frame.resolution; i += SDFGI_GROUP_LINES) {
        const uint y = i >> 2u, x = 2u * (i & 1u), z = i >> 1u & 1u, own = 4u * z + x;
        if (block_is_stale(stale, y))
            sdfgi_distances[sdfgi_cell_index(args.cascade, ivec3(first_x() + x, y, first_z() + z)) >> 1u] =
                encoded(y, own) | encoded(y, own + 1u) << 16u;
    }
}

void main()
{
    const uvec2 stale = stale_blocks(first_x() >> 2u, first_z() >> 2u);
    if (stale == uvec2(0u))
        return;
    begin();
    mark_all(stale);
    const uint count = line_candidates();
    for (uint first = 0u; first < count; first += line_room()) {
        line_put_batch(first);
        put_planes(min(line_room(), count - first));
        line_search(min(line_room(), count - first));
        barrier();
    }
    line_publish();
    store_lines(stale);
}
