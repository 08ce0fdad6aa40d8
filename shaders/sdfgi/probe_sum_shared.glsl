/* SPDX-License-Identifier: MIT
 * A workgroup sums up the rays of a probe. Its threads share rays and texels. They load as many rays at a
 * time as there are threads: probes that are not new have no more, and little shared memory lets more
 * workgroups run at once. */
#ifndef SDFGI_PROBE_SUM_SHARED_GLSL
#define SDFGI_PROBE_SUM_SHARED_GLSL

#include "probe_rays.glsl"

layout(local_size_x = SDFGI_GROUP_PROBE) in;

const uint THREADS = uint(SDFGI_GROUP_PROBE);
const uint MAX_EMITTER_RAYS = MAX_RAYS / uint(SDFGI_SAMPLES_PER_EMITTER_SAMPLE) + 1u;

/* A thread sums up one ray in SUM_PARTS for SUM_TEXELS texels, so that each ray is read from shared memory by
 * SUM_THREADS threads and not by all. */
const uint SUM_THREADS = 8u, SUM_PARTS = THREADS / SUM_THREADS, SUM_TEXELS = 4u;

/* Rays, directions (as in probe_ray) before light; then the parts of the sums, texel by texel, part after
 * part. */
shared vec4 places[SUM_PARTS * SUM_THREADS * SUM_TEXELS];
shared probe_emitter_ray emitter_rays[MAX_EMITTER_RAYS];

/* Irradiance over pi that so many of them bring to a texel. */
vec3 light_of_emitters(uint texel, uint rays)
{
    const vec3 normal = probe_texel_direction(texel);
    vec3 sum = vec3(0.0);
    float count = 0.0;
    for (uint i = 0u; i < rays; i++) {
        const probe_emitter_ray ray = emitter_rays[i];
        sum += ray.radiance * (ray.dir.w * max(dot(normal, ray.dir.xyz), 0.0));
        count += ray.dir.w;
    }
    return sum / (3.14159265 * max(count, 1.0));
}

/* Adds up the parts of all rays, and leaves them in `places`. Called by the whole workgroup. */
void sum_rays(probe_reader reader, uint rays)
{
    const uint lane = gl_LocalInvocationIndex, part = lane / SUM_THREADS, first = lane % SUM_THREADS;
    vec3 normals[SUM_TEXELS];
    vec4 sums[SUM_TEXELS];
    for (uint k = 0u; k < SUM_TEXELS; k++) {
        normals[k] = probe_texel_direction(first + SUM_THREADS * k);
        sums[k] = vec4(0.0);
    }
    for (uint before = 0u; before < rays; before += THREADS) {
        if (before + lane < rays) {
            const probe_ray ray = load_ray(reader, before + lane);
            places[lane] = ray.dir;
            places[THREADS + lane] = vec4(ray.light, 1.0);
        }
        barrier();
        for (uint i = part; i < THREADS && before + i < rays; i += SUM_PARTS) {
            const vec4 dir = places[i], light = places[THREADS + i];
            for (uint k = 0u; k < SUM_TEXELS; k++)
                sums[k] += light * (max(dot(normals[k], dir.xyz), 0.0) * dir.w);
        }
        barrier();
    }
    for (uint k = 0u; k < SUM_TEXELS; k++)
        places[part * SUM_THREADS * SUM_TEXELS + SUM_THREADS * k + first] = sums[k];
}

vec4 sum_of_texel(uint texel)
{
    vec4 sum = vec4(0.0);
    for (uint part = 0u; part < SUM_PARTS; part++)
        sum += places[part * SUM_THREADS * SUM_TEXELS + texel];
    return sum;
}

/* Called by the whole workgroup; the texel of a thread, if it has one, gets its sum. */
void sum_probe(uint cascade)
{
    const uint lane = gl_LocalInvocationIndex;
    const probe_reader reader = reader_of(cascade, gl_WorkGroupID.x);
    const uint rays = rays_to_read(reader), to_emitters = emitter_rays_to_read(rays);
    if (rays == 0u)
        return;
    if (lane < to_emitters)
        emitter_rays[lane] = load_emitter_ray(reader.slot, lane);
    sum_rays(reader, rays);
    barrier();
    if (lane >= uint(SDFGI_IRRADIANCE_COUNT))
        return;
    const vec4 sum = sum_of_texel(lane);
    const vec3 of_emitters = to_emitters > 0u ? light_of_emitters(lane, to_emitters) : vec3(0.0);
    sdfgi_sums[probe_sums(reader.slot) + lane] =
        probe_load_sum(reader.slot, lane) + sum + vec4(of_emitters * sum.a, 0.0);
}

#endif
