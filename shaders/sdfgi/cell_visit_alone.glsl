/* SPDX-License-Identifier: MIT
 * A thread visits a cell alone, for software drivers: where threads wait for one another, these drivers keep
 * all variables in memory, and they read shared memory for one thread after another. */
#ifndef SDFGI_CELL_VISIT_ALONE_GLSL
#define SDFGI_CELL_VISIT_ALONE_GLSL

#include "cell_visit.glsl"

layout(local_size_x = 32) in; /* one for each bit of a word of seen cells */

visited_cell visited;
visit_notes notes = visit_notes(0.0, 0.0, 0.0);

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

bool choose_emitter(uint cascade, uint own, inout float place, out emitter chosen, out float chance)
{
    return choose_among(cascade, visited, 0u, emitter_count(cascade), place * visited.importance, place,
                        chosen, chance);
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
    if (!find_entry(cascade, visited.entry))
        return;
    visited.cell =
        light_cell_from_index(cascade, sdfgi_light_cells_at(light_cell_slot(cascade, visited.entry)));
    if (!sdfgi_cell_is_valid(cascade, visited.cell))
        return;
    const uint facing = light_cell_facing(cascade, visited.cell);
    if (facing == 0u)
        return;
    visited.state = state_of_visit(cascade, visited.entry);
    visited.importance = sum_importance(cascade, visited.cell, 0u, emitter_count(cascade));
    for (uint left = facing; left != 0u; left &= left - 1u) {
        const uint surface = uint(findLSB(left));
        add_visit(cascade, surface, send_rays(cascade, source_of(cascade, surface)));
    }
    end_visit(cascade, 0u);
}

#endif
