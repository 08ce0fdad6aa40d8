/* SPDX-License-Identifier: MIT
 * A thread finds the light cells of a dirty block alone, for software drivers: where threads wait for one
 * another, these drivers keep all variables in memory. Included by light_mark. */

/* A bit if a cell is a light cell. */
uint light_cell_bit(ivec3 cell)
{
    return uint(sdfgi_cell_distance(args.cascade, cell) < FARTHEST && is_light_cell(cell));
}

/* Tests the cells of a block, row by row, and clears their visibility bits, which are a word for each row. */
void mark_block(uint block)
{
    const ivec3 first = sdfgi_cell_from_texel(args.cascade, 4u * light_block_coords(block));
    uvec2 found = uvec2(0u);
    for (uint row = SDFGI_ZERO; row < 16u; row++) {
        const ivec3 cell = first + ivec3(0, row & 3u, row >> 2u);
        uint bits = 0u;
        for (uint x = SDFGI_ZERO; x < 4u; x++)
            bits |= light_cell_bit(cell + ivec3(x, 0, 0)) << x;
        found.x |= row < 8u ? bits << 4u * row : 0u;
        found.y |= row < 8u ? 0u : bits << 4u * (row - 8u);
        sdfgi_masks[sdfgi_cell_index(args.cascade, cell) >> 2u] = 0u;
    }
    store_block(block, found);
}

void mark_dirty_blocks()
{
    bool more = true;
    for (uint n = gl_GlobalInvocationID.x; more; n += gl_NumWorkGroups.x * SDFGI_GROUP_LINEAR) {
        uint block;
        if (dirty_block(n, block, more))
            mark_block(block);
    }
}
