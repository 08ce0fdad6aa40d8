/* SPDX-License-Identifier: MIT
 * Means of albedo, emission and normals from the accumulators. The light volume, which held emissive bits
 * until then, becomes light's again. One thread per block of 2x2x2 cells of the box. */
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
#define SDFGI_WRITES_LIGHT
#define SDFGI_WRITES_SURFACE
#include "dirty_bounds.glsl"
#include "surface.glsl"

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

uvec2 block_bits[8];
uvec2 block_emissive[8];

/* The 16 sub-voxels of a cell at a depth along an axis, in any order that is the same for all depths. */
uvec2 slice_of(uvec2 bits, int major, int depth)
{
    if (major == 0)
        return bits >> uint(depth) & 0x11111111u;
    if (major == 1)
        return bits >> uint(4 * depth) & 0x000f000fu;
    return uvec2((depth < 2 ? bits.x : bits.y) >> uint(16 * (depth & 1)) & 0xffffu, 0u);
}

/* The same of the four cells side by side: where one leaves room the next one goes. */
uvec2 slice_of_block(uvec2 cells[8], int major, int depth)
{
    const int deep = depth >> 2, near = depth & 3, along = 1 << major;
    const int beside = major == 0 ? 2 : 1, above = major == 2 ? 2 : 4;
    const int first = deep * along;
    const uvec2 a = slice_of(cells[first], major, near), b = slice_of(cells[first + beside], major, near);
    const uvec2 c = slice_of(cells[first + above], major, near),
                d = slice_of(cells[first + beside + above], major, near);
    if (major == 0)
        return a | b << 1u | c << 2u | d << 3u;
    if (major == 1)
        return a | b << 4u | c << 8u | d << 12u;
    return uvec2(a.x | b.x << 16u, c.x | d.x << 16u);
}

/* Of the sub-voxels seen first by someone who looks along -axis, the share that emits. Emitters a sub-voxel
 * before a wall, or on one side of it, keep their power whatever lies behind them. Meant for a constant axis.
 */
float resolve_seen_share(uint axis)
{
    const int major = int(axis >> 1u);
    uvec2 hidden = uvec2(0u), emissive = uvec2(0u);
    [[unroll]] for (int i = 0; i < 8; i++)
    {
        const int depth = (axis & 1u) == 0u ? 7 - i : i;
        const uvec2 solid = slice_of_block(block_bits, major, depth);
        emissive |= solid & slice_of_block(block_emissive, major, depth) & ~hidden;
        hidden |= solid;
    }
    const ivec2 seen = bitCount(hidden), emits = bitCount(emissive);
    return seen.x + seen.y > 0 ? float(emits.x + emits.y) / float(seen.x + seen.y) : 0.0;
}

/* Share of its sub-voxels that a lamp fills: those of a small one, and the rim of a larger, it fills in part.
 * Where surfaces that face different ways meet, what one leaves of a sub-voxel is the other's. */
float resolve_filled(float covered, int bits, uint facing)
{
    const bool corner = bitCount((facing | facing >> 1u) & 0x15u) > 1;
    const int most_of_speck = 8;
    return corner && bits > most_of_speck ? 1.0
                                          : min(covered / (float(max(bits, 1)) * SDFGI_EMISSION_STEPS), 1.0);
}

/* Takes a block's bits, and clears those that emit; returns how many did. */
int take_bits(uvec3 block_texel)
{
    int count = 0;
    [[unroll]] for (uint i = 0u; i < 8u; i++)
    {
        const uvec3 texel = 2u * block_texel + uvec3(i & 1u, i >> 1u & 1u, i >> 2u);
        const uint index = sdfgi_texel_index(texel) | args.cascade << (3u * sdfgi_frame.resolution_log2);
        block_bits[i] = sdfgi_bits[index];
        block_emissive[i] = sdfgi_light[index];
        sdfgi_light[index] = uvec2(0u);
        count += bitCount(block_emissive[i].x) + bitCount(block_emissive[i].y);
    }
    return count;
}

uvec2 resolve_emission(uint block, uvec3 block_texel)
{
    const float covered = float(accumulated(SDFGI_ACCUM_EMISSION_COVERED, block));
    const uint facing = accumulated(SDFGI_ACCUM_EMISSION_FACING, block);
    if (covered == 0.0 && facing == 0u)
        return uvec2(0u);
    const int bits = take_bits(block_texel);
    if (covered == 0.0)
        return uvec2(0u);
    float shares[6], largest = 0.0;
    [[unroll]] for (uint axis = 0u; axis < 6u; axis++)
    {
        shares[axis] = (facing >> axis & 1u) != 0u ? resolve_seen_share(axis) : 0.0;
        largest = max(largest, shares[axis]);
    }
    /* Relative to the largest: a lamp that fills a thousandth of its block would round to none. */
    uint packed = 0u;
    for (uint axis = 0u; axis < 6u && largest > 0.0; axis++)
        packed |= uint(round(31.0 * shares[axis] / largest)) << (5u * axis);
    const vec3 mean = accumulated3(SDFGI_ACCUM_EMISSION, block) / covered;
    return uvec2(sdfgi_rgbe_encode(mean * resolve_filled(covered, bits, facing) * largest), packed);
}

shared uint voxels; /* samples in the blocks of the workgroup: one atomic for all */

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
    const uint i = gl_GlobalInvocationID.x;
    if (gl_LocalInvocationIndex == 0u)
        voxels = 0u;
    barrier();
    if (i < size.x * size.y * size.z)
        resolve(args.low + 2 * ivec3(i % size.x, i / size.x % size.y, i / (size.x * size.y)));
    barrier();
    if (gl_LocalInvocationIndex == 0u && voxels > 0u)
        counter_add(SDFGI_COUNTER_VOXELS, voxels);
}
