/* SPDX-License-Identifier: MIT
 * Exact distance from each cell's centre to the nearest set sub-voxel's centre, rounded down: branch and bound over the
 * occupancy masks. One workgroup per block of 4^3 cells, one thread per cell. The workgroup first finds the sub-voxel nearest
 * to the middle of its block, which bounds the distance of every cell to within 2.6 cells; then it lists the occupied blocks
 * within that bound, and each cell searches the list. Unlike a flood it depends on nothing but the bits, so that any part
 * can be made again alone.
 * Shared memory: 8 KiB of blocks, 3 KiB of groups, 64 distances. */
#version 460
#extension GL_GOOGLE_include_directive : require
#define SDFGI_WRITES_DISTANCE
#include "occupancy.glsl"

layout(local_size_x = SDFGI_GROUP_LINEAR) in;

const uint GROUPS_AT_ONCE = 32u;
const uint LIST_GROUPS = 256u;

shared uint middle2;  /* float bits: squared distance from the block's middle, at first a bound */
shared uint group_count, listed_count;
shared uint groups[LIST_GROUPS];
shared uvec2 group_masks[LIST_GROUPS];
shared uint blocks[GROUPS_AT_ONCE * 64u];
shared uint encoded[64];

/* ---- Boxes of sub-voxel centres, in cells relative to the middle of this workgroup's block */

struct box {
    vec3 low, high;
};

box box_of_group(ivec3 own, ivec3 group)
{
    const vec3 low = vec3(16 * group - own) - 2.0;
    return box(low + 0.125, low + 15.875);
}

/* Occupied blocks are packed with the slabs of cells that hold anything: 6 bits per coordinate, then 2 bits for each end. */
uint pack_block(ivec3 block, uvec2 mask)
{
    const uvec3 slabs = nearest_slabs(mask);
    const uvec3 low = uvec3(findLSB(slabs)), high = uvec3(findMSB(slabs));
    return uint(block.x) | uint(block.y) << 6u | uint(block.z) << 12u | low.x << 18u | low.y << 20u | low.z << 22u |
           high.x << 24u | high.y << 26u | high.z << 28u;
}

ivec3 unpack_block(uint packed)
{
    return ivec3(uvec3(packed, packed >> 6u, packed >> 12u) & 63u);
}

box box_of_block(ivec3 own, uint packed)
{
    const vec3 corner = vec3(4 * unpack_block(packed) - own) - 2.0;
    const vec3 low = vec3(uvec3(packed >> 18u, packed >> 20u, packed >> 22u) & 3u);
    const vec3 high = vec3(uvec3(packed >> 24u, packed >> 26u, packed >> 28u) & 3u);
    return box(corner + low + 0.125, corner + high + 0.875);
}

/* Least squared distance from a box around the middle, of half size `half_size`, and greatest from the middle itself. */
float near2(box b, float half_size)
{
    const vec3 metric = metric_from_cells(max(max(b.low, -b.high) - half_size, 0.0));
    return dot(metric, metric);
}

float far2(box b)
{
    const vec3 metric = metric_from_cells(max(abs(b.low), abs(b.high)));
    return dot(metric, metric);
}

const float CELL_CENTRES = 1.5; /* how far this block's cell centres are from its middle, along an axis */

/* Squared distance beyond which nothing can be nearest to any cell of this block. */
float bound2()
{
    const float reach = sqrt(uintBitsToFloat(middle2)) + length(metric_from_cells(vec3(CELL_CENTRES)));
    return reach * reach * 1.00001;
}

void lower_bound_by(float d2)
{
    atomicMin(middle2, floatBitsToUint(d2));
}

/* ---- Steps of the workgroup */

ivec3 group_at(uint i)
{
    const uint bits = occupancy_group_bits(), mask = (1u << bits) - 1u;
    return ivec3(i & mask, i >> bits & mask, i >> (2u * bits));
}

uint group_total()
{
    return 1u << (3u * occupancy_group_bits());
}

void bound_by_groups(ivec3 own)
{
    for (uint i = gl_LocalInvocationIndex; i < group_total(); i += 64u)
        if (occupancy_mask(occupancy_group_slot(group_at(i))) != uvec2(0u))
            lower_bound_by(far2(box_of_group(own, group_at(i))));
}

/* Lists occupied groups from `first` on that lie within the bound; returns where to go on. */
uint list_groups(ivec3 own, uint first)
{
    const uint end = min(group_total(), first + LIST_GROUPS);
    for (uint i = first + gl_LocalInvocationIndex; i < end; i += 64u) {
        const uvec2 mask = occupancy_mask(occupancy_group_slot(group_at(i)));
        if (mask != uvec2(0u) && near2(box_of_group(own, group_at(i)), CELL_CENTRES) <= bound2()) {
            const uint at = atomicAdd(group_count, 1u);
            groups[at] = i;
            group_masks[at] = mask;
        }
    }
    return end;
}

/* Brings nearest2 down to the least squared distance from the middle of this block to a sub-voxel of another. */
void search_block_from_middle(ivec3 own, ivec3 block, uvec2 mask, inout float nearest2)
{
    for (int word = 0; word < 2; word++) {
        uint rest = mask[word];
        for (int i = 0; i < 32 && rest != 0u; i++) {
            const int bit = findLSB(rest);
            rest &= rest - 1u;
            const ivec3 cell = 4 * block + ivec3(bit & 3, bit >> 2 & 3, (bit >> 4) + 2 * word);
            const vec3 low = vec3(cell - own) - 2.0;
            if (near2(box(low + 0.125, low + 0.875), 0.0) < min(nearest2, uintBitsToFloat(middle2)))
                nearest2 = min(nearest2, nearest_in_cell2(cell_bits(args.cascade, cell), -4.0 * low - 0.5));
        }
    }
}

