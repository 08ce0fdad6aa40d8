/* SPDX-License-Identifier: MIT
 * Filters the irradiance of light cells, because neighbours that send different rays differ by noise. A cell
 * and its 26 neighbours exchange light along each axis that surfaces of both face: what one gains the other
 * loses, so the filter keeps the sum. Cells whose irradiance differs more than noise explains, at the edge of
 * a shadow, exchange little. A thread per light cell of the rows that seen.glsl tells. */
#version 460
#extension GL_GOOGLE_include_directive : require
#define SDFGI_WRITES_SURFACES
#include "../lib/on_cpu.glsl"
#include "gathered.glsl"
#include "seen.glsl"
#include "../include/sdfgi_cells.glsl"

layout(local_size_x = SDFGI_GROUP_LINEAR) in;
SDFGI_PUSH(sdfgi_cell_gather_args);

/* Relative differences of this size are noise after one visit. The noise of n visits is smaller by the root
 * of n. */
const float NOISE_OF_VISIT = 1.5;
const float LEAST_NOISE = 0.25;

/* Size of relative differences that are noise. In a first cycle the last two visits count most. */
float noise_of(gathered_state state)
{
    uint visits = clamp(state.visits, 1u, 2u);
    if (state.mean == GATHERED_ROUGH)
        visits = max(state.visits, SDFGI_ROUGH_VISITS);
    if (state.mean == GATHERED_COMPLETE)
        visits = sdfgi_frame.cycle_visits;
    return max(NOISE_OF_VISIT * inversesqrt(float(visits)), LEAST_NOISE);
}

/* How far two cells exchange light, 0 to 1; the same from either side. */
float likeness(vec3 a, vec3 b, float noise)
{
    const float la = sdfgi_light_luminance(a), lb = sdfgi_light_luminance(b);
    const float difference = abs(la - lb) / (noise * (la + lb) + 1e-12);
    return exp(-4.0 * difference * difference);
}

/* Most that a neighbour counts. A surface has about one cell in each of the eight columns around, so that a
 * cell which all of them resemble becomes their mean with itself. */
const float SHARE = 1.0 / 9.0;

uint raw_word(uint cascade, uint axis, uint entry)
{
    return sdfgi_gathered[gathered_word(cascade, GATHERED_RAW + axis, entry)];
}

/* Neighbour i of 27, in the order of its coordinates. */
ivec3 neighbour_offset(int i)
{
    return ivec3(i % 3, i / 3 % 3, i / 9) - 1;
}

void main()
{
    const uint cascade = visited_cascade(gl_WorkGroupID.y);
    uint entry;
    if (!visited_entry(gl_WorkGroupID.y, gl_GlobalInvocationID.x, args.first[cascade], args.end[cascade],
                       light_cell_count(cascade), entry))
        return;
    const ivec3 cell = light_cell_from_index(cascade, sdfgi_light_cells[light_cell_slot(cascade, entry)]);
    if (!sdfgi_cell_is_valid(cascade, cell))
        return;
    const float noise = noise_of(gathered_load_state(cascade, entry));
    uint own[6];
    vec3 gained[6];
    for (uint axis = 0u; axis < 6u; axis++) {
        own[axis] = raw_word(cascade, axis, entry);
        gained[axis] = vec3(0.0);
    }
    for (int i = 0; i < 27; i++) {
        const ivec3 at = cell + neighbour_offset(i);
        uint other;
        if (i == 13 || !sdfgi_cell_is_valid(cascade, at) || !sdfgi_cell_entry(cascade, at, other))
            continue;
        const float both = max(noise, noise_of(gathered_load_state(cascade, other)));
        for (uint axis = 0u; axis < 6u; axis++) {
            if (own[axis] >= SDFGI_SURFACE_UNKNOWN)
                continue;
            const uint word = raw_word(cascade, axis, other);
            if (word >= SDFGI_SURFACE_UNKNOWN)
                continue;
            const vec3 a = sdfgi_rgbe_decode(own[axis]), b = sdfgi_rgbe_decode(word);
            gained[axis] += SHARE * likeness(a, b, both) * (b - a);
        }
    }
    for (uint axis = 0u; axis < 6u; axis++) {
        uint result = own[axis];
        if (result < SDFGI_SURFACE_UNKNOWN)
            result =
                min(sdfgi_rgbe_encode(sdfgi_rgbe_decode(result) + gained[axis]), SDFGI_SURFACE_UNKNOWN - 1u);
        sdfgi_surfaces[sdfgi_surface_index(cascade, entry, axis)] = result;
    }
}
