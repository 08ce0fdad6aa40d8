/* SPDX-License-Identifier: MIT
 * Light at a point. The finest cascade around it answers: at a surface its light cells, or its probes where
 * no light cell is near. In the cascade blend, and where a cascade has no answer, the
 * next coarser one takes over, and beyond the last one the sky does. */
#ifndef SDFGI_LOOKUP_GLSL
#define SDFGI_LOOKUP_GLSL

#include "sdfgi_cells.glsl"
#include "sdfgi_probes.glsl"
#include "sdfgi_sky.glsl"

/* The weight of a cascade at a position. It falls from 1 to 0 across the cascade blend: a band along the edge
 * of the blend region, one probe spacing wide, that ends one cell before that edge. The region moves smoothly
 * while the cascade scrolls, so the weight does not jump. */
float sdfgi_lookup_cascade_weight(uint cascade, vec3 pos)
{
    const vec3 to_edge =
        min(pos - sdfgi_frame.cascades[cascade].blend_low, sdfgi_frame.cascades[cascade].blend_high - pos);
    return clamp((min(to_edge.x, min(to_edge.y, to_edge.z)) - 1.0) / float(SDFGI_PROBE_SPACING), 0.0, 1.0);
}

/* What is looked up at a point. */
struct sdfgi_lookup_query {
    uint what;    /* SDFGI_LOOKUP_* */
    uint cascade; /* the finest one that may answer */
    vec3 pos;     /* in cell space of cascade 0 */
    vec3 normal;  /* of the surface at the point */
    vec3 to_eye;  /* to the viewer, in metres */
};

const uint SDFGI_LOOKUP_SURFACE = 0u; /* irradiance over pi of a surface: light cells answer, else probes */
const uint SDFGI_LOOKUP_LEAVING = 1u; /* radiance that leaves a surface: light cells answer */

/* Shaders pass what they have, and the normal of a triangle without area is no number. Some unit vector
 * stands for what is none, the normal for a way to a viewer who is nowhere, and a point far beyond all
 * cascades for one that is nowhere. */
vec3 sdfgi_lookup_unit(vec3 direction)
{
    const float square = dot(direction, direction);
    return square > 0.25 && square < 4.0 ? direction : vec3(0.0, 1.0, 0.0);
}

vec3 sdfgi_lookup_to_eye(vec3 to_eye, vec3 normal)
{
    const float square = dot(to_eye, to_eye);
    return square > 1e-30 && square < 1e30 ? to_eye : normal;
}

/* In cell space of cascade 0. */
vec3 sdfgi_lookup_position(vec3 position)
{
    return sdfgi_first_from_position(dot(position, position) < 1e30 ? position : vec3(1e15));
}

/* The way to the viewer in cell widths of a cascade, as far as a lookup goes. */
vec3 sdfgi_lookup_eye(uint cascade, vec3 to_eye)
{
    const float reach_m = length(to_eye) / SDFGI_CELLS_REACH;
    return to_eye * (1.0 / max(reach_m, sdfgi_frame.cascades[cascade].cell_m));
}

/* Light times exposure and weight in rgb, and its weight in a, of one cascade. */
vec4 sdfgi_lookup_cascade(uint cascade, vec3 pos, sdfgi_lookup_query query)
{
    const vec3 eye = sdfgi_lookup_eye(cascade, query.to_eye);
    vec4 light =
        sdfgi_cells_lookup(cascade, pos, query.normal, eye,
                           query.what == SDFGI_LOOKUP_LEAVING ? SDFGI_CELLS_LEAVING : SDFGI_CELLS_ARRIVING);
    if (query.what != SDFGI_LOOKUP_LEAVING && light.a <= 0.0)
        light = sdfgi_probes_lookup(cascade, pos, query.normal, eye);
    return light;
}

/* Light times exposure, of all cascades and of what lies beyond them, in rgb; 1 in a, or 0 where nothing is
 * known. Light that leaves a surface is that of one cascade: where two hand over, a ray of each hits one. */
vec4 sdfgi_lookup(sdfgi_lookup_query query)
{
    vec3 result = vec3(0.0);
    float rest = 1.0;    /* weight that the cascades so far have left */
    float outside = 1.0; /* weight of what lies beyond the last cascade */
    uint c = query.cascade;
    /* In a round, the next cascade around the point answers, which may be another one for other threads. */
    for (;;) {
        vec3 pos = query.pos;
        float weight = 0.0;
        for (; c < sdfgi_frame.cascade_count && weight <= 0.0; c++) {
            pos = sdfgi_cascade_from_first(c, query.pos);
            weight = query.what == SDFGI_LOOKUP_LEAVING ? 1.0 : sdfgi_lookup_cascade_weight(c, pos);
        }
        if (weight <= 0.0)
            break;
        outside *= 1.0 - weight;
        const vec4 light = sdfgi_lookup_cascade(c - 1u, pos, query);
        if (light.a > 0.0) {
            result += rest * weight * light.rgb / light.a;
            rest *= 1.0 - weight;
        }
        if (rest <= 0.0)
            break;
    }
    const vec3 sky = outside > 0.0 ? sdfgi_sky_around(query.normal) : vec3(0.0);
    /* What no cascade has answered, although it lies within one, is not outside: the others stand for it. */
    const float answered = 1.0 - rest + outside;
    return answered > 1e-3 ? vec4((result + outside * sky) / answered, 1.0) : vec4(0.0);
}

#endif
