/* SPDX-License-Identifier: MIT
 * Begins the reflections of a picture with what rough surfaces reflect: their irradiance over pi. Lists the
 * tiles in which a surface is smoother, and the pixels that send a ray: those of a grid, and those that are
 * unlike the pixels of the grid around them. A workgroup per tile, a thread per pixel. */
#version 460
#extension GL_GOOGLE_include_directive : require
#include "../lib/on_cpu.glsl"
#include "../include/sdfgi_reflection.glsl"
#include "picture_reflect.glsl"

layout(local_size_x = SDFGI_GROUP_PIXELS, local_size_y = SDFGI_GROUP_PIXELS) in;
layout(set = SDFGI_SET_VIEW, binding = SDFGI_BINDING_VIEW_DIFFUSE,
       rgba16f) uniform readonly image2D diffuse_image;

/* Share of the four pixels around, by their weights, that must be like a pixel that sends no ray. */
const float ENOUGH_LIKE = 0.4;

shared uint rays, first_ray; /* of this tile; its first place in the list */
shared uint is_smooth;

/* True if a pixel sends a ray of its own. */
bool sends_ray(ivec2 pixel, picture_surface s, float roughness)
{
    const int step = picture_ray_step(roughness);
    const ivec2 at = pixel & (step - 1);
    if (at == ivec2(0))
        return true;
    const vec2 t = vec2(at) / float(step);
    float like = 0.0;
    for (int i = 0; i < 4; i++) {
        const ivec2 corner = ivec2(i & 1, i >> 1);
        const vec2 near = mix(1.0 - t, t, vec2(corner));
        if (near.x * near.y > 0.0)
            like += near.x * near.y *
                    picture_likeness(s, roughness, float(SDFGI_RAYS_SIDE * step), pixel - at + step * corner);
    }
    return like < ENOUGH_LIKE;
}

/* Makes room for the rays of a tile. */
void list_tile()
{
    if (gl_WorkGroupID.xy == uvec2(0u))
        for (uint i = 1u; i <= 2u; i++)
            sdfgi_tiles[uint(SDFGI_TILES_RAYS) + i] = sdfgi_tiles[uint(SDFGI_TILES_TILES) + i] = 1u;
    if (is_smooth == 0u)
        return;
    const uint i = atomicAdd(sdfgi_tiles[TILES_COUNT], 1u);
    atomicMax(sdfgi_tiles[SDFGI_TILES_TILES], min(i + 1u, uint(SDFGI_MAX_GROUPS)));
    sdfgi_tiles[picture_tile_word(i)] = picture_pack(ivec2(gl_WorkGroupID.xy));
    first_ray = atomicAdd(sdfgi_tiles[RAYS_COUNT], rays);
    const uint groups = (first_ray + rays + uint(SDFGI_GROUP_LINEAR) - 1u) / uint(SDFGI_GROUP_LINEAR);
    atomicMax(sdfgi_tiles[SDFGI_TILES_RAYS], min(groups, uint(SDFGI_MAX_GROUPS)));
}

void main()
{
    if (gl_LocalInvocationIndex == 0u)
        rays = is_smooth = 0u;
    barrier();
    const ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    picture_surface s;
    float roughness;
    const bool reflects = picture_reflects(pixel, s, roughness),
               sends = reflects && sends_ray(pixel, s, roughness);
    uint ray = 0u;
    if (reflects)
        is_smooth = 1u;
    if (sends)
        ray = atomicAdd(rays, 1u);
    if (pixel.x < int(args.width) && pixel.y < int(args.height)) {
        const vec3 light = imageLoad(diffuse_image, pixel).rgb / 3.14159265;
        imageStore(reflection_image, pixel, vec4(light, reflects && !sends ? PICTURE_NO_RAY : 0.0));
    }
    barrier();
    if (gl_LocalInvocationIndex == 0u)
        list_tile();
    barrier();
    if (sends)
        sdfgi_tiles[picture_ray_word(first_ray + ray)] = picture_pack(pixel);
}
