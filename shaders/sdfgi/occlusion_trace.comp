/* SPDX-License-Identifier: MIT
 * Depth to the nearest set sub-voxel in 16x16 directions around each probe, then mean and mean of squares over each
 * texel and its neighbours, as unorm16 of the range (half floats lose the variance, HARD_CASES row 43). One workgroup per
 * probe; those that nothing new comes near keep theirs. Shared memory: 256 depths. */
#version 460
#extension GL_GOOGLE_include_directive : require
#define SDFGI_WRITES_OCCLUSION
#include "changed.glsl"
#include "probe_common.glsl"
#include "../include/sdfgi_trace.glsl"

layout(local_size_x = SDFGI_GROUP_OCCLUSION) in;
layout(push_constant) uniform sdfgi_push { sdfgi_pass_args args; };

const int N = SDFGI_OCCLUSION_TEXELS;
const uint TEXELS = uint(N * N);
/* Range of depths, and how far a probe may have moved. */
const int NEAR = int(SDFGI_OCCLUSION_RANGE) + 4;
shared float depth[TEXELS];

float trace_depth(vec3 pos, uint texel)
{
    const vec2 uv = (vec2(texel % uint(N), texel / uint(N)) + 0.5) * (2.0 / float(N)) - 1.0;
    return min(trace_solid(args.cascade, args.cascade, pos, octahedral_decode(uv), SDFGI_OCCLUSION_RANGE).distance,
               SDFGI_OCCLUSION_RANGE);
}

float depth_at(ivec2 coord)
{
    const ivec2 source = octahedral_border_source(coord, N);
    return depth[source.x + N * source.y] / SDFGI_OCCLUSION_RANGE;
}

/* A 3x3 tent: wide enough to smooth steps between texels, narrow enough to keep the far side of a thin wall apart. */
vec2 filtered_moments(ivec2 coord)
{
    vec2 moments = vec2(0.0);
    for (int i = 0; i < 9; i++) {
        const ivec2 offset = ivec2(i % 3, i / 3) - 1;
        const float weight = float((2 - abs(offset.x)) * (2 - abs(offset.y))) / 16.0;
        const float d = depth_at(clamp(coord + offset, ivec2(-1), ivec2(N)));
        moments += weight * vec2(d, d * d);
    }
    return moments;
}

void main()
{
    const ivec3 probe = probe_from_linear(gl_WorkGroupID.x);
    const uint slot = probe_index(args.cascade, probe);
    const uint state = sdfgi_probes[slot];
    const ivec3 corner = probe * SDFGI_PROBE_SPACING;
    if (probe_is_dead(state) || !changed_near(args.cascade, corner, corner, NEAR))
        return;
    const vec3 pos = probe_position(probe, state);
    for (uint i = gl_LocalInvocationIndex; i < TEXELS; i += uint(SDFGI_GROUP_OCCLUSION))
        depth[i] = trace_depth(pos, i);
    barrier();
    const uint stride = uint(SDFGI_OCCLUSION_STRIDE);
    for (uint i = gl_LocalInvocationIndex; i < stride * stride; i += uint(SDFGI_GROUP_OCCLUSION)) {
        const ivec2 coord = octahedral_border_source(ivec2(i % stride, i / stride) - 1, N);
        sdfgi_occlusion[slot * stride * stride + i] = packUnorm2x16(filtered_moments(coord));
    }
}
