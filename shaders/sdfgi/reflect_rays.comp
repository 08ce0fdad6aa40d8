/* SPDX-License-Identifier: MIT
 * Sends a ray from each listed pixel, and reads the light that leaves what it hits. The rays of neighbouring
 * pixels are spread over the lobe of a rough surface; reflect_filter takes their mean. Which part of the lobe
 * a pixel samples depends on its place in the picture alone, so that nothing flickers while the camera rests.
 * A thread per pixel. */
#version 460
#extension GL_GOOGLE_include_directive : require
#include "../lib/on_cpu.glsl"
#include "../lib/random.glsl"
#include "reflect_path.glsl"
#include "picture_reflect.glsl"

layout(local_size_x = SDFGI_GROUP_REFLECT) in;

/* Cosine between a ray and the face's normal, at least. */
const float LEAST_RISE = 0.02;
/* Minus that cosine, from which on a ray into the surface brings nothing. */
const float DEEPEST = 0.15;
/* Of the square of the way to a neighbouring pixel: that of the bend of a surface, at least, at an edge. */
const float EVEN = 0.1;

/* Cells: so far behind what a pixel shows is what was voxelised there. */
const float BEHIND = 0.25;

/* Every square of SDFGI_RAYS_SIDE rays a side, wherever it begins, holds each point of a sequence once, and
 * squares side by side hold it with other shifts. `pixel` is in steps from ray to ray. */
vec2 pattern_point(ivec2 pixel)
{
    const uvec2 side = uvec2(SDFGI_RAYS_SIDE), at = uvec2(pixel) % side, square = uvec2(pixel) / side % side;
    const uint shift = bitfieldReverse(square.x + side.x * square.y);
    return sdfgi_random_r2(at.x + side.x * at.y, shift >> 4u);
}

/* True if the surface of a pixel is metal: the host says so, or the voxels do. */
bool shows_metal(ivec2 pixel, picture_surface s)
{
    if (picture_is_metal(pixel))
        return true;
    const vec3 first = sdfgi_first_from_position(s.pos);
    for (uint c = 0u; c < sdfgi_frame.cascade_count; c++) {
        const ivec3 cell = ivec3(floor(sdfgi_cascade_from_first(c, first) - BEHIND * s.normal));
        if (sdfgi_cell_is_valid(c, cell))
            return is_metal(sdfgi_block_index(c, cell));
    }
    return false;
}

/* How much the facet counts that sends light from `dir`: by the angle, unless it is one of metal. */
float facet_share(ivec2 pixel, picture_surface s, float roughness, vec3 dir, bool is_hidden)
{
    return shows_metal(pixel, s)
               ? 1.0
               : sdfgi_reflection_facet_share(s.normal, s.to_eye, roughness, dir, is_hidden);
}

/* From a point to the surface of another pixel; far away if there is none. */
vec3 way_to(ivec2 pixel, vec3 pos)
{
    vec4 position = vec4(0.0);
    return picture_contains(pixel) && picture_position(pixel, position) ? position.xyz / position.w - pos
                                                                        : vec3(1e25);
}

/* Along a surface, to that of one of two neighbouring pixels: to the nearer one, as edges lie farther off.
 * `even`: both neighbours and the pixel lie in a line, or one neighbour is beyond the picture. */
vec3 tangent(ivec2 pixel, ivec2 step, vec3 pos, inout bool even)
{
    const vec3 next = way_to(pixel + step, pos), last = way_to(pixel - step, pos), bend = next + last;
    const float next2 = dot(next, next), last2 = dot(last, last);
    even = even && (dot(bend, bend) < EVEN * min(next2, last2) || !picture_contains(pixel + step) ||
                    !picture_contains(pixel - step));
    return next2 <= last2 ? next : -last;
}

/* The normal of what is drawn, without the detail that a texture gives it; that of the pixel where no
 * neighbours tell. `even`: there is no edge beside the pixel. */
vec3 face_normal(ivec2 pixel, picture_surface s, out bool even)
{
    even = true;
    const vec3 normal =
        cross(tangent(pixel, ivec2(1, 0), s.pos, even), tangent(pixel, ivec2(0, 1), s.pos, even));
    const float length2 = dot(normal, normal);
    if (!(length2 > 0.0) || !picture_is_finite(length2))
        return s.normal;
    return normal * (dot(normal, s.to_eye) < 0.0 ? -inversesqrt(length2) : inversesqrt(length2));
}

/* A normal of a texture may lean so far that the ray would lead into the surface, which would see itself. A
 * little below the face it is turned back; deep below, what it shows is the dark of a groove. */
vec3 off_face(vec3 dir, vec3 face)
{
    return normalize(dir + max(2.0 * LEAST_RISE - 2.0 * dot(dir, face), 0.0) * face);
}

float open_share(vec3 dir, vec3 face)
{
    return clamp(1.0 + dot(dir, face) / DEEPEST, 0.0, 1.0);
}

/* `word` is that of the list. */
void reflect_pixel(uint word)
{
    const ivec2 pixel = picture_unpack(word);
    picture_surface s;
    float roughness;
    if (!picture_reflects(pixel, s, roughness))
        return;
    const float scale = sdfgi_frame.exposure_inverse * sdfgi_frame.energy * args.scale;
    const int ray_step = picture_ray_step(roughness);
    const bool is_dense = (word & PICTURE_DENSE) != 0u || !picture_is_on_grid(pixel, ray_step);
    const vec2 point = pattern_point(pixel / (is_dense ? picture_dense_step(roughness) : ray_step));
    bool even;
    const vec3 face = face_normal(pixel, s, even),
               of_facet = sdfgi_reflection_of_facet(s.normal, s.to_eye, roughness, point),
               of_lobe = sdfgi_ggx_above(of_facet, s.normal), dir = off_face(of_lobe, face);
    const float share = (even ? open_share(of_lobe, face) : 1.0) *
                        facet_share(pixel, s, roughness, dir, dot(of_facet, s.normal) <= 0.0);
    const reflect_found found =
        reflect_trace(sdfgi_first_from_position(s.pos), face, dir, packUnorm2x16(fract(5.0 * point)));
    const vec3 light = scale * share * reflect_light(found);
    imageStore(reflection_image, pixel, vec4(min(light, vec3(PICTURE_BRIGHTEST)), found.length_m));
}

void main()
{
    const uint threads = gl_NumWorkGroups.x * uint(SDFGI_GROUP_REFLECT);
    for (uint i = gl_GlobalInvocationID.x; i < sdfgi_tiles[RAYS_COUNT]; i += threads)
        reflect_pixel(sdfgi_tiles[picture_ray_word(i)]);
}
