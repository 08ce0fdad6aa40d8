/* SPDX-License-Identifier: MIT
 * Publishes irradiance: the sums of this ring so far, and for the rest of the ring the value of the one
 * before. At the end of a ring (args.cycle_ends = 1) only the new sums count, the change against the ring
 * before is measured, and the sums start again: a static scene repeats a fixed ring and so converges exactly.
 * A part of a ring strays from its mean, in an unchanged scene by the same amounts in every ring. Surfaces
 * are therefore shown, eased in, only what strays further than the ring before did; light cells read all of
 * it, so that light settles as fast as it can. A probe whose light has surely changed by half is young again.
 * One workgroup per probe and cascade. */
#version 460
#extension GL_GOOGLE_include_directive : require
#define SDFGI_WRITES_IRRADIANCE
#include "probe_store.glsl"
#include "../lib/rgbe.glsl"
#include "../lib/light_pack.glsl"

layout(local_size_x = 64) in;
layout(push_constant) uniform sdfgi_push
{
    sdfgi_probe_blend_args args;
};

/* Share of a ring's weight, stored as a half float, from which on nothing is missing. */
const float COMPLETE = 0.99;
const float HALF_MAX = 65504.0;
/* Change is measured against a texel's own brightness plus this share of the brightest, below which nobody
 * sees it. */
const float DARK_SHARE = 1.0 / 512.0;

/* A probe is young again if its light is sure to change by this share over a ring: what it has gathered since
 * the ring began has strayed by as much of that as it can tell, besides what rings stray by anyway. With a
 * quarter, light under a lamp that moves at 3 m/s had half as much noise again and was further behind. */
const float YOUNG_CHANGE = 0.5;
const float DOUBT = 1.5;
const float LEAST_DOUBT = 0.02;
/* What the past of a young probe counts for at most, over what it has gathered in a frame. */
const float YOUNG_MEMORY = 1.0;
/* Share of a ring that its past counts for when a probe becomes young again. */
const float REBORN_SHARE = 0.125;
const float MAX_GAIN = 8.0;
/* Share of what is new that a frame shows, and the change over a ring below which all of it is. Light settles
 * below that. */
const float EASE = 0.25;
const float UNSEEN_CHANGE = 1.0 / 256.0;
/* Straying is hard to tell from change: in a ring it falls by no more than this. */
const float STRAYING_KEPT = 0.75;

shared uint group_change;
shared uint group_brightest;

struct texel {
    vec4 sum, before; /* of this ring, mean and weight of the one before */
    vec4 mixed;       /* what both together say, and their weight */
    float change;     /* from `before` to that */
};

/* Relative, of one texel. */
float texel_change(vec3 value, vec3 before)
{
    const float brightest = sdfgi_frame.brightest_texel;
    const vec3 change = abs(value - before) / (max(value, before) + brightest * DARK_SHARE + 1e-12);
    return min(max(change.r, max(change.g, change.b)), 1.0);
}

texel load_texel(uint slot, bool young, bool fresh)
{
    texel t;
    t.sum = sdfgi_sums[probe_sums(slot) + gl_LocalInvocationIndex];
    const uvec2 packed = sdfgi_previous[slot * uint(SDFGI_IRRADIANCE_COUNT) + gl_LocalInvocationIndex];
    t.before = vec4(unpackHalf2x16(packed.x), unpackHalf2x16(packed.y));
    /* What a whole ring weighs; a probe that was new in the middle of one has missed its beginning. */
    const float ring = max(t.before.w, probe_ring_weight());
    const bool whole = args.cycle_ends != 0u && t.sum.w > COMPLETE * ring;
    float rest = whole || fresh ? 0.0 : min(t.before.w, max(ring - t.sum.w, 0.0));
    if (young && t.sum.w > 0.0)
        rest = min(t.before.w, YOUNG_MEMORY * t.sum.w);
    const float weight = t.sum.w + rest;
    t.mixed = vec4(min((t.sum.rgb + rest * t.before.rgb) / max(weight, 1e-12), vec3(HALF_MAX)), weight);
    t.change = texel_change(t.mixed.rgb, t.before.rgb);
    return t;
}

/* What light cells read, over what is shown. */
float texel_gain(vec3 shown, vec3 mixed)
{
    const float a = sdfgi_light_luminance(shown), b = sdfgi_light_luminance(mixed);
    return a > 0.0 ? clamp(b / a, 1.0 / MAX_GAIN, MAX_GAIN) : 1.0;
}

