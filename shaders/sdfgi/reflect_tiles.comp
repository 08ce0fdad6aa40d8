/* SPDX-License-Identifier: MIT
 * Begins the reflections of a picture with what rough surfaces reflect: their irradiance over pi. Lists the
 * tiles in which a surface is smoother. A workgroup per tile, a thread per pixel. */
#version 460
#extension GL_GOOGLE_include_directive : require
#include "../include/sdfgi_reflection.glsl"
#include "picture_reflect.glsl"

layout(local_size_x = SDFGI_GROUP_PIXELS, local_size_y = SDFGI_GROUP_PIXELS) in;
layout(set = SDFGI_SET_VIEW, binding = SDFGI_BINDING_VIEW_DIFFUSE,
       rgba16f) uniform readonly image2D diffuse_image;

shared uint wants_rays;

void list_tile()
{
    if (gl_WorkGroupID.xy == uvec2(0u))
        sdfgi_tiles[1] = sdfgi_tiles[2] = 1u;
    if (wants_rays == 0u)
        return;
    const uint i = atomicAdd(sdfgi_tiles[TILES_COUNT], 1u);
    atomicMax(sdfgi_tiles[0], min(i + 1u, uint(SDFGI_MAX_GROUPS)));
    sdfgi_tiles[uint(SDFGI_TILES_HEADER) + i] = gl_WorkGroupID.x | gl_WorkGroupID.y << 16u;
}

void main()
{
    if (gl_LocalInvocationIndex == 0u)
        wants_rays = 0u;
    barrier();
    const ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    picture_surface s;
    if (pixel.x < int(args.width) && pixel.y < int(args.height)) {
        vec3 light = vec3(0.0);
        if (picture_surface_at(pixel, s)) {
            light = imageLoad(diffuse_image, pixel).rgb / 3.14159265;
            if (sdfgi_reflection_ray_share(picture_roughness(pixel)) > 0.0)
                wants_rays = 1u;
        }
        imageStore(reflection_image, pixel, vec4(light, 0.0));
    }
    barrier();
    if (gl_LocalInvocationIndex == 0u)
        list_tile();
}
