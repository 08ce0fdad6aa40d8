/* SPDX-License-Identifier: MIT
 * Multiplies all stored light by a factor: the exposure that light is stored with has changed. A power of two
 * changes no mantissa, unless light becomes so dim or so bright that its format ends. Marks of light stay:
 * light counts as settled a span later. A thread for each texel of the irradiance atlas and their sums, for
 * each light cell, and for each axis of one. */
#version 460
#extension GL_GOOGLE_include_directive : require
#define SDFGI_WRITES_SUMS
#define SDFGI_WRITES_PREVIOUS
#define SDFGI_WRITES_DIRECT
#define SDFGI_WRITES_GATHERED
#define SDFGI_WRITES_IRRADIANCE
#define SDFGI_WRITES_LIGHT
#define SDFGI_WRITES_SURFACES
#include "../lib/on_cpu.glsl"
#include "gathered.glsl"
#include "probe_store.glsl"
#include "workgroup.glsl"

layout(local_size_x = SDFGI_GROUP_LINEAR) in;
SDFGI_PUSH(sdfgi_light_rescale_args);

uint rescale_rgbe(uint packed)
{
    return sdfgi_rgbe_encode(sdfgi_rgbe_decode(packed) * args.factor);
}

/* Irradiance of a surface: the largest words say that it has none, or that none is known. */
uint rescale_surface(uint packed)
{
    return packed < SDFGI_SURFACE_UNKNOWN ? min(rescale_rgbe(packed), SDFGI_SURFACE_UNKNOWN - 1u) : packed;
}

void rescale_axis(uint i)
{
    sdfgi_light[i] = rescale_rgbe(sdfgi_light_at(i));
    sdfgi_surfaces[i] = rescale_surface(sdfgi_surfaces_at(i));
}

void rescale_gathered(uint cascade, uint entry)
{
    for (uint axis = 0u; axis < 6u; axis++) {
        const gathered_light light = gathered_load(cascade, entry, axis);
        gathered_store(cascade, entry, axis,
                       gathered_light(light.sum * args.factor, light.mean * args.factor));
        const uint raw = gathered_word(cascade, GATHERED_RAW + axis, entry),
                   between = gathered_word(cascade, GATHERED_BETWEEN + axis, entry);
        sdfgi_gathered[raw] = rescale_surface(sdfgi_gathered_at(raw));
        sdfgi_gathered[between] = rescale_surface(sdfgi_gathered_at(between));
    }
}

void rescale_cell(uint i)
{
    const uint cascade = i / sdfgi_frame.light_cell_room, entry = i % sdfgi_frame.light_cell_room;
    const uint color = direct_word(cascade, 0u, entry);
    sdfgi_direct[color] = rescale_rgbe(sdfgi_direct_at(color));
    if (gathers())
        rescale_gathered(cascade, entry);
}

/* The last of four numbers is a weight, or says what the probe's light is like. */
vec4 rescale_color(vec4 value)
{
    const float most = 65504.0;
    return vec4(min(value.rgb * args.factor, vec3(most)), value.a);
}

void rescale_texel(uint i)
{
    const uint slot = i / uint(SDFGI_IRRADIANCE_COUNT), texel = i % uint(SDFGI_IRRADIANCE_COUNT);
    probe_store_irradiance(slot, texel, rescale_color(probe_load_irradiance(slot, texel)));
    const vec4 previous = rescale_color(probe_load_previous(slot, texel));
    probe_store_previous(slot, texel, previous.rgb, previous.a);
    const uint sum = probe_sums(slot) + texel;
    sdfgi_sums[sum] = vec4(sdfgi_sums_at(sum).rgb * args.factor, sdfgi_sums_at(sum).a);
}

void main()
{
    const uint i = workgroup_index() * SDFGI_GROUP_LINEAR + gl_LocalInvocationIndex;
    const uint side = sdfgi_frame.probes_per_side, cascades = sdfgi_frame.cascade_count;
    const uint cells = sdfgi_frame.light_cell_room * cascades;
    if (i < 6u * cells)
        rescale_axis(i);
    if (i < cells)
        rescale_cell(i);
    if (i < side * side * side * cascades * uint(SDFGI_IRRADIANCE_COUNT))
        rescale_texel(i);
}
