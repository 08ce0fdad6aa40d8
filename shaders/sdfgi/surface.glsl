/* SPDX-License-Identifier: MIT
 * The properties of surfaces: one albedo, emission and set of normals per albedo block (2^3 cells). A pass
 * defines SDFGI_WRITES_SURFACE to write them. */
#ifndef SDFGI_SURFACE_GLSL
#define SDFGI_SURFACE_GLSL

#include "pass.glsl"
#include "../include/sdfgi_emission.glsl"
#include "../lib/rgbe.glsl"

#ifdef SDFGI_WRITES_SURFACE
#define SDFGI_ACCESS_SURFACE
#else
#define SDFGI_ACCESS_SURFACE readonly
#endif

/* 10 bits each of red, green and blue. With 8 bits 0.95 was 0.949, and a furnace had 2 % less light. */
layout(std430, set = SDFGI_SET_WORK,
       binding = SDFGI_BINDING_ALBEDO) SDFGI_ACCESS_SURFACE buffer sdfgi_albedo_buffer
{
    uint sdfgi_albedo[];
};

/* Three mean normals: of the triangles whose dominant axis is x, y and z. Each has ten bits, two slopes of 5
 * bits in
 * [-1, 1]. If there are no such triangles, the first slope is SURFACE_NO_NORMAL. */
layout(std430, set = SDFGI_SET_WORK,
       binding = SDFGI_BINDING_NORMALS) SDFGI_ACCESS_SURFACE buffer sdfgi_normals_buffer
{
    uint sdfgi_normals[];
};

const uint SURFACE_NO_NORMAL = 31u;

/* Mean unit normal of the triangles whose dominant axis is `axis`, turned to that side. False if the block
 * has no such triangles. */
bool surface_class_normal(uint packed, uint axis, out vec3 normal)
{
    const uint major = axis >> 1u;
    const uint slopes = packed >> (10u * major);
    normal = vec3(sdfgi_axis_direction(axis));
    if ((slopes & 31u) == SURFACE_NO_NORMAL)
        return false;
    const vec2 slope = vec2(slopes & 31u, slopes >> 5u & 31u) / 15.0 - 1.0;
    const vec3 n =
        major == 0u ? vec3(1.0, slope) : (major == 1u ? vec3(slope.y, 1.0, slope.x) : vec3(slope, 1.0));
    normal = normalize((axis & 1u) == 0u ? n : -n);
    return true;
}

/* The normal of the surface that faces `axis` in a block: that of the triangles whose dominant axis it is, or
 * else that of the triangles which lean towards it most. */
vec3 surface_normal(uint block, uint axis)
{
    const uint packed = sdfgi_normals[block];
    vec3 normal;
    if (surface_class_normal(packed, axis, normal))
        return normal;
    const vec3 towards = vec3(sdfgi_axis_direction(axis));
    vec3 best = towards;
    float best_height = 0.2;
    for (uint other = 0u; other < 6u; other += 2u) {
        vec3 candidate;
        if (!surface_class_normal(packed, other, candidate))
            continue;
        const float height = dot(candidate, towards);
        if (abs(height) > best_height) {
            best_height = abs(height);
            best = height > 0.0 ? candidate : -candidate;
        }
    }
    return best;
}

uint surface_pack_albedo(vec3 albedo)
{
    const uvec3 q = uvec3(clamp(albedo, 0.0, 1.0) * SDFGI_ALBEDO_STEPS + 0.5);
    return q.r | q.g << 10u | q.b << 20u;
}

vec3 surface_albedo(uint block)
{
    const uint packed = sdfgi_albedo[block];
    return vec3(packed & 1023u, packed >> 10u & 1023u, packed >> 20u) / SDFGI_ALBEDO_STEPS;
}

/* Radiance and the packed sides. */
uvec2 surface_pack_emission(vec3 radiance, uint sides)
{
    const bool bright = max(radiance.r, max(radiance.g, radiance.b)) >= 0.5;
    const float unit = bright ? SDFGI_EMISSION_BRIGHT_UNIT : SDFGI_EMISSION_DIM_UNIT;
    return uvec2(sdfgi_rgbe_encode(radiance / unit), sides | (bright ? SDFGI_EMISSION_IS_BRIGHT : 0u));
}

bool surface_is_listed_emitter(uint block)
{
    return (sdfgi_emission[block].y & SDFGI_EMISSION_IS_LISTED) != 0u;
}

#endif
