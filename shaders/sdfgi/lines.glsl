/* SPDX-License-Identifier: MIT
 * The distance search along lines of cells. For each cell it finds the least cost over the candidates of the
 * cell's line. The cost is what a candidate costs by itself plus the square of its distance along the line.
 *
 *     line        the N cells along one axis; a workgroup searches LINES lines side by side
 *     position    a sub-voxel along a line, 0 to 4 N - 1: four for each cell
 *     candidate   a position that may be the nearest one; all lines of a workgroup have the same candidates,
 *                 but each line has a base cost of its own for each of them
 *     batch       as many candidates as shared memory has room for, in the order of their positions
 *     segment     the cells of a line that one thread answers for, N / SEGMENTS in a row
 *
 * The offset from the centre of cell i to position p is 2 p - 3 - 8 i halves of a sub-voxel, an odd number.
 * For each line the search finds the same as this loop:
 *
 *     for each cell i
 *         least[i] = infinity
 *         for each candidate p
 *             offset = 2 p - 3 - 8 i
 *             least[i] = min(least[i], base[p] + line_weight * (offset^2 - 1) / 8)
 *
 * It looks at fewer candidates, because the best candidate never moves back as i grows: from one cell to the
 * next, the cost of a candidate grows by more than that of any later candidate (Aggarwal et al. 1987,
 * "Geometric applications of a matrix-searching algorithm"). For each batch:
 *
 *     1. The last cell of every segment looks at all candidates. The threads of the line share them.
 *     2. Each cell of a segment looks at the candidates from the best one of the segment before to the best
 *        one of its own segment, as step 1 found them.
 *
 * Example: 4 cells in two segments, line_weight 1, candidates at p = 1, 6 and 13 with base costs 3, 0 and 1.
 *
 *                 p = 1           p = 6           p = 13          least
 *     cell 0      3 +  0 =  3     0 + 10 = 10     1 + 66 = 67      3, of p = 1
 *     cell 1      3 + 10 = 13     0 +  0 =  0     1 + 28 = 29      0, of p = 6
 *     cell 2      3 + 36 = 39     0 +  6 =  6     1 +  6 =  7      6, of p = 6
 *     cell 3      3 + 78 = 81     0 + 28 = 28     1 +  0 =  1      1, of p = 13
 *
 * Step 1 looks at all candidates for cells 1 and 3, and finds p = 6 and p = 13. In step 2 cells 0 and 1 look
 * at p = 1 and p = 6 alone, and cells 2 and 3 at p = 6 and p = 13 alone. Where a village scrolls, a cell
 * looks at 10 to 12 candidates in step 2 in the mean, and at 23 to 30 in the slowest of 32 threads.
 *
 * With o = 2 p - 3 the square becomes a sum whose terms are cheap to compute:
 *
 *     (offset^2 - 1) / 8 = (o^2 - 1) / 8 - 2 o i + 8 i^2
 *
 * The first term is part of line_costs, with the base cost. The second falls by the same amount from cell to
 * cell. The third is the same for all candidates, so line_result adds it at the end.
 *
 * A pass defines BATCH before it includes this file. BATCH is at least 256, because results are put where the
 * costs were, and 4 more than a multiple of 32, so that 32 threads (four segments of eight lines) read 32
 * different banks of shared memory. Shared memory: 36 bytes per candidate of a batch, and 800 besides. */
#ifndef SDFGI_LINES_GLSL
#define SDFGI_LINES_GLSL

#include "occupancy.glsl"

layout(local_size_x = SDFGI_GROUP_LINES) in;

const uint LINES = SDFGI_LINES;
const uint SEGMENTS = SDFGI_GROUP_LINES / LINES;
const uint MOST_CELLS = 256u / SEGMENTS; /* of a segment */
const int MAX_COST = 0x7fffffff;
const uint NO_COST = 0xffffffffu;

shared uint line_positions[32];           /* a bit for each position that is a candidate */
shared uint line_ranks[33];               /* candidates before every 32nd position; last, all of them */
shared uint line_needed;                  /* a bit for each segment whose results are needed */
shared uint line_batch[BATCH];            /* positions of the candidates of a batch */
shared int line_costs[LINES * BATCH];     /* their costs for cell 0, of each line */
shared uint line_ends[SDFGI_GROUP_LINES]; /* for the last cell of each segment its least cost and, in the low
                                             bits, the rank of its best candidate in the batch */

int line_least[MOST_CELLS]; /* of the cells of this thread, without the term 8 i^2 */
int line_weight;            /* factor of squares along this line */
uint line_rank_bits;        /* low bits of line_ends: costs leave so many of 32 */

/* Which of the workgroup's lines this thread works on. */
uint line_index()
{
    return gl_LocalInvocationIndex & (LINES - 1u);
}

uint line_segment()
{
    return gl_LocalInvocationIndex / LINES;
}

uint line_segment_cells()
{
    return sdfgi_frame.resolution / SEGMENTS;
}

/* o: offset from the centre of cell 0. */
int line_offset(uint position)
{
    return 2 * int(position) - 3;
}

/* Cost of a candidate for cell 0. */
int line_cost(uint position, int base)
{
    const int offset = line_offset(position);
    return line_weight * (offset * offset >> 3) + base;
}

/* ---- Candidates: found before the first batch */

