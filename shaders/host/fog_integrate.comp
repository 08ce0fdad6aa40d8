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

layout(local_size_x = HOST_FOG_THREADS, local_size_y = HOST_FOG_THREADS) in;

layout(set = HOST_SET_FOG, binding = 0, rgba16f) uniform image3D volume;

void main()
{
    const ivec2 column = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(column, imageSize(volume).xy)))
        return;
    vec3 seen = vec3(0.0), source = vec3(0.0), from = fog_position(vec2(column), 0.0);
    float through = 1.0;
    for (int slice = 0; slice < HOST_FOG_SLICES; slice++) {
        const vec3 to = fog_position(vec2(column), fog_distance(float(slice + 1)));
        const float left = through * exp(-fog_optical_depth(from, to));
        source = imageLoad(volume, ivec3(column, slice)).rgb;
        seen += (through - left) * source;
        through = left;
        imageStore(volume, ivec3(column, slice), vec4(seen, 1.0 - through));
        from = to;
    }
    imageStore(volume, ivec3(column, HOST_FOG_SLICES), vec4(source, 0.0));
}
