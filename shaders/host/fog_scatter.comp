/* SPDX-License-Identifier: MIT
 * The radiance that the fog of each froxel sends towards the camera per optical depth: light of suns and
 * lamps times phase function times albedo. Runs beside fog_air. Dispatched as 1 thread per froxel. */
#version 460
#extension GL_GOOGLE_include_directive : require
#include "lib/on_cpu.glsl"
#include "host/host_frame.glsl"
#include "host/host_shadow.glsl"
#include "host/host_fog_space.glsl"
#include "host/host_fog_seen.glsl"

layout(local_size_x = HOST_FOG_THREADS, local_size_y = HOST_FOG_THREADS, local_size_z = HOST_FOG_THREADS) in;

layout(set = HOST_SET_FOG, binding = 0, rgba16f) uniform writeonly image3D volume;

/* Places in a froxel at which shadows of suns are looked up: the same in all frames, so that nothing
 * flickers. More make shafts with sharp edges smoother. Where the first few agree there is no edge. */
const int SUN_PLACES = 8, SUN_FIRST = 4;

/* The i-th place in a froxel, spread evenly: Roberts 2018, "The Unreasonable Effectiveness of Quasirandom
 * Sequences". */
vec3 place_within(int i)
{
    return fract(0.5 + float(i + 1) * vec3(0.8191725, 0.6710436, 0.5497005)) - vec3(0.5, 0.5, 0.0);
}

/* How much of a froxel a sun reaches. */
float sun_share(int sun, ivec3 froxel, vec4 column, float reach, int places)
{
    float lit = 0.0;
    int count = 0;
    for (; count < places; count++) {
        if (count == SUN_FIRST && (lit == 0.0 || lit == float(SUN_FIRST)))
            break;
        const vec3 place = place_within(count);
        const float distance_m =
            fog_lit_distance(column, place.xy, 1.0, fog_distance(float(froxel.z) + place.z), reach);
        lit += shadow_sun_in_air(sun, fog_position(vec2(froxel.xy) + place.xy, distance_m));
    }
    return lit / float(max(count, 1));
}

vec3 from_suns(ivec3 froxel, vec4 column, vec3 direction, float reach, int places)
{
    vec3 sum = vec3(0.0);
    for (int s = 0; s < int(frame.counts.x); s++) {
        const float phase = fog_phase(dot(frame.suns[s].direction.xyz, direction));
        sum += frame.suns[s].irradiance.rgb * (phase * sun_share(s, froxel, column, reach, places));
    }
    return sum;
}

/* A lamp's light falls with the square of the distance d, over a slice by a lot. The mean of 1 / d^2 along a
 * ray is the angle under which the lamp sees the slice, over its length and the ray's distance from the lamp.
 * Half of that angle is where shadow and phase are looked up (Kulla and Fajardo 2012, "Importance Sampling
 * Techniques for Path Tracing in Participating Media", section 4). `tile`: the width of a tile of the
 * picture, 1 m away or anywhere. */
vec3 from_lamps(vec3 eye, vec3 direction, vec2 range_m, float tile, int count)
{
    vec3 sum = vec3(0.0);
    const float thick = range_m.y - range_m.x;
    for (int i = 0; i < count; i++) {
        const host_light_data light = lights[i];
        const vec3 to_lamp = light.position.xyz - eye;
        const float along = dot(to_lamp, direction);
        const vec3 off = to_lamp - along * direction;
        const float beside = max(max(range_m.x - along, along - range_m.y), 0.0);
        if ((dot(off, off) + beside * beside) * light.position.w * light.position.w > 1.0)
            continue; /* none of the slice is within its range */
        /* A froxel is as wide as its tile, a disc of as much area. The mean of 1 / h over it is 2 / radius at
         * the lamp; far off, h^2 is radius^2 / 4 less. Both together keep the sum over a plane. */
        const float wide = frame.camera_forward.w > 0.0 ? 1.0 : clamp(along, range_m.x, range_m.y);
        const float half_radius = 0.2821 * tile * wide;
        const float floor2 = half_radius * half_radius + 1e-8;
        const float h = sqrt(max(dot(off, off) - floor2, floor2));
        /* Tangents of the angles to both ends, cosines and sines; and the tangent of half their sum. */
        const vec2 ends = (range_m - along) / h, cosines = inversesqrt(1.0 + ends * ends),
                   sines = ends * cosines;
        const float half_way = (sines.x + sines.y) / (cosines.x + cosines.y);
        const vec3 offset = (along + h * half_way) * direction - to_lamp;
        const float distance2 = max(dot(offset, offset), 1e-8);
        const vec3 to_light = -offset * inversesqrt(distance2);
        const float share = light_share(light, to_light, distance2);
        const float angle = atan(thick / h, 1.0 + ends.x * ends.y);
        if (share > 0.0)
            sum += light.intensity.rgb * (angle / (h * thick) * share * fog_phase(dot(to_light, direction)) *
                                          shadow_punctual_in_air(light, offset));
    }
    return sum;
}

void main()
{
    const ivec3 froxel = ivec3(gl_GlobalInvocationID), size = ivec3(fog_columns(), HOST_FOG_SLICES);
    if (any(greaterThanEqual(froxel, size)))
        return;
    const vec3 ray = fog_ray(vec2(froxel.xy));
    const vec3 direction = normalize(ray);
    const vec4 column = seen[froxel.x + size.x * froxel.y];
    const float reach = fog_reach(froxel.xy - 1, froxel.xy, size.xy);
    const float near = fog_distance(float(froxel.z)), far = fog_distance(float(froxel.z + 1));
    /* Fog beyond what is seen scatters nothing that counts. */
    const vec2 range_m = vec2(fog_lit_distance(column, vec2(0.0), 1.0, near, reach),
                              fog_lit_distance(column, vec2(0.0), 1.0, far, reach));
    const float tile = 2.0 * length(frame.camera_right.xyz) * frame.fog_grid.z / frame.fog_grid.x;
    vec3 radiance = from_suns(froxel, column, direction, reach, near < reach ? SUN_PLACES : 0) +
                    from_lamps(fog_position(vec2(froxel.xy), 0.0), direction,
                               length(ray) * vec2(range_m.x, max(range_m.y, 1.001 * range_m.x)), tile,
                               near < reach ? int(frame.counts.y) : 0);
    radiance *= frame.fog_density.w;
    imageStore(volume, froxel, vec4(min(frame.fog_medium.rgb * radiance, vec3(FOG_MAX_STORED)), 0.0));
}
