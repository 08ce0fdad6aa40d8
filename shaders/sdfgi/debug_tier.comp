/* SPDX-License-Identifier: MIT
 * A debug view of what the host has drawn: which tier a pixel's reflection comes from, as its roughness says.
 * It reads no volumes. sdfgi/debug.h says what the colours mean. A thread per pixel. */
#version 460
#extension GL_GOOGLE_include_directive : require
#include "../lib/on_cpu.glsl"
#include "../include/sdfgi_reflection_rays.glsl"
#include "debug_colors.glsl"
#include "picture_reflect.glsl"

layout(local_size_x = SDFGI_GROUP_PIXELS, local_size_y = SDFGI_GROUP_PIXELS) in;
layout(set = SDFGI_SET_VIEW, binding = SDFGI_BINDING_VIEW_DIFFUSE,
       rgba16f) uniform writeonly image2D output_image;

/* The mean of the faces that a normal leans to. */
float shade_of(vec3 normal)
{
    float shade = 0.0;
    for (int axis = 0; axis < 3; axis++)
        shade += normal[axis] * normal[axis] * DEBUG_SHADES[2 * axis + (normal[axis] < 0.0 ? 1 : 0)];
    return shade;
}

vec3 color_of(ivec2 pixel)
{
    picture_surface s;
    if (!picture_surface_at(pixel, s))
        return DEBUG_SKY;
    const float share = sdfgi_reflection_ray_share(picture_roughness(pixel));
    return shade_of(s.normal) * (share > 0.0 ? debug_red_to_green(share) : DEBUG_BLUE);
}

void main()
{
    const ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (pixel.x < int(args.width) && pixel.y < int(args.height))
        imageStore(output_image, pixel, vec4(color_of(pixel), 1.0));
}
