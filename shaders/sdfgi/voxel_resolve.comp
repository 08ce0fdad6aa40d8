/* SPDX-License-Identifier: MIT
 * Resolves the accumulators of each albedo block (2x2x2 cells) to mean albedo, emission and normals. The
 * emissive bits tell which sub-voxels emit. One thread per albedo block of the box. */
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
#define SDFGI_WRITES_SURFACE
#include "dirty_bounds.glsl"
#include "surface.glsl"
#include "workgroup.glsl"

layout(local_size_x = SDFGI_GROUP_LINEAR) in;
layout(push_constant) uniform sdfgi_push
{
    sdfgi_region_args args;
};

uint accumulated(uint plane, uint block)
{
    return sdfgi_scratch[plane * sdfgi_albedo_block_count() + block];
}

vec3 accumulated3(uint plane, uint block)
{
    return vec3(accumulated(plane, block), accumulated(plane + 1u, block), accumulated(plane + 2u, block));
}

/* One normal for each dominant axis: two slopes of 5 bits, means over the samples. */
uint resolve_normals(uint block)
{
    uint packed = 0u;
    for (uint major = 0u; major < 3u; major++) {
        const uint plane = SDFGI_ACCUM_NORMAL + 3u * major;
        const uint count = accumulated(plane, block);
        uint slopes = SURFACE_NO_NORMAL;
        if (count > 0u) {
            const vec2 sum = vec2(int(accumulated(plane + 1u, block)), int(accumulated(plane + 2u, block)));
            const uvec2 q =
                uvec2(round(clamp(sum / (float(count) * SDFGI_SLOPE_STEPS), -1.0, 1.0) * 15.0) + 15.0);
            slopes = q.x | q.y << 5u;
        }
        packed |= slopes << (10u * major);
    }
    return packed;
}

/* ---- Slices. An albedo block is a cube of 8x8x8 sub-voxels. Along an axis it has eight slices of 8x8
 * sub-voxels, one for each depth, and a slice fits the 64 bits of a uvec2. The slices of an axis are equal
 * arrangements of bits, so that bitwise operations compare sub-voxels that lie behind one another. */

/* Per cell (bit 0 of the index: x, bit 1: y, bit 2: z) its occupancy bits, and its emissive bits. */
uvec2 block_bits[8];
uvec2 block_emissive[8];

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

/* Fraction of the sub-voxels visible from one side of the block that emit. Of 64 lines of sight along the
 * axis each sees the first set sub-voxel that it meets. An emitter a sub-voxel before a wall, or on one side
 * of it, therefore keeps its power whatever lies behind it. `side` is +x -x +y -y +z -z, and a constant where
 * loops are unrolled. */
float visible_emissive(uint side)
{
    const int axis = int(side >> 1u);
    uvec2 hidden = uvec2(0u), emissive = uvec2(0u);
    [[unroll]] for (int i = 0; i < 8; i++)
    {
        const int depth = (side & 1u) == 0u ? 7 - i : i;
        const uvec2 solid = slice_of_block(block_bits, axis, depth);
        emissive |= solid & slice_of_block(block_emissive, axis, depth) & ~hidden;
        hidden |= solid;
    }
    const ivec2 seen = bitCount(hidden), emits = bitCount(emissive);
    return seen.x + seen.y > 0 ? float(emits.x + emits.y) / float(seen.x + seen.y) : 0.0;
}

/* ---- Emission */

/* Fraction of its emissive sub-voxels that an emitter covers: a small lamp, or the rim of a larger one,
 * covers them in part. Where surfaces of different orientation meet, each covers part of the same sub-voxel,
 * so the sub-voxel counts as full. A lamp smaller than a sub-voxel has such corners too, but it covers only a
 * part of the sub-voxels that it sets, up to eight of them. */
float covered_fraction(float covered, int bits, uint facing)
{
    const bool corner = bitCount((facing | facing >> 1u) & 0x15u) > 1;
    const int most_of_small_lamp = 8;
    return corner && bits > most_of_small_lamp
               ? 1.0
               : min(covered / (float(max(bits, 1)) * SDFGI_EMISSION_STEPS), 1.0);
}