/* Of a grown probe: within a ring, what strays further than parts of the ring before did; at its end all of
 * it. Either way eased in, but for what nobody sees: settled light is shown exactly. */
vec4 show_news(texel t, vec3 shown_before, float doubt, bool ring_ends)
{
    const float news = ring_ends ? 1.0 : max(1.0 - doubt / max(t.change, 1e-12), 0.0);
    const vec3 target = mix(t.before.rgb, t.mixed.rgb, news);
    const bool exact = ring_ends && t.change < UNSEEN_CHANGE;
    const vec3 shown = mix(shown_before, target, exact ? 1.0 : EASE);
    return vec4(shown, texel_gain(shown, t.mixed.rgb));
}

void start_ring(uint slot, texel t, bool born)
{
    const uint i = gl_LocalInvocationIndex;
    const float most = born ? REBORN_SHARE * probe_ring_weight() : HALF_MAX;
    probe_store_previous(slot * uint(SDFGI_IRRADIANCE_COUNT) + i, t.mixed.rgb, min(t.mixed.w, most));
    sdfgi_sums[probe_sums(slot) + i] = vec4(0.0);
}

vec4 next_memory(vec4 memory, float change, bool born, bool ring_ends)
{
    const float strayed = max(memory.x, change), age = born ? PROBE_BORN : memory.z;
    if (!ring_ends)
        return vec4(strayed, memory.y, age, 0.0);
    /* What has changed for good is no straying. */
    const float doubt = max(sqrt(max(strayed * strayed - change * change, 0.0)), STRAYING_KEPT * memory.y);
    return vec4(0.0, doubt, min(age + 1.0, PROBE_GROWN), 0.0);
}

bool is_sure(float change, float doubt)
{
    const float gathered =
        float(sdfgi_frame.first_sample + sdfgi_frame.rays_per_frame) / float(sdfgi_frame.cycle_samples);
    return change > YOUNG_CHANGE * gathered + DOUBT * doubt + LEAST_DOUBT;
}

void main()
{
    const uint cascade = gl_WorkGroupID.y;
    const ivec3 probe = probe_from_linear(gl_WorkGroupID.x);
    const uint slot = sdfgi_probe_index(cascade, probe);
    if (sdfgi_probe_is_dead(sdfgi_probes[slot]) || !sdfgi_probe_is_valid(cascade, probe))
        return;
    const uint i = gl_LocalInvocationIndex;
    const bool ring_ends = args.cycle_ends != 0u, fresh = args.without_history != 0u;
    const bool has_texel = i < uint(SDFGI_IRRADIANCE_COUNT);
    const vec4 memory = sdfgi_sums[probe_memory(slot)];
    if (i == 0u) {
        group_change = 0u;
        group_brightest = 0u;
    }
    barrier();
    texel t;
    if (has_texel) {
        t = load_texel(slot, probe_is_young(memory), fresh);
        atomicMax(group_change, floatBitsToUint(t.change));
        atomicMax(group_brightest, floatBitsToUint(max(t.mixed.r, max(t.mixed.g, t.mixed.b))));
    }
    barrier();
    const float change = uintBitsToFloat(group_change);
    const bool grown = memory.z >= PROBE_GROWN && !fresh;
    const bool born = grown && is_sure(change, memory.y);
    const bool starts = ring_ends || born || probe_is_young(memory);
    if (has_texel) {
        const vec4 shown = grown && !born
                               ? show_news(t, probe_load_irradiance(slot, i).rgb, memory.y, ring_ends)
                               : vec4(t.mixed.rgb, -probe_trust(t.mixed.w));
        probe_store_irradiance(slot, i, shown);
        if (starts)
            start_ring(slot, t, born);
    }
    if (i > 0u)
        return;
    sdfgi_sums[probe_memory(slot)] = next_memory(memory, change, born, ring_ends);
    if (ring_ends) {
        atomicMax(sdfgi_counters[SDFGI_COUNTER_MAX_CHANGE],
                  memory.z < PROBE_WHOLE ? floatBitsToUint(1.0) : group_change);
        atomicMax(sdfgi_counters[SDFGI_COUNTER_MAX_IRRADIANCE], group_brightest);
    }
}
