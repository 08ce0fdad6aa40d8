/* SPDX-License-Identifier: MIT
 * Outgoing radiance of each light cell, per axis along which a surface faces: direct light, the surface's
 * emission, and the irradiance from the probes times bounce gain. A thread per light cell that args names, in
 * the cascade args.cascade + gl_WorkGroupID.y. */
#version 460
#extension GL_GOOGLE_include_directive : require
#define SDFGI_WRITES_LIGHT
#include "light_blocks.glsl"
#include "bounce.glsl"

layout(local_size_x = SDFGI_GROUP_LINEAR) in;
layout(push_constant) uniform sdfgi_push
{
    sdfgi_light_bounce_args args;
};

/* Albedo times feedback, capped below 1 so that light in a closed white room stays finite. */
vec3 bounce_gain(vec3 albedo)
{
    const vec3 gain = albedo * sdfgi_frame.bounce_feedback;
    if (any(greaterThan(gain, vec3(SDFGI_MAX_BOUNCE_GAIN))))
        counter_add(SDFGI_COUNTER_BOUNCE_CLAMPED, 1u);
    return min(gain, vec3(SDFGI_MAX_BOUNCE_GAIN));
}

void main()
{
    const uint cascade = args.cascade + gl_WorkGroupID.y;
    uint entry;
    if (!light_entry(cascade, args.only_dirty != 0u, args.first, args.end, gl_GlobalInvocationID.x, entry))
        return;
    const uint slot = light_cell_slot(cascade, entry);
    const ivec3 cell = light_cell_from_index(cascade, sdfgi_light_cells[slot]);
    if (!sdfgi_cell_is_valid(cascade, cell))
        return;
    const uint facing = light_cell_facing(cascade, cell);
    const uvec2 direct = light_cell_direct(slot);
    const uint visibility_bits = sdfgi_cell_visibility_bits(cascade, cell);

    vec3 axes[6];
    for (uint a = 0u; a < 6u; a++)
        axes[a] = vec3(0.0);
    for (uint rest = facing; rest != 0u; rest &= rest - 1u) {
        const uint a = uint(findLSB(rest));
        const uint block = surface_block_index(cascade, cell - surface_axis_direction(a));
        axes[a] = sdfgi_light_unpack_axis(direct, a) + surface_emission(block, a);
        if (args.without_probes == 0u) {
            const vec4 sum = bounce_light_cell(cascade, cell, surface_normal(block, a), visibility_bits);
            axes[a] += bounce_gain(surface_albedo(block)) * sum.rgb / max(sum.a, 1e-6);
        }
        if (any(greaterThan(axes[a], vec3(SDFGI_RGBE_MAX))))
            counter_add(SDFGI_COUNTER_VALUES_CLAMPED, 1u);
    }
    light_fill_axes(facing, axes);
    sdfgi_light[sdfgi_cell_index(cascade, cell)] = sdfgi_light_pack(axes, light_cell_hash(cascade, cell));
}
