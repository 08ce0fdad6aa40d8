/* SPDX-License-Identifier: MIT
 * Rays of probes towards emitters: a sample for each SDFGI_SAMPLES_PER_EMITTER_SAMPLE of those at random,
 * where a cascade lists all of its emitters. Where there are more, they fill much of what probes see, and
 * rays at random meet them. Samples are cached behind these, in SDFGI_EMITTER_SAMPLE_WORDS words each: all
 * that the sum needs, so that it waits for no list of emitters. */
#ifndef SDFGI_EMITTER_SAMPLES_GLSL
#define SDFGI_EMITTER_SAMPLES_GLSL

#include "emitters.glsl"
#include "ray_cache.glsl"
#include "../lib/octahedral.glsl"
#include "../shared/scratch.h"

struct emitter_sample {
    uvec2 radiance; /* as emitters have it */
    vec3 dir;       /* to the emitter */
    float arrives;  /* irradiance of a surface that faces it, over its radiance; 0 if it is not seen */
    float total;    /* importance of all emitters; 0 if the sample is not known */
};

/* Words of a probe in the ray cache. */
uint emitter_cache_stride()
{
    return sdfgi_frame.cycle_samples + uint(SDFGI_EMITTER_SAMPLE_WORDS) * sdfgi_frame.emitter_samples;
}

/* This frame's samples towards emitters: the number of the first one in the cycle, and how many follow. */
uint emitter_first_of_frame()
{
    return sdfgi_frame.first_sample / uint(SDFGI_SAMPLES_PER_EMITTER_SAMPLE);
}

uint emitter_rays_of_frame()
{
    return sdfgi_scratch_emitter_rays(sdfgi_frame.first_sample, sdfgi_frame.rays_per_frame);
}

uint emitter_sample_word(uint slot, uint number)
{
    return slot * emitter_cache_stride() + sdfgi_frame.cycle_samples +
           uint(SDFGI_EMITTER_SAMPLE_WORDS) * number;
}

/* A direction's first bit gives way to SDFGI_EMISSION_IS_BRIGHT. */
uvec4 emitter_sample_pack(emitter_sample s)
{
    const uint dir = packSnorm2x16(sdfgi_octahedral_encode(s.dir)) & ~1u;
    return uvec4(s.radiance.x, dir | uint(s.radiance.y != 0u), floatBitsToUint(s.arrives),
                 floatBitsToUint(s.total));
}

emitter_sample emitter_sample_unpack(uvec4 words)
{
    return emitter_sample(uvec2(words.x, (words.y & 1u) * SDFGI_EMISSION_IS_BRIGHT),
                          sdfgi_octahedral_decode(unpackSnorm2x16(words.y & ~1u)), uintBitsToFloat(words.z),
                          uintBitsToFloat(words.w));
}

emitter_sample emitter_sample_load(uint slot, uint number)
{
    const uint word = emitter_sample_word(slot, number);
    return emitter_sample_unpack(uvec4(sdfgi_rays_at(word), sdfgi_rays_at(word + 1u),
                                       sdfgi_rays_at(word + 2u), sdfgi_rays_at(word + 3u)));
}

bool emitter_sample_is_known(uint word)
{
    return sdfgi_rays_at(word + 3u) != SDFGI_RAY_UNKNOWN;
}

void emitter_sample_forget(uint word)
{
    sdfgi_rays[word + 3u] = SDFGI_RAY_UNKNOWN;
}

/* Solid angles, sr: rays at random meet well what fills more than the second one. Light that is even all
 * around is exact that way, however few they are. */
const vec2 EMITTER_SHARE_ANGLES = vec2(1.0, 3.0);

/* How much of an emitter's light the rays of a probe towards emitters bring; those at random bring the rest,
 * and nothing counts twice. `total` is the importance of all emitters: over the radiance of one, about the
 * solid angle that all would fill if they were as bright. */
float emitter_share(uvec2 radiance, float total)
{
    const float light = sdfgi_light_luminance(sdfgi_emission_radiance(radiance));
    return 1.0 - smoothstep(EMITTER_SHARE_ANGLES.x, EMITTER_SHARE_ANGLES.y, total / max(light, 1e-30));
}

/* Chooses an emitter for a probe by its importance, and sums up that of all. Each emitter takes the place of
 * the one before with the chance that it has among those so far. `place` decides, and is spread over 0 to 1
 * again each time. At last it tells where in the emitter. */
uint emitter_choose(uint cascade, vec3 pos, inout float place, out float total)
{
    uint chosen = 0u;
    total = 0.0;
    for (uint i = 0u; i < emitter_count(cascade); i++) {
        const float importance = emitter_importance(emitter_load(cascade, i), pos);
        total += importance;
        const float chance = importance / max(total, 1e-30);
        const bool takes = place < chance;
        chosen = takes ? i : chosen;
        place = clamp(takes ? place / chance : (place - chance) / max(1.0 - chance, 1e-6), 0.0, 1.0);
    }
    return chosen;
}

/* Sends a probe's ray towards an emitter. */
emitter_sample emitter_sample_send(uint cascade, vec3 pos, vec3 place)
{
    float total;
    const uint chosen = emitter_choose(cascade, pos, place.x, total);
    const emitter e = emitter_load(cascade, chosen);
    const emitter_point point = emitter_point_at(e, pos, place);
    const float chance = emitter_importance(e, pos) / max(total, 1e-30);
    vec3 dir;
    const float shown = emitter_solid_angle(e, pos, point.inside, dir);
    const bool seen =
        shown * chance > 0.0 && emitter_is_seen(cascade, e, pos, emitter_way_to(pos, point.face));
    return emitter_sample(e.radiance, emitter_way_to(pos, 0.5 * (e.low + e.high)).dir,
                          seen ? shown * emitter_share(e.radiance, total) / chance : 0.0, total);
}

#endif
