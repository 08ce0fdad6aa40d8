/* SPDX-License-Identifier: MIT
 * Visits light cells: sends SDFGI_VISIT_RAYS rays from each for each axis along which a surface faces,
 * distributed by the cosine about the surface's normal, and adds the mean of what they meet to the cell's
 * sums. A ray reads what leaves the surface that it hits, or the sky. All bounces go from cell to cell.
 *
 * A workgroup visits SDFGI_VISIT_CELLS cells of the cascade gl_WorkGroupID.y. Its threads share the rays of
 * all their surfaces. A surface adds its rays in order, so that sums do not depend on which thread sent which
 * ray. Shared memory: 7 KiB. */
#version 460
#extension GL_GOOGLE_include_directive : require
#include "gathered.glsl"
#include "../include/sdfgi_cells.glsl"
#include "../include/sdfgi_trace.glsl"
#include "../lib/sky.glsl"

layout(local_size_x = 64) in;
layout(push_constant) uniform sdfgi_push
{
    sdfgi_cell_gather_args args;
};

const uint CELLS = uint(SDFGI_VISIT_CELLS), RAYS = uint(SDFGI_VISIT_RAYS), THREADS = 64u;

shared ivec3 cells[CELLS];
shared uint facing[CELLS];           /* a bit per axis; 0 for a cell that is not there */
shared gathered_state states[CELLS]; /* with which the visits begin */
shared uint changes[CELLS];          /* float bits: how far a mean has changed */
shared uint surfaces[6u * CELLS];    /* a cell's index in `cells` times 6, plus an axis */
shared uint surface_count;
shared uvec2 found[6u * CELLS * RAYS]; /* per ray: radiance, and 1 if it is known */

uint entry_of(uint own)
{
    return args.first[gl_WorkGroupID.y] + gl_WorkGroupID.x * CELLS + own;
}

/* Light at the end of a ray: 0 in a if the surface that it hit has no light cell. */
vec4 ray_light(uint cascade, vec3 pos, vec3 dir)
{
    const sdfgi_trace_hit hit = sdfgi_trace_ray(cascade, sdfgi_frame.cascade_count - 1u, pos, dir, 1e9);
    if (!hit.hit)
        return vec4(
            sdfgi_sky_radiance(dir, sdfgi_frame.sky_zenith, sdfgi_frame.sky_horizon, sdfgi_frame.sky_ground),
            1.0);
    if (!hit.has_cell)
        return vec4(0.0);
    uint entry;
    if (!sdfgi_cell_entry(hit.cascade, hit.cell, entry))
        return vec4(0.0);
    return vec4(sdfgi_rgbe_decode(sdfgi_light[sdfgi_surface_index(hit.cascade, entry, hit.axis)]), 1.0);
}

/* Direction of ray `index` of a cycle: points of one sequence in the unit square, shifted by a hash of the
 * cell, and mapped to the hemisphere so that their density follows the cosine. */
vec3 ray_direction(vec3 normal, uint index, uint shift)
{
    const vec2 point = sdfgi_random_r2(index, shift);
    const float radius = sqrt(point.x), turn = 6.2831853 * point.y;
    const vec3 side =
        normalize(abs(normal.y) < 0.9 ? vec3(-normal.z, 0.0, normal.x) : vec3(0.0, normal.z, -normal.y));
    const vec3 up = cross(normal, side);
    return radius * (cos(turn) * side + sin(turn) * up) + sqrt(max(1.0 - point.x, 0.0)) * normal;
}

/* Sends a ray of a surface, one of the visit's. */
vec4 send_ray(uint cascade, uint surface, uint ray)
{
    const uint own = surface / 6u, axis = surface % 6u;
    const ivec3 cell = cells[own];
    const uint block = surface_block_index(cascade, cell - surface_axis_direction(axis));
    const uint shift = sdfgi_random_hash(light_cell_hash(cascade, cell) + 6u * sdfgi_frame.seed + axis);
    const vec3 dir = ray_direction(surface_normal(block, axis), states[own].visits * RAYS + ray, shift);
    return ray_light(cascade, vec3(cell) + 0.5, dir);
}

vec3 mean_of_rays(uint first)
{
    vec4 sum = vec4(0.0);
    for (uint i = 0u; i < RAYS; i++) {
        const vec4 ray = sdfgi_half4_decode(found[first + i]);
        sum += vec4(ray.rgb * ray.a, ray.a);
    }
    return sum.rgb / max(sum.a, 1.0);
}

/* The state with which a visit begins: under new lights a cycle begins anew. */
gathered_state state_of_visit(uint cascade, uint entry)
{
    const gathered_state state = gathered_load_state(cascade, entry);
    if (state.epoch == args.epoch)
        return state;
    const bool knows = state.mean != GATHERED_NOTHING || state.visits > 0u;
    return gathered_state(0u, knows ? GATHERED_OUTDATED : GATHERED_NOTHING, args.epoch);
}

