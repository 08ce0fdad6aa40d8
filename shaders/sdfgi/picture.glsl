/* SPDX-License-Identifier: MIT
 * What gathers of a picture share: its images, and the surface that a pixel shows. */
#ifndef SDFGI_PICTURE_GLSL
#define SDFGI_PICTURE_GLSL

#define SDFGI_WRITES_SEEN
#include "seen.glsl"
#include "../include/sdfgi.glsl"
#include "../lib/random.glsl"
#include "../shared/args.h"

/* The largest half float. Brighter light would be stored as infinity. */
#define PICTURE_BRIGHTEST 65504.0

layout(push_constant) uniform sdfgi_push
{
    sdfgi_gather_args args;
};
layout(set = SDFGI_SET_VIEW, binding = SDFGI_BINDING_GATHER_DEPTH) uniform sampler2D depth_image;
layout(set = SDFGI_SET_VIEW, binding = SDFGI_BINDING_GATHER_NORMAL) uniform sampler2D normal_image;
layout(set = SDFGI_SET_VIEW, binding = SDFGI_BINDING_GATHER_OUTPUT,
       rgba16f) uniform writeonly image2D output_image;

struct picture_surface {
    vec3 pos, normal, to_eye; /* `to_eye` leads towards the viewer */
    float pixel_m;            /* width or height of a pixel at its distance, whichever is greater */
};

/* Numbers and their squares are neither infinite nor NaN. */
bool picture_is_finite(float squared_length)
{
    return squared_length < 1e30;
}

/* What a pixel shows. False for background, and where position or normal are of no use. */
bool picture_surface_at(ivec2 pixel, out picture_surface s)
{
    const float depth = texelFetch(depth_image, pixel, 0).r;
    if (depth == args.background_depth)
        return false;
    const vec2 ndc = (vec2(pixel) + 0.5) / vec2(args.width, args.height) * 2.0 - 1.0;
    const mat4 to_position = mat4(args.inverse_view_projection[0], args.inverse_view_projection[1],
                                  args.inverse_view_projection[2], args.inverse_view_projection[3]);
    const vec4 position = to_position * vec4(ndc, depth, 1.0);
    const vec3 normal = texelFetch(normal_image, pixel, 0).xyz;
    /* A point on the near plane: the vector to it leads towards the viewer. */
    const vec4 near = to_position * vec4(ndc, 1.0 - args.background_depth, 1.0);
    s.pos = position.xyz / position.w;
    s.normal = normalize(normal);
    s.to_eye = near.xyz / near.w - s.pos;
    /* How the position changes from pixel to pixel while the depth stays. */
    const vec3 right = (to_position[0].xyz - s.pos * to_position[0].w) / (position.w * float(args.width));
    const vec3 down = (to_position[1].xyz - s.pos * to_position[1].w) / (position.w * float(args.height));
    s.pixel_m = 2.0 * sqrt(max(dot(right, right), dot(down, down)));
    const float length2 = dot(normal, normal);
    return length2 > 1e-20 && picture_is_finite(length2) && picture_is_finite(dot(s.pos, s.pos));
}

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
    const uint bit = 1u << (entry & 31u);
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

#endif
