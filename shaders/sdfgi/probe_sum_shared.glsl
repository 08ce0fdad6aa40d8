/* SPDX-License-Identifier: MIT
 * A workgroup sums up the rays of a probe. Its threads share rays and texels. Shared memory: 128 rays of 32
 * bytes, and nine towards emitters. */
#ifndef SDFGI_PROBE_SUM_SHARED_GLSL
#define SDFGI_PROBE_SUM_SHARED_GLSL

#include "probe_rays.glsl"

const uint MAX_EMITTER_RAYS = MAX_RAYS / uint(SDFGI_SAMPLES_PER_EMITTER_SAMPLE) + 1u;

shared vec4 ray_dir[MAX_RAYS]; /* as in probe_ray */
shared vec3 ray_light[MAX_RAYS];
shared probe_emitter_ray emitter_rays[MAX_EMITTER_RAYS];

/* Irradiance over pi that so many of them bring to a texel. */
vec3 light_of_emitters(uint texel, uint rays)
{
    const vec3 normal = probe_texel_direction(texel);
    vec3 sum = vec3(0.0);
    float count = 0.0;
    for (uint i = 0u; i < rays; i++) {
        sum += emitter_rays[i].radiance *
               (emitter_rays[i].dir.w * max(dot(normal, emitter_rays[i].dir.xyz), 0.0));
        count += emitter_rays[i].dir.w;
    }
    return sum / (3.14159265 * max(count, 1.0));
}

/* A thread sums up one ray in SUM_PARTS for SUM_TEXELS texels, so that each ray is read from shared memory by
 * SUM_THREADS threads and not by all. */
const uint SUM_THREADS = 8u, SUM_PARTS = SDFGI_GROUP_PROBE / SUM_THREADS, SUM_TEXELS = 4u;

/* Adds up the parts of all rays, and leaves them in ray_dir, which has just as many places: texel by texel,
 * part after part. */
void sum_rays(uint rays)
{
    const uint part = gl_LocalInvocationIndex / SUM_THREADS, first = gl_LocalInvocationIndex % SUM_THREADS;
    vec3 normals[SUM_TEXELS];
    vec4 sums[SUM_TEXELS];
    for (uint k = 0u; k < SUM_TEXELS; k++) {
        normals[k] = probe_texel_direction(first + SUM_THREADS * k);
        sums[k] = vec4(0.0);
    }
    for (uint i = part; i < rays; i += SUM_PARTS) {
        const vec4 dir = ray_dir[i], light = vec4(ray_light[i], 1.0);
        for (uint k = 0u; k < SUM_TEXELS; k++)
            sums[k] += light * (max(dot(normals[k], dir.xyz), 0.0) * dir.w);
    }
    barrier();
    for (uint k = 0u; k < SUM_TEXELS; k++)
        ray_dir[part * SUM_THREADS * SUM_TEXELS + SUM_THREADS * k + first] = sums[k];
}

vec4 sum_of_texel(uint texel)
{
    vec4 sum = vec4(0.0);
    for (uint part = 0u; part < SUM_PARTS; part++)
        sum += ray_dir[part * SUM_THREADS * SUM_TEXELS + texel];
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
    for (uint i = lane; i < rays; i += uint(SDFGI_GROUP_PROBE)) {
        const probe_ray ray = load_ray(reader, i);
        ray_light[i] = ray.light;
        ray_dir[i] = ray.dir;
    }
    if (lane < to_emitters)
        emitter_rays[lane] = load_emitter_ray(reader.slot, lane);
    barrier();
    sum_rays(rays);
    barrier();
    if (lane >= uint(SDFGI_IRRADIANCE_COUNT))
        return;
    const vec4 sum = sum_of_texel(lane);
    const vec3 of_emitters = to_emitters > 0u ? light_of_emitters(lane, to_emitters) : vec3(0.0);
    sdfgi_sums[probe_sums(reader.slot) + lane] =
        probe_load_sum(reader.slot, lane) + sum + vec4(of_emitters * sum.a, 0.0);
}

#endif
