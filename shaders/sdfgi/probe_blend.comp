/* SPDX-License-Identifier: MIT
 * Publishes the irradiance of probes: a temporal filter over sample cycles (probe_filter.glsl). */
#version 460
#extension GL_GOOGLE_include_directive : require
#define SDFGI_WRITES_IRRADIANCE
#include "../lib/on_cpu.glsl"
#ifdef SDFGI_SOFTWARE
#include "probe_blend_alone.glsl"
#else
#include "probe_blend_shared.glsl"
#endif

layout(local_size_x = SDFGI_GROUP_PROBE) in;

void main()
{
    blend_probe(gl_WorkGroupID.y);
}
