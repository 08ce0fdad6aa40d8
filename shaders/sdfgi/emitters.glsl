/* SPDX-License-Identifier: MIT
 * Emitters: albedo blocks in which something emits. A cascade lists those that emit most, and light cells
 * send rays towards them, because few rays at random meet a small lamp. An emitter lies in the box around its
 * emissive sub-voxels. How much area it shows in a direction follows from what the sides of its block see. */
#ifndef SDFGI_EMITTERS_GLSL
#define SDFGI_EMITTERS_GLSL

#include "emitter_shapes.glsl"
#include "../include/sdfgi_trace.glsl"
#include "../lib/light_pack.glsl"

/* The words of an emitter: its block, its shape, RGB9E5 radiance, what the two sides of each axis see of it,
 * together and the one less the other, as half floats, its power, and SDFGI_EMISSION_IS_BRIGHT. */
uint emitter_word(uint cascade, uint i)
{
    return emitter_count_word(cascade) + 8u + uint(SDFGI_EMITTER_WORDS) * i;
}

uint emitter_count(uint cascade)
{
    return sdfgi_frame.emitter_samples != 0u ? sdfgi_emitters_at(emitter_count_word(cascade)) : 0u;
}

/* In the list `boxy` and `bent` take the place of `fill`, in 7 bits each. */
uint emitter_shape_pack_form(uint shape, float boxy, float bent)
{
    return shape & 0x3ffffu | uint(round(boxy * 127.0)) << 18u | uint(round(bent * 127.0)) << 25u;
}

/* The place of a listed block in the list of a cascade. */
uint emitter_of_block(uint cascade, uint block)
{
    uint first = 0u, count = emitter_count(cascade);
    while (count > 1u) {
        const uint half_count = count / 2u;
        if (sdfgi_emitters_at(emitter_word(cascade, first + half_count)) <= block)
            first += half_count;
        count -= half_count;
    }
    return first;
}

/* True if a cascade lists all of its emitters, and there are any. */
bool emitters_are_complete(uint cascade)
{
    return emitter_count(cascade) > 0u && sdfgi_emitters_at(emitter_count_word(cascade) + 1u) != 0u;
}

struct emitter {
    vec3 low, high; /* corners, in cells */
    uvec2 radiance; /* as blocks have it: sdfgi_emission_radiance */
    vec3 seen;      /* areas that both sides of an axis see, in squares of a cell's width */
    vec3 net;       /* that of the positive side less that of the negative one */
    float boxy;     /* 1: a box; 0: a ball, whatever its proportions */
    float bent;     /* 0: flat */
    float power;    /* luminance of the radiance times the area that emits */
};

emitter emitter_load(uint cascade, uint i)
{
    const uint word = emitter_word(cascade, i), block = sdfgi_emitters_at(word),
               shape = sdfgi_emitters_at(word + 1u);
    const vec3 corner = vec3(sdfgi_cell_from_texel(cascade, sdfgi_albedo_block_texel(block)));
    emitter e;
    const emitter_bounds bounds = emitter_shape_bounds(shape);
    e.low = corner + vec3(bounds.low) / float(SDFGI_SUBVOXELS);
    e.high = corner + vec3(bounds.high + 1u) / float(SDFGI_SUBVOXELS);
    e.radiance = uvec2(sdfgi_emitters_at(word + 2u), sdfgi_emitters_at(word + 7u));
    const vec2 x = unpackHalf2x16(sdfgi_emitters_at(word + 3u)),
               y = unpackHalf2x16(sdfgi_emitters_at(word + 4u)),
               z = unpackHalf2x16(sdfgi_emitters_at(word + 5u));
    e.seen = vec3(x.x, y.x, z.x);
    e.net = vec3(x.y, y.y, z.y);
    e.boxy = float(shape >> 18u & 127u) / 127.0;
    e.bent = float(shape >> 25u) / 127.0;
    e.power = uintBitsToFloat(sdfgi_emitters_at(word + 6u));
    return e;
}

/* Area that an emitter shows in a direction and in the opposite one, together: of a flat one, of a box, and
 * of a ball, it is known from the areas that the sides of a block see. */
float emitter_area_both_ways(emitter e, vec3 dir)
{
    const vec3 sides = e.seen * abs(dir);
    return mix(abs(dot(e.net, dir)), mix(length(sides), sides.x + sides.y + sides.z, e.boxy), e.bent);
}

/* Area that an emitter shows in a direction. Whatever its form, what it shows in the opposite one is less by
 * the net area along it. */
float emitter_area_towards(emitter e, vec3 dir)
{
    return max(0.5 * (emitter_area_both_ways(e, dir) + dot(e.net, dir)), 0.0);
}

