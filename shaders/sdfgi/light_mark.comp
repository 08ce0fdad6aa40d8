/* SPDX-License-Identifier: MIT
 * Marks the light cells of a cascade: empty cells with an occupied face neighbour. light_list then writes
 * them into the list.
 *
 * In a dirty light block all cells are tested, and those that are no light cells lose their light. In
 * every other block the light cells are those of the previous list; their direct light is copied from it,
 * because light_list overwrites the list. The layout of lists and marks is in light_blocks.glsl. The threads
 * share the entries of the previous list. The workgroups share the dirty blocks, with a thread per cell; on
 * software drivers each thread tests the cells of a block alone. */
#version 460
#extension GL_GOOGLE_include_directive : require
#define SDFGI_WRITES_MASKS
#define SDFGI_WRITES_SCRATCH
#include "../lib/on_cpu.glsl"
#include "dirty.glsl"
#include "light_blocks.glsl"
#include "gathered.glsl"
#include "low_lights.glsl"
#include "visibility.glsl"
#include "../include/sdfgi_cells.glsl"

layout(local_size_x = SDFGI_GROUP_LINEAR) in;
SDFGI_PUSH(sdfgi_light_mark_args);

/* ---- Which blocks are dirty */

/* Number of light cells that the previous list counted. It is more than the list holds where it was too
 * short. */
uint previous_count()
{
    return indirect_number(uint(SDFGI_INDIRECT_CELLS) + args.cascade);
}

bool previous_was_too_short()
{
    return previous_count() > sdfgi_frame.light_cell_room;
}

/* The block of an entry of the previous list. */
uint block_of_entry(uint entry)
{
    const uint index = sdfgi_light_cells_at(light_cell_slot(args.cascade, entry));
    return light_block_from_coords(sdfgi_texel_from_index(index) / SDFGI_GROUP_CELLS);
}

/* A list that was too short may lack cells of its last entry's block, and lacks all blocks after it. Its
 * entries cannot tell which cells those are, so these blocks are tested again. */
bool previous_was_cut_before(uint block)
{
    return previous_was_too_short() && block >= block_of_entry(sdfgi_frame.light_cell_room - 1u);
}

bool is_dirty(uint block)
{
    const ivec3 cage =
        sdfgi_cell_from_texel(args.cascade, 4u * light_block_coords(block)) / SDFGI_PROBE_SPACING;
    return args.rebuild != 0u ||
           dirty_near(args.cascade, cage * SDFGI_PROBE_SPACING, (cage + 1) * SDFGI_PROBE_SPACING, 0) ||
           previous_was_cut_before(block);
}

/* True if dirty blocks may lie anywhere, not only around dirty boxes. */
bool tests_all_blocks()
{
    return args.rebuild != 0u || previous_was_too_short();
}

/* The cells whose cages touch a dirty box. */
void cells_around_box(int box, out ivec3 low, out ivec3 high)
{
    const ivec3 end = ivec3(sdfgi_space_resolution());
    low = clamp(sdfgi_frame.cascades[args.cascade].dirty[box].low - SDFGI_PROBE_SPACING, ivec3(0), end);
    high = clamp(sdfgi_frame.cascades[args.cascade].dirty[box].high + SDFGI_PROBE_SPACING, ivec3(0), end);
}

bool is_around_earlier_box(int box, ivec3 cell)
{
    for (int i = 0; i < box; i++) {
        ivec3 low, high;
        cells_around_box(i, low, high);
        if (all(greaterThanEqual(cell, low)) && all(lessThan(cell, high)))
            return true;
    }
    return false;
}

/* Finds candidate n: one of all blocks, or of the blocks around dirty boxes, box by box. Returns true if the
 * block is to be marked. A block around two boxes is marked for the first of them only. `more` is false if
 * there is no candidate n. */
bool dirty_block(uint n, out uint block, out bool more)
{
    block = n;
    more = false;
    if (tests_all_blocks()) {
        more = n < light_block_count();
        return more && is_dirty(n);
    }
    for (int i = 0; i < dirty_count(args.cascade); i++) {
        ivec3 low, high;
        cells_around_box(i, low, high);
        const uvec3 size = uvec3(max(high - low, ivec3(0))) / 4u;
        const uint blocks = size.x * size.y * size.z;
        if (n < blocks) {
            const ivec3 cell = low + 4 * ivec3(n % size.x, n / size.x % size.y, n / (size.x * size.y));
            block = light_block_from_coords(sdfgi_cell_texel(args.cascade, cell) / 4u);
            more = true;
            return !is_around_earlier_box(i, cell);
        }
        n -= blocks;
    }
    return false;
}

/* ---- Cells of the previous list */

/* A row is SDFGI_GROUP_LINEAR blocks in sequence. The slot of the first word of the row that holds a block:
 * how many light cells the row has. */
uint row_slot_of_block(uint block)
{
    return light_row_slot(block / SDFGI_GROUP_LINEAR);
}

