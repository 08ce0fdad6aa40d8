/* SPDX-License-Identifier: MIT
 * The reflection of a pixel: the mean of the rays of the pixels around it that see the same surface. It runs
 * twice: over a square of neighbouring pixels, and then over such squares, which together hold rays of all
 * parts of the lobe (Dammertz et al. 2010, "Edge-Avoiding A-Trous Wavelet Transform for fast Global
 * Illumination Filtering"). Mirrors keep their own ray. A workgroup per listed tile, a thread per pixel. */
#version 460
#extension GL_GOOGLE_include_directive : require
#include "../include/sdfgi_reflection.glsl"
#include "picture_reflect.glsl"

layout(local_size_x = SDFGI_GROUP_PIXELS, local_size_y = SDFGI_GROUP_PIXELS) in;
layout(set = SDFGI_SET_VIEW, binding = SDFGI_BINDING_VIEW_DIFFUSE,
       rgba16f) uniform readonly image2D diffuse_image;

/* Per run, roughness below which a pixel's own value is as good, and from which on neighbours count wholly.
 */
const vec2 FIRST = vec2(0.01, 0.03), SECOND = vec2(0.15, 0.3);

bool is_first()
{
    return args.filter_step == 1u;
}

vec4 before_at(ivec2 pixel)
{
    return is_first() ? imageLoad(reflection_image, pixel) : imageLoad(filtered_image, pixel);
}

/* How much a neighbour's ray tells of a surface: nothing where it is off the surface's plane by the width of
 * the square, differs in roughness by a fifth, or leans by more than the lobe is wide: 2 alpha. */
float likeness(picture_surface s, float roughness, ivec2 pixel)
{
    picture_surface other;
    float other_roughness;
    if (!picture_reflects(pixel, other, other_roughness))
        return 0.0;
    const float reach_m = float(SDFGI_RAYS_SIDE) * float(args.filter_step) * s.pixel_m;
    const float off_plane = abs(dot(other.pos - s.pos, s.normal)) / reach_m;
    const float alpha = roughness * roughness, lean = 1.0 - dot(s.normal, other.normal);
    return max(1.0 - off_plane, 0.0) * max(1.0 - 5.0 * abs(other_roughness - roughness), 0.0) *
           max(1.0 - lean / (2.0 * alpha * alpha + 1e-5), 0.0);
}

vec4 filtered(ivec2 pixel, picture_surface s, float roughness)
{
    const vec2 range = is_first() ? FIRST : SECOND;
    const float spread = smoothstep(range.x, range.y, roughness);
    vec4 sum = before_at(pixel);
    float weights = 1.0;
    for (int i = 0; i < SDFGI_RAYS_SIDE * SDFGI_RAYS_SIDE && spread > 0.0; i++) {
        const ivec2 tap = ivec2(i % SDFGI_RAYS_SIDE, i / SDFGI_RAYS_SIDE) - (SDFGI_RAYS_SIDE / 2 - 1);
        const ivec2 at = pixel + tap * int(args.filter_step);
        const float weight = at == pixel ? 0.0 : spread * likeness(s, roughness, at);
        if (weight > 0.0)
            sum += weight * before_at(at);
        weights += weight;
    }
    return sum / weights;
}

void filter_pixel(ivec2 pixel)
{
    picture_surface s;
    float roughness;
    if (!picture_reflects(pixel, s, roughness))
        return;
    const vec4 mean = filtered(pixel, s, roughness);
    const vec3 rough = imageLoad(diffuse_image, pixel).rgb / 3.14159265;
    if (is_first())
        imageStore(filtered_image, pixel, mean);
    else
        imageStore(reflection_image, pixel,
                   vec4(mix(rough, mean.rgb, sdfgi_reflection_ray_share(roughness)), mean.a));
}

void main()
{
    for (uint i = gl_WorkGroupID.x; i < sdfgi_tiles[TILES_COUNT]; i += gl_NumWorkGroups.x)
        filter_pixel(picture_listed(i));
}
