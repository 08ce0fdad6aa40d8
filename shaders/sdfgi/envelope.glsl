/* SPDX-License-Identifier: MIT
 * The distance search along two lines of cells by one thread alone, for software drivers: where threads wait
 * for one another, these drivers keep all variables in memory. It finds what lines.glsl does.
 *
 * Without the term 8 i^2, which is the same for all candidates, the cost of a candidate falls with the cell i
 * along a straight line, and the later the candidate the faster. The least costs of all are the lower
 * envelope of these lines: a stack of the candidates that are best somewhere, each with the first cell where
 * it is (Felzenszwalb and Huttenlocher 2012, "Distance Transforms of Sampled Functions"). */
#ifndef SDFGI_ENVELOPE_GLSL
#define SDFGI_ENVELOPE_GLSL

#include "pass.glsl"

const uint ENVELOPE_LINES = 2u, ENVELOPE_CELLS = 256u;

int envelope_costs[ENVELOPE_LINES * ENVELOPE_CELLS];   /* for cell 0 */
uint envelope_places[ENVELOPE_LINES * ENVELOPE_CELLS]; /* position << 8 | first cell */
uint envelope_ends[ENVELOPE_LINES];                    /* of each line's stack */
uint envelope_at[ENVELOPE_LINES];                      /* that is best for the cell that was asked last */
int envelope_weight;                                   /* factor of squares along the lines */

void envelope_begin(int weight)
{
    envelope_weight = weight;
    envelope_ends[0] = envelope_at[0] = 0u;
    envelope_ends[1] = envelope_at[1] = ENVELOPE_CELLS;
}

/* Offset from the centre of cell 0, in halves of a sub-voxel. */
int envelope_offset(uint position)
{
    return 2 * int(position) - 3;
}

/* By how much a candidate's cost falls from cell to cell. */
int envelope_fall(uint position)
{
    return 2 * envelope_weight * envelope_offset(position);
}

/* The least whole number that is not below a quotient of two positive ones below 2^24. */
int envelope_quotient(int a, int b)
{
    int q = int(float(a) / float(b));
    q -= int(q * b >= a + b);
    return q + int(q * b < a);
}

/* Adds a candidate behind those that were added before. `base` is what it costs by itself. */
void envelope_push(uint line, uint position, int base)
{
    const int offset = envelope_offset(position), cost = envelope_weight * (offset * offset >> 3) + base,
              fall = envelope_fall(position);
    const uint begin = line * ENVELOPE_CELLS;
    uint end = envelope_ends[line], first = 0u;
    while (end > begin) {
        const int more = cost - envelope_costs[end - 1u];
        const uint below = envelope_places[end - 1u];
        first = more <= 0 ? 0u : uint(envelope_quotient(more, fall - envelope_fall(below >> 8u)));
        if (first > (below & 255u))
            break;
        first = 0u;
        end--;
    }
    if (first < sdfgi_frame.resolution) {
        envelope_costs[end] = cost;
        envelope_places[end] = position << 8u | first;
        end++;
    }
    envelope_ends[line] = end;
}

bool envelope_is_empty(uint line)
{
    return envelope_ends[line] == line * ENVELOPE_CELLS;
}

/* Least cost for a cell. Cells are asked for in their order, once all candidates are there. */
int envelope_least(uint line, uint cell)
{
    uint at = envelope_at[line];
    while (at + 1u < envelope_ends[line] && (envelope_places[at + 1u] & 255u) <= cell)
        at++;
    envelope_at[line] = at;
    const int i = int(cell);
    return envelope_costs[at] + i * (8 * envelope_weight * i - envelope_fall(envelope_places[at] >> 8u));
}

#endif
