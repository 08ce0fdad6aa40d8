/* SPDX-License-Identifier: MIT
 * A workgroup visits SDFGI_VISIT_CELLS cells of a cascade, or fewer where new ones send more rays. Its
 * threads share the rays of all their surfaces. A surface adds its rays in order, so that sums do not depend
 * on which thread sent which ray. Shared memory: 9 KiB. */
#ifndef SDFGI_CELL_VISIT_SHARED_GLSL
#define SDFGI_CELL_VISIT_SHARED_GLSL

#include "cell_visit.glsl"

layout(local_size_x = SDFGI_MOST_THREADS) in;

const uint CELLS = uint(SDFGI_VISIT_CELLS), THREADS = gl_WorkGroupSize.x;
const uint PARTS = 32u; /* of a list of emitters, so that threads share it and few are looked through */

shared visited_cell cells[CELLS];
shared uvec3 notes[CELLS];        /* float bits of visit_notes */
shared bool wakes[CELLS];         /* a ray has met what has changed */
shared uint facing[CELLS];        /* a bit per axis; 0 for a cell that is not there */
shared uint surfaces[6u * CELLS]; /* a cell's index in `cells` times 6, plus an axis */
shared uint surface_count;
/* Per surface and ray at random, and then those towards emitters: ray_pack. */
shared uvec2 found[6u * CELLS * MOST_RAYS];
shared float importance[CELLS * PARTS]; /* per cell and part of the list: sums over emitters */

/* How many cells the workgroup visits. */
uint cell_count()
{
    return CELLS / args.new_rays;
}

visited_cell cell_of(uint own)
{
    return cells[own];
}

visit_notes notes_of(uint own)
{
    return visit_notes(uintBitsToFloat(notes[own].x), uintBitsToFloat(notes[own].y),
                       uintBitsToFloat(notes[own].z));
}

void note(uint own, visit_notes found)
{
    atomicMax(notes[own].x, floatBitsToUint(found.change));
    atomicMax(notes[own].y, floatBitsToUint(found.light));
    atomicMax(notes[own].z, floatBitsToUint(found.noise));
}

void wake(uint own)
{
    wakes[own] = true;
}

/* ---- Emitters */

uint first_of_part(uint part, uint count)
{
    return part * count / PARTS;
}

float sum_part(uint cascade, uint own, uint part)
{
    const uint count = emitter_count(cascade);
    return sum_importance(cascade, cells[own].cell, first_of_part(part, count),
                          first_of_part(part + 1u, count));
}

float sum_of_parts(uint own)
{
    float sum = 0.0;
    for (uint part = 0u; part < PARTS; part++)
        sum += importance[own * PARTS + part];
    return sum;
}

bool choose_emitter(uint cascade, uint own, inout float place, out emitter chosen, out float chance)
{
    const visited_cell of = cells[own];
    const uint count = emitter_count(cascade);
    float rest = place * of.importance, of_part = importance[own * PARTS];
    uint part = 0u;
    while (part < PARTS - 1u && rest >= of_part) {
        rest -= of_part;
        part++;
        of_part = importance[own * PARTS + part];
    }
    return choose_among(cascade, of, first_of_part(part, count), first_of_part(part + 1u, count), rest, place,
                        chosen, chance);
}

/* ---- A visit */

/* Where the rays of a surface are kept. */
uint first_found(uint surface)
{
    return surface * args.new_rays * MOST_RAYS;
}

/* Sends the rays of all surfaces. There is a place for as many as new cells send. */
void send_rays(uint cascade)
{
    const visit_rays most = rays_times(cascade, args.new_rays);
    for (uint i = gl_LocalInvocationIndex; i < surface_count * most.at_random; i += THREADS) {
        const uint of_surface = i / most.at_random, ray = i % most.at_random,
                   rays = rays_of(cascade, surfaces[of_surface] / 6u).at_random;
        if (ray >= rays)
            continue;
        const ray_source source = source_of(cascade, surfaces[of_surface]);
        const uint index = source.visits * rays + ray;
        const vec4 light = send_random_ray(cascade, source, index);
        found[first_found(of_surface) + ray] =
            ray_pack(source.normal, surfaces[of_surface] % 6u,
                     ray_direction(source.normal, index, source.shift), light);
    }
    for (uint i = gl_LocalInvocationIndex; i < surface_count * most.to_emitters; i += THREADS) {
        const uint of_surface = i / most.to_emitters, ray = i % most.to_emitters,
                   rays = rays_of(cascade, surfaces[of_surface] / 6u).to_emitters;
        if (ray >= rays)
            continue;
        const ray_source source = source_of(cascade, surfaces[of_surface]);
        vec3 dir;
        const vec4 light = send_emitter_ray(cascade, source, source.visits * rays + ray, dir);
        found[first_found(of_surface) + most.at_random + ray] =
            ray_pack(source.normal, surfaces[of_surface] % 6u, dir, light);
    }
    for (uint i = gl_LocalInvocationIndex; surfaces_look_out() && i < surface_count; i += THREADS)
        look_out(cascade, source_of(cascade, surfaces[i]));
}

