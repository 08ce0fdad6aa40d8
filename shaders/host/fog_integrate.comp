/* SPDX-License-Identifier: MIT
 * From what froxels scatter to what is seen of it. Front to back along each column, a froxel gets the
 * radiance that reaches the camera from there to here in rgb, and in a the share of light that the fog takes.
 * Within a slice the radiance per optical depth is the same, so that the integral is exact (Hillaire 2015,
 * "Physically Based and Unified Volumetric Rendering in Frostbite"). One texel more keeps what the last slice
 * scatters. Dispatched as 1 thread per column. */
#version 460
#extension GL_GOOGLE_include_directive : require
#include "lib/on_cpu.glsl"
#include "host/host_frame.glsl"
#include "host/host_fog_space.glsl"

layout(local_size_x = HOST_FOG_COLUMNS, local_size_y = HOST_FOG_COLUMNS) in;

layout(set = HOST_SET_FOG, binding = 0, rgba16f) uniform image3D volume;
layout(set = HOST_SET_FOG, binding = 2) uniform sampler3D air;

/* Slices that are loaded at once, before any of them is stored. Their number is a multiple of it. */
const int AHEAD = 8;

/* What fog scatters of GI's light: as fog_air.comp has stored it, times albedo. */
vec3 from_air(ivec3 froxel)
{
    const vec3 at = (vec3(froxel) + 0.5) / (float(HOST_FOG_AIR) * vec3(textureSize(air, 0)));
    const vec4 light = textureLod(air, at, 0.0);
    return light.a > 1e-3 ? frame.fog_medium.rgb * light.rgb / light.a : vec3(0.0);
}

vec3 scattered(ivec3 froxel)
{
    vec3 light = imageLoad(volume, froxel).rgb;
    if (frame.fog_grid.w > 0.0)
        light += from_air(froxel);
    return min(light, vec3(FOG_MAX_STORED));
}

void main()
{
    const ivec2 column = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(column, fog_columns())))
        return;
    vec3 seen = vec3(0.0), source = vec3(0.0), from = fog_position(vec2(column), 0.0);
    float through = 1.0;
    for (int first = 0; first < HOST_FOG_SLICES; first += AHEAD) {
        vec3 sources[AHEAD];
        for (int k = 0; k < AHEAD; k++)
            sources[k] = scattered(ivec3(column, first + k));
        for (int k = 0; k < AHEAD; k++) {
            const vec3 to = fog_position(vec2(column), fog_distance(float(first + k + 1)));
            const float left = through * exp(-fog_optical_depth(from, to));
            source = sources[k];
            seen += (through - left) * source;
            through = left;
            imageStore(volume, ivec3(column, first + k), vec4(seen, 1.0 - through));
            from = to;
        }
    }
    imageStore(volume, ivec3(column, HOST_FOG_SLICES), vec4(source, 0.0));
}
