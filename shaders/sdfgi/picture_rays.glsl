/* SPDX-License-Identifier: MIT
 * The reflections of a picture, and which of its surfaces are smooth enough for rays. */
#ifndef SDFGI_PICTURE_RAYS_GLSL
#define SDFGI_PICTURE_RAYS_GLSL

#include "picture.glsl"
#include "../include/sdfgi_resources.glsl"

/* Radiance times the scale in rgb, and metres to what is reflected in a: PICTURE_NO_RAY where a pixel needs
 * its neighbours' rays. Where rays are sent it has what these find until it has the result. */
layout(set = SDFGI_SET_VIEW, binding = SDFGI_BINDING_VIEW_REFLECTION,
       rgba16f) uniform image2D reflection_image;
layout(set = SDFGI_SET_VIEW, binding = SDFGI_BINDING_VIEW_ROUGHNESS) uniform sampler2D roughness_image;

const float PICTURE_NO_RAY = -1.0;

/* 1 for what is no roughness. That of metal is stored below 0. */
float picture_roughness(ivec2 pixel)
{
    const float roughness = abs(texelFetch(roughness_image, pixel, 0).r);
    return roughness <= 1.0 ? roughness : 1.0;
}

bool picture_is_metal(ivec2 pixel)
{
    const float roughness = texelFetch(roughness_image, pixel, 0).r;
    return roughness < 0.0 && roughness >= -1.0;
}

/* Where rays count: sdfgi_reflection_ray_share is above 0, unless it rounds to it. */
bool picture_is_smooth(float roughness)
{
    return roughness < sdfgi_frame.rays_end;
}

#endif
