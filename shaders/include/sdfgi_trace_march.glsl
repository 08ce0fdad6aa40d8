/* SPDX-License-Identifier: MIT
 * The march from cell to cell and from cascade to cascade. The occupancy bits alone decide what a ray hits:
 * in cells that have some, it walks from sub-voxel to sub-voxel. What is empty it crosses in few steps: GPUs
 * by the empty boxes that begin where the ray is, software drivers by distances (Hart 1996, "Sphere
 * tracing"). Distances are read at cell centres and never interpolated, so a ray cannot slip through a wall,
 * however thin. */
#ifndef SDFGI_TRACE_MARCH_GLSL
#define SDFGI_TRACE_MARCH_GLSL

#include "sdfgi_trace_state.glsl"

/* True if nothing is left for a ray where it stands: it goes on in the next cascade, or ends. */
bool sdfgi_trace_is_at_border(sdfgi_trace_state ray)
{
    return !(ray.t < ray.border);
}

bool sdfgi_trace_goes_on(sdfgi_trace_query query, sdfgi_trace_state ray)
{
    return ray.cascade < query.last_cascade && sdfgi_trace_length(ray) < query.range;
}

/* How a ray ends. */
const uint SDFGI_TRACE_MISS = 0u;
const uint SDFGI_TRACE_HIT = 1u;    /* in a set sub-voxel of ray.cell */
const uint SDFGI_TRACE_CAPPED = 2u; /* it ran out of steps */

/* Looks for the one of a cell's set sub-voxels that a ray meets before it leaves the cell. */
bool sdfgi_trace_meets_subvoxel(uvec2 subvoxels, float t_exit, inout sdfgi_trace_state ray)
{
    const uvec2 bits = subvoxels & sdfgi_trace_bits_near_ray(ray.cell, ray.origin, ray.dir, ray.t, t_exit);
    return bits != uvec2(0u) &&
           sdfgi_trace_walk_subvoxels(bits, ray.cell, ray.origin, ray.dir, ray.inv_dir, ray.t, ray.axis);
}

#ifdef SDFGI_SOFTWARE

/* A cell with a greater stored distance has no sub-voxel of its own: sqrt(3) 3 / 8, rounded up. */
#define SDFGI_TRACE_OCCUPIED_DISTANCE 0.65
/* Walking through a cell is cheaper than a step of the distance field that is shorter than this. */
#define SDFGI_TRACE_MIN_STEP 0.5

/* How far a ray may go on: to where it leaves the ball around its cell's centre that holds no sub-voxel, as
 * `distance` tells for that centre. 0 if the ray is outside of the ball. */
float sdfgi_trace_free_length(sdfgi_trace_state ray, float distance)
{
    const vec3 from_centre = sdfgi_metric_from_cells(ray.origin + ray.dir * ray.t - vec3(ray.cell) - 0.5);
    const float radius = max(distance - SDFGI_TRACE_MARGIN, 0.0),
                room = radius * radius - dot(from_centre, from_centre),
                along = dot(from_centre, sdfgi_metric_from_cells(ray.dir));
    return room > 0.0 ? sqrt(along * along + room) - along : 0.0;
}

/* Walks through a cell, which is stored at `index`. Returns true at a set sub-voxel; otherwise the ray stands
 * where it leaves the cell. */
bool sdfgi_trace_cross_cell(uint index, inout sdfgi_trace_state ray)
{
    float t_exit;
    const int exit_axis = sdfgi_trace_box_exit(ray.origin, ray.inv_dir, vec3(ray.cell), 1.0, t_exit);
    t_exit = max(ray.t, t_exit);
    if (sdfgi_trace_meets_subvoxel(sdfgi_subvoxels(index), t_exit, ray))
        return true;
    ray.axis = exit_axis;
    ray.t = t_exit;
    return false;
}

/* Goes on to where the ray leaves its cell. */
void sdfgi_trace_leave_cell(ivec3 signs, inout sdfgi_trace_state ray)
{
    float t_exit;
    ray.axis = sdfgi_trace_box_exit(ray.origin, ray.inv_dir, vec3(ray.cell), 1.0, t_exit);
    ray.t = max(ray.t, t_exit);
    ray.cell += sdfgi_trace_offset(signs, ray.axis);
}

/* Software drivers run what is under a condition for every thread. The walk through a cell and the way into
 * the next cascade, which few steps take, have loops of their own around that over steps: threads wait for
 * one another, and take them together. */
