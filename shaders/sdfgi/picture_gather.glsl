/* SPDX-License-Identifier: MIT
 * What gathers of a picture share: the irradiance of what a pixel shows, and marks on the light cells that it
 * reads. */
#ifndef SDFGI_PICTURE_GATHER_GLSL
#define SDFGI_PICTURE_GATHER_GLSL

#define SDFGI_WRITES_SEEN
#include "seen.glsl"
#include "picture_rays.glsl"
#ifdef SDFGI_LOBES
#include "picture_lobes.glsl"
#endif
#include "../include/sdfgi.glsl"
#include "../lib/random.glsl"

layout(set = SDFGI_SET_VIEW, binding = SDFGI_BINDING_VIEW_DIFFUSE,
       rgba16f) uniform writeonly image2D diffuse_image;

/* Marks a light cell in front of a surface as seen. */
bool picture_mark_in(uint cascade, vec3 pos, vec3 normal)
{
    uint entry;
    bool found = false;
    for (int i = 1; i <= 3 && !found; i++) {
        const vec3 at = pos + sdfgi_cells_from_metric(float(i) * SDFGI_CELLS_OFF_SURFACE * normal);
        const ivec3 cell = ivec3(floor(at));
        found = sdfgi_cell_is_valid(cascade, cell) && sdfgi_cell_entry(cascade, cell, entry);
    }
    const uint bit = 1u << entry % uint(SDFGI_SEEN_BITS);
    if (found && (atomicOr(sdfgi_seen[seen_word(cascade, entry)], bit) & bit) == 0u)
        counter_add(SDFGI_COUNTER_CELLS_SEEN + cascade, 1u);
    return found;
}

/* Marks what a lookup at a surface reads, for one pixel of 64, another one in every frame: `lane` is one of
 * 64 or more. A light cell is many pixels wide. */
void picture_mark(picture_surface s, uint lane)
{
    const uint turn =
        sdfgi_random_hash(sdfgi_frame.first_sample + gl_WorkGroupID.x + 4099u * gl_WorkGroupID.y);
    if ((lane & 63u) != (turn & 63u) || sdfgi_frame.cycle_visits == 0u || sdfgi_frame.cascade_count == 0u)
        return;
    const vec3 first = sdfgi_first_from_position(s.pos);
    for (uint c = 0u; c < sdfgi_frame.cascade_count; c++) {
        const vec3 pos = sdfgi_cascade_from_first(c, first);
        if (sdfgi_lookup_cascade_weight(c, pos) > 0.0 && picture_mark_in(c, pos, s.normal))
            return;
    }
}

/* As the output holds it. */
vec3 picture_irradiance(picture_surface s)
{
    return min(sdfgi_irradiance(s.pos, s.normal, s.to_eye) * args.scale, vec3(PICTURE_BRIGHTEST));
}

/* Stores the irradiance of a pixel, and what it reflects where a view has reflections and rays make none. */
void picture_store(ivec2 pixel, bool is_surface, vec3 normal, vec3 irradiance)
{
    imageStore(diffuse_image, pixel, vec4(irradiance, 1.0));
    if (args.ray_step == 0u || (is_surface && picture_is_smooth(picture_roughness(pixel))))
        return;
    float answer = 1.0;
#ifdef SDFGI_LOBES
    if (is_surface)
        answer = picture_lobe_answer(pixel, normal);
#endif
    imageStore(reflection_image, pixel,
               vec4(min(irradiance * (answer / 3.14159265), vec3(PICTURE_BRIGHTEST)), 0.0));
}

#endif
