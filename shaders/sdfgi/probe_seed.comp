/* SPDX-License-Identifier: MIT
 * Gives probes that are new, or that have moved, a start: the light of those probes of the next coarser
 * cascade that see their place. Where none sees it a probe starts from nothing, because light from behind a
 * wall would stay in a room for several sample cycles. The light of coarser probes counts for little, so that
 * the probe's own rays soon replace it. Resets the sums and the history of these probes. One workgroup per
 * probe. */
#version 460
#extension GL_GOOGLE_include_directive : require
#define SDFGI_WRITES_SUMS
#define SDFGI_WRITES_PREVIOUS
#define SDFGI_WRITES_IRRADIANCE
#include "../lib/on_cpu.glsl"
#include "probe_common.glsl"
#include "probe_store.glsl"
#include "bounce.glsl"
#include "../include/sdfgi_trace.glsl"

layout(local_size_x = SDFGI_GROUP_PROBE) in;
SDFGI_PUSH(sdfgi_cascade_args);

shared sdfgi_visibility visible;
shared uint seen_by; /* a bit per probe of the coarser cage */

/* Which of the eight probes around `pos` see it. Called by the whole workgroup. */
void find_visible(uint cascade, ivec3 cage, vec3 pos)
{
    const uint k = gl_LocalInvocationIndex;
    if (k < 8u) {
        const ivec3 probe = cage + sdfgi_cage_corner(int(k));
        const uint state = sdfgi_probes_at(sdfgi_probe_index(cascade, probe));
        if (!sdfgi_probe_is_dead(state) &&
            sdfgi_trace_visible(cascade, pos, sdfgi_probe_position(probe, state)))
            atomicOr(seen_by, 1u << k);
    }
    barrier();
    if (k == 0u)
        visible = visibility_from_bits(seen_by);
    barrier();
}

/* Sum of the trilinear weights of those probes that see a place. */
float visible_weight(ivec3 cage, vec3 pos)
{
    const vec3 f = sdfgi_cage_coords(cage, pos);
    float weight = 0.0;
    for (int k = 0; k < 8; k++) {
        const vec3 t = mix(1.0 - f, f, vec3(sdfgi_cage_corner(k)));
        weight += t.x * t.y * t.z * visible.of_probe[k];
    }
    return weight;
}

/* Light in rgb, its weight among the samples of a cycle in a. */
vec4 seed_from_coarser(uint coarser, ivec3 cage, vec3 pos, vec3 normal)
{
    const bounce_light sum = bounce_sum(coarser, cage, pos, normal, visible);
    if (sum.weight <= 1e-6)
        return vec4(0.0);
    return vec4(sum.estimate / sum.weight,
                visible_weight(cage, pos) * PROBE_SEED_FRACTION * probe_cycle_weight());
}

void store_seed(uint slot, uint texel, vec4 seed)
{
    sdfgi_sums[probe_sums(slot) + texel] = vec4(0.0);
    probe_store_previous(slot, texel, seed.rgb, seed.a);
    probe_store_irradiance(slot, texel, sdfgi_irradiance_pack_confidence(seed.rgb, probe_confidence(seed.a)));
}

void main()
{
    const ivec3 probe = probe_from_linear(gl_WorkGroupID.x);
    const uint slot = sdfgi_probe_index(args.cascade, probe);
    const uint state = sdfgi_probes_at(slot);
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
    if (i < uint(SDFGI_IRRADIANCE_COUNT))
        store_seed(slot, i,
                   exists ? seed_from_coarser(coarser, cage, pos, probe_texel_direction(i)) : vec4(0.0));
    if (i == 0u)
        probe_history_store(slot, probe_history(0.0, 0.0, 0.0, 0.0));
}