/* Keeps what an entry of the previous list held. */
void keep_light(uint entry)
{
    for (uint k = 0u; k < uint(SDFGI_DIRECT_WORDS); k++)
        sdfgi_scratch[light_previous_slot(entry, LIGHT_KEPT_DIRECT + k)] =
            sdfgi_direct_at(direct_word(args.cascade, k, entry));
    for (uint axis = 0u; axis < 6u; axis++) {
        const uint index = sdfgi_surface_index(args.cascade, entry, axis);
        sdfgi_scratch[light_previous_slot(entry, LIGHT_KEPT_LIGHT + axis)] = sdfgi_light_at(index);
        sdfgi_scratch[light_previous_slot(entry, LIGHT_KEPT_SURFACES + axis)] = sdfgi_surfaces_at(index);
    }
    for (uint axis = 0u; keeps_low_light() && axis < 6u; axis++)
        sdfgi_scratch[light_previous_slot(entry, LIGHT_KEPT_LOW + axis)] =
            sdfgi_seen_at(low_light_word(sdfgi_surface_index(args.cascade, entry, axis)));
    for (uint k = 0u; gathers() && k < SDFGI_GATHERED_WORDS; k++)
        sdfgi_scratch[light_previous_slot(entry, LIGHT_KEPT_GATHERED + k)] =
            sdfgi_gathered_at(gathered_word(args.cascade, k, entry));
}

/* Keeps an entry of the previous list, and marks it again unless its block is dirty. */
void keep_entry(uint entry)
{
    const uint count = min(previous_count(), sdfgi_frame.light_cell_room);
    if (args.rebuild != 0u || entry >= count)
        return;
    keep_light(entry);
    const uint block = block_of_entry(entry);
    if (is_dirty(block))
        return;
    const uint slot = light_cell_slot(args.cascade, entry);
    const uvec3 inside = sdfgi_texel_from_index(sdfgi_light_cells_at(slot)) & 3u;
    const uint bit = inside.x | inside.y << 2u | inside.z << 4u;
    atomicOr(sdfgi_scratch[light_block_slot(block) + (bit >> 5u)], 1u << (bit & 31u));

    /* The entries of a block are contiguous, so a block has last + 1 - first of them. The thread of its first
     * entry subtracts `first` and the thread of its last one adds `last + 1`: two atomics per block instead
     * of one per cell, in either order, because unsigned sums may wrap. */
    const bool is_first = entry == 0u || block_of_entry(entry - 1u) != block;
    const bool is_last = entry + 1u == count || block_of_entry(entry + 1u) != block;
    if (is_first) {
        sdfgi_scratch[light_block_slot(block) + 3u] = entry;
        atomicAdd(sdfgi_scratch[row_slot_of_block(block)], 0u - entry);
    }
    if (is_last)
        atomicAdd(sdfgi_scratch[row_slot_of_block(block)], entry + 1u);
}

/* ---- Cells of dirty blocks */

/* Beyond this distance no face neighbour of a cell can hold a sub-voxel: sqrt(1.375^2 + 2 * 0.375^2), and the
 * 0.1 by which a flood's distances may be too large. */
const float FARTHEST = 1.6;

/* Of a cell that is not beyond FARTHEST. The bits of most cells are not read. */
bool is_light_cell(ivec3 cell)
{
    return sdfgi_cell_is_empty(args.cascade, cell) && light_cell_facing(args.cascade, cell) != 0u;
}

/* Notes which light cells a dirty block had in the previous list: they may keep their light. */
void note_previous(uint block)
{
    const uint slot = light_block_slot(block);
    const uint record = light_block_record(args.cascade, block);
    const bool keeps = args.rebuild == 0u;
    const uvec2 low = keeps ? sdfgi_light_blocks_at(record) : uvec2(0u),
                high = keeps ? sdfgi_light_blocks_at(record + 1u) : uvec2(0u);
    sdfgi_scratch[slot + 3u] = low.y;
    sdfgi_scratch[slot + 4u] = low.x;
    sdfgi_scratch[slot + 5u] = high.x;
}

/* Writes the light cells of a dirty block: a bit for each. */
void store_block(uint block, uvec2 found)
{
    const uint count = uint(bitCount(found.x) + bitCount(found.y));
    if (count == 0u)
        return;
    const uint slot = light_block_slot(block);
    sdfgi_scratch[slot] = found.x;
    sdfgi_scratch[slot + 1u] = found.y;
    sdfgi_scratch[slot + 2u] = 1u;
    note_previous(block);
    atomicAdd(sdfgi_scratch[row_slot_of_block(block)], count);
    atomicAdd(sdfgi_scratch[row_slot_of_block(block) + 1u], count);
}

#ifdef SDFGI_SOFTWARE
#include "light_mark_alone.glsl"
#else
#include "light_mark_shared.glsl"
#endif

void main()
{
    for (uint entry = gl_GlobalInvocationID.x; entry < sdfgi_frame.light_cell_room;
         entry += gl_NumWorkGroups.x * SDFGI_GROUP_LINEAR)
        keep_entry(entry);
    mark_dirty_blocks();
}
