/* SPDX-License-Identifier: MIT
 * Means of albedo, emission and normals from the accumulators. One thread per block of 2x2x2 cells. */
#version 460
#extension GL_GOOGLE_include_directive : require
#define SDFGI_WRITES_SURFACE
#include "surface.glsl"

layout(local_size_x = SDFGI_GROUP_LINEAR) in;
layout(push_constant) uniform sdfgi_push { sdfgi_pass_args args; };

uint accumulated(uint plane, uint block)
{
    return sdfgi_scratch[plane * block_count() + block];
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
            const uvec2 q = uvec2(round(clamp(sum / (float(count) * SDFGI_SLOPE_STEPS), -1.0, 1.0) * 15.0) + 15.0);
            slopes = q.x | q.y << 5u;
        }
        packed |= slopes << (10u * major);
    }
    return packed;
}

uvec2 block_bits[8];
uvec2 block_emissive[8];

bool block_bit(bool emissive, ivec3 sub)
{
    const int cell = (sub.x >> 2) + 2 * (sub.y >> 2) + 4 * (sub.z >> 2);
    const uvec2 bits = emissive ? block_emissive[cell] : block_bits[cell];
    const uint shift = uint((sub.x & 3) + 4 * (sub.y & 3) + 16 * (sub.z & 1));
    return (((sub.z & 2) == 0 ? bits.x : bits.y) >> shift & 1u) != 0u;
}

/* Of the sub-voxels seen first by someone who looks along -axis, the share that emits. Emitters a sub-voxel before a
 * wall, or on one side of it, keep their power whatever lies behind them. */
uint resolve_seen_share(uint axis)
{
    const int major = int(axis >> 1u);
    int seen = 0, emissive = 0;
    for (int i = 0; i < 64; i++) {
        ivec3 sub;
        sub[(major + 1) % 3] = i & 7;
        sub[(major + 2) % 3] = i >> 3;
        for (int depth = 0; depth < 8; depth++) {
            sub[major] = (axis & 1u) == 0u ? 7 - depth : depth;
            if (block_bit(false, sub)) {
                seen += 1;
                emissive += block_bit(true, sub) ? 1 : 0;
                break;
            }
        }
    }
    return seen > 0 ? uint(round(31.0 * float(emissive) / float(seen))) : 0u;
}

uvec2 resolve_emission(uint block, uvec3 block_texel)
{
    const uint count = accumulated(SDFGI_ACCUM_EMISSION_COUNT, block);
    if (count == 0u)
        return uvec2(0u);
    for (uint i = 0u; i < 8u; i++) {
        const uvec3 texel = 2u * block_texel + uvec3(i & 1u, i >> 1u & 1u, i >> 2u);
        const uint index = texel_index(texel) | args.cascade << (3u * sdfgi_frame.size.y);
        block_bits[i] = sdfgi_bits[index];
        block_emissive[i] = sdfgi_light[index];
    }
    const uint facing = accumulated(SDFGI_ACCUM_EMISSION_FACING, block);
    uint shares = 0u;
    for (uint axis = 0u; axis < 6u; axis++)
        if ((facing >> axis & 1u) != 0u)
            shares |= resolve_seen_share(axis) << (5u * axis);
    const vec3 mean = accumulated3(SDFGI_ACCUM_EMISSION, block) / (float(count) * SDFGI_EMISSION_STEPS);
    return uvec2(rgbe_encode(mean), shares);
}

void main()
{
    const uint block = gl_GlobalInvocationID.x;
    if (block >= block_count())
        return;
    const uint bits = sdfgi_frame.size.y - 1u;
    const uvec3 block_texel = uvec3(block, block >> bits, block >> (2u * bits)) & (sdfgi_frame.size.x / 2u - 1u);
    const uint count = accumulated(SDFGI_ACCUM_NORMAL, block) + accumulated(SDFGI_ACCUM_NORMAL + 3u, block) +
                       accumulated(SDFGI_ACCUM_NORMAL + 6u, block);
    const uint out_index = block + args.cascade * block_count();
    const vec3 albedo = accumulated3(SDFGI_ACCUM_ALBEDO, block) / (float(max(count, 1u)) * 255.0);
    sdfgi_albedo[out_index] = packUnorm4x8(vec4(albedo, 0.0));
    sdfgi_emission[out_index] = resolve_emission(block, block_texel);
    sdfgi_normals[out_index] = resolve_normals(block);
    if (count > 0u)
        counter_add(SDFGI_COUNTER_VOXELS, count);
}
