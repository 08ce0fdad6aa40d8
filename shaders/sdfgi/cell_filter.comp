/* SPDX-License-Identifier: MIT
 * The first run of the filter over light cells: see cell_filter.glsl. */
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
#include "../lib/on_cpu.glsl"
#define FILTER_DISTANCE         1
#define FILTER_NOISE_SCALE      3.0
#define FILTER_LEAST_DIFFERENCE 0.25
#define FILTER_FROM             GATHERED_RAW
#include "cell_filter.glsl"

void filter_store(uint cascade, uint axis, uint entry, uint word)
{
    sdfgi_gathered[gathered_word(cascade, GATHERED_BETWEEN + axis, entry)] = word;
}

void main()
{
    filter_cells();
}
