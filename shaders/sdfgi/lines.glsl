/* SPDX-License-Identifier: MIT
 * For every cell along a line the least of a sum over candidate sub-voxels of the line: what a candidate
 * brings along plus the square of the way to it. The best candidate never moves back as the cell moves on, so
 * few cells look at all candidates and the others only at those between their neighbours' best (Aggarwal et
 * al. 1987, "Geometric applications of a matrix-searching algorithm"). A workgroup works on LINES lines.
 * SLOTS threads share one; each answers for as many cells in a row. First they share out the candidates, each
 * trying its own on the last cell of every slot; then each looks for its cells between the best of its last
 * and of the one before its first: at 10 to 12 candidates in the mean where a village scrolls, at 23 to 30 in
 * the slowest of 32 threads. With t = (way^2 - 1) / 8, ways being odd numbers of half a sub-voxel, the sum is
 * line_weight t + what is brought along. A way is a candidate's step less eight times the cell, so one
 * product per candidate and a constant per cell tell all sums. Candidates come in batches. Before it includes
 * this, a pass defines BATCH, at least 256 and 4 more than a multiple of 32: threads that share a line, and
 * those of lines beside it, then find candidates side by side in banks of their own. Shared memory: 36 bytes
 * per candidate of a batch, and 800 besides. */
#ifndef SDFGI_LINES_GLSL
#define SDFGI_LINES_GLSL

#include "occupancy.glsl"

layout(local_size_x = SDFGI_GROUP_LINES) in;

const uint LINES = SDFGI_LINES;
const uint SLOTS = SDFGI_GROUP_LINES / LINES;
const uint MOST_CELLS = 256u / SLOTS; /* of a slot */
const int WORST = 0x7fffffff;
const uint NOT_YET = 0xffffffffu;

shared uint line_places[32];              /* a bit per place along the line that has candidates */
shared uint line_ranks[33];               /* candidates before each 32 places, and all */
shared uint line_wanted;                  /* a bit per slot that has to answer */
shared uint line_batch[BATCH];            /* places of a batch of candidates */
shared int line_sums[LINES * BATCH];      /* of each line: what its candidates amount to for cell 0 */
shared uint line_ends[SDFGI_GROUP_LINES]; /* for the last cell of each slot: its sum, and below it the
                                             candidate's number */

int line_least[MOST_CELLS]; /* for the cells of this thread */
int line_weight;            /* how much squares along this line count */
uint line_number_bits;      /* that sums leave of 32 for the number of a candidate in its batch */

uint line_own()
{
    return gl_LocalInvocationIndex & (LINES - 1u);
}

uint line_slot()
{
    return gl_LocalInvocationIndex / LINES;
}

uint line_cells_per_slot()
{
    return sdfgi_frame.resolution / SLOTS;
}

/* The way from the centre of cell 0, in halves of a sub-voxel. */
int line_step(uint place)
{
    return 2 * int(place) - 3;
}

/* A candidate for cell 0. */
int line_sum(uint place, int brought)
{
    const int way = line_step(place);
    return line_weight * (way * way >> 3) + brought;
}

/* ---- Places: before candidates are put into batches */

/* Weight and bits are worked out once: within loops they took longer than all else. */
void line_begin(int weight, uint number_bits)
{
    line_weight = weight;
    line_number_bits = number_bits;
    if (gl_LocalInvocationIndex < 32u)
        line_places[gl_LocalInvocationIndex] = 0u;
    if (gl_LocalInvocationIndex == 0u)
        line_wanted = 0u;
    [[unroll]] for (uint k = 0u; k < MOST_CELLS; k++) line_least[k] = WORST;
    barrier();
}

/* `four` has a bit per sub-voxel along this cell of the line. */
void line_mark(uint cell, uint four)
{
    if (four != 0u)
        atomicOr(line_places[cell >> 3u], four << 4u * (cell & 7u));
}

uint line_words()
{
    return sdfgi_frame.resolution >> 3u;
}

/* Once all are marked. */
void line_count()
{
    barrier();
    if (gl_LocalInvocationIndex <= line_words()) {
        uint rank = 0u;
        for (uint i = 0u; i < gl_LocalInvocationIndex; i++)
            rank += uint(bitCount(line_places[i]));
        line_ranks[gl_LocalInvocationIndex] = rank;
    }
    barrier();
}

