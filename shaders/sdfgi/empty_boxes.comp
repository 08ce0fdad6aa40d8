/* SPDX-License-Identifier: MIT
 * The best empty box of each empty cell in each octant: shared/boxes.h. A box whose sides are twice as long
 * consists of two, four or eight cubes. A thread chooses for an octant of 32 cells along x. It has a word for
 * each digit of a number, a bit for each cell. */
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
#define SDFGI_WRITES_BITS
#include "pass.glsl"
#include "cubes.glsl"
#include "workgroup.glsl"

layout(local_size_x = SDFGI_GROUP_BOXES) in;
SDFGI_PUSH(sdfgi_cascade_args);

const uint OCTANTS = 8u, WORDS = uint(SDFGI_GROUP_BOXES) / OCTANTS;
const uint SIZE_DIGITS = 3u, RANK_DIGITS = 5u, AXES = 3u;
const uint RANKS[SDFGI_BOX_SIZES][4] = SDFGI_BOX_RANKS;

/* What is stored of an octant: the digits of the size, and per axis whether the side is twice as long. */
const uint DIGITS = SIZE_DIGITS + AXES;
shared uint chosen[WORDS * OCTANTS * DIGITS];

/* The first cell of a word of the workgroup. */
ivec3 word_cell(uint word)
{
    return ivec3(sdfgi_texel_from_index(32u * (WORDS * workgroup_index() + word)));
}

/* Two words of a row of cubes, side by side: the word of the 32 cells from `first` on is the first of them,
 * or the second where boxes lead down along x. */
uvec2 load_row(int size, ivec3 first, bool down)
{
    if (any(greaterThanEqual(first.yz, ivec2(sdfgi_space_resolution()))))
        return uvec2(0u);
    const int x = down ? first.x - 32 : first.x;
    const uint word = cubes_word(size, ivec3(x, first.yz));
    return uvec2(sdfgi_scratch_at(word),
                 x + 32 < sdfgi_space_resolution() ? sdfgi_scratch_at(word + 1u) : 0u);
}

/* 32 of 64 bits, from `first` on: 0 to 32. */
uint bits_from(uvec2 words, int first)
{
    return first == 0 ? words.x : first == 32 ? words.y : words.x >> first | words.y << 32 - first;
}

/* For each choice of sides that are twice as long, a bit for each axis, which boxes of an octant are not
 * empty. `first`: of 32 cells along x at which boxes begin. */
void find_boxes(int size, ivec3 first, uint octant, out uint occupied[8])
{
    const bvec3 down = bvec3(octant & 1u, octant & 2u, octant & 4u);
    [[unroll]] for (uint i = 0u; i < 4u; i++)
    {
        const ivec2 far = size * ivec2(i & 1u, i >> 1u);
        const uvec2 row = load_row(size, first + ivec3(0, mix(far, 1 - size - far, down.yz)), down.x);
        occupied[2u * i] = bits_from(row, down.x ? 33 - size : 0);
        occupied[2u * i + 1u] = bits_from(row, down.x ? 33 - 2 * size : size);
    }
    [[unroll]] for (uint axis = 0u; axis < AXES; axis++)
    {
        [[unroll]] for (uint i = 0u; i < 8u; i++)
        {
            if ((i >> axis & 1u) != 0u)
                occupied[i] |= occupied[i ^ 1u << axis];
        }
    }
}

struct boxes {
    uint size[SIZE_DIGITS], wide[AXES], rank[RANK_DIGITS];
};

const boxes NO_BOXES =
    boxes(uint[SIZE_DIGITS](0u, 0u, 0u), uint[AXES](0u, 0u, 0u), uint[RANK_DIGITS](0u, 0u, 0u, 0u, 0u));

/* The best boxes of a size: those with the most sides that are twice as long, and of such the first in this
 * order. A rank of 0: there is none. */
boxes best_of_size(int size, uint occupied[8])
{
    const uint order[8] = { 7u, 5u, 3u, 6u, 1u, 4u, 2u, 0u };
    boxes best = NO_BOXES;
    uint left = ~0u;
    [[unroll]] for (uint i = 0u; i < 8u; i++)
    {
        const uint takes = left & ~occupied[order[i]], rank = RANKS[size - 1][bitCount(order[i])];
        left &= ~takes;
        [[unroll]] for (uint d = 0u; d < SIZE_DIGITS; d++)
        {
            best.size[d] |= (uint(size) >> d & 1u) != 0u ? takes : 0u;
            best.wide[d] |= (order[i] >> d & 1u) != 0u ? takes : 0u;
        }
        [[unroll]] for (uint d = 0u; d < RANK_DIGITS; d++)
        {
            best.rank[d] |= (rank >> d & 1u) != 0u ? takes : 0u;
        }
    }
    return best;
}