/* Loads a block's bits and emissive bits. Returns the number of the latter. */
int load_block(uvec3 block_texel)
{
    int count = 0;
    [[unroll]] for (uint i = 0u; i < 8u; i++)
    {
        const uvec3 texel = 2u * block_texel + uvec3(i & 1u, i >> 1u & 1u, i >> 2u);
        const uint index = sdfgi_texel_index(texel) | args.cascade << (3u * sdfgi_frame.resolution_log2);
        block_bits[i] = sdfgi_bits[index];
        const uint word =
            sdfgi_scratch_emissive_bits(sdfgi_frame.resolution_log2) + 2u * sdfgi_texel_index(texel);
        block_emissive[i] = uvec2(sdfgi_scratch[word], sdfgi_scratch[word + 1u]);
        count += bitCount(block_emissive[i].x) + bitCount(block_emissive[i].y);
    }
    return count;
}

/* Emission of the brightest side as RGB9E5, and the six sides relative to it, 5 bits each. */
uvec2 resolve_emission(uint block, uvec3 block_texel)
{
    const float covered = float(accumulated(SDFGI_ACCUM_EMISSION_COVERED, block));
    const uint facing = accumulated(SDFGI_ACCUM_EMISSION_FACING, block);
    if (covered == 0.0 && facing == 0u)
        return uvec2(0u);
    const int bits = load_block(block_texel);
    if (covered == 0.0)
        return uvec2(0u);
    float fractions[6], largest = 0.0;
    [[unroll]] for (uint side = 0u; side < 6u; side++)
    {
        fractions[side] = (facing >> side & 1u) != 0u ? visible_emissive(side) : 0.0;
        largest = max(largest, fractions[side]);
    }
    /* Relative to the largest, because that of a lamp in a thousandth of its block would round to 0. */
    uint packed = 0u;
    for (uint side = 0u; side < 6u && largest > 0.0; side++)
        packed |= uint(round(31.0 * fractions[side] / largest)) << (5u * side);
    const vec3 mean = accumulated3(SDFGI_ACCUM_EMISSION, block) / covered;
    return uvec2(sdfgi_rgbe_encode(mean * covered_fraction(covered, bits, facing) * largest), packed);
}

/* ---- Blocks */

/* Samples in the blocks of the workgroup, so that one atomic adds them to the counter. */
shared uint voxels;

void resolve(ivec3 cell)
{
    const uvec3 block_texel = sdfgi_cell_texel(args.cascade, cell) / 2u;
    const uint block = sdfgi_albedo_block_index(args.cascade, cell);
    const uint count = accumulated(SDFGI_ACCUM_NORMAL, block) + accumulated(SDFGI_ACCUM_NORMAL + 3u, block) +
                       accumulated(SDFGI_ACCUM_NORMAL + 6u, block);
    const uint out_index = block + args.cascade * sdfgi_albedo_block_count();
    const vec3 albedo = accumulated3(SDFGI_ACCUM_ALBEDO, block) / (float(max(count, 1u)) * 255.0);
    sdfgi_albedo[out_index] = packUnorm4x8(vec4(albedo, 0.0));
    sdfgi_emission[out_index] = resolve_emission(block, block_texel);
    sdfgi_normals[out_index] = resolve_normals(block);
    if (count == 0u)
        return;
    atomicAdd(voxels, count);
    if (args.bounds_axis >= 0)
        bounds_add(args.cascade, BOUNDS_ADDED, args.bounds_axis, cell, cell + 2);
}

void main()
{
    const uvec3 size = uvec3(args.high - args.low) / 2u;
    const uint i = workgroup_index() * gl_WorkGroupSize.x + gl_LocalInvocationIndex;
    if (gl_LocalInvocationIndex == 0u)
        voxels = 0u;
    barrier();
    if (i < size.x * size.y * size.z)
        resolve(args.low + 2 * ivec3(i % size.x, i / size.x % size.y, i / (size.x * size.y)));
    barrier();
    if (gl_LocalInvocationIndex == 0u && voxels > 0u)
        counter_add(SDFGI_COUNTER_VOXELS, voxels);
}