/* What the rays of a surface, the i-th, have found. */
visit_light light_of_rays(uint cascade, uint i)
{
    const visit_rays rays = rays_of(cascade, surfaces[i] / 6u);
    const uint first = first_found(i), first_emitter = first + RAYS * args.new_rays;
    ray_sums at_random = NO_RAYS, to_emitters = NO_RAYS;
    for (uint ray = 0u; ray < rays.at_random; ray++)
        ray_add(at_random, found[first + ray], false);
    for (uint ray = 0u; ray < rays.to_emitters; ray++)
        ray_add(to_emitters, found[first_emitter + ray], true);
    return visit_mean(at_random, to_emitters);
}

/* Finds the cells that the workgroup visits, and their surfaces. Called by the whole workgroup. */
void find_surfaces(uint cascade)
{
    const uint lane = gl_LocalInvocationIndex, own = lane / 8u, axis = lane % 8u, count = cell_count();
    uint of_cell, entry;
    const bool visited = own < count && visit_find(count * workgroup_index() + own, of_cell, entry);
    ivec3 cell = ivec3(0);
    if (visited)
        cell = light_cell_from_index(cascade, sdfgi_light_cells_at(light_cell_slot(cascade, entry)));
    const bool there = visited && sdfgi_cell_is_valid(cascade, cell);
    if (axis == 0u && own < count) {
        cells[own].cell = cell;
        cells[own].entry = entry;
        notes[own] = uvec3(0u);
        facing[own] = 0u;
        wakes[own] = false;
        if (there) {
            cells[own].state = state_of_visit(cascade, entry, cells[own].begins);
            cells[own].times_rays = times_rays_of(cells[own].state);
            cells[own].watched = watched_holds(cascade, entry);
        }
    }
    barrier();
    if (there && axis < 6u && light_cell_faces(cascade, cell, axis))
        atomicOr(facing[own], 1u << axis);
    barrier();
    if (axis > 0u || own >= count)
        return;
    uint n = 0u;
    for (uint i = 0u; i < own; i++)
        n += uint(bitCount(facing[i]));
    for (uint rest = facing[own]; rest != 0u; rest &= rest - 1u)
        surfaces[n++] = 6u * own + uint(findLSB(rest));
    if (own + 1u == count)
        surface_count = n;
}

/* Wakes the cell of a number if its rays have met what has changed. */
void wake_cell(uint own)
{
    if (own >= cell_count() || !wakes[own])
        return;
    cells[own].state = state_reached(cells[own].state);
    cells[own].begins = true;
}

void visit()
{
    const uint word = visit_word(cell_count() * workgroup_index());
    if (word == VISIT_NOTHING)
        return;
    const uint cascade = visit_cascade(word), lane = gl_LocalInvocationIndex, count = cell_count();
    const bool lists_emitters = emitter_count(cascade) > 0u;
    find_surfaces(cascade);
    barrier();
    for (uint i = lane; lists_emitters && i < count * PARTS; i += THREADS)
        importance[i] = sum_part(cascade, i / PARTS, i % PARTS);
    barrier();
    if (lists_emitters && lane < count)
        cells[lane].importance = sum_of_parts(lane);
    barrier();
    send_rays(cascade);
    barrier();
    if (sdfgi_frame.changes_are_local != 0u) {
        wake_cell(lane);
        barrier();
    }
    for (uint i = lane; i < surface_count; i += THREADS)
        add_visit(cascade, surfaces[i], light_of_rays(cascade, i));
    barrier();
    if (lane < count && facing[lane] != 0u)
        end_visit(cascade, lane);
}

#endif