uint sdfgi_trace_march(sdfgi_trace_query query, inout sdfgi_trace_state ray)
{
    const ivec3 signs = sdfgi_trace_signs(ray.dir);
    uint end = SDFGI_TRACE_CAPPED;
    bool goes_on, walks;
    do {
        do {
            uint index = 0u;
            goes_on = walks = false;
            while (ray.steps < SDFGI_TRACE_STEP_CAP) {
                ray.steps++;
                if (sdfgi_trace_is_at_border(ray)) {
                    goes_on = sdfgi_trace_goes_on(query, ray);
                    end = goes_on ? end : SDFGI_TRACE_MISS;
                    break;
                }
                index = sdfgi_trace_cell_index(ray.volume, ray.cell);
                const float distance = sdfgi_stored_distance(index);
                const float step_length = min(sdfgi_trace_free_length(ray, distance), query.longest_step);
                const bool leaps = step_length > SDFGI_TRACE_MIN_STEP;
                walks = !leaps && distance < SDFGI_TRACE_OCCUPIED_DISTANCE;
                if (walks)
                    break;
                if (leaps)
                    sdfgi_trace_leap(step_length, ray);
                else
                    sdfgi_trace_leave_cell(signs, ray);
            }
            if (walks && sdfgi_trace_cross_cell(index, ray)) {
                end = sdfgi_trace_length(ray) >= query.range ? SDFGI_TRACE_MISS : SDFGI_TRACE_HIT;
                walks = false;
            }
            if (walks)
                ray.cell += sdfgi_trace_offset(signs, ray.axis);
        } while (walks);
        if (goes_on)
            sdfgi_trace_enter_coarser(query, ray);
    } while (goes_on);
    return end;
}

#else

/* The cell in which a ray is when it has left a box that begins at its cell. Rounding must not lead it past
 * the edges of the box. */
ivec3 sdfgi_trace_cell_after(ivec3 sides, bvec3 forward, sdfgi_trace_state ray)
{
    const ivec3 last = sides - ivec3(forward), beyond = sides - ivec3(not(forward)),
                cell = clamp(ivec3(floor(ray.origin + ray.dir * ray.t)), min(ray.cell, last),
                             max(ray.cell, last));
    return ivec3(ray.axis == 0 ? beyond.x : cell.x, ray.axis == 1 ? beyond.y : cell.y,
                 ray.axis == 2 ? beyond.z : cell.z);
}

/* Arithmetic is what GPUs spend most time on. So a cell with sub-voxels is crossed like a box of one cell:
 * all threads of a subgroup do the same then, but for the walk. An empty cell that holds no boxes yet is
 * crossed alone, as well. */
uint sdfgi_trace_march(sdfgi_trace_query query, inout sdfgi_trace_state ray)
{
    const bvec3 forward = greaterThan(ray.dir, vec3(0.0));
    const bool is_limited = query.longest_step < float(SDFGI_BOX_REACH);
    const int longest = int(min(query.longest_step, float(SDFGI_BOX_REACH)));
    for (int i = 0; i < SDFGI_TRACE_STEP_CAP; i++) {
        ray.steps++;
        if (sdfgi_trace_is_at_border(ray)) {
            if (!sdfgi_trace_goes_on(query, ray))
                return SDFGI_TRACE_MISS;
            sdfgi_trace_enter_coarser(query, ray);
            continue;
        }
        const uvec2 bits = sdfgi_bits_at(sdfgi_trace_cell_index(ray.volume, ray.cell));
        const bool has_boxes = sdfgi_has_boxes(bits);
        ivec3 box = sdfgi_box_sides(has_boxes ? bits : SDFGI_BOXES_OF_CELL, forward);
        if (is_limited)
            box = min(box, longest);
        const ivec3 sides = ray.cell + mix(1 - box, box, forward);
        float t_exit;
        const int exit_axis = sdfgi_trace_sides_exit(ray.origin, ray.inv_dir, vec3(sides), t_exit);
        t_exit = max(ray.t, t_exit);
        if (!has_boxes && sdfgi_trace_meets_subvoxel(bits, t_exit, ray))
            return sdfgi_trace_length(ray) >= query.range ? SDFGI_TRACE_MISS : SDFGI_TRACE_HIT;
        ray.axis = exit_axis;
        ray.t = min(t_exit, ray.border);
        ray.cell = sdfgi_trace_cell_after(sides, forward, ray);
    }
    return SDFGI_TRACE_CAPPED;
}

#endif

#endif
