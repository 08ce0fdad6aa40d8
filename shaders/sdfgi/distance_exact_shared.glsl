/* SPDX-License-Identifier: MIT
 * A workgroup searches eight lines along y: four cells along x, two along z (lines.glsl). */
#ifndef SDFGI_DISTANCE_EXACT_SHARED_GLSL
#define SDFGI_DISTANCE_EXACT_SHARED_GLSL

/* Little shared memory, so that many workgroups run at once. The layers of a village take one batch. */
const uint BATCH = 260u;

#include "lines.glsl"

SDFGI_PUSH(sdfgi_distance_search_args);

const uint PAIRS = LINES / 2u;
const uint PER_THREAD = (BATCH * PAIRS - 1u) / SDFGI_GROUP_LINES + 1u;

/* Squares along y count 4, 9 or 16, and those in planes count 16. Costs leave out the power of 2 that both
 * have in common, so that they fit their bits. This is its logarithm. */
int common_bits;

void begin()
{
    const int weight = int(distance_y_weight());
    common_bits = findLSB(weight);
    /* Planes hold up to 2^20, and the search adds less than weight / 8 (8 N)^2. Without the common power of 2
     * costs have 23 bits at most, which leaves 9 for the rank. */
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

bool block_is_dirty(uvec2 dirty, uint y)
{
    return (dirty[y >> 7u] >> (y >> 2u & 31u) & 1u) != 0u;
}

/* Finds the candidates and the needed segments. `dirty` are the dirty blocks of the lines' column. */
void mark_all(uvec2 dirty)
{
    for (uint y = gl_LocalInvocationIndex; y < sdfgi_frame.resolution; y += SDFGI_GROUP_LINES) {
        if (dirty_within_reach(dirty, int(y >> 2u)))
            line_mark(y, layers_at(y));
        if (block_is_dirty(dirty, y))
            atomicOr(line_needed, 1u << y / line_segment_cells());
    }
    line_count();
}

int plane_cost(uint layer, uint plane)
{
    return line_cost(layer, int(plane) * (16 >> common_bits));
}

/* Costs of a batch, from the planes. There the words of a workgroup's lines lie side by side, two lines in a
 * word. All words are read before any is used, so that the reads overlap. */
void load_costs(uint count)
{
    uint planes[PER_THREAD];
    [[unroll]] for (uint k = 0u; k < PER_THREAD; k++)
    {
        const uint n = min(gl_LocalInvocationIndex + k * SDFGI_GROUP_LINES, count * PAIRS - 1u);
        planes[k] =
            sdfgi_scratch_at(plane_slot(line_batch[n / PAIRS], first_x(), first_z()) + (n & (PAIRS - 1u)));
    }
    [[unroll]] for (uint k = 0u; k < PER_THREAD; k++)
    {
        const uint n = gl_LocalInvocationIndex + k * SDFGI_GROUP_LINES, i = n / PAIRS,
                   line = 2u * (n & (PAIRS - 1u));
        if (i < count) {
            line_costs[line * BATCH + i] = plane_cost(line_batch[i], planes[k] & 0xffffu);
            line_costs[(line + 1u) * BATCH + i] = plane_cost(line_batch[i], planes[k] >> 16u);
        }
    }
    barrier();
}

/* Stored form of a result: eight times the sum of (d^2 - 1) / 8, plus the 1 of each axis. */
uint encoded(uint y, uint line)
{
    const uint length2 = uint((8 * line_result(y, line) + line_weight) << common_bits) + 32u;
    return line_candidates() == 0u ? sdfgi_distance_reach() : distance_encode(length2);
}

/* Two cells share a word. */
void store_lines(uvec2 dirty)
{
    for (uint i = gl_LocalInvocationIndex; i < 4u * sdfgi_frame.resolution; i += SDFGI_GROUP_LINES) {
        const uint y = i >> 2u, x = 2u * (i & 1u), z = i >> 1u & 1u, line = 4u * z + x;
        if (block_is_dirty(dirty, y))
            sdfgi_distances[sdfgi_cell_index(args.cascade, ivec3(first_x() + x, y, first_z() + z)) >> 1u] =
                encoded(y, line) | encoded(y, line + 1u) << 16u;
    }
}

void search_lines()
{
    const uvec2 dirty = dirty_blocks(first_x() >> 2u, first_z() >> 2u);
    if (dirty == uvec2(0u))
        return;
    begin();
    mark_all(dirty);
    const uint count = line_candidates();
    for (uint first = 0u; first < count; first += line_batch_room()) {
        line_begin_batch(first);
        load_costs(min(line_batch_room(), count - first));
        line_search(min(line_batch_room(), count - first));
        barrier();
    }
    line_share_results();
    store_lines(dirty);
}

#endif