/* Candidates before that of a place. */
uint line_rank(uint place)
{
    return line_ranks[place >> 5u] + uint(bitCount(line_places[place >> 5u] & ((1u << (place & 31u)) - 1u)));
}

uint line_candidates()
{
    return line_ranks[line_words()];
}

/* Candidates in a batch at most. */
uint line_room()
{
    return min(BATCH, 1u << line_number_bits);
}

/* Fills line_batch with the places of the candidates numbered from `first`. */
void line_put_batch(uint first)
{
    for (uint cell = gl_LocalInvocationIndex; cell < sdfgi_frame.resolution; cell += SDFGI_GROUP_LINES) {
        const uint four = line_places[cell >> 3u] >> 4u * (cell & 7u) & 15u;
        uint at = line_rank(4u * cell) - first;
        for (uint i = 0u; i < 4u; i++)
            if ((four >> i & 1u) != 0u) {
                if (at < line_room())
                    line_batch[at] = 4u * cell + i;
                at++;
            }
    }
    line_ends[gl_LocalInvocationIndex] = NOT_YET;
    barrier();
}

/* ---- Search */

bool line_slot_wanted(uint slot)
{
    return (line_wanted >> slot & 1u) != 0u;
}

/* What the sum at the last cell of a slot is more than at that of the slot before, a candidate's way aside.
 */
uint line_growth(uint slot)
{
    const int cells = int(line_cells_per_slot());
    return uint(8 * line_weight * cells * (2 * (int(slot) * cells - 1) + cells));
}

/* The last cell of every slot looks at all candidates; the threads of its line take turns. The number of a
 * candidate lies below its sum, so that of several best the first is found. */
void line_search_ends(uint count)
{
    uint least[SLOTS];
    [[unroll]] for (uint s = 0u; s < SLOTS; s++) least[s] = NOT_YET;
    const uint shift = line_number_bits;
    const int stride = 2 * line_weight * int(line_cells_per_slot());
    for (uint i = line_slot(); i < count; i += SLOTS) {
        const int way = line_step(line_batch[i]);
        uint sum = uint(line_sums[line_own() * BATCH + i] + line_weight * (2 * way + 8)) << shift | i;
        [[unroll]] for (uint s = 0u; s < SLOTS; s++)
        {
            sum += (line_growth(s) - uint(stride * way)) << shift;
            least[s] = min(least[s], sum);
        }
    }
    [[unroll]] for (uint s = 0u; s < SLOTS; s++) atomicMin(line_ends[s * LINES + line_own()], least[s]);
    barrier();
}

/* Which candidate is best for the last cell of a slot. */
uint line_best(uint slot)
{
    return line_ends[slot * LINES + line_own()] & (1u << line_number_bits) - 1u;
}

/* Eight cells from the slot's cell `first` on look between the best of the slot's ends. */
void line_search_eight(uint first)
{
    const uint own = line_own(), slot = line_slot(), end = line_best(slot);
    const int cell = int(slot * line_cells_per_slot() + first);
    for (uint i = slot > 0u ? line_best(slot - 1u) : 0u; i <= end; i++) {
        const int way = 2 * line_weight * line_step(line_batch[i]);
        int sum = line_sums[own * BATCH + i] - cell * way;
        [[unroll]] for (uint k = 0u; k < 8u; k++, sum -= way) line_least[first + k] =
            min(line_least[first + k], sum);
    }
}

/* Lowers line_least by the `count` candidates of a batch. */
void line_search(uint count)
{
    line_search_ends(count);
    if (!line_slot_wanted(line_slot()))
        return;
    line_search_eight(0u);
    if (line_cells_per_slot() > 8u)
        line_search_eight(8u);
}

/* Once all batches are searched: results of all threads go where the sums were, to be stored in the order in
 * which they lie. */
void line_publish()
{
    const uint first = line_slot() * line_cells_per_slot();
    barrier();
    [[unroll]] for (uint k = 0u; k < MOST_CELLS; k++) if (k < line_cells_per_slot())
        line_sums[(first + k) * LINES + line_own()] = line_least[k];
    barrier();
}

int line_result(uint cell, uint own)
{
    return line_sums[cell * LINES + own] + 8 * line_weight * int(cell * cell);
}

#endif
