/* SPDX-License-Identifier: MIT
 * Which light cells a dispatch visits: in each cascade those of a range of the list, and beside it some that
 * are seen (seen.glsl). Includers have args.first and args.end, the ranges. */
#ifndef SDFGI_VISITS_GLSL
#define SDFGI_VISITS_GLSL

#include "light_cells.glsl"
#include "seen.glsl"
#include "workgroup.glsl"
#include "../lib/nth_bit.glsl"

/* The cascade of a row. Rows of the ranges come first, and then those of the seen cells. */
uint visited_cascade(uint row)
{
    return row % sdfgi_frame.cascade_count;
}

/* The lowest n bits. */
uint visited_bits_below(int n)
{
    return n < SDFGI_SEEN_BITS ? (1u << max(n, 0)) - 1u : ~0u;
}

/* Seen cells of a word that are visited beside the range: a bit for each, from the entry `first` on. */
uint visited_seen(uint cascade, uint word, out uint first)
{
    first = sdfgi_frame.cascades[cascade].seen_first + uint(SDFGI_SEEN_BITS) * word;
    const uint last = min(sdfgi_frame.cascades[cascade].seen_end, light_cell_count(cascade));
    if (first >= last)
        return 0u;
    const uint in_range = visited_bits_below(int(args.end[cascade] - first)) &
                          ~visited_bits_below(int(args.first[cascade] - first));
    return sdfgi_seen_at(seen_word(cascade, first)) & visited_bits_below(int(last - first)) & ~in_range;
}

#ifdef SDFGI_SOFTWARE

/* Software drivers run what is under a condition in any case, but a loop only as often as one of its threads
 * needs: few threads may have nothing to do. As many threads as a word has bits take the entries of a block:
 * those of a range that follow one another, or SDFGI_SEEN_WORDS words of seen cells. */

/* Blocks for a thread. */
#ifndef VISIT_BLOCKS
#define VISIT_BLOCKS 1u
#endif

struct visit_block {
    uint row;   /* the ranges of all cascades, and then their seen cells */
    uint index; /* of the block in its row; too large if there is no such block */
};

uint visit_blocks_of(uint row)
{
    const uint cascade = visited_cascade(row), bits = uint(SDFGI_SEEN_BITS);
    return row < sdfgi_frame.cascade_count
               ? (args.end[cascade] - args.first[cascade] + bits - 1u) / bits
               : (sdfgi_frame.cascades[cascade].seen_end - sdfgi_frame.cascades[cascade].seen_first +
                  bits * uint(SDFGI_SEEN_WORDS) - 1u) /
                     (bits * uint(SDFGI_SEEN_WORDS));
}

visit_block visit_block_find(uint index)
{
    visit_block block = visit_block(0u, index);
    for (uint row = 0u; row + 1u < 2u * sdfgi_frame.cascade_count; row++) {
        const uint count = visit_blocks_of(row);
        if (block.index < count)
            break;
        block = visit_block(row + 1u, block.index - count);
    }
    return block;
}

/* The entry that a thread visits in a step. False if there is none. */
bool visit_step(uint step, out uint cascade, out uint entry)
{
    const uint bits = uint(SDFGI_SEEN_BITS), lane = gl_LocalInvocationIndex % bits;
    const uint turn = step / uint(SDFGI_SEEN_WORDS), k = step % uint(SDFGI_SEEN_WORDS);
    const uint first_block = workgroup_index() * VISIT_BLOCKS + turn;
    const visit_block block =
        visit_block_find((first_block * gl_WorkGroupSize.x + gl_LocalInvocationIndex) / bits);
    cascade = visited_cascade(block.row);
    if (block.row < sdfgi_frame.cascade_count) {
        entry = args.first[cascade] + block.index * bits + lane;
        return k == 0u && entry < min(args.end[cascade], light_cell_count(cascade));
    }
    uint first;
    const uint seen = visited_seen(cascade, block.index * uint(SDFGI_SEEN_WORDS) + k, first);
    /* Words that hold few bits give them to different threads. */
    const uint n = (lane + 8u * k) % bits;
    entry = first + sdfgi_nth_bit(seen, n);
    return n < uint(bitCount(seen));
}

/* Goes on to the next entry that a thread visits. False if there is none. */
bool visit_next(inout uint step, out uint cascade, out uint entry)
{
    bool found = false;
    for (; !found && step < VISIT_BLOCKS * uint(SDFGI_SEEN_WORDS); step++)
        found = visit_step(step, cascade, entry);
    return found;
}

#else

/* Finds the n-th entry of a row: of the range [first, end), or of the seen cells outside of it. False if it
 * is not to be visited. */
bool visited_entry(uint row, uint n, out uint entry)
{
    const uint cascade = visited_cascade(row), count = light_cell_count(cascade), first = args.first[cascade],
               end = args.end[cascade];
    entry = first + n;
    if (row < sdfgi_frame.cascade_count)
        return entry < min(end, count);
    entry = sdfgi_frame.cascades[cascade].seen_first + n;
    return entry < min(sdfgi_frame.cascades[cascade].seen_end, count) && (entry < first || entry >= end) &&
           seen_holds(cascade, entry);
}

#endif

#endif
