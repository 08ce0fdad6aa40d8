/* SPDX-License-Identifier: MIT
 * Reads the light where this frame's rays of each probe end, and adds it to the running sums of the probe's
 * 25 texels. A ray of direction w adds L max(0, n.w) a to a texel of direction n, and max(0, n.w) a to its
 * weight, where a is the solid angle that the ray stands for. Sums and weights stay apart and are divided
 * once, so that a constant field is exact. NEW probes read the rays of earlier frames again. One workgroup
 * per probe and cascade. Shared memory: 128 rays of 32 bytes. */
#version 460
#extension GL_GOOGLE_include_directive : require
#include "../lib/on_cpu.glsl"
#include "emitter_samples.glsl"
#include "probe_common.glsl"
#include "ray_cache.glsl"
#include "ray_queue.glsl"
#include "surface.glsl"
#include "../include/sdfgi_cells.glsl"
#include "../include/sdfgi_sky.glsl"
#include "../lib/rgbe.glsl"

layout(local_size_x = SDFGI_GROUP_PROBE) in;

const uint MAX_RAYS = 128u;
shared vec4 ray_dir[MAX_RAYS]; /* w: solid angle, 0 if the light is not known */
shared vec3 ray_light[MAX_RAYS];

/* Samples towards emitters that belong to so many at random. */
uint emitter_samples_of(uint rays)
{
    return (rays - 1u) / uint(SDFGI_SAMPLES_PER_EMITTER_SAMPLE) + 1u;
}

const uint MAX_EMITTER_RAYS = MAX_RAYS / uint(SDFGI_SAMPLES_PER_EMITTER_SAMPLE) + 1u;
shared vec4 emitter_dir[MAX_EMITTER_RAYS]; /* w: 1 if the sample is known */
shared vec3 emitter_radiance[MAX_EMITTER_RAYS];

/* The probe whose rays a workgroup reads. */
struct probe_reader {
    uint cascade, slot;
    ivec3 probe;
    float total; /* importance of all emitters; 0 if no ray towards them is known */
};

/* Emission behind a light cell: as much of it as rays towards emitters do not bring. */
vec3 emission_behind(probe_reader reader, uint cascade, ivec3 cell, uint axis)
{
    const ivec3 solid = cell - sdfgi_axis_direction(axis);
    const uint block = sdfgi_block_index(cascade, solid);
    const vec3 emission = sdfgi_block_emission(block, axis);
    if (emission == vec3(0.0) || reader.total == 0.0 || cascade != reader.cascade ||
        !surface_is_listed_emitter(block))
        return emission;
    return emission * (1.0 - emitter_share(sdfgi_emission[block], reader.total));
}

/* Emission of the surface at a light cell that faces along an axis. If none does, the mean of the others
 * stands for it, as in light_fill_axes. Software drivers run a loop as often as one of their threads needs:
 * once, where it is not unrolled. */
vec3 cell_emission(probe_reader reader, uint cascade, uint entry, ivec3 cell, uint axis)
{
    const bool faces = sdfgi_surfaces[sdfgi_surface_index(cascade, entry, axis)] != SDFGI_SURFACE_NONE;
    const uint first = faces ? axis : 0u, last = faces ? axis : 5u;
    vec3 sum = vec3(0.0);
    float count = 0.0;
    uint other = first;
    do {
        if (sdfgi_surfaces[sdfgi_surface_index(cascade, entry, other)] != SDFGI_SURFACE_NONE) {
            sum += emission_behind(reader, cascade, cell, other);
            count += 1.0;
        }
    } while (++other <= last);
    return sum / max(count, 1.0);
}

/* Light at the end of a ray. False where it is not known, because the light list was too short for the cell
 * and has not grown yet: the ray then has no weight, so the history stands for it instead of black. */
bool hit_light(probe_reader reader, uint code, vec3 dir, out vec3 light)
{
    light = vec3(0.0);
    if (code == SDFGI_RAY_SKY)
        light = sdfgi_sky_towards(dir);
    if (code >= SDFGI_RAY_CAPPED)
        return true;
    uint axis, entry;
    const uint index = ray_light_index(code, axis), cascade = index >> (3u * sdfgi_frame.resolution_log2);
    const uvec3 texel = sdfgi_texel_from_index(index);
    if (!sdfgi_light_block_entry(sdfgi_light_block_of_texel(cascade, texel), texel, entry))
        return false;
    light = sdfgi_rgbe_decode(sdfgi_light[sdfgi_surface_index(cascade, entry, axis)]);
    if (sdfgi_surfaces_emit())
        light += cell_emission(reader, cascade, entry, sdfgi_cell_from_texel(cascade, texel), axis);
    return true;
}