/* Weight and rank bits are computed once, because computing them within loops took longer than all else. */
void line_begin(int weight, uint rank_bits)
{
    line_weight = weight;
    line_rank_bits = rank_bits;
    if (gl_LocalInvocationIndex < 32u)
        line_positions[gl_LocalInvocationIndex] = 0u;
    if (gl_LocalInvocationIndex == 0u)
        line_needed = 0u;
    [[unroll]] for (uint k = 0u; k < MOST_CELLS; k++)
    {
        line_least[k] = MAX_COST;
    }
    barrier();
}

/* Makes candidates of those positions of a cell whose bit is set in `four`. */
void line_mark(uint cell, uint four)
{
    if (four != 0u)
        atomicOr(line_positions[cell >> 3u], four << 4u * (cell & 7u));
}

uint line_words()
{
    return sdfgi_frame.resolution >> 3u;
}

/* Counts the candidates, once all are marked. */
void line_count()
{
    barrier();
    if (gl_LocalInvocationIndex <= line_words()) {
        uint rank = 0u;
        for (uint i = 0u; i < gl_LocalInvocationIndex; i++)
            rank += uint(bitCount(line_positions[i]));
        line_ranks[gl_LocalInvocationIndex] = rank;
    }
    barrier();
}

/* Number of candidates before a position. */
uint line_rank(uint position)
{
    const uint below = (1u << (position & 31u)) - 1u;
    return line_ranks[position >> 5u] + uint(bitCount(line_positions[position >> 5u] & below));
}

/* Number of all candidates. */
uint line_candidates()
{
    return line_ranks[line_words()];
}

/* ---- Batches */

/* Most candidates of a batch. */
uint line_batch_room()
{
    return min(BATCH, 1u << line_rank_bits);
}

/* Fills line_batch with the candidates from the rank `first` on. */
void line_begin_batch(uint first)
{
    for (uint cell = gl_LocalInvocationIndex; cell < sdfgi_frame.resolution; cell += SDFGI_GROUP_LINES) {
        const uint four = line_positions[cell >> 3u] >> 4u * (cell & 7u) & 15u;
        uint rank = line_rank(4u * cell) - first;
        for (uint i = 0u; i < 4u; i++)
            if ((four >> i & 1u) != 0u) {
                if (rank < line_batch_room())
                    line_batch[rank] = 4u * cell + i;
                rank++;
            }
    }
    line_ends[gl_LocalInvocationIndex] = NO_COST;
    barrier();
}

/* ---- Search */

bool line_segment_needed(uint segment)
{
    return (line_needed >> segment & 1u) != 0u;
}

/* Difference of 8 line_weight i^2 between the last cell of a segment and that of the segment before. */
uint line_end_growth(uint segment)
{
    const int cells = int(line_segment_cells());
    return uint(8 * line_weight * cells * (2 * (int(segment) * cells - 1) + cells));
}

/* Step 1. Costs go from the last cell of a segment to that of the next by additions, and begin with cell -1.
 * They hold the term 8 i^2, because a packed cost must not be negative. The rank in the low bits makes the
 * first of several best candidates the least. */
void line_search_ends(uint count)
{
    uint least[SEGMENTS];
    [[unroll]] for (uint s = 0u; s < SEGMENTS; s++)
    {
        least[s] = NO_COST;
    }
    const uint shift = line_rank_bits;
    const int stride = 2 * line_weight * int(line_segment_cells());
    for (uint i = line_segment(); i < count; i += SEGMENTS) {
        const int offset = line_offset(line_batch[i]);
        uint cost = uint(line_costs[line_index() * BATCH + i] + line_weight * (2 * offset + 8)) << shift | i;
        [[unroll]] for (uint s = 0u; s < SEGMENTS; s++)
        {
            cost += (line_end_growth(s) - uint(stride * offset)) << shift;
            least[s] = min(least[s], cost);
        }
    }
    [[unroll]] for (uint s = 0u; s < SEGMENTS; s++)
    {
        atomicMin(line_ends[s * LINES + line_index()], least[s]);
    }
    barrier();
}

/* Rank of the best candidate for the last cell of a segment. */
uint line_best(uint segment)
{
    return line_ends[segment * LINES + line_index()] & (1u << line_rank_bits) - 1u;
}

/* Step 2, for eight cells of this thread's segment from its cell `first` on. */
void line_search_eight(uint first)
{
    const uint line = line_index(), segment = line_segment(), last = line_best(segment);
    const int cell = int(segment * line_segment_cells() + first);
    for (uint i = segment > 0u ? line_best(segment - 1u) : 0u; i <= last; i++) {
        const int step = 2 * line_weight * line_offset(line_batch[i]);
        int cost = line_costs[line * BATCH + i] - cell * step;
        [[unroll]] for (uint k = 0u; k < 8u; k++, cost -= step)
        {
            line_least[first + k] = min(line_least[first + k], cost);
        }
    }
}

/* Lowers line_least by the `count` candidates of a batch. */
void line_search(uint count)
{
    line_search_ends(count);
    if (!line_segment_needed(line_segment()))
        return;
    line_search_eight(0u);
    if (line_segment_cells() > 8u)
        line_search_eight(8u);
}

/* ---- Results */

/* Puts the results of all threads where the costs were, once all batches are searched: threads then store
 * them in the order in which they lie in memory. */
void line_share_results()
{
    const uint first = line_segment() * line_segment_cells();
    barrier();
    [[unroll]] for (uint k = 0u; k < MOST_CELLS; k++)
    {
        if (k < line_segment_cells())
            line_costs[(first + k) * LINES + line_index()] = line_least[k];
    }
    barrier();
}

/* Least cost of a cell of a line. */
int line_result(uint cell, uint line)
{
    return line_costs[cell * LINES + line] + 8 * line_weight * int(cell * cell);
}

#endif
