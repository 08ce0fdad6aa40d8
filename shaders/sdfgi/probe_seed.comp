/* SPDX-License-Identifier: MIT
 * Gives probes that are new, or stand elsewhere than before, a start: the light of those probes of the next
 * coarser cascade that see their place. It counts for little, and for nothing where none does: light from
 * behind a wall would stay in a room for rings. Empties their sums. One workgroup per probe. */
#version 460
#extension GL_GOOGLE_include_directive : require
#define SDFGI_WRITES_IRRADIANCE
#include "probe_common.glsl"
#include "probe_store.glsl"
#include "bounce.glsl"

layout(local_size_x = 64) in;
layout(push_constant) uniform sdfgi_push
{
    sdfgi_cascade_args args;
};

shared sdfgi_visibility visible;
shared uint seen_by;

/* Which of the eight probes around `pos` see it. */
void find_visible(uint cascade, ivec3 cage, vec3 pos)
{
    const uint k = gl_LocalInvocationIndex;
    if (k < 8u) {
        const ivec3 probe = cage + sdfgi_cage_corner(int(k));
        const uint state = sdfgi_probes[sdfgi_probe_index(cascade, probe)];
        if (!sdfgi_probe_is_dead(state) &&
            sdfgi_trace_visible(cascade, pos, sdfgi_probe_position(probe, state)))
            atomicOr(seen_by, 1u << k);
    }
    barrier();
    if (k == 0u)
        visible = sdfgi_visibility_from_bits(seen_by);
    barrier();
}

/* Trilinear share of the probes that see a place. */
float visible_share(ivec3 cage, vec3 pos)
{
    const vec3 f = sdfgi_cage_coords(cage, pos);
    float share = 0.0;
    for (int k = 0; k < 8; k++) {
        const vec3 t = mix(1.0 - f, f, vec3(sdfgi_cage_corner(k)));
        share += t.x * t.y * t.z * visible.of_probe[k];
    }
    return share;
}

/* Light in rgb, how much of a ring it counts for in a. */
vec4 seed_from_coarser(uint coarser, ivec3 cage, vec3 pos, vec3 normal)
{
    const vec4 sum = bounce_sum(coarser, cage, pos, normal, visible);
    if (sum.a <= 1e-6)
        return vec4(0.0);
    return vec4(sum.rgb / sum.a, visible_share(cage, pos) * PROBE_SEED_SHARE * probe_ring_weight());
}

void main()
{
    const ivec3 probe = probe_from_linear(gl_WorkGroupID.x);
    const uint slot = sdfgi_probe_index(args.cascade, probe);
    const uint state = sdfgi_probes[slot];
    if (sdfgi_probe_is_dead(state) || (state & SDFGI_PROBE_NEW) == 0u)
        return;
    const uint i = gl_LocalInvocationIndex, coarser = args.cascade + 1u;
    const bool exists = coarser < sdfgi_frame.cascade_count;
    if (i == 0u)
        seen_by = 0u;
    barrier();
    ivec3 cage;
    vec3 pos;
    if (exists) {
        pos = sdfgi_cascade_from_first(
            coarser, sdfgi_first_from_cascade(args.cascade, sdfgi_probe_position(probe, state)));
        cage = sdfgi_cage_of(coarser, pos);
        find_visible(coarser, cage, pos);
    }
    if (i < uint(SDFGI_IRRADIANCE_COUNT)) {
        const uint at = slot * uint(SDFGI_IRRADIANCE_COUNT) + i;
        const vec4 seed =
            exists ? seed_from_coarser(coarser, cage, pos, probe_texel_direction(i)) : vec4(0.0);
        sdfgi_sums[probe_sums(slot) + i] = vec4(0.0);
        probe_store_previous(at, seed.rgb, seed.a);
        probe_store_irradiance(slot, i, vec4(seed.rgb, -probe_trust(seed.a)));
    }
    if (i == 0u)
        sdfgi_sums[probe_memory(slot)] = vec4(0.0, 0.0, PROBE_BORN, 0.0);
}