/* Sum and mean with which a visit begins. What was gathered under other lights becomes the mean. */
gathered_light load_light(uint cascade, uint entry, uint axis)
{
    const gathered_state stored = gathered_load_state(cascade, entry);
    gathered_light light = gathered_load(cascade, entry, axis);
    if (stored.epoch == args.epoch)
        return light;
    vec3 shown;
    if (gathered_irradiance(stored, light, vec4(0.0), shown))
        light.mean = shown;
    light.sum = vec3(0.0);
    return light;
}

/* Difference of two colours over the brighter one, at most 1. Below a part of the brightest probe nobody sees
 * a change. */
float relative_change(vec3 a, vec3 b)
{
    const vec3 difference = abs(a - b), larger = max(a, b);
    const float most = max(difference.r, max(difference.g, difference.b));
    return min(most / (max(larger.r, max(larger.g, larger.b)) + sdfgi_frame.brightest_texel / 512.0 + 1e-12),
               1.0);
}

/* True if a visit is the last one of a cell's cycle; `state` is the one before it. */
bool ends_cycle(uint cascade, gathered_state state)
{
    return state.visits + 1u >= args.visits[cascade];
}

/* What a cell's mean is at the end of a cycle. */
uint mean_after(uint cascade)
{
    return args.visits[cascade] < sdfgi_frame.cycle_visits ? GATHERED_ROUGH : GATHERED_COMPLETE;
}

/* Adds a visit to the sum of a surface. The last visit of a cycle makes the sum the mean. */
void add_visit(uint cascade, uint surface, vec3 light)
{
    const uint own = surface / 6u, axis = surface % 6u, entry = entry_of(own);
    gathered_light gathered = load_light(cascade, entry, axis);
    gathered.sum = gathered_add(states[own], gathered, light);
    if (ends_cycle(cascade, states[own])) {
        const vec3 mean = gathered_mean(states[own], gathered.sum, states[own].visits + 1u);
        const float change =
            states[own].mean == mean_after(cascade) ? relative_change(mean, gathered.mean) : 1.0;
        atomicMax(changes[own], floatBitsToUint(change));
        gathered = gathered_light(vec3(0.0), mean);
    }
    gathered_store(cascade, entry, axis, gathered);
}

void end_visit(uint cascade, uint own)
{
    gathered_state state = states[own];
    state.visits++;
    if (ends_cycle(cascade, states[own]))
        state = gathered_state(0u, mean_after(cascade), state.epoch);
    gathered_store_state(cascade, entry_of(own), state);
    if (changes[own] != 0u)
        atomicMax(sdfgi_counters[SDFGI_COUNTER_CELL_CHANGE + cascade], changes[own]);
}

/* Finds the cells that the workgroup visits, and their surfaces. Called by the whole workgroup. */
void find_surfaces(uint cascade)
{
    const uint lane = gl_LocalInvocationIndex, own = lane / 8u, axis = lane % 8u;
    const uint entry = entry_of(own), end = min(args.end[cascade], light_cell_count(cascade));
    ivec3 cell = ivec3(0);
    if (entry < end)
        cell = light_cell_from_index(cascade, sdfgi_light_cells[light_cell_slot(cascade, entry)]);
    const bool there = entry < end && sdfgi_cell_is_valid(cascade, cell);
    if (axis == 0u) {
        cells[own] = cell;
        facing[own] = changes[own] = 0u;
        if (there)
            states[own] = state_of_visit(cascade, entry);
    }
    barrier();
    if (there && axis < 6u && light_cell_faces(cascade, cell, axis))
        atomicOr(facing[own], 1u << axis);
    barrier();
    if (axis > 0u)
        return;
    uint n = 0u;
    for (uint i = 0u; i < own; i++)
        n += uint(bitCount(facing[i]));
    for (uint rest = facing[own]; rest != 0u; rest &= rest - 1u)
        surfaces[n++] = 6u * own + uint(findLSB(rest));
    if (own + 1u == CELLS)
        surface_count = n;
}

void main()
{
    const uint cascade = gl_WorkGroupID.y, lane = gl_LocalInvocationIndex;
    find_surfaces(cascade);
    barrier();
    for (uint i = lane; i < surface_count * RAYS; i += THREADS)
        found[i] = sdfgi_half4_encode(
            sdfgi_half4_round(min(send_ray(cascade, surfaces[i / RAYS], i % RAYS), vec4(65504.0))));
    barrier();
    for (uint i = lane; i < surface_count; i += THREADS)
        add_visit(cascade, surfaces[i], mean_of_rays(i * RAYS));
    barrier();
    if (lane < CELLS && facing[lane] != 0u)
        end_visit(cascade, lane);
}