/* Thread i looks after block i of each group. Returns false where that is empty. */
bool own_block(uint group_listed, out ivec3 block)
{
    const uint lane = gl_LocalInvocationIndex;
    const uvec2 mask = group_masks[group_listed];
    block = 4 * group_at(groups[group_listed]) + ivec3(lane & 3u, lane >> 2u & 3u, lane >> 4u);
    return ((lane < 32u ? mask.x : mask.y) >> (lane & 31u) & 1u) != 0u;
}

box box_around_block(ivec3 own, ivec3 block)
{
    const vec3 low = vec3(4 * block - own) - 2.0;
    return box(low + 0.125, low + 3.875);
}

/* Brings middle2 down to the distance of the nearest sub-voxel in the listed groups. */
void search_from_middle(ivec3 own)
{
    float nearest2 = 1e30;
    ivec3 block;
    for (uint i = 0u; i < group_count; i++)
        if (own_block(i, block) && near2(box_around_block(own, block), 0.0) <= uintBitsToFloat(middle2)) {
            const uvec2 mask = occupancy_mask(occupancy_block_slot(block));
            lower_bound_by(far2(box_of_block(own, pack_block(block, mask))));
        }
    barrier();
    for (uint i = 0u; i < group_count; i++)
        if (own_block(i, block) && near2(box_around_block(own, block), 0.0) <= uintBitsToFloat(middle2))
            search_block_from_middle(own, block, occupancy_mask(occupancy_block_slot(block)), nearest2);
    lower_bound_by(nearest2);
    barrier();
}

void list_blocks(ivec3 own, uint first)
{
    ivec3 block;
    for (uint i = first; i < min(first + GROUPS_AT_ONCE, group_count); i++) {
        if (!own_block(i, block) || near2(box_around_block(own, block), CELL_CENTRES) > bound2())
            continue;
        const uint packed = pack_block(block, occupancy_mask(occupancy_block_slot(block)));
        if (near2(box_of_block(own, packed), CELL_CENTRES) <= bound2())
            blocks[atomicAdd(listed_count, 1u)] = packed;
    }
}

/* ---- Steps of a cell */

void search_block(ivec3 cell, ivec3 block, inout float best2)
{
    const uvec2 mask = occupancy_mask(occupancy_block_slot(block));
    for (int word = 0; word < 2; word++) {
        uint rest = mask[word];
        for (int i = 0; i < 32 && rest != 0u; i++) {
            const int bit = findLSB(rest);
            rest &= rest - 1u;
            const ivec3 other = 4 * block + ivec3(bit & 3, bit >> 2 & 3, (bit >> 4) + 2 * word);
            if (nearest_bound2(cell, other, vec3(0.0), vec3(3.0)) < best2)
                best2 = min(best2, nearest_in_cell2(cell_bits(args.cascade, other), vec3(4 * (cell - other)) + 1.5));
        }
    }
}

void search_list(ivec3 own, ivec3 cell, inout float best2)
{
    const vec3 offset = vec3(cell - own) - 1.5;
    for (uint i = 0u; i < listed_count; i++) {
        const box b = box_of_block(own, blocks[i]);
        if (near2(box(b.low - offset, b.high - offset), 0.0) < best2)
            search_block(cell, unpack_block(blocks[i]), best2);
    }
}

/* No cell is further from a surface than the middle by more than its way there. */
float bound_of_cell2(ivec3 own, ivec3 cell)
{
    const float reach = sqrt(uintBitsToFloat(middle2)) + length(metric_from_cells(vec3(cell - own) - 1.5));
    return reach * reach * 1.00001;
}

/* Two cells share a word; so do the threads of a pair. */
void store_distance(ivec3 cell, float d2)
{
    encoded[gl_LocalInvocationIndex] = encode_nearest(d2);
    barrier();
    if ((cell.x & 1) == 0)
        sdfgi_distances[cell_index(args.cascade, cell) >> 1u] =
            encoded[gl_LocalInvocationIndex] | encoded[gl_LocalInvocationIndex + 1u] << 16u;
}

void main()
{
    const ivec3 own = 4 * ivec3(gl_WorkGroupID);
    const uint lane = gl_LocalInvocationIndex;
    const ivec3 cell = own + ivec3(lane & 3u, lane >> 2u & 3u, lane >> 4u);
    float best2 = 1e30;
    if (lane == 0u)
        middle2 = floatBitsToUint(1e30);
    barrier();
    bound_by_groups(own);

    for (uint next = 0u; next < group_total();) {
        barrier();
        if (lane == 0u)
            group_count = 0u;
        barrier();
        next = list_groups(own, next);
        barrier();
        search_from_middle(own);
        best2 = min(best2, bound_of_cell2(own, cell));
        for (uint first = 0u; first < group_count; first += GROUPS_AT_ONCE) {
            barrier();
            if (lane == 0u)
                listed_count = 0u;
            barrier();
            list_blocks(own, first);
            barrier();
            search_list(own, cell, best2);
        }
    }
    store_distance(cell, best2);
}
