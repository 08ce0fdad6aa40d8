/* SPDX-License-Identifier: MIT
 * The second run of the filter over light cells, which makes what lookups show: see cell_filter.glsl. Of nine
 * like cells a third of the noise is left. */
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
#define SDFGI_WRITES_SURFACES
#include "../lib/on_cpu.glsl"
#define FILTER_DISTANCE         2
#define FILTER_NOISE_SCALE      0.9
#define FILTER_LEAST_DIFFERENCE 0.05
#define FILTER_FROM             GATHERED_BETWEEN
#include "cell_filter.glsl"

void filter_store(uint cascade, uint axis, uint entry, uint word)
{
    sdfgi_surfaces[sdfgi_surface_index(cascade, entry, axis)] = word;
}

void main()
{
    filter_cells();
}
