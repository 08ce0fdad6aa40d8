/* SPDX-License-Identifier: MIT
 * For every cell along a line the least of a sum over candidate sub-voxels of the line: what a candidate brings along plus
 * the square of the way to it. The best candidate never moves back as the cell moves on, so few cells look at all candidates
 * and the others only at those between their neighbours' best (Aggarwal et al. 1987, "Geometric applications of a
 * matrix-searching algorithm"). For 128 cells a candidate is read nine times: by four cells that look at all, by three between
 * each two of those, and then by the rest four at a time.
 * A workgroup works on LINES lines. SLOTS threads share one; each answers for as many cells in a row, and four make a team.
 * Candidates come in batches. A pass defines line_values and, before it includes this, BATCH.
 * Shared memory: 36 bytes per candidate of a batch, 8 KiB of results, and 1.3 KiB besides. */
#ifndef SDFGI_LINES_GLSL
#define SDFGI_LINES_GLSL

#include "occupancy.glsl"

layout(local_size_x = SDFGI_GROUP_LINES) in;

const uint LINES = SDFGI_LINES;
const uint SLOTS = SDFGI_GROUP_LINES / LINES;
const uint PLACE_BITS = 10u;

shared uint line_places[32];             /* a bit per place along the line that has candidates */
shared uint line_ranks[33];              /* candidates before each 32 places, and all */
shared uint line_any;                    /* not 0 if there is a candidate */
shared uint line_wanted;                 /* a bit per slot that has to answer */
shared uint line_batch[BATCH];           /* places of a batch of candidates */
shared uint line_entries[BATCH * LINES]; /* for each line: place, and above it what the candidate brings along */
shared uint line_least[256u * LINES];    /* per cell, of the batches so far */
shared uint line_part[SDFGI_GROUP_LINES];
shared uint line_best[SDFGI_GROUP_LINES]; /* which candidate is best for the last cell of each slot */

/* What a candidate amounts to for four cells of the line: the way to it squared, and what it brings along. */
uvec4 line_values(ivec4 way, uint brought);

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
    return sdfgi_frame.size.x / SLOTS;
}

/* For cells whose ways are measured from `centre`, line_centre of each. */
uvec4 line_values_of(uint entry, ivec4 centre)
{
    return line_values(2 * int(entry & ((1u << PLACE_BITS) - 1u)) - centre, entry >> PLACE_BITS);
}

/* Where a cell's centre is, so that its way to the centre of a sub-voxel is twice the place less this, in halves of a sub-voxel:
 * an odd number. */
int line_centre(uint cell)
{
    return int(8u * cell + 3u);
}

/* ---- Places: before candidates are put into batches */

void line_begin()
{
    if (gl_LocalInvocationIndex < 32u)
        line_places[gl_LocalInvocationIndex] = 0u;
    if (gl_LocalInvocationIndex == 0u) {
        line_wanted = 0u;
        line_any = 0u;
    }
    barrier();
}

/* `four` has a bit per sub-voxel along this cell of the line. */
void line_mark(uint cell, uint four)
{
    if (four == 0u)
        return;
    atomicOr(line_places[cell >> 3u], four << 4u * (cell & 7u));
    line_any = 1u;
}

uint line_words()
{
    return sdfgi_frame.size.x >> 3u;
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

bool line_holds(uint place)
{
    return (line_places[place >> 5u] >> (place & 31u) & 1u) != 0u;
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

/* Fills line_batch with the places of the candidates numbered from `first`. */
void line_put_batch(uint first)
{
    for (uint place = gl_LocalInvocationIndex; place < 4u * sdfgi_frame.size.x; place += SDFGI_GROUP_LINES) {
        const uint at = line_rank(place) - first;
        if (line_holds(place) && at < BATCH)
            line_batch[at] = place;
    }
    barrier();
}

/* ---- Search */

bool line_slots_wanted(uint first, uint count)
{
    return (line_wanted >> first & ((1u << count) - 1u)) != 0u;
}

/* Each thread those cells that it answers for. */
void line_clear()
{
    const uint count = line_cells_per_slot();
    if (line_slots_wanted(line_slot(), 1u))
        for (uint cell = line_slot() * count; cell < (line_slot() + 1u) * count; cell++)
            line_least[cell * LINES + line_own()] = 0xffffffffu;
}

/* Looks at candidates from `first` to before `end`. */
void line_scan(uint cell, uint first, uint end, inout uint least, inout uint best)
{
    for (uint i = first; i < end; i++) {
        const uint value = line_values_of(line_entries[i * LINES + line_own()], ivec4(line_centre(cell))).x;
        best = value < least ? i : best;
        least = min(least, value);
    }
}

void line_lower(uint cell, uint value)
{
    const uint at = cell * LINES + line_own();
    line_least[at] = min(line_least[at], value);
}

/* A team that the next one would start from is as good as asked. */
bool line_team_asked(uint team)
{
    return line_slots_wanted(team, 8u);
}

/* The last cell of each team looks at all candidates; its threads take a quarter each. */
void line_search_teams(uint count)
{
    const uint lane = gl_LocalInvocationIndex, member = line_slot() & 3u, team = line_slot() & ~3u;
    const uint cell = (team + 4u) * line_cells_per_slot() - 1u;
    uint least = 0xffffffffu, best = 0u;
    if (line_team_asked(team))
        line_scan(cell, count * member >> 2u, count * (member + 1u) >> 2u, least, best);
    line_part[lane] = least;
    line_best[lane] = best;
    barrier();
    if (member == 3u && line_team_asked(team)) {
        for (uint other = lane - 3u * LINES; other < lane; other += LINES)
            if (line_part[other] < least) {
                least = line_part[other];
                best = line_best[other];
            }
        line_best[lane] = best;
        line_lower(cell, least);
    }
    barrier();
}

/* Best candidate of the cell before a slot's first; 0 where nobody asked for it, which is no later. */
uint line_best_before(uint slot)
{
    return slot == 0u ? 0u : line_best[(slot - 1u) * LINES + line_own()];
}

/* The last cells of the other slots look between those of the teams. */
void line_search_slots()
{
    const uint slot = line_slot(), cell = (slot + 1u) * line_cells_per_slot() - 1u;
    if ((slot & 3u) != 3u) {
        uint least = 0xffffffffu, best = line_best_before(slot & ~3u);
        if (line_slots_wanted(slot, 1u)) {
            line_scan(cell, best, line_best[(slot | 3u) * LINES + line_own()] + 1u, least, best);
            line_lower(cell, least);
        }
        line_best[gl_LocalInvocationIndex] = best;
    }
    barrier();
}

/* Four cells look between the best of their slot's last and of the one before their first. */
void line_search_four(uint cell, uint cell_end)
{
    const ivec4 centre = line_centre(cell) + ivec4(0, 8, 16, 24);
    const uint end = line_best[gl_LocalInvocationIndex] + 1u;
    uvec4 least = uvec4(0xffffffffu);
    for (uint i = line_best_before(line_slot()); i < end; i++)
        least = min(least, line_values_of(line_entries[i * LINES + line_own()], centre));
    for (int k = 0; k < 4; k++)
        if (cell + k < cell_end)
            line_lower(cell + k, least[k]);
}

/* Lowers line_least by the `count` candidates of a batch. */
void line_search(uint count)
{
    line_search_teams(count);
    line_search_slots();
    const uint cells = line_cells_per_slot(), cell_end = (line_slot() + 1u) * cells;
    if (line_slots_wanted(line_slot(), 1u))
        for (uint cell = cell_end - cells; cell < cell_end; cell += 4u)
            line_search_four(cell, cell_end);
}

#endif