/* Cells: from nearer than that light grows no more, because the place of surfaces is not known so closely. */
const float EMITTER_NEAR = 0.5;

/* About the light that a place may get from an emitter, and never 0 where a surface there gets any. */
float emitter_importance(emitter e, vec3 pos)
{
    const vec3 offset = sdfgi_metric_from_cells(0.5 * (e.low + e.high) - pos);
    const float radius = 0.5 * length(sdfgi_metric_from_cells(e.high - e.low));
    const float range = max(length(offset), 1e-3), slack = (radius + 1.0) / range;
    const float all_sides = e.seen.x + e.seen.y + e.seen.z;
    const float shown = emitter_area_towards(e, -offset / range) / max(all_sides, 1e-12) + slack;
    const float nearest = max(range, max(radius, EMITTER_NEAR));
    return e.power * min(shown, 1.0) / (nearest * nearest);
}

/* A point of an emitter. */
struct emitter_point {
    vec3 face;   /* on a face of the box: whether it is seen tells whether the emitter is */
    vec3 inside; /* where light comes from: the surface lies half a sub-voxel behind the face on average */
};

/* A point on those faces of an emitter's box that emit towards `from`; `place` is in [0, 1]^3. A face counts
 * as much as it shows. */
emitter_point emitter_point_at(emitter e, vec3 from, vec3 place)
{
    const vec3 offset = sdfgi_metric_from_cells(from - 0.5 * (e.low + e.high));
    const vec3 shown = max(abs(offset) * e.seen + offset * e.net, 0.0);
    float rest = place.x * (shown.x + shown.y + shown.z);
    int axis = 0;
    for (; axis < 2 && rest >= shown[axis]; axis++)
        rest -= shown[axis];
    vec3 point = vec3(clamp(rest / max(shown[axis], 1e-30), 0.0, 1.0), place.yz);
    point = axis == 0 ? point.yxz : (axis == 1 ? point.xyz : point.xzy);
    point[axis] = offset[axis] > 0.0 ? 1.0 : 0.0;
    const vec3 face = mix(e.low, e.high, point);
    vec3 inside = face;
    inside[axis] += (offset[axis] > 0.0 ? -0.5 : 0.5) / float(SDFGI_SUBVOXELS);
    return emitter_point(face, inside);
}

/* Solid angle under which an emitter shows if all of it is seen and lies at `point`. `dir` leads there. */
float emitter_solid_angle(emitter e, vec3 pos, vec3 point, out vec3 dir)
{
    const vec3 offset = sdfgi_metric_from_cells(point - pos);
    const float range = max(length(offset), 1e-3), nearest = max(range, EMITTER_NEAR);
    dir = offset / range;
    return emitter_area_towards(e, -dir) / (nearest * nearest);
}

/* Irradiance over pi times exposure that a surface would get from an emitter, if all of it were seen and lay
 * at `point`. */
vec3 emitter_light(emitter e, vec3 pos, vec3 normal, vec3 point)
{
    vec3 dir;
    const float shown = emitter_solid_angle(e, pos, point, dir);
    return sdfgi_emission_radiance(e.radiance) * (sdfgi_frame.emission_scale / 3.14159265) * shown *
           max(dot(normal, dir), 0.0);
}

/* The way to a point on a face of an emitter's box. */
struct emitter_way {
    vec3 dir;
    float range;
};

emitter_way emitter_way_to(vec3 pos, vec3 face)
{
    const vec3 offset = sdfgi_metric_from_cells(face - pos);
    const float range = max(length(offset), 1e-3);
    return emitter_way(offset / range, range);
}

/* True if a ray that has hit something met the emitter at the end of the way: in the box, unless the emitter
 * emits to the other side alone. */
bool emitter_is_hit(emitter e, sdfgi_trace_hit hit, float range)
{
    const float NEAR = 0.02;
    const float net = sdfgi_trace_component(e.net, int(hit.axis >> 1u));
    return !hit.capped && hit.distance >= range - NEAR && ((hit.axis & 1u) == 0u ? net : -net) >= 0.0;
}

/* The ray to a point of an emitter. It starts in the open, and leads through the emitter's box. */
sdfgi_trace_hit emitter_trace(uint cascade, emitter e, vec3 pos, emitter_way way)
{
    const float beyond = length(sdfgi_metric_from_cells(e.high - e.low));
    return sdfgi_trace_solid(cascade, cascade, pos, way.dir, way.range + beyond);
}

/* True if it meets the emitter, or nothing. */
bool emitter_is_seen(uint cascade, emitter e, vec3 pos, emitter_way way)
{
    const sdfgi_trace_hit hit = emitter_trace(cascade, e, pos, way);
    return !hit.hit || emitter_is_hit(e, hit, way.range);
}

#endif
