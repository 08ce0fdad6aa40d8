/* SPDX-License-Identifier: MIT
 * Running sums over a workgroup of SDFGI_GROUP_LINEAR threads. */
#ifndef SDFGI_LIGHT_SUMS_GLSL
#define SDFGI_LIGHT_SUMS_GLSL

shared uvec2 light_sums[SDFGI_GROUP_LINEAR];

/* Sum of `value` over this thread and those before it in the workgroup, left in light_sums too. */
uvec2 light_running_sum(uvec2 value)
{
    const uint i = gl_LocalInvocationIndex;
    light_sums[i] = value;
    barrier();
    for (uint step = 1u; step < SDFGI_GROUP_LINEAR; step *= 2u) {
        const uvec2 before = i >= step ? light_sums[i - step] : uvec2(0u);
        barrier();
        light_sums[i] += before;
        barrier();
    }
    return light_sums[i];
}

#endif
