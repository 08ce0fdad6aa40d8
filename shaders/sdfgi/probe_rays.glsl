/* SPDX-License-Identifier: MIT
 * Rays of a probe, as its sums take them: where they lead, and the light where they end. */
#ifndef SDFGI_PROBE_RAYS_GLSL
#define SDFGI_PROBE_RAYS_GLSL

#include "emitter_samples.glsl"
#include "probe_common.glsl"
#include "ray_cache.glsl"
#include "ray_queue.glsl"
#include "surface.glsl"
#include "../include/sdfgi_cells.glsl"
#include "../include/sdfgi_sky.glsl"
#include "../lib/rgbe.glsl"

const uint MAX_RAYS = 128u; /* that a sum reads in a frame */

/* Samples towards emitters that belong to so many at random. */
uint emitter_samples_of(uint rays)
{
    return (rays - 1u) / uint(SDFGI_SAMPLES_PER_EMITTER_SAMPLE) + 1u;
}

/* The probe whose rays are read. */
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
    return emission * (1.0 - emitter_share(sdfgi_emission_at(block), reader.total));
}

/* Emission of the surface at a light cell that faces along an axis. If none does, the mean of the others
 * stands for it, as in light_fill_axes. Software drivers run a loop as often as one of their threads needs:
 * once, where it is not unrolled. */
vec3 cell_emission(probe_reader reader, uint cascade, uint entry, ivec3 cell, uint axis)
{
    const bool faces = sdfgi_surfaces_at(sdfgi_surface_index(cascade, entry, axis)) != SDFGI_SURFACE_NONE;
    const uint first = faces ? axis : 0u, last = faces ? axis : 5u;
    vec3 sum = vec3(0.0);
    float count = 0.0;
    uint other = first;
    do {
        if (sdfgi_surfaces_at(sdfgi_surface_index(cascade, entry, other)) != SDFGI_SURFACE_NONE) {
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
    light = sdfgi_rgbe_decode(sdfgi_light_at(sdfgi_surface_index(cascade, entry, axis)));
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

struct probe_ray {
    vec4 dir; /* w: solid angle, 0 if the light is not known */
    vec3 light;
};

probe_ray load_ray(probe_reader reader, uint i)
{
    const bool of_frame = i < rays_of_frame();
    const uint s = ray_sample(i), code = sdfgi_rays_at(reader.slot * emitter_cache_stride() + s);
    float solid_angle;
    const vec3 dir = probe_sample_direction(reader.cascade, reader.probe, s, solid_angle);
    if (code == SDFGI_RAY_UNLIT && of_frame)
        counter_add(SDFGI_COUNTER_UNLIT_HITS, 1u);
    if (code == SDFGI_RAY_CAPPED && of_frame)
        counter_add(SDFGI_COUNTER_TRACE_CAPS, 1u);
    vec3 light = vec3(0.0);
    const bool known = (of_frame || ray_is_cached(code)) && hit_light(reader, code, dir, light);
    return probe_ray(vec4(dir, known ? solid_angle : 0.0), light);
}

/* How many rays are read: of this frame, or of several for NEW probes. None of a probe that is dead or not
 * valid. */
uint rays_to_read(probe_reader reader)
{
    if (sdfgi_probe_is_dead(sdfgi_probes_at(reader.slot)) ||
        !sdfgi_probe_is_valid(reader.cascade, reader.probe))
        return 0u;
    const bool is_new = probe_history_state(probe_history_load(reader.slot)) == PROBE_NEW;
    return min((is_new ? PROBE_NEW_FRAMES : 1u) * rays_of_frame(), min(MAX_RAYS, sdfgi_frame.cycle_samples));
}

/* ---- Rays towards emitters */

struct probe_emitter_ray {
    vec4 dir; /* w: 1 if the sample is known */
    vec3 radiance;
};

/* The probe's last sample of this frame or, going backwards, the i-th before it. */
probe_emitter_ray load_emitter_ray(uint slot, uint i)
{
    const uint samples = sdfgi_frame.emitter_samples,
               last = emitter_first_of_frame() + emitter_rays_of_frame() - 1u;
    const emitter_sample s = emitter_sample_load(slot, (last + samples - i) % samples);
    return probe_emitter_ray(vec4(s.dir, s.total > 0.0 ? 1.0 : 0.0),
                             sdfgi_emission_radiance(s.radiance) * (sdfgi_frame.emission_scale * s.arrives));
}

uint emitter_rays_to_read(uint rays)
{
    return rays > 0u ? min(emitter_samples_of(rays), sdfgi_frame.emitter_samples) : 0u;
}

probe_reader reader_of(uint cascade, uint linear)
{
    const ivec3 probe = probe_from_linear(linear);
    const uint slot = sdfgi_probe_index(cascade, probe);
    const float total =
        sdfgi_frame.emitter_samples > 0u ? emitter_sample_load(slot, emitter_first_of_frame()).total : 0.0;
    return probe_reader(cascade, slot, probe, total);
}

#endif
