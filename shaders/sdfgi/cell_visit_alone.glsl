/* SPDX-License-Identifier: MIT
 * A thread visits a cell alone, for software drivers: where threads wait for one another,
 * these drivers keep all variables in memory, and they read shared memory for one thread after another. */
#ifndef SDFGI_CELL_VISIT_ALONE_GLSL
#define SDFGI_CELL_VISIT_ALONE_GLSL

#include "pass.glsl"

/* Before the includes that ask for it. */
layout(local_size_x = SDFGI_SEEN_BITS) in;

#include "cell_visit.glsl"

visited_cell visited;
visit_notes notes;
bool wakes; /* a ray has met what has changed */

visited_cell cell_of(uint own)
{
    return visited;
}

visit_notes notes_of(uint own)
{
    return notes;
}

void note(uint own, visit_notes found)
{
    notes = visit_notes(max(notes.change, found.change), max(notes.light, found.light),
                        max(notes.noise, found.noise));
}

void wake(uint own)
{
    wakes = true;
}

bool choose_emitter(uint cascade, uint own, inout float place, out emitter chosen, out float chance)
{
    return choose_among(cascade, visited, 0u, emitter_count(cascade), place * visited.importance, place,
                        chosen, chance);
}

/* What the rays of a surface find. */
visit_light send_rays(uint cascade, ray_source source, uint axis)
{
    const visit_rays rays = rays_of(cascade, 0u);
    ray_sums at_random = NO_RAYS, to_emitters = NO_RAYS;
    for (uint ray = 0u; ray < rays.at_random; ray++) {
        const uint index = source.visits * rays.at_random + ray;
        const vec4 light = send_random_ray(cascade, source, index);
        ray_add(at_random,
                ray_pack(source.normal, axis, ray_direction(source.normal, index, source.shift), light),
                false);
    }
    for (uint ray = 0u; ray < rays.to_emitters; ray++) {
        vec3 dir;
        const vec4 light = send_emitter_ray(cascade, source, source.visits * rays.to_emitters + ray, dir);
        ray_add(to_emitters, ray_pack(source.normal, axis, dir, light), true);
    }
    if (surfaces_look_out())
        look_out(cascade, source);
    return visit_mean(at_random, to_emitters);
}

void visit_cell(uint cascade)
{
    visited.cell =
        light_cell_from_index(cascade, sdfgi_light_cells_at(light_cell_slot(cascade, visited.entry)));
    if (!sdfgi_cell_is_valid(cascade, visited.cell))
        return;
    const uint facing = light_cell_facing(cascade, visited.cell);
    if (facing == 0u)
        return;
    notes = visit_notes(0.0, 0.0, 0.0);
    visited.state = state_of_visit(cascade, visited.entry, visited.begins);
    visited.times_rays = times_rays_of(visited.state);
    visited.watched = watched_holds(cascade, visited.entry);
    visited.importance = sum_importance(cascade, visited.cell, 0u, emitter_count(cascade));
    wakes = false;
    visit_light light[6];
    for (uint left = facing; left != 0u; left &= left - 1u) {
        const uint surface = uint(findLSB(left));
        light[surface] = send_rays(cascade, source_of(cascade, surface), surface);
    }
    if (wakes) {
        visited.state = state_reached(visited.state);
        visited.begins = true;
    }
    for (uint left = facing; left != 0u; left &= left - 1u)
        add_visit(cascade, uint(findLSB(left)), light[findLSB(left)]);
    end_visit(cascade, 0u);
}

void visit()
{
    uint cascade;
    if (visit_find(gl_WorkGroupSize.x * workgroup_index() + gl_LocalInvocationIndex, cascade, visited.entry))
        visit_cell(cascade);
}

#endif
