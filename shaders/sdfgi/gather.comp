/* SPDX-License-Identifier: MIT
 * Indirect diffuse irradiance of a whole picture, from its depths and normals. A thread per pixel. */
#version 460
#extension GL_GOOGLE_include_directive : require
#include "../lib/on_cpu.glsl"
#include "picture_gather.glsl"

layout(local_size_x = SDFGI_GROUP_PIXELS, local_size_y = SDFGI_GROUP_PIXELS) in;

void main()
{
    const ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (pixel.x >= int(args.width) || pixel.y >= int(args.height))
        return;
    picture_surface s;
    const bool is_surface = picture_surface_at(pixel, s);
    const vec3 irradiance = is_surface ? picture_irradiance(s) : vec3(0.0);
    picture_store(pixel, is_surface, s.normal, irradiance);
    if (is_surface)
        picture_mark(s, gl_LocalInvocationIndex);
}