/* Rays that a probe sends in a frame. */
uint rays_of_frame()
{
    return min(sdfgi_frame.rays_per_frame, MAX_RAYS);
}

/* Sample of a probe's ray i: first those of this frame, then those of the frames before, backwards. */
uint ray_sample(uint i)
{
    const uint sent = rays_of_frame(), samples = sdfgi_frame.cycle_samples;
    return i < sent ? sdfgi_frame.first_sample + i
                    : (sdfgi_frame.first_sample + samples + sent - 1u - i) % samples;
}

void load_ray(probe_reader reader, uint i)
{
    const bool of_frame = i < rays_of_frame();
    const uint s = ray_sample(i), code = sdfgi_rays[reader.slot * emitter_cache_stride() + s];
    float solid_angle;
    const vec3 dir = probe_sample_direction(reader.cascade, reader.probe, s, solid_angle);
    if (code == SDFGI_RAY_UNLIT && of_frame)
        counter_add(SDFGI_COUNTER_UNLIT_HITS, 1u);
    if (code == SDFGI_RAY_CAPPED && of_frame)
        counter_add(SDFGI_COUNTER_TRACE_CAPS, 1u);
    vec3 light = vec3(0.0);
    const bool known = (of_frame || ray_is_cached(code)) && hit_light(reader, code, dir, light);
    ray_light[i] = light;
    ray_dir[i] = vec4(dir, known ? solid_angle : 0.0);
}

/* ---- Rays towards emitters */

/* The probe's last sample of this frame or, going backwards, the i-th before it. */
void load_emitter_ray(uint slot, uint i)
{
    const uint samples = sdfgi_frame.emitter_samples,
               last = emitter_first_of_frame() + emitter_rays_of_frame() - 1u;
    const emitter_sample s = emitter_sample_load(slot, (last + samples - i) % samples);
    emitter_radiance[i] = sdfgi_emission_radiance(s.radiance) * (sdfgi_frame.emission_scale * s.arrives);
    emitter_dir[i] = vec4(s.dir, s.total > 0.0 ? 1.0 : 0.0);
}

/* Irradiance over pi that so many of them bring to a texel. */
vec3 light_of_emitters(uint texel, uint rays)
{
    const vec3 normal = probe_texel_direction(texel);
    vec3 sum = vec3(0.0);
    float count = 0.0;
    for (uint i = 0u; i < rays; i++) {
        sum += emitter_radiance[i] * (emitter_dir[i].w * max(dot(normal, emitter_dir[i].xyz), 0.0));
        count += emitter_dir[i].w;
    }
    return sum / (3.14159265 * max(count, 1.0));
}

/* ---- Sums */

/* A thread sums up one ray in SUM_PARTS for SUM_TEXELS texels, so that each ray is read from shared memory by
 * SUM_THREADS threads and not by all: software drivers read it for each thread on its own. */
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

void main()
{
    const uint cascade = gl_WorkGroupID.y, lane = gl_LocalInvocationIndex;
    const ivec3 probe = probe_from_linear(gl_WorkGroupID.x);
    const uint slot = sdfgi_probe_index(cascade, probe);
    if (gl_GlobalInvocationID == uvec3(0u))
        sdfgi_counters[SDFGI_COUNTER_RAYS_TRACED] = ray_queue_count();
    if (sdfgi_probe_is_dead(sdfgi_probes[slot]) || !sdfgi_probe_is_valid(cascade, probe))
        return;

    const bool is_new = probe_history_state(probe_history_load(slot)) == PROBE_NEW;
    const uint most = min(MAX_RAYS, sdfgi_frame.cycle_samples), frames = is_new ? PROBE_NEW_FRAMES : 1u,
               rays = min(frames * rays_of_frame(), most);
    const uint emitter_rays = min(emitter_samples_of(rays), sdfgi_frame.emitter_samples);
    const float total = emitter_rays > 0u ? emitter_sample_load(slot, emitter_first_of_frame()).total : 0.0;
    const probe_reader reader = probe_reader(cascade, slot, probe, total);
    uint i = lane;
    do { /* once, mostly; software drivers run a loop that begins with its condition once more than that */
        if (i < rays)
            load_ray(reader, i);
        i += uint(SDFGI_GROUP_PROBE);
    } while (i < rays);
    if (lane < emitter_rays)
        load_emitter_ray(slot, lane);
    barrier();
    sum_rays(rays);
    barrier();
    if (lane >= uint(SDFGI_IRRADIANCE_COUNT))
        return;
    const vec4 sum = sum_of_texel(lane);
    const vec3 of_emitters = emitter_rays > 0u ? light_of_emitters(lane, emitter_rays) : vec3(0.0);
    sdfgi_sums[probe_sums(slot) + lane] = probe_load_sum(slot, lane) + sum + vec4(of_emitters * sum.a, 0.0);
}
