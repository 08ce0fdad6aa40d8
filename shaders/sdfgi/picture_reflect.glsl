/* SPDX-License-Identifier: MIT
 * What passes over the reflections of a picture share: its images, a list of the tiles that the filter takes,
 * and one of the pixels that send a ray. A tile has 8 x 8 pixels. */
#ifndef SDFGI_PICTURE_REFLECT_GLSL
#define SDFGI_PICTURE_REFLECT_GLSL

#include "picture_rays.glsl"
#include "picture_tiles.glsl"

/* What the filter's first run has made of the rays, in listed tiles. */
layout(set = SDFGI_SET_VIEW, binding = SDFGI_BINDING_VIEW_FILTERED, rgba16f) uniform image2D filtered_image;

const uint RAYS_COUNT = uint(SDFGI_TILES_RAYS) + 3u, TILES_COUNT = uint(SDFGI_TILES_TILES) + 3u;
/* Roughness of mirrors at most: their lobes are narrower than four pixels of 3e-6 rad, the least that the
 * filter takes. Where views are narrower, mirrors show single rays. */
const float PICTURE_MIRROR = 0.0025;
/* Roughness from which on every second pixel along each axis sends a ray, and every fourth. */
const vec2 PICTURE_SPARSE_RAYS = vec2(0.55, 0.64);

/* In the place of a ray: pixels around it send rays as at full resolution. */
const uint PICTURE_DENSE = 0x8000u;

uint picture_pack(ivec2 place)
{
    return uint(place.x) | uint(place.y) << 16u;
}

ivec2 picture_unpack(uint place)
{
    return ivec2(place & 0x7fffu, place >> 16u);
}

/* The pixel of this thread in the tile of a number of the list. */
ivec2 picture_listed(uint i)
{
    return picture_unpack(sdfgi_tiles[picture_tile_word(i)]) * SDFGI_GROUP_PIXELS +
           ivec2(gl_LocalInvocationID.xy);
}

/* What a pixel shows, if it reflects by rays. */
bool picture_reflects(ivec2 pixel, out picture_surface s, out float roughness)
{
    roughness = 1.0;
    if (!picture_contains(pixel) || !picture_surface_at(pixel, s))
        return false;
    roughness = picture_roughness(pixel);
    return picture_is_smooth(roughness);
}

/* Pixels from ray to ray at full resolution, along each axis. Wide lobes do with fewer rays: the filter's
 * second run takes the mean of squares all around. */
int picture_dense_step(float roughness)
{
    return roughness < PICTURE_SPARSE_RAYS.x ? 1 : (roughness < PICTURE_SPARSE_RAYS.y ? 2 : 4);
}

/* The same at the resolution of reflections. */
int picture_ray_step(float roughness)
{
    return int(args.ray_step) * picture_dense_step(roughness);
}

/* True for a pixel of the grid whose pixels all send rays. */
bool picture_is_on_grid(ivec2 pixel, int ray_step)
{
    return (pixel & (ray_step - 1)) == ivec2(0);
}

/* Roughness up to which a pixel keeps the ray that it sends itself, and none around it takes it. Such a ray
 * must count wholly. */
float picture_mirror_end()
{
    return args.ray_step == 1u ? min(PICTURE_MIRROR, sdfgi_frame.rays_blend) : -1.0;
}

/* A surface with which the pixels around `origin` are compared. A height above its plane is a quotient of two
 * sums over a place: pixels right and down of `origin`, depth, and 1. */
struct picture_comparison {
    ivec2 origin;
    vec4 height, w; /* dividend, in widths of the square that the filter looks at; divisor */
    vec3 normal;
    float roughness;
    float per_lean; /* what leans by so much counts for nothing: its reciprocal */
    float mirror_end;
};

/* A sum over a place from one over NDC, depth and 1. */
vec4 picture_over_place(vec4 over_ndc, ivec2 origin)
{
    return vec4(2.0 * over_ndc.xy / vec2(args.width, args.height), over_ndc.z,
                over_ndc.w + dot(over_ndc.xy, picture_ndc(origin)));
}

float picture_sum_at(vec4 over_place, vec2 offset, float depth)
{
    return over_place.z * depth + (over_place.x * offset.x + (over_place.y * offset.y + over_place.w));
}

/* `reach` is the width of the square in pixels. */
picture_comparison picture_compare(picture_surface s, float roughness, float reach, ivec2 origin)
{
    const mat4 to_position = picture_to_position();
    const vec4 plane = vec4(s.normal, -dot(s.normal, s.pos)) / (reach * s.pixel_m),
               w = vec4(to_position[0].w, to_position[1].w, to_position[2].w, to_position[3].w);
    const float alpha = roughness * roughness;
    return picture_comparison(origin, picture_over_place(plane * to_position, origin),
                              picture_over_place(w, origin), s.normal, roughness,
                              1.0 / (2.0 * alpha * alpha + 1e-5), picture_mirror_end());
}

/* How much a neighbour's ray tells of a surface: nothing where it is off the surface's plane by the width of
 * the square, differs in roughness by a fifth, or leans by more than the lobe is wide: 2 alpha. Nothing is
 * loaded under a condition: loads that wait for each other take most time. */
float picture_likeness(picture_comparison to, ivec2 pixel)
{
    const ivec2 last = ivec2(args.width, args.height) - 1, at = clamp(pixel, ivec2(0), last);
    const float roughness = picture_roughness(at);
    const vec3 normal = texelFetch(normal_image, at, 0).xyz;
    const float depth = texelFetch(depth_image, at, 0).r, length2 = dot(normal, normal);
    const bool counts = depth != args.background_depth && picture_is_normal(length2) && at == pixel &&
                        picture_is_smooth(roughness) && roughness > to.mirror_end;
    const vec2 offset = vec2(pixel - to.origin);
    /* A reciprocal takes less than a division. */
    const float off_plane =
        abs(picture_sum_at(to.height, offset, depth) * (1.0 / picture_sum_at(to.w, offset, depth)));
    const float lean = 1.0 - dot(to.normal, normal) * inversesqrt(length2);
    const float likeness = max(1.0 - off_plane, 0.0) * max(1.0 - 5.0 * abs(roughness - to.roughness), 0.0) *
                           max(1.0 - lean * to.per_lean, 0.0);
    return counts && off_plane < 1.0 ? likeness : 0.0;
}

#endif
