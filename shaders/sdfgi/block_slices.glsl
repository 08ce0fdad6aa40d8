/* SPDX-License-Identifier: MIT
 * An albedo block is a cube of 8x8x8 sub-voxels. Along an axis it has eight slices of 8x8 sub-voxels, one for
 * each depth, and a slice fits the 64 bits of a uvec2. The slices of an axis are equal arrangements of bits,
 * so that bitwise operations compare sub-voxels that lie behind one another. Needs
 * GL_EXT_control_flow_attributes, and SDFGI_ZERO (on_cpu.glsl). */
#ifndef SDFGI_BLOCK_SLICES_GLSL
#define SDFGI_BLOCK_SLICES_GLSL

#include "../include/sdfgi_space.glsl"

/* The 16 sub-voxels of a cell at a depth along an axis. Where they lie in the two words depends on the axis:
 * every fourth bit along x, every fourth group of four bits along y, and the low half of one word along z. */
uvec2 slice_of_cell(uvec2 bits, int axis, int depth)
{
    if (axis == 0)
        return bits >> uint(depth) & 0x11111111u;
    if (axis == 1)
        return bits >> uint(4 * depth) & 0x000f000fu;
    return uvec2((depth < 2 ? bits.x : bits.y) >> uint(16 * (depth & 1)) & 0xffffu, 0u);
}

/* The 64 sub-voxels of a block at a depth along an axis. Four cells lie side by side there, and each is
 * shifted to bits that the slices of the others leave free. */
uvec2 slice_of_block(uvec2 cells[8], int axis, int depth)
{
    const int depth_of_cell = depth >> 2, depth_in_cell = depth & 3;
    const int first = depth_of_cell << axis; /* then the next cells along the other two axes */
    const int u = axis == 0 ? 2 : 1, v = axis == 2 ? 2 : 4;
    const uvec2 a = slice_of_cell(cells[first], axis, depth_in_cell);
    const uvec2 b = slice_of_cell(cells[first + u], axis, depth_in_cell);
    const uvec2 c = slice_of_cell(cells[first + v], axis, depth_in_cell);
    const uvec2 d = slice_of_cell(cells[first + u + v], axis, depth_in_cell);
    if (axis == 0)
        return a | b << 1u | c << 2u | d << 3u;
    if (axis == 1)
        return a | b << 4u | c << 8u | d << 12u;
    return uvec2(a.x | b.x << 16u, c.x | d.x << 16u);
}

uint slice_count(uvec2 slice)
{
    return uint(bitCount(slice.x) + bitCount(slice.y));
}

/* Lines of sight along an axis, of 64, that meet a set sub-voxel. */
uint slices_seen(uvec2 cells[8], int axis)
{
    uvec2 seen = uvec2(0u);
    [[unroll]] for (int depth = int(SDFGI_ZERO); depth < 8; depth++)
    {
        seen |= slice_of_block(cells, axis, depth);
    }
    return slice_count(seen);
}

/* The first and the last depth along an axis at which a sub-voxel is set, if one is. */
uvec2 slices_bounds(uvec2 cells[8], int axis)
{
    uint depths = 0u;
    [[unroll]] for (int depth = int(SDFGI_ZERO); depth < 8; depth++)
    {
        depths |= uint(slice_of_block(cells, axis, depth) != uvec2(0u)) << depth;
    }
    return depths == 0u ? uvec2(0u) : uvec2(findLSB(depths), findMSB(depths));
}

/* Bits of the sub-voxels of a cell between two corners of its block, both included. `cell` is 0 or 1 along
 * each axis. */
uvec2 box_of_cell(uvec3 low, uvec3 high, uvec3 cell)
{
    const uvec3 along = ((uvec3(2u) << high) - (uvec3(1u) << low)) >> (4u * cell);
    const uint row = along.x & 15u;
    const uint layer =
        row * (along.y & 1u | (along.y & 2u) << 3u | (along.y & 4u) << 6u | (along.y & 8u) << 9u);
    return layer * (uvec2(along.z, along.z >> 2u) & 1u | (uvec2(along.z, along.z >> 2u) & 2u) << 15u);
}

/* The slice along an axis of a box between two corners of the block, both included. */
uvec2 slice_of_box(int axis, uvec3 low, uvec3 high)
{
    uvec2 cells[8];
    low[axis] = 0u;
    high[axis] = 7u;
    [[unroll]] for (uint i = SDFGI_ZERO; i < 8u; i++)
    {
        cells[i] = box_of_cell(low, high, uvec3(i & 1u, i >> 1u & 1u, i >> 2u));
    }
    return slice_of_block(cells, axis, 0);
}

/* Area of the cross-section of a sub-voxel's column along an axis, in squares of a sub-voxel's width. */
float slices_column_area(int axis)
{
    return axis == 1 ? 1.0 : sdfgi_space_y_scale();
}

#endif
