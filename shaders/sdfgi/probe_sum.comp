/* SPDX-License-Identifier: MIT
 * Reads the light where this frame's rays of each probe end, and adds it to the running sums of the probe's
 * 25 texels. A ray of direction w adds L max(0, n.w) a to a texel of direction n, and max(0, n.w) a to its
 * weight, where a is the solid angle that the ray stands for. Sums and weights stay apart and are divided
 * once, so that a constant field is exact. NEW probes read the rays of earlier frames again. */
#version 460
#extension GL_GOOGLE_include_directive : require
#include "../lib/on_cpu.glsl"
#ifdef SDFGI_SOFTWARE
#include "probe_sum_alone.glsl"
#else
#include "probe_sum_shared.glsl"
#endif

void main()
{
    if (gl_GlobalInvocationID == uvec3(0u))
        sdfgi_counters[SDFGI_COUNTER_RAYS_TRACED] = ray_queue_count();
    sum_probe(gl_WorkGroupID.y);
}
