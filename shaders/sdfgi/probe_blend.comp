/* SPDX-License-Identifier: MIT
 * Publishes irradiance: the sums of this ring so far, and for the rest of the ring the value of the one before. At the
 * end of a ring (args.step = 1) only the new sums count, the change against the ring before is measured, and the sums
 * start again: a static scene repeats a fixed ring and so converges exactly. args.fresh: bit per cascade whose earlier rings do
 * not count. One workgroup per probe and cascade. */
#version 460
#extension GL_GOOGLE_include_directive : require
#include "probe_store.glsl"

layout(local_size_x = 64) in;
layout(push_constant) uniform sdfgi_push { sdfgi_pass_args args; };

/* Share of a ring's weight, stored as a half float, from which on nothing is missing. */
const float COMPLETE = 0.99;
const float HALF_MAX = 65504.0;
/* Change is measured against a texel's own brightness plus this share of the brightest, below which nobody sees it. */
const float DARK_SHARE = 1.0 / 512.0;

shared uint group_change;
shared uint group_brightest;

void measure_change(vec3 value, vec3 before, bool fresh)
{
    const float brightest = uintBitsToFloat(sdfgi_frame.ring.w);
    const vec3 change = abs(value - before) / (max(value, before) + brightest * DARK_SHARE + 1e-12);
    const float largest = fresh ? 1.0 : min(max(change.r, max(change.g, change.b)), 1.0);
    atomicMax(group_change, floatBitsToUint(largest));
    atomicMax(group_brightest, floatBitsToUint(max(value.r, max(value.g, value.b))));
}

vec3 blend_texel(uint at, bool fresh)
{
    const vec4 sum = sdfgi_sums[at];
    const uvec2 packed = sdfgi_previous[at];
    const vec4 before = vec4(unpackHalf2x16(packed.x), unpackHalf2x16(packed.y));
    const bool ring_ends = args.step != 0u;
    /* A probe that was new in the middle of a ring has missed its beginning. */
    const bool whole = ring_ends && sum.w > COMPLETE * before.w;
    const float rest = whole || fresh ? 0.0 : max(before.w - sum.w, 0.0);
    const vec3 value = min((sum.rgb + rest * before.rgb) / max(sum.w + rest, 1e-12), vec3(HALF_MAX));
    if (ring_ends) {
        measure_change(value, before.rgb, fresh);
        probe_store_previous(at, value, sum.w + rest);
        sdfgi_sums[at] = vec4(0.0);
    }
    return value;
}

void main()
{
    const uint cascade = gl_WorkGroupID.y;
    const ivec3 probe = probe_from_linear(gl_WorkGroupID.x);
    const uint slot = probe_index(cascade, probe);
    if (probe_is_dead(sdfgi_probes[slot]) || !probe_is_served(cascade, probe))
        return;
    const uint i = gl_LocalInvocationIndex;
    if (i == 0u) {
        group_change = 0u;
        group_brightest = 0u;
    }
    barrier();
    if (i < uint(SDFGI_IRRADIANCE_COUNT))
        texels[i] = blend_texel(slot * uint(SDFGI_IRRADIANCE_COUNT) + i, (args.fresh >> cascade & 1u) != 0u);
    barrier();
    probe_store_texels(cascade, probe);
    if (i == 0u && args.step != 0u) {
        atomicMax(sdfgi_counters[SDFGI_COUNTER_MAX_CHANGE], group_change);
        atomicMax(sdfgi_counters[SDFGI_COUNTER_MAX_IRRADIANCE], group_brightest);
    }
}
