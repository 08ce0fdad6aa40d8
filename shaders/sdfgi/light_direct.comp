/* SPDX-License-Identifier: MIT
 * Direct light on the surfaces behind each light cell: sun, point and spot lights with traced shadows, reflected by the
 * surface's albedo, one value per axis along which a surface faces. For each light cell of those that args name 2^args.source
 * threads, which share the lights. Shared memory: 6 KiB. */
#version 460
#extension GL_GOOGLE_include_directive : require
#include "light_blocks.glsl"
#include "../include/sdfgi_trace.glsl"

layout(local_size_x = SDFGI_GROUP_LINEAR) in;
layout(push_constant) uniform sdfgi_push { sdfgi_pass_args args; };
layout(std430, set = 0, binding = SDFGI_BINDING_LIGHTS) readonly buffer sdfgi_lights_buffer
{
    sdfgi_light_params sdfgi_lights[];
};

const float PI = 3.14159265;

shared vec3 shares[SDFGI_GROUP_LINEAR][6]; /* per thread, what its lights bring */

/* Irradiance that a light sends to `position` on a surface that faces it, and the way to it. Inside half a cell the
 * inverse square is cut off: a voxelised surface is no closer than that (HARD_CASES row 47). */
vec3 light_arriving(sdfgi_light_params light, vec3 position, out vec3 to_light, out float range)
{
    if ((light.kind.x & 3u) == SDFGI_LIGHT_KIND_DIRECTIONAL) {
        to_light = -light.direction.xyz;
        range = 1e9;
        return light.intensity.rgb;
    }
    const vec3 way = light.position.xyz - position;
    const float floor_m = 0.5 * sdfgi_frame.cascades[args.cascade].origin_rel.w;
    range = length(way);
    to_light = range > 0.0 ? way / range : vec3(0.0, 1.0, 0.0);
    if (light.position.w > 0.0 && range > light.position.w)
        return vec3(0.0);
    float cone = 1.0;
    if ((light.kind.x & 3u) == SDFGI_LIGHT_KIND_SPOT) {
        const float edge = dot(-to_light, light.direction.xyz) - light.direction.w;
        cone = clamp(edge * light.intensity.w, 0.0, 1.0);
        cone *= cone;
    }
    return light.intensity.rgb * (cone / max(range * range, floor_m * floor_m));
}

bool light_reaches(vec3 pos, vec3 to_light, float range_m)
{
    const float cell_m = sdfgi_frame.cascades[args.cascade].origin_rel.w;
    return !trace_ray(args.cascade, sdfgi_frame.size.w - 1u, pos, to_light, range_m / cell_m).hit;
}

/* Adds what lights bring to the surfaces along each axis: of as many threads as share a cell, each takes its own. */
void add_lights(ivec3 cell, uint facing, out vec3 axes[6])
{
    /* Shadows are traced from the cell's centre, which is in the open; light arrives at the surface before it. */
    const float depth = clamp(cell_distance(args.cascade, cell), 0.5, 1.0);
    const vec3 pos = vec3(cell) + 0.5;
    const vec3 position = position_from_cascade(args.cascade, pos);
    vec3 normals[6], surfaces[6];
    for (uint a = 0u; a < 6u; a++) {
        axes[a] = vec3(0.0);
        normals[a] = (facing >> a & 1u) != 0u
                         ? surface_normal(surface_block(args.cascade, cell - surface_axis_step(a)), a)
                         : vec3(0.0);
        surfaces[a] = position_from_cascade(args.cascade, pos - vec3(surface_axis_step(a)) * depth);
    }
    const uint sharing = 1u << args.source;
    for (uint i = gl_LocalInvocationIndex & sharing - 1u; i < sdfgi_frame.light.x; i += sharing) {
        vec3 to_light, arriving[6];
        float range, most = 0.0;
        for (uint a = 0u; a < 6u; a++) {
            arriving[a] = vec3(0.0);
            if ((facing >> a & 1u) == 0u)
                continue;
            const vec3 full = light_arriving(sdfgi_lights[i], surfaces[a], to_light, range);
            arriving[a] = full * max(dot(normals[a], to_light), 0.0);
            most = max(most, max(arriving[a].r, max(arriving[a].g, arriving[a].b)));
        }
        if (most <= 0.0)
            continue;
        light_arriving(sdfgi_lights[i], position, to_light, range);
        const bool shadows = (sdfgi_lights[i].kind.x & SDFGI_LIGHT_CASTS_SHADOW) != 0u;
        if (shadows && !light_reaches(pos, to_light, range))
            continue;
        for (uint a = 0u; a < 6u; a++)
            axes[a] += arriving[a];
    }
}

void main()
{
    const uint lane = gl_LocalInvocationIndex, sharing = 1u << args.source;
    uint entry;
    bool lit = light_entry(args, args.cascade, light_group() * SDFGI_GROUP_LINEAR + lane >> args.source, entry);
    const uint slot = light_cell_slot(args.cascade, lit ? entry : 0u);
    const ivec3 cell = light_cell_position(args.cascade, sdfgi_light_cells[slot]);
    lit = lit && cell_served(args.cascade, cell);
    uint facing = 0u;
    vec3 axes[6];
    if (lit) {
        facing = light_cell_facing(args.cascade, cell);
        add_lights(cell, facing, axes);
        for (uint a = 0u; a < 6u; a++)
            shares[lane][a] = axes[a];
    }
    barrier();
    if (!lit || (lane & sharing - 1u) > 0u)
        return;
    for (uint a = 0u; a < 6u; a++) {
        if ((facing >> a & 1u) == 0u)
            continue;
        for (uint other = 1u; other < sharing; other++)
            axes[a] += shares[lane + other][a];
        axes[a] *= surface_albedo(surface_block(args.cascade, cell - surface_axis_step(a))) / PI;
    }
    light_fill_axes(facing, axes);
    for (uint a = 0u; a < 6u; a++)
        if (any(greaterThan(axes[a], vec3(SDFGI_RGBE_MAX))))
            counter_add(SDFGI_COUNTER_VALUES_CLAMPED, 1u);
    light_cell_store_direct(slot, light_pack(axes, light_cell_hash(args.cascade, cell)));
}
