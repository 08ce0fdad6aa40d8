/* SPDX-License-Identifier: MIT
 * Gives probes that are new, or stand elsewhere than before, the light of the next coarser cascade at their place (of the
 * sky, where there is none), as if a ring had measured it, and empties their sums: they are never black, and what they
 * gather takes over sample by sample. One workgroup per probe. */
#version 460
#extension GL_GOOGLE_include_directive : require
#include "probe_common.glsl"
#include "probe_store.glsl"
#include "../include/sdfgi_lookup.glsl"

layout(local_size_x = 64) in;
layout(push_constant) uniform sdfgi_push { sdfgi_pass_args args; };

shared lookup_visibility visible;
shared uint seen_by;

/* Which of the eight probes around `pos` see it; all of them where none does: light from behind a wall, for the length of a
 * ring, is better than none. */
void find_visible(uint cascade, ivec3 cage, vec3 pos)
{
    const uint k = gl_LocalInvocationIndex;
    if (k < 8u) {
        const ivec3 probe = cage + lookup_corner(int(k));
        const uint state = sdfgi_probes[probe_index(cascade, probe)];
        if (!probe_is_dead(state) && trace_visible(cascade, pos, probe_position(probe, state)))
            atomicOr(seen_by, 1u << k);
    }
    barrier();
    if (k == 0u)
        visible = lookup_from_mask(seen_by != 0u ? seen_by : 0xffu);
    barrier();
}

vec3 seed_from_coarser(vec3 first, vec3 normal)
{
    const vec3 sky = sky_irradiance(normal, sdfgi_frame.sky_zenith.rgb, sdfgi_frame.sky_horizon.rgb,
                                    sdfgi_frame.sky_ground.rgb);
    if (args.cascade + 1u >= sdfgi_frame.size.w)
        return sky;
    const uint coarser = args.cascade + 1u;
    const vec3 pos = cascade_from_first(coarser, first);
    const vec4 sum = lookup_sum(coarser, lookup_cage(coarser, pos), pos, normal, visible);
    return sum.a > 1e-6 ? sum.rgb / sum.a : sky;
}

void main()
{
    const ivec3 probe = probe_from_linear(gl_WorkGroupID.x);
    const uint slot = probe_index(args.cascade, probe);
    const uint state = sdfgi_probes[slot];
    if (probe_is_dead(state) || (state & SDFGI_PROBE_NEW) == 0u)
        return;
    const uint i = gl_LocalInvocationIndex;
    if (i == 0u)
        seen_by = 0u;
    barrier();
    const vec3 first = first_from_cascade(args.cascade, probe_position(probe, state));
    if (args.cascade + 1u < sdfgi_frame.size.w) {
        const vec3 pos = cascade_from_first(args.cascade + 1u, first);
        find_visible(args.cascade + 1u, lookup_cage(args.cascade + 1u, pos), pos);
    }
    if (i < uint(SDFGI_IRRADIANCE_COUNT)) {
        const uint at = slot * uint(SDFGI_IRRADIANCE_COUNT) + i;
        const vec3 value = seed_from_coarser(first, probe_texel_direction(i));
        sdfgi_sums[at] = vec4(0.0);
        probe_store_previous(at, value, probe_ring_weight());
        texels[i] = value;
    }
    barrier();
    probe_store_texels(args.cascade, probe);
}
