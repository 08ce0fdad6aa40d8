/* SPDX-License-Identifier: MIT
 * The reflection of a pixel: the mean of the rays of the pixels around it that see the same surface. It runs
 * twice: over a square of 4 x 4 neighbouring rays, and then over such squares, which together hold rays of
 * all parts of the lobe (Dammertz et al. 2010, "Edge-Avoiding A-Trous Wavelet Transform for fast Global
 * Illumination Filtering"). Mirrors keep their own ray. A workgroup per listed tile, a thread per pixel. */
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
#include "../lib/on_cpu.glsl"
#include "../include/sdfgi_reflection_rays.glsl"
#include "picture_lobes.glsl"
#include "picture_reflect.glsl"

layout(local_size_x = SDFGI_GROUP_PIXELS, local_size_y = SDFGI_GROUP_PIXELS) in;
layout(set = SDFGI_SET_VIEW, binding = SDFGI_BINDING_VIEW_DIFFUSE,
       rgba16f) uniform readonly image2D diffuse_image;

/* Per run, roughness below which a pixel's own value is as good, and from which on neighbours count wholly.
 */
const vec2 FIRST = vec2(0.01, 0.03), SECOND = SDFGI_REFLECTION_WIDE_LOBES;
/* The same of the second run, by the width of the lobe over that of the square of squares. */
const vec2 LOBE = vec2(0.25, 1.0);

vec4 before_at(ivec2 pixel, bool is_first)
{
    return is_first ? imageLoad(reflection_image, pixel) : imageLoad(filtered_image, pixel);
}

/* How near a pixel is to one that sends a ray: weights of bilinear interpolation. */
float nearness(ivec2 pixel, ivec2 ray, int step)
{
    const vec2 near = max(1.0 - abs(vec2(pixel - ray)) / float(step), 0.0);
    return near.x * near.y;
}

/* How wide the lobe is in the picture, in pixels, where rays of a facet's slope alpha meet something at a
 * distance. Near the surface all of them meet the same. */
float lobe_pixels(picture_surface s, float roughness, float distance_m)
{
    const float eye_m = length(s.to_eye), seen = max(distance_m, 0.0) / (max(distance_m, 0.0) + eye_m);
    return 2.0 * roughness * roughness * seen * eye_m / s.pixel_m;
}

/* How much neighbours count: wholly where the lobe is wide. Squares of squares whose rays lie apart are
 * large, and alike only where the lobe is as wide in the picture. */
float spread_of(picture_surface s, float roughness, float distance_m, float reach, bool is_first)
{
    if (is_first)
        return smoothstep(FIRST.x, FIRST.y, roughness);
    const bool is_sparse = picture_ray_step(roughness) > int(args.ray_step);
    const float by_roughness = is_sparse ? 0.0 : smoothstep(SECOND.x, SECOND.y, roughness);
    return max(by_roughness, smoothstep(LOBE.x, LOBE.y, lobe_pixels(s, roughness, distance_m) / reach));
}

/* What the runs before have made of a pixel. */
struct pixel_before {
    vec4 own;
    bool sends_ray; /* asked for only where rays lie apart */
};

pixel_before before_of(ivec2 pixel, bool is_first)
{
    return pixel_before(before_at(pixel, is_first),
                        args.ray_step == 1u || imageLoad(reflection_image, pixel).a >= 0.0);
}

/* Pixels from ray to ray around a pixel. One between those of the grid that sends a ray has others beside it
 * that do. */
int ray_step_at(ivec2 pixel, float roughness, bool sends_ray)
{
    const int ray_step = picture_ray_step(roughness);
    const bool dense = args.ray_step > 1u && !picture_is_on_grid(pixel, ray_step) && sends_ray;
    return dense ? picture_dense_step(roughness) : ray_step;
}

/* The mean of what the rays around have found; PICTURE_NO_RAY in a where none tells of the pixel's surface.
 * The first run interpolates between rays, which may lie apart; the second begins with pixels. */
vec4 filtered(ivec2 pixel, picture_surface s, float roughness, pixel_before before, bool is_first)
{
    const int ray_step = ray_step_at(pixel, roughness, before.sends_ray),
              step = ray_step * int(args.filter_step);
    const float reach = float(SDFGI_RAYS_SIDE * step);
    const ivec2 center = is_first ? pixel - (pixel & (ray_step - 1)) : pixel;
    const bool interpolates = is_first && ray_step > 1;
    const vec4 own = before.own;
    const float spread = spread_of(s, roughness, own.a, reach, is_first);
    float weights = own.a < 0.0 ? 0.0 : 1.0;
    vec4 sum = weights * own;
    const picture_comparison to = picture_compare(s, roughness, reach, center);
    /* The loads of a row overlap. */
    const int rows = spread > 0.0 || interpolates ? SDFGI_RAYS_SIDE : 0;
    for (int row = 0; row < rows; row++) {
        [[unroll]] for (int column = 0; column < SDFGI_RAYS_SIDE; column++)
        {
            const ivec2 at = center + (ivec2(column, row) - (SDFGI_RAYS_SIDE / 2 - 1)) * step;
            const float near = interpolates ? nearness(pixel, at, ray_step) : 0.0;
            const vec4 value = before_at(at, is_first);
            const float share = at == pixel || value.a < 0.0 ? 0.0 : mix(near, 1.0, spread),
                        weight = share * picture_likeness(to, at);
            /* What nobody wrote may be no number. */
            sum += weight > 0.0 ? weight * value : vec4(0.0);
            weights += weight;
        }
    }
    return weights > 0.0 ? sum / weights : vec4(0.0, 0.0, 0.0, PICTURE_NO_RAY);
}

vec4 blended(vec3 rough, vec4 mean, float roughness)
{
    return vec4(mix(rough, mean.rgb, sdfgi_reflection_ray_share(roughness)), mean.a);
}

/* Loads of a pixel do not wait for each other. */
void filter_pixel(ivec2 pixel, bool is_first)
{
    if (!picture_contains(pixel))
        return;
    picture_surface s;
    const pixel_before before = before_of(pixel, is_first);
    const float roughness = picture_roughness(pixel);
    if (!picture_surface_at(pixel, s) || !picture_is_smooth(roughness))
        return;
    const vec4 mean = filtered(pixel, s, roughness, before, is_first);
    if (is_first) {
        imageStore(filtered_image, pixel, mean);
        return;
    }
    const vec3 rough =
        imageLoad(diffuse_image, pixel).rgb * (picture_lobe_answer(pixel, s.normal) / 3.14159265);
    imageStore(reflection_image, pixel, mean.a < 0.0 ? vec4(rough, 0.0) : blended(rough, mean, roughness));
}

void filter_tiles(bool is_first)
{
    /* The first is loaded beside the count: there are as many groups as tiles, or fewer. */
    const ivec2 first = picture_listed(gl_WorkGroupID.x);
    const uint count = sdfgi_tiles[TILES_COUNT];
    for (uint i = gl_WorkGroupID.x; i < count; i += gl_NumWorkGroups.x)
        filter_pixel(i == gl_WorkGroupID.x ? first : picture_listed(i), is_first);
}

void main()
{
    const bool is_first = args.filter_step == 1u;
#ifdef SDFGI_SOFTWARE
    filter_tiles(is_first); /* software drivers would run both */
#else
    /* Where the picture that taps come from is known to the compiler, no tap loads from both. */
    if (is_first)
        filter_tiles(true);
    else
        filter_tiles(false);
#endif
}
