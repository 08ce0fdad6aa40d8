/* SPDX-License-Identifier: MIT
 * Filters the irradiance of light cells, because neighbours that send different rays differ by noise. A cell
 * and its 26 neighbours exchange light along each axis that surfaces of both face: what one gains the other
 * loses, so the filter keeps the sum. Cells whose irradiance differs more than their noise explains, at the
 * edge of a shadow, exchange little. cell_filter goes over neighbours, and then cell_filter_far over what it
 * has left, with neighbours two cells away (a trous: Dammertz et al. 2010, "Edge-avoiding A-Trous wavelet
 * transform for fast global illumination filtering"). It takes the light cells that are
 * visited (visits.glsl), or all.
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

SDFGI_PUSH(sdfgi_cell_filter_args);
#include "visits_or_all.glsl"

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

/* What a surface gains from a neighbour's along the same axis, of which something is known; and the
 * neighbour's share. */
vec4 gain_from(vec3 own, vec3 other, float likely)
{
    return SHARE * likeness(own, other, likely) * vec4(other - own, 1.0);
}

/* What a surface shows that has gained so much: light, and the sum of shares. */
uint filter_result(uint own, vec4 gained)
{
    /* In a thicket more than eight may be alike. */
    const vec3 light = sdfgi_rgbe_decode(own) + gained.rgb / max(gained.a, 1.0);
    return own < SDFGI_SURFACE_UNKNOWN ? min(sdfgi_rgbe_encode(light), SDFGI_SURFACE_UNKNOWN - 1u) : own;
}

#ifdef SDFGI_SOFTWARE
#include "cell_filter_alone.glsl"
#else
#include "cell_filter_shared.glsl"
#endif

#endif
