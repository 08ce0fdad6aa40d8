/* SPDX-License-Identifier: MIT
 * A workgroup finds the light cells of a dirty block, with a thread for each cell. Included by light_mark. */

shared uint found[2]; /* a bit per light cell of the workgroup's block */

/* Clears the visibility bits of a cell: those that the list has room for get new ones. */
void clear_cell(uint index)
{
    const uint bits = 0xffu << (8u * (index & 3u));
    if ((sdfgi_masks_at(index >> 2u) & bits) != 0u)
        atomicAnd(sdfgi_masks[index >> 2u], ~bits);
}

/* Called by the whole workgroup. */
void mark_block(uint block)
{
    const uint bit = gl_LocalInvocationIndex;
    if (bit < 2u)
        found[bit] = 0u;
    barrier();
    const uvec3 inside = uvec3(bit, bit >> 2u, bit >> 4u) & 3u;
    const ivec3 cell = sdfgi_cell_from_texel(args.cascade, 4u * light_block_coords(block) + inside);
    if (sdfgi_cell_distance(args.cascade, cell) < FARTHEST && is_light_cell(cell))
        atomicOr(found[bit >> 5u], 1u << (bit & 31u));
    clear_cell(sdfgi_cell_index(args.cascade, cell));
    barrier();
    if (bit == 0u)
        store_block(block, uvec2(found[0], found[1]));
}

void mark_dirty_blocks()
{
    bool more = true;
    for (uint n = gl_WorkGroupID.x; more; n += gl_NumWorkGroups.x) {
        uint block;
        if (dirty_block(n, block, more))
            mark_block(block);
        barrier();
    }
}
