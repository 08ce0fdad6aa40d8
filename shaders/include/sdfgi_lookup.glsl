/* SPDX-License-Identifier: MIT
 * Irradiance at a surface point. The finest cascade around it answers: its light cells, or its probes where
 * no light cell is near. In the cascade blend, and where a cascade has no answer, the next coarser one takes
 * over, and beyond the last one the sky does. */
#ifndef SDFGI_LOOKUP_GLSL
#define SDFGI_LOOKUP_GLSL

#include "sdfgi_cells.glsl"
#include "sdfgi_probes.glsl"
#include "../lib/sky.glsl"

/* The weight of a cascade at a position. It falls from 1 to 0 across the cascade blend: a band along the edge
 * of the blend region, one probe spacing wide, that ends one cell before that edge. The region moves smoothly
 * while the cascade scrolls, so the weight does not jump. */
float sdfgi_lookup_cascade_weight(uint cascade, vec3 pos)
{
    const vec3 to_edge =
        min(pos - sdfgi_frame.cascades[cascade].blend_low, sdfgi_frame.cascades[cascade].blend_high - pos);
    return clamp((min(to_edge.x, min(to_edge.y, to_edge.z)) - 1.0) / float(SDFGI_PROBE_SPACING), 0.0, 1.0);
}

/* Irradiance over pi times exposure at a position in cell space of cascade 0. `to_eye` leads to the viewer,
 * in metres. */
vec3 sdfgi_lookup_irradiance(vec3 pos_first, vec3 normal, vec3 to_eye)
{
    const float range_m = length(to_eye);
    vec3 result = vec3(0.0);
    float rest = 1.0;    /* weight that the cascades so far have left */
    float outside = 1.0; /* weight of what lies beyond the last cascade */
    for (uint c = 0u; c < sdfgi_frame.cascade_count && rest > 0.0; c++) {
        const vec3 pos = sdfgi_cascade_from_first(c, pos_first);
        const float weight = sdfgi_lookup_cascade_weight(c, pos);
        if (weight <= 0.0)
            continue;
        outside *= 1.0 - weight;
        const vec3 eye = to_eye / max(range_m / SDFGI_CELLS_REACH, sdfgi_frame.cascades[c].cell_m);
        vec4 light = sdfgi_cells_lookup(c, pos, normal, eye);
        if (light.a <= 0.0)
            light = sdfgi_probes_lookup(c, pos, normal, eye);
        if (light.a <= 0.0)
            continue;
        result += rest * weight * light.rgb / light.a;
        rest *= 1.0 - weight;
    }
    const vec3 sky =
        sdfgi_sky_irradiance(normal, sdfgi_frame.sky_zenith, sdfgi_frame.sky_horizon, sdfgi_frame.sky_ground);
    /* What no cascade has answered, although it lies within one, is not outside: the others stand for it. */
    const float answered = 1.0 - rest + outside;
    return answered > 1e-3 ? (result + outside * sky) / answered : vec3(0.0);
}

#endif
