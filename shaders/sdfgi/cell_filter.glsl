/* SPDX-License-Identifier: MIT
 * Filters the irradiance of light cells, because neighbours that send different rays differ by noise. A cell
 * and its 26 neighbours exchange light along each axis that surfaces of both face: what one gains the other
 * loses, so the filter keeps the sum. Cells whose irradiance differs more than their noise explains, at the
 * edge of a shadow, exchange little. cell_filter goes over neighbours, and then cell_filter_far over what it
 * has left, with neighbours two cells away (a trous: Dammertz et al. 2010, "Edge-avoiding A-Trous wavelet
 * transform for fast global illumination filtering"). A thread per light cell that visits.glsl
 * tells.
 *
 * Before it includes this file a shader defines
 *   FILTER_DISTANCE          how far away neighbours are, in cells
 *   FILTER_NOISE_SCALE       how many times their noise cells may differ and still be alike
 *   FILTER_LEAST_DIFFERENCE  relative difference of cells without noise, which have rays from other places
 *   FILTER_FROM              the planes of GATHERED that it reads
 * and after it filter_store, which takes a result. */
#ifndef SDFGI_CELL_FILTER_GLSL
#define SDFGI_CELL_FILTER_GLSL

#include "gathered.glsl"
#include "../include/sdfgi_cells.glsl"

layout(local_size_x = SDFGI_GROUP_LINEAR) in;
SDFGI_PUSH(sdfgi_cell_filter_args);
#include "visits.glsl"

void filter_store(uint cascade, uint axis, uint entry, uint word);

/* Relative difference up to which two cells are alike, by the sum of their noise. */
float likely_difference(float noise)
{
    return max(FILTER_NOISE_SCALE * sqrt(noise), FILTER_LEAST_DIFFERENCE);
}

/* How far two cells exchange light, 0 to 1; the same from either side. */
float likeness(vec3 a, vec3 b, float likely)
{
    const float la = sdfgi_light_luminance(a), lb = sdfgi_light_luminance(b);
    const float difference = 2.0 * (la - lb) / (likely * (la + lb) + 1e-12);
    return exp(-difference * difference);
}

/* Most that a neighbour counts. A surface has about one cell in each of the eight columns around, so that a
 * cell which all of them resemble becomes their mean with itself. */
const float SHARE = 1.0 / 9.0;

/* What is filtered: irradiance along an axis, packed. */
uint filtered_word(uint cascade, uint axis, uint entry)
{
    return sdfgi_gathered_at(gathered_word(cascade, FILTER_FROM + axis, entry));
}

/* Three neighbours in a row, or the cell itself in place of one that is no light cell. */
struct row {
    uint entries[3];
    float likely[3]; /* relative differences */
    bool there[3];
};

/* Rows, and places in them, go from -1 to 1 times the distance. Everything is loaded before it is
 * needed: loads overlap, so that a thread waits once for three of them. */
row load_row(uint cascade, ivec3 cell, uint entry, float noise, int y, int z)
{
    row r;
    for (int k = 0; k < 3; k++) {
        const ivec3 at = cell + FILTER_DISTANCE * ivec3(k - 1, y, z);
        uint other;
        const bool is_light = sdfgi_cell_entry(cascade, at, other);
        r.there[k] = is_light && sdfgi_cell_is_valid(cascade, at);
        r.entries[k] = r.there[k] ? other : entry;
    }
    for (int k = 0; k < 3; k++)
        r.likely[k] = likely_difference(noise + gathered_load_shown_noise(cascade, r.entries[k]));
    return r;
}

/* What a surface gains from those of a row along an axis, and the sum of shares. */
vec4 gain_from_row(uint cascade, row r, uint axis, vec3 own)
{
    uint words[3];
    for (int k = 0; k < 3; k++)
        words[k] = filtered_word(cascade, axis, r.entries[k]);
    vec4 gained = vec4(0.0);
    for (int k = 0; k < 3; k++) {
        const vec3 other = sdfgi_rgbe_decode(words[k]);
        if (words[k] < SDFGI_SURFACE_UNKNOWN && r.there[k])
            gained += SHARE * likeness(own, other, r.likely[k]) * vec4(other - own, 1.0);
    }
    return gained;
}

void filter_cell(uint cascade, uint entry)
{
    const ivec3 cell = light_cell_from_index(cascade, sdfgi_light_cells_at(light_cell_slot(cascade, entry)));
    if (!sdfgi_cell_is_valid(cascade, cell))
        return;
    const float noise = gathered_load_shown_noise(cascade, entry);
    uint own[6];
    vec4 gained[6]; /* light, and the sum of shares */
    for (uint axis = 0u; axis < 6u; axis++) {
        own[axis] = filtered_word(cascade, axis, entry);
        gained[axis] = vec4(0.0);
    }
    for (int i = 0; i < 9; i++) {
        row r = load_row(cascade, cell, entry, noise, i % 3 - 1, i / 3 - 1);
        r.there[1] = r.there[1] && i != 4;
        for (uint axis = 0u; axis < 6u; axis++)
            if (own[axis] < SDFGI_SURFACE_UNKNOWN)
                gained[axis] += gain_from_row(cascade, r, axis, sdfgi_rgbe_decode(own[axis]));
    }
    for (uint axis = 0u; axis < 6u; axis++) {
        uint result = own[axis];
        if (result < SDFGI_SURFACE_UNKNOWN) {
            /* In a thicket more than eight may be alike. */
            const vec3 light = sdfgi_rgbe_decode(result) + gained[axis].rgb / max(gained[axis].a, 1.0);
            result = min(sdfgi_rgbe_encode(light), SDFGI_SURFACE_UNKNOWN - 1u);
        }
        filter_store(cascade, axis, entry, result);
    }
}

void main()
{
    uint entry;
#ifdef SDFGI_SOFTWARE
    uint cascade;
    if (visit_entry(0u, cascade, entry))
        filter_cell(cascade, entry);
#else
    if (visited_entry(gl_WorkGroupID.y, gl_GlobalInvocationID.x, entry))
        filter_cell(visited_cascade(gl_WorkGroupID.y), entry);
#endif
}

#endif
