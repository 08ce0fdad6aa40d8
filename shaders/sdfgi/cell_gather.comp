/* SPDX-License-Identifier: MIT
 * Visits light cells: sends SDFGI_VISIT_RAYS rays from each for each axis along which a surface faces,
 * distributed by the cosine about the surface's normal, and adds the mean of what they meet to the cell's
 * sums. A ray reads what leaves the surface that it hits, or the sky. All bounces go from cell to cell.
 *
 * Where the cascade lists emitters, SDFGI_VISIT_EMITTER_RAYS more rays go towards points of them. An emitter
 * is chosen with a probability that follows how much light the cell may get from it (Shirley et al. 1996,
 * "Monte Carlo techniques for direct lighting calculations"). Both kinds of rays bring a share of the light
 * of what is listed, so nothing counts twice. */
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
#define SDFGI_WRITES_SEEN
#include "../lib/on_cpu.glsl"
#ifdef SDFGI_SOFTWARE
#include "cell_visit_alone.glsl"
#else
#include "cell_visit_shared.glsl"
#endif

void main()
{
    visit();
}
