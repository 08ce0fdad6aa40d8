/* SPDX-License-Identifier: MIT
 * Depths around each probe: the distance to the first set sub-voxel in 16x16 directions. Stores their mean
 * and the mean of their squares, filtered over a texel and its neighbours, as unorm16 of the range. Half
 * floats would lose the variance (HARD_CASES row 43). Of probes that are not new, only texels whose rays come
 * near a dirty box are made again. One workgroup per probe. Shared memory: 256 depths. */
#version 460
#extension GL_GOOGLE_include_directive : require
#define SDFGI_WRITES_OCCLUSION
#include "../lib/on_cpu.glsl"
#include "dirty.glsl"
#include "probe_common.glsl"
#include "visibility.glsl"
#include "../include/sdfgi_trace.glsl"

layout(local_size_x = SDFGI_GROUP_OCCLUSION) in;
SDFGI_PUSH(sdfgi_cascade_args);

const int N = SDFGI_OCCLUSION_TEXELS;
const uint TEXELS = uint(N * N);
/* A ray takes the same steps as before if no dirty box is within this distance of it, in cells: the diagonal
 * of the longest step. Whether that is free depends on no cell beyond it; where it is not, boxes have sides
 * of four cells at most, and none of their cells is so far from the first. */
const float RAY_MARGIN = 1.7321 * SDFGI_TRACE_STABLE_STEP;
/* Cells: farthest that a probe stands from its corner. */
const float MOST_MOVED = 4.0;

shared float depth[TEXELS];
/* Sets of texels, a bit each. DIRTY: their own rays come near a dirty box. STORED: their filter reads a DIRTY
 * texel. TRACED: the filter of a STORED texel reads them. */
const uint DIRTY = 0u, STORED = 1u, TRACED = 2u, WORDS = TEXELS / 32u;
shared uint sets[3u][WORDS];

vec3 texel_direction(uint texel)
{
    return sdfgi_octahedral_decode((vec2(texel % uint(N), texel / uint(N)) + 0.5) * (2.0 / float(N)) - 1.0);
}

bool ray_is_dirty(vec3 pos, uint texel)
{
    return dirty_crosses(args.cascade, pos, sdfgi_cells_from_metric(texel_direction(texel)),
                         SDFGI_OCCLUSION_RANGE, RAY_MARGIN / sdfgi_space_y_scale());
}

bool set_holds(uint set, ivec2 coord)
{
    const ivec2 source = sdfgi_octahedral_border_source(coord, N);
    const uint texel = uint(source.x + N * source.y);
    return (sets[set][texel >> 5u] >> (texel & 31u) & 1u) != 0u;
}

void set_add(uint set, uint texel)
{
    atomicOr(sets[set][texel >> 5u], 1u << (texel & 31u));
}

/* Fills the next set with the texels of this one and their neighbours, because the filter reads 3x3 texels.
 * Called by the whole workgroup. */
void widen(uint set)
{
    for (uint texel = gl_LocalInvocationIndex; texel < TEXELS; texel += uint(SDFGI_GROUP_OCCLUSION)) {
        const ivec2 coord = ivec2(texel % uint(N), texel / uint(N));
        bool holds = false;
        for (int i = 0; i < 9 && !holds; i++)
            holds = set_holds(set, coord + ivec2(i % 3, i / 3) - 1);
        if (holds)
            set_add(set + 1u, texel);
    }
    barrier();
}

/* Fills all three sets. Called by the whole workgroup. */
void find_texels(vec3 pos, bool all)
{
    if (gl_LocalInvocationIndex < WORDS)
        for (uint set = 0u; set < 3u; set++)
            sets[set][gl_LocalInvocationIndex] = all ? 0xffffffffu : 0u;
    barrier();
    if (all)
        return;
    for (uint texel = gl_LocalInvocationIndex; texel < TEXELS; texel += uint(SDFGI_GROUP_OCCLUSION))
        if (ray_is_dirty(pos, texel))
            set_add(DIRTY, texel);
    barrier();
    widen(DIRTY);
    widen(STORED);
}

/* `pos` counts from the probe's corner, so that it is rounded alike wherever the cascade stands. */
float trace_depth(ivec3 corner, vec3 pos, uint texel)
{
    return min(
        sdfgi_trace_stable(args.cascade, corner, pos, texel_direction(texel), SDFGI_OCCLUSION_RANGE).distance,
        SDFGI_OCCLUSION_RANGE);
}

float depth_at(ivec2 coord)
{
    const ivec2 source = sdfgi_octahedral_border_source(coord, N);
    return depth[source.x + N * source.y] / SDFGI_OCCLUSION_RANGE;
}

/* Mean and mean of squares, by a 3x3 tent. The tent is wide enough to smooth the edges between texels, and
 * narrow enough to keep the far side of a thin wall apart. */
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
    const ivec3 probe = probe_from_linear(gl_WorkGroupID.x), corner = probe * SDFGI_PROBE_SPACING;
    const uint slot = sdfgi_probe_index(args.cascade, probe), state = sdfgi_probes_at(slot);
    const int near = int(ceil((SDFGI_OCCLUSION_RANGE + RAY_MARGIN) / sdfgi_space_y_scale() + MOST_MOVED));
    if (sdfgi_probe_is_dead(state) || !dirty_near(args.cascade, corner, corner, near))
        return;
    const vec3 pos = sdfgi_probe_position(probe, state);
    find_texels(pos, (state & SDFGI_PROBE_NEW) != 0u);
    for (uint i = gl_LocalInvocationIndex; i < TEXELS; i += uint(SDFGI_GROUP_OCCLUSION))
        if (set_holds(TRACED, ivec2(i % uint(N), i / uint(N))))
            depth[i] = trace_depth(corner, pos - vec3(corner), i);
    barrier();
    const uint stride = uint(SDFGI_OCCLUSION_STRIDE);
    for (uint i = gl_LocalInvocationIndex; i < stride * stride; i += uint(SDFGI_GROUP_OCCLUSION)) {
        const ivec2 coord = sdfgi_octahedral_border_source(ivec2(i % stride, i / stride) - 1, N);
        if (set_holds(STORED, coord))
            sdfgi_occlusion[slot * stride * stride + i] = packUnorm2x16(filtered_moments(coord));
    }
}
