/* SPDX-License-Identifier: MIT
 * A thread visits a cell alone, for software drivers: where threads wait for one another, these drivers keep
 * all variables in memory, and they read shared memory for one thread after another. */
#ifndef SDFGI_CELL_VISIT_ALONE_GLSL
#define SDFGI_CELL_VISIT_ALONE_GLSL

#include "cell_visit.glsl"

layout(local_size_x = 32) in; /* one for each bit of a word of seen cells */

ivec3 own_cell;
uint own_entry;
gathered_state own_state;
float own_importance, own_change = 0.0, own_light = 0.0, own_noise = 0.0;

ivec3 cell_of(uint own)
{
    return own_cell;
}

uint entry_of(uint own)
{
    return own_entry;
}

gathered_state state_of(uint own)
{
    return own_state;
}

float importance_of_all(uint own)
{
    return own_importance;
}

float change_of(uint own)
{
    return own_change;
}

float light_of(uint own)
{
    return own_light;
}

float noise_of(uint own)
{
    return own_noise;
}

void note_change(uint own, float change)
{
    own_change = max(own_change, change);
}

void note_light(uint own, float light)
{
    own_light = max(own_light, light);
}

void note_noise(uint own, float noise)
{
    own_noise = max(own_noise, noise);
}

float sum_importance(uint cascade)
{
    float sum = 0.0;
    for (uint i = 0u; i < emitter_count(cascade); i++)
        sum += emitter_importance(emitter_load(cascade, i), vec3(own_cell) + 0.5);
    return sum;
}

bool choose_emitter(uint cascade, uint own, inout float place, out emitter chosen, out float chance)
{
    float rest = place * own_importance, share = 0.0;
    for (uint i = 0u; i < emitter_count(cascade); i++) {
        rest -= share;
        chosen = emitter_load(cascade, i);
        share = emitter_importance(chosen, vec3(own_cell) + 0.5);
        if (rest < share)
            break;
    }
    place = clamp(rest / max(share, 1e-30), 0.0, 1.0);
    chance = share / max(own_importance, 1e-30);
    return share > 0.0;
}

/* The mean of a surface's rays. */
vec4 send_rays(uint cascade, ray_source source)
{
    visit_light light = visit_light(vec4(0.0), vec3(0.0), vec2(0.0));
    for (uint ray = 0u; ray < RAYS; ray++)
        visit_add(
            light,
            sdfgi_half4_decode(ray_pack_light(send_random_ray(cascade, source, source.visits * RAYS + ray))),
            true);
    const uint to_emitters = rays_of_visit(cascade) - RAYS;
    for (uint ray = 0u; ray < to_emitters; ray++)
        visit_add(light, sdfgi_half4_decode(ray_pack_light(send_emitter_ray(cascade, source, ray))), false);
    return visit_mean(light);
}

/* Entry of the cell that the thread visits. False if there is none. */
bool find_entry(uint cascade, out uint entry)
{
    entry = args.first[cascade] + gl_GlobalInvocationID.x;
    if (gl_WorkGroupID.y < sdfgi_frame.cascade_count)
        return entry < min(args.end[cascade], light_cell_count(cascade));
    uint first;
    const uint seen = seen_cells(cascade, first);
    /* Elsewhere workgroups of several rows share a word. */
    if (gl_WorkGroupID.y >= 2u * sdfgi_frame.cascade_count || gl_LocalInvocationIndex >= uint(bitCount(seen)))
        return false;
    entry = first + number_of_bit(seen, gl_LocalInvocationIndex);
    return entry < light_cell_count(cascade);
}

void visit()
{
    const uint cascade = visited_cascade(gl_WorkGroupID.y);
    if (!find_entry(cascade, own_entry))
        return;
    own_cell = light_cell_from_index(cascade, sdfgi_light_cells_at(light_cell_slot(cascade, own_entry)));
    if (!sdfgi_cell_is_valid(cascade, own_cell))
        return;
    const uint facing = light_cell_facing(cascade, own_cell);
    if (facing == 0u)
        return;
    own_state = state_of_visit(cascade, own_entry);
    own_importance = sum_importance(cascade);
    for (uint left = facing; left != 0u; left &= left - 1u) {
        const uint surface = uint(findLSB(left));
        add_visit(cascade, surface, send_rays(cascade, source_of(cascade, surface)));
    }
    end_visit(cascade, 0u);
}

#endif
