/* SPDX-License-Identifier: MIT
 * What passes over a picture share: what the host has drawn, and the surface that a pixel shows. */
#ifndef SDFGI_PICTURE_GLSL
#define SDFGI_PICTURE_GLSL

#include "../shared/args.h"
#include "push.glsl"
#include "../shared/bindings.h"

/* The largest half float. Brighter light would be stored as infinity. */
#define PICTURE_BRIGHTEST 65504.0

SDFGI_PUSH(sdfgi_gather_args);
layout(set = SDFGI_SET_VIEW, binding = SDFGI_BINDING_VIEW_DEPTH) uniform sampler2D depth_image;
layout(set = SDFGI_SET_VIEW, binding = SDFGI_BINDING_VIEW_NORMAL) uniform sampler2D normal_image;

struct picture_surface {
    vec3 pos, normal, to_eye; /* `to_eye` leads towards the viewer */
    float pixel_m;            /* width or height of a pixel at its distance, whichever is greater */
};

/* Numbers and their squares are neither infinite nor NaN. */
bool picture_is_finite(float squared_length)
{
    return squared_length < 1e30;
}

/* Vectors of other lengths, and what is no number, are no normals. */
bool picture_is_normal(float squared_length)
{
    return squared_length > 1e-20 && picture_is_finite(squared_length);
}

mat4 picture_to_position()
{
    return mat4(args.inverse_view_projection[0], args.inverse_view_projection[1],
                args.inverse_view_projection[2], args.inverse_view_projection[3]);
}

bool picture_contains(ivec2 pixel)
{
    return all(greaterThanEqual(pixel, ivec2(0))) && all(lessThan(pixel, ivec2(args.width, args.height)));
}

vec2 picture_ndc(ivec2 pixel)
{
    return (vec2(pixel) + 0.5) / vec2(args.width, args.height) * 2.0 - 1.0;
}

/* Where the surface of a pixel lies, in homogeneous coordinates. False for background. */
bool picture_position(ivec2 pixel, out vec4 position)
{
    const float depth = texelFetch(depth_image, pixel, 0).r;
    position = picture_to_position() * vec4(picture_ndc(pixel), depth, 1.0);
    return depth != args.background_depth;
}

/* What a pixel shows. False for background, and where position or normal are of no use. Loads all at once. */
bool picture_surface_at(ivec2 pixel, out picture_surface s)
{
    vec4 position;
    const vec3 normal = texelFetch(normal_image, pixel, 0).xyz;
    const bool is_drawn = picture_position(pixel, position);
    const mat4 to_position = picture_to_position();
    /* A point on the near plane: the vector to it leads towards the viewer. */
    const vec4 near = to_position * vec4(picture_ndc(pixel), 1.0 - args.background_depth, 1.0);
    s.pos = position.xyz / position.w;
    s.normal = normalize(normal);
    s.to_eye = near.xyz / near.w - s.pos;
    /* How the position changes from pixel to pixel while the depth stays. */
    const vec3 right = (to_position[0].xyz - s.pos * to_position[0].w) / (position.w * float(args.width));
    const vec3 down = (to_position[1].xyz - s.pos * to_position[1].w) / (position.w * float(args.height));
    s.pixel_m = 2.0 * sqrt(max(dot(right, right), dot(down, down)));
    const float length2 = dot(normal, normal);
    return is_drawn && picture_is_normal(length2) && picture_is_finite(dot(s.pos, s.pos));
}

#endif
