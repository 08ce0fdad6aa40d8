/* SPDX-License-Identifier: MIT
 * GI's light in the air, as what a medium of albedo 1 scatters towards the camera, for blocks of
 * HOST_FOG_AIR^3 froxels: it changes slowly, and is what costs most. rgb: radiance as stored, times a; a: how
 * far it is known. Dispatched as 1 thread per block. */
#version 460
#extension GL_GOOGLE_include_directive : require
#include "lib/on_cpu.glsl"
#include "host/host_frame.glsl"
#include "host/host_fog_space.glsl"
#include "host/host_fog_seen.glsl"
#define SDFGI_SET HOST_SET_GI
#include "sdfgi.glsl"

layout(local_size_x = HOST_FOG_THREADS, local_size_y = HOST_FOG_THREADS, local_size_z = HOST_FOG_THREADS) in;

layout(set = HOST_SET_FOG, binding = 1, rgba16f) uniform writeonly image3D air;

/* Metres along the camera's axis that are seen through a block: it is interpolated for columns up to one
 * block away, and each of these for the tiles around it. */
float reach_of(ivec2 block, ivec2 columns)
{
    const ivec2 first = HOST_FOG_AIR * (block - 1);
    return fog_reach(first, first + 3 * HOST_FOG_AIR - 2, columns);
}

/* The light of a lobe of mean cosine g: see sdfgi_light_air. */
vec4 light_at(vec3 position, vec3 ray)
{
    const float g = frame.fog_medium.w;
    const sdfgi_air_light light = sdfgi_light_air(position, g < 0.0 ? -ray : ray);
    const vec3 radiance = mix(light.mean, light.towards, min(1.5 * abs(g), 1.0));
    const vec3 stored = min(radiance * frame.fog_density.w, vec3(FOG_MAX_STORED));
    return vec4(stored * light.known, light.known);
}

void main()
{
    const ivec3 block = ivec3(gl_GlobalInvocationID);
    if (any(greaterThanEqual(block, imageSize(air))))
        return;
    const ivec2 columns = fog_columns(), first = min(HOST_FOG_AIR * block.xy, columns - 1);
    /* From the first of its columns to its middle. */
    const vec2 offset = vec2(0.5 * float(HOST_FOG_AIR - 1));
    const vec3 ray = fog_ray(vec2(first) + offset);
    const float reach = reach_of(block.xy, columns), slice = float(HOST_FOG_AIR * block.z);
    const float distance_m =
        fog_lit_distance(seen[first.x + columns.x * first.y], offset, float(2 * HOST_FOG_AIR),
                         fog_distance(slice + 0.5 * float(HOST_FOG_AIR)), reach);
    vec4 light = vec4(0.0);
    /* A loop of one round or none: drivers that run both sides of a branch leave loops early. */
    const int rounds = fog_distance(slice - float(HOST_FOG_AIR)) < reach ? 1 : 0;
    for (int i = 0; i < rounds; i++)
        light = light_at(fog_position(vec2(first) + offset, distance_m), normalize(ray));
    imageStore(air, block, light);
}