/* Where `other` is better. */
uint is_better(boxes other, boxes best)
{
    uint better = 0u, equal = ~0u;
    [[unroll]] for (int d = int(RANK_DIGITS) - 1; d >= 0; d--)
    {
        better |= equal & other.rank[d] & ~best.rank[d];
        equal &= ~(other.rank[d] ^ best.rank[d]);
    }
    return better;
}

/* A digit of `b` where a bit of `which` is set, and of `a` elsewhere. */
uint choice(uint a, uint b, uint which)
{
    return a & ~which | b & which;
}

void take_better(boxes other, inout boxes best)
{
    const uint better = is_better(other, best);
    [[unroll]] for (uint d = 0u; d < SIZE_DIGITS; d++)
    {
        best.size[d] = choice(best.size[d], other.size[d], better);
    }
    [[unroll]] for (uint axis = 0u; axis < AXES; axis++)
    {
        best.wide[axis] = choice(best.wide[axis], other.wide[axis], better);
    }
    [[unroll]] for (uint d = 0u; d < RANK_DIGITS; d++)
    {
        best.rank[d] = choice(best.rank[d], other.rank[d], better);
    }
}

boxes best_boxes(ivec3 first, uint octant)
{
    boxes best = NO_BOXES;
    [[unroll]] for (int size = 1; size <= SDFGI_BOX_SIZES; size++)
    {
        uint occupied[8];
        find_boxes(size, first, octant, occupied);
        take_better(best_of_size(size, occupied), best);
    }
    return best;
}

/* Transposes a square of eight rows of eight bits (Warren 2012, "Hacker's Delight", 7-3). */
uvec2 transposed(uvec2 rows)
{
    uvec2 swap = (rows ^ rows >> 7u) & 0x00aa00aau;
    rows ^= swap ^ swap << 7u;
    swap = (rows ^ rows >> 14u) & 0x0000ccccu;
    rows ^= swap ^ swap << 14u;
    swap.x = (rows.x ^ rows.y << 4u) & 0xf0f0f0f0u;
    return rows ^ uvec2(swap.x, swap.x >> 4u);
}

/* A byte for each of eight cells: digits [first, first + count) of 8 / count octants, from `octant` on. */
uvec2 bytes_of_cells(uint word, uint cell, uint octant, uint first, uint count)
{
    uvec2 rows = uvec2(0u);
    [[unroll]] for (uint i = 0u; i < 8u; i++)
    {
        const uint digits = chosen[(word * OCTANTS + octant + i / count) * DIGITS + first + i % count];
        rows[i / 4u] |= (digits >> cell & 255u) << 8u * (i % 4u);
    }
    return transposed(rows);
}

/* Stores the boxes of eight cells, which lie side by side, because cascades scroll by as many. Octants of
 * occupied cells have no digits. */
void store_boxes(uint word, uint cell)
{
    uvec2 sizes[4], wide[2];
    [[unroll]] for (uint i = 0u; i < 4u; i++)
    {
        sizes[i] = bytes_of_cells(word, cell, 2u * i, 0u, 4u);
    }
    [[unroll]] for (uint i = 0u; i < 2u; i++)
    {
        wide[i] = bytes_of_cells(word, cell, 4u * i, 4u, 2u);
    }
    const uint index = sdfgi_cell_index(args.cascade, word_cell(word) + ivec3(cell, 0, 0));
    [[unroll]] for (uint i = 0u; i < 8u; i++)
    {
        uvec2 words = uvec2(0u, SDFGI_BOXES_MARK);
        [[unroll]] for (uint k = 0u; k < 4u; k++)
        {
            words.x |= (sizes[k][i / 4u] >> 8u * (i % 4u) & 255u) << 8u * k;
        }
        [[unroll]] for (uint k = 0u; k < 2u; k++)
        {
            words.y |= (wide[k][i / 4u] >> 8u * (i % 4u) & 255u) << 8u * k;
        }
        if (words.x != 0u)
            sdfgi_bits[index + i] = words;
    }
}

void main()
{
    const uint lane = gl_LocalInvocationIndex;
    const boxes best = best_boxes(word_cell(lane / OCTANTS), lane % OCTANTS);
    [[unroll]] for (uint d = 0u; d < SIZE_DIGITS; d++)
    {
        chosen[lane * DIGITS + d] = best.size[d];
        chosen[lane * DIGITS + SIZE_DIGITS + d] = best.wide[d];
    }
    barrier();
    if (lane < 4u * WORDS)
        store_boxes(lane / 4u, 8u * (lane % 4u));
}
