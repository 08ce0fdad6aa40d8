/* SPDX-License-Identifier: MIT
 * A thread searches two lines along y alone, for software drivers: where threads wait for one another, these
 * drivers keep all variables in memory.
 *
 * Without the term 8 i^2, which is the same for all candidates (lines.glsl), the cost of a candidate falls
 * with the cell i along a straight line, and the later the candidate the faster. The least costs of all are
 * the lower envelope of these lines: a stack of the candidates that are best somewhere, each with the first
 * cell where it is (Felzenszwalb and Huttenlocher 2012, "Distance Transforms of Sampled Functions"). */
#ifndef SDFGI_DISTANCE_EXACT_ALONE_GLSL
#define SDFGI_DISTANCE_EXACT_ALONE_GLSL

#include "occupancy.glsl"

layout(local_size_x = SDFGI_LINES) in; /* two cells along x, for two of them along x and four along z */
SDFGI_PUSH(sdfgi_distance_search_args);

const uint MOST_CELLS = 256u;

/* The stack: costs for cell 0, and position << 8 | first cell. */
int costs[MOST_CELLS];
uint places[MOST_CELLS];
uint top;
uint encoded[MOST_CELLS]; /* results of the first line */
int weight; /* factor of squares along y, without the power of 2 that it has in common with 16 */
int common_bits;

int offset_of(uint position)
{
    return 2 * int(position) - 3;
}

/* By how much a candidate's cost falls from cell to cell. */
int fall_of(uint position)
{
    return 2 * weight * offset_of(position);
}

/* The least whole number that is not below a quotient of two positive ones below 2^24. */
int quotient_up(int a, int b)
{
    int q = int(float(a) / float(b));
    q -= int(q * b >= a + b);
    return q + int(q * b < a);
}

void push(uint position, int cost)
{
    uint first = 0u;
    while (top > 0u) {
        const int more = cost - costs[top - 1u];
        const uint below = places[top - 1u];
        first = more <= 0 ? 0u : uint(quotient_up(more, fall_of(position) - fall_of(below >> 8u)));
        if (first > (below & 255u))
            break;
        first = 0u;
        top--;
    }
    if (first < sdfgi_frame.resolution) {
        costs[top] = cost;
        places[top] = position << 8u | first;
        top++;
    }
}

/* A bit for each of the four layers at a y of cells that holds a bit within reach along z. */
uint layers_in_reach(uint y, uint z)
{
    const uint low = max(z, uint(SDFGI_DISTANCE_REACH)) - uint(SDFGI_DISTANCE_REACH),
               high = min(z + uint(SDFGI_DISTANCE_REACH), sdfgi_frame.resolution - 1u);
    return (sdfgi_search_at(layers_slot(y, low / SDFGI_GROUP_COLUMNS)) |
            sdfgi_search_at(layers_slot(y, high / SDFGI_GROUP_COLUMNS))) &
           15u;
}

void find_envelope(uvec2 dirty, uint x, uint z)
{
    top = 0u;
    for (uint y = 0u; y < sdfgi_frame.resolution; y++) {
        uint layers = dirty_within_reach(dirty, int(y >> 2u)) ? layers_in_reach(y, z) : 0u;
        while (layers != 0u) {
            const uint position = 4u * y + uint(findLSB(layers));
            const uint plane = sdfgi_scratch_at(plane_slot(position, x, z)) >> 16u * (x & 1u) & 0xffffu;
            const int offset = offset_of(position);
            push(position, weight * (offset * offset >> 3) + int(plane) * (16 >> common_bits));
            layers &= layers - 1u;
        }
    }
}

/* Stored form of a result: eight times the sum of (d^2 - 1) / 8, plus the 1 of each axis. */
uint encoded_least(uint y, int cost, uint position)
{
    const int least = cost + int(y) * (8 * weight * int(y) - fall_of(position));
    return distance_encode((uint(8 * least + weight) << common_bits) + 32u);
}

/* The results of the second line go with those of the first: two cells share a word. */
void store_line(uvec2 dirty, uint x, uint z)
{
    uint at = 0u;
    for (uint y = 0u; y < sdfgi_frame.resolution; y++) {
        while (at + 1u < top && (places[at + 1u] & 255u) <= y)
            at++;
        const uint distance =
            top > 0u ? encoded_least(y, costs[at], places[at] >> 8u) : sdfgi_distance_reach();
        if ((x & 1u) == 0u)
            encoded[y] = distance;
        else if ((dirty[y >> 7u] >> (y >> 2u & 31u) & 1u) != 0u)
            sdfgi_distances[sdfgi_cell_index(args.cascade, ivec3(x, y, z)) >> 1u] = encoded[y] | distance
                                                                                                     << 16u;
    }
}

void search_lines()
{
    const uint thread = gl_LocalInvocationIndex,
               x = args.first_x + 4u * gl_WorkGroupID.y + 2u * (thread & 1u),
               z = 4u * gl_WorkGroupID.x + (thread >> 1u);
    const uvec2 dirty = dirty_blocks(x >> 2u, z >> 2u);
    if (dirty == uvec2(0u))
        return;
    common_bits = findLSB(int(distance_y_weight()));
    weight = int(distance_y_weight()) >> common_bits;
    for (uint i = SDFGI_ZERO; i < 2u; i++) {
        find_envelope(dirty, x + i, z);
        store_line(dirty, x + i, z);
    }
}

#endif
