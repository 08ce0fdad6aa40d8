/* SPDX-License-Identifier: MIT
 * Decides where each probe near a dirty box stands. If the eight cells around its corner are empty, it stands
 * on the corner. Otherwise it moves to the centre of the empty cell with the most room nearby, and where
 * there is none the probe is dead (Hu et al. 2021, SDFDDGI, section 3.4: probes leave geometry along the
 * distance field). Also decides which of the next probes along the three axes it sees, because lookups
 * extrapolate along such links. */
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
#define SDFGI_WRITES_PROBES
#include "../lib/on_cpu.glsl"
#ifdef SDFGI_SOFTWARE
#include "probe_place_alone.glsl"
#else
#include "probe_place_shared.glsl"
#endif

void main()
{
    place_probe();
}
