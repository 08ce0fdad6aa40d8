/* SPDX-License-Identifier: MIT
 * A thread sums up the rays of a probe, for software drivers: threads that share rays read them from shared
 * memory, which these drivers read for one thread after another. Sums stay in registers: loops over texels
 * have constant bounds, and are unrolled. */
#ifndef SDFGI_PROBE_SUM_ALONE_GLSL
#define SDFGI_PROBE_SUM_ALONE_GLSL

#include "probe_rays.glsl"

layout(local_size_x = SDFGI_GROUP_PROBE) in;

const uint TEXELS = uint(SDFGI_IRRADIANCE_COUNT);

/* Light of rays at random, times weight, and its weight, for each texel. */
void sum_rays(probe_reader reader, uint rays, out vec4 sums[TEXELS])
{
    for (uint k = 0u; k < TEXELS; k++)
        sums[k] = vec4(0.0);
    for (uint i = 0u; i < rays; i++) {
        const probe_ray ray = load_ray(reader, i);
        for (uint k = 0u; k < TEXELS; k++)
            sums[k] +=
                vec4(ray.light, 1.0) * (max(dot(probe_texel_direction(k), ray.dir.xyz), 0.0) * ray.dir.w);
    }
}

/* Adds irradiance over pi that emitters bring to the sums. */
void add_emitters(probe_reader reader, uint rays, inout vec4 sums[TEXELS])
{
    vec3 light[TEXELS];
    float count = 0.0;
    for (uint k = 0u; k < TEXELS; k++)
        light[k] = vec3(0.0);
    for (uint i = 0u; i < rays; i++) {
        const probe_emitter_ray ray = load_emitter_ray(reader.slot, i);
        for (uint k = 0u; k < TEXELS; k++)
            light[k] += ray.radiance * (ray.dir.w * max(dot(probe_texel_direction(k), ray.dir.xyz), 0.0));
        count += ray.dir.w;
    }
    for (uint k = 0u; k < TEXELS; k++)
        sums[k].rgb += light[k] * (sums[k].a / (3.14159265 * max(count, 1.0)));
}

void sum_probe(uint cascade)
{
    const uint linear = gl_GlobalInvocationID.x;
    if (linear >= sdfgi_frame.probes_per_side * sdfgi_frame.probes_per_side * sdfgi_frame.probes_per_side)
        return;
    const probe_reader reader = reader_of(cascade, linear);
    const uint rays = rays_to_read(reader);
    if (rays == 0u)
        return;
    vec4 sums[TEXELS];
    sum_rays(reader, rays, sums);
    add_emitters(reader, emitter_rays_to_read(rays), sums);
    for (uint k = 0u; k < TEXELS; k++)
        sdfgi_sums[probe_sums(reader.slot) + k] = probe_load_sum(reader.slot, k) + sums[k];
}

#endif
