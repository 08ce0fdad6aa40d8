/* SPDX-License-Identifier: MIT
 * The properties of surfaces: two albedos, emission and a set of normals per albedo block (2^3 cells). A pass
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

/* Albedo blocks have two colours, and for each side, +x -x +y -y +z -z, the one that it shows: what is
 * painted differently on its two faces, or stands before something else, is one wall of many. The first
 * colour has ten bits a channel: with 8 bits 0.95 was 0.949, and a furnace had 2 % less light. The second has
 * nine for red and blue. Six bits are left for the sides. */
layout(std430, set = SDFGI_SET_WORK,
       binding = SDFGI_BINDING_ALBEDO) SDFGI_ACCESS_SURFACE buffer sdfgi_albedo_buffer
{
    uvec2 sdfgi_albedo[];
};

/* Three mean normals: of the triangles whose dominant axis is x, y and z. Each has ten bits, two slopes of 5
 * bits in [-1, 1]. If there are no such triangles, the first slope is SURFACE_NO_NORMAL. Two more
 * tell the kind of metal: see surface_metal. */
layout(std430, set = SDFGI_SET_WORK,
       binding = SDFGI_BINDING_NORMALS) SDFGI_ACCESS_SURFACE buffer sdfgi_normals_buffer
{
    uint sdfgi_normals[];
};

const uint SURFACE_NO_NORMAL = 31u;
/* Of a block without surfaces. */
const uint SURFACE_NO_NORMALS = SURFACE_NO_NORMAL * 0x100401u;
const uint SURFACE_METAL_SHIFT = 30u; /* beside the normals */
const vec3 SURFACE_SECOND_STEPS = vec3(511.0, 1023.0, 511.0);

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
    const uint packed = sdfgi_normals_at(block);
    vec3 normal;
    if (surface_class_normal(packed, axis, normal))
        return normal;
    const vec3 towards = vec3(sdfgi_axis_direction(axis));
    vec3 best = towards;
    float best_height = 0.2;
    for (uint other = SDFGI_ZERO; other < 6u; other += 2u) {
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

/* What a block shows on the side that faces `axis`. */
vec3 surface_albedo(uint block, uint axis)
{
    const uvec2 packed = sdfgi_albedo_at(block);
    const uint sides = packed.x >> 30u | packed.y >> 28u << 2u;
    return (sides >> axis & 1u) == 0u
               ? vec3(packed.x & 1023u, packed.x >> 10u & 1023u, packed.x >> 20u & 1023u) / SDFGI_ALBEDO_STEPS
               : vec3(packed.y & 511u, packed.y >> 9u & 1023u, packed.y >> 19u & 511u) / SURFACE_SECOND_STEPS;
}

/* The kind of metal from which rays go on, 1 to 3; 0 for all else. */
uint surface_metal(uint block)
{
    return sdfgi_frame.has_metal != 0u ? sdfgi_normals_at(block) >> SURFACE_METAL_SHIFT : 0u;
}

/* `sides` has a bit for each side that shows the second colour. */
uvec2 surface_pack_albedo(vec3 first, vec3 second, uint sides)
{
    const uvec3 a = uvec3(clamp(first, 0.0, 1.0) * SDFGI_ALBEDO_STEPS + 0.5),
                b = uvec3(clamp(second, 0.0, 1.0) * SURFACE_SECOND_STEPS + 0.5);
    return uvec2(a.r | a.g << 10u | a.b << 20u | sides << 30u,
                 b.r | b.g << 9u | b.b << 19u | sides >> 2u << 28u);
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
    return (sdfgi_emission_at(block).y & SDFGI_EMISSION_IS_LISTED) != 0u;
}

#endif
