/* SPDX-License-Identifier: MIT
 * Which light cells a dispatch visits: in each cascade those of a range of the list, and beside it some that
 * are watched (seen.glsl). Includers have args.first and args.end, the ranges. */
#ifndef SDFGI_VISITS_GLSL
#define SDFGI_VISITS_GLSL

#include "light_cells.glsl"
#include "seen.glsl"
#include "workgroup.glsl"
#include "../lib/nth_bit.glsl"

/* The cascade of a row. Rows of the ranges come first, and then those of the watched cells. */
uint visited_cascade(uint row)
{
    return row % sdfgi_frame.cascade_count;
}

/* The lowest n bits. */
uint visited_bits_below(int n)
{
    return n < SDFGI_SEEN_BITS ? (1u << max(n, 0)) - 1u : ~0u;
}

/* Watched cells of a word that are visited beside the range: a bit for each entry from `first` to before
 * `last`.
 */
uint visited_watched(uint cascade, uint first, uint last)
{
    if (first >= last)
        return 0u;
    const uint in_range = visited_bits_below(int(args.end[cascade] - first)) &
                          ~visited_bits_below(int(args.first[cascade] - first));
    return watched_bits(cascade, first) & visited_bits_below(int(last - first)) & ~in_range;
}

/* The end of a cascade's entries of which those that are watched are visited. */
uint visited_watched_end(uint cascade)
{
    return min(sdfgi_frame.cascades[cascade].watched_end, light_cell_count(cascade));
}

#ifdef SDFGI_SOFTWARE

/* Software drivers run the whole shader for threads that have nothing to do, too: there are to be few. As
 * many threads as a word has bits take the entries of a block: those of a range that follow one another, or
 * those of a word that are watched. A thread of cell_gather has one entry: these drivers end a shader whose
 * loops go round too often. */

/* Blocks for a thread. */
#ifndef VISIT_BLOCKS
#define VISIT_BLOCKS 1u
#endif

struct visit_block {
    uint cascade;
    uint first, end; /* entries */
    bool watched;    /* only those that are watched, outside of the range */
};

/* Takes the block with so many before it from entries that follow one another. `before` becomes less by those
 * that are passed over. */
void visit_block_take(inout visit_block block, inout int before, uint cascade, bool watched, uint first,
                      uint end)
{
    const uint size = uint(SDFGI_SEEN_BITS);
    const uint count = cascade < sdfgi_frame.cascade_count ? (end - first + size - 1u) / size : 0u;
    if (before >= 0 && uint(before) < count)
        block = visit_block(cascade, first + uint(before) * size, end, watched);
    before -= int(count);
}

/* The block with so many before it: those of the ranges come first. Cascades are constants where loops are
 * unrolled, so that all threads load together. Without entries if there is no such block. */
visit_block visit_block_find(uint index)
{
    visit_block block = visit_block(0u, 0u, 0u, false);
    int before = int(index);
    [[unroll]] for (uint c = 0u; c < uint(SDFGI_MAX_CASCADES); c++)
    {
        visit_block_take(block, before, c, false, args.first[c], args.end[c]);
    }
    [[unroll]] for (uint c = 0u; c < uint(SDFGI_MAX_CASCADES); c++)
    {
        visit_block_take(block, before, c, true, sdfgi_frame.cascades[c].watched_first,
                         sdfgi_frame.cascades[c].watched_end);
    }
    return block;
}

/* Numbers workgroups so that those in a row are far apart: these drivers give each processor a part of them,
 * in a row, and blocks of watched cells have less to do than others. */
uint visit_group()
{
    const uint parts = uint(SDFGI_VISIT_PARTS),
               part = max(gl_NumWorkGroups.x * gl_NumWorkGroups.y / parts, 1u);
    return workgroup_index() % part * parts + workgroup_index() / part;
}

/* The entry that a thread visits in its k-th block. False if there is none. */
bool visit_entry(uint k, out uint cascade, out uint entry)
{
    const uint bits = uint(SDFGI_SEEN_BITS), lane = gl_LocalInvocationIndex % bits;
    const uint groups = visit_group() * VISIT_BLOCKS + k;
    const visit_block block =
        visit_block_find((groups * gl_WorkGroupSize.x + gl_LocalInvocationIndex) / bits);
    cascade = block.cascade;
    const uint last = min(block.end, light_cell_count(cascade));
    const uint watched = block.watched ? visited_watched(cascade, block.first, last) : 0u;
    entry = block.first + (block.watched ? sdfgi_nth_bit(watched, lane) : lane);
    return block.watched ? lane < uint(bitCount(watched)) : entry < last;
}

#else

/* Finds the n-th entry of a row: of the range [first, end), or of the watched cells outside of it. False if
 * it is not to be visited. */
bool visited_entry(uint row, uint n, out uint entry)
{
    const uint cascade = visited_cascade(row), count = light_cell_count(cascade), first = args.first[cascade],
               end = args.end[cascade];
    entry = first + n;
    if (row < sdfgi_frame.cascade_count)
        return entry < min(end, count);
    entry = sdfgi_frame.cascades[cascade].watched_first + n;
    return entry < visited_watched_end(cascade) && (entry < first || entry >= end) &&
           watched_holds(cascade, entry);
}

#endif

#endif
