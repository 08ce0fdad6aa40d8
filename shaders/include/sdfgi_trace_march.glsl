/* SPDX-License-Identifier: MIT
 * The march from box to box and from cascade to cascade. The occupancy bits alone decide what a ray hits: in
 * cells that have some, it walks from sub-voxel to sub-voxel. What is empty it crosses in few steps, by the
 * empty boxes that begin where it is: shared/boxes.h. So a ray cannot slip through a wall, however thin. */
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

/* Which way a ray leads, and how many cells a step may cross at most. */
struct sdfgi_trace_way {
    bvec3 forward;
    int longest;
    bool is_limited; /* boxes may be longer */
};

sdfgi_trace_way sdfgi_trace_way_of(sdfgi_trace_query query, sdfgi_trace_state ray)
{
    return sdfgi_trace_way(greaterThan(ray.dir, vec3(0.0)),
                           int(min(query.longest_step, float(SDFGI_BOX_REACH))),
                           query.longest_step < float(SDFGI_BOX_REACH));
}

/* Where the sides lie by which a ray leaves the box that begins at its cell. A cell with sub-voxels, or
 * without boxes of its own, is a box. */
ivec3 sdfgi_trace_box(uvec2 bits, sdfgi_trace_way way, ivec3 cell)
{
    ivec3 box = sdfgi_box_sides(sdfgi_has_boxes(bits) ? bits : SDFGI_BOXES_OF_CELL, way.forward);
    if (way.is_limited)
        box = min(box, way.longest);
    return cell + mix(1 - box, box, way.forward);
}

/* Goes on to where a ray leaves a box with these sides. Rounding must not lead it past the edges of the box.
 */
void sdfgi_trace_leave_box(ivec3 sides, int exit_axis, float t_exit, bvec3 forward,
                           inout sdfgi_trace_state ray)
{
    ray.axis = exit_axis;
    ray.t = min(t_exit, ray.border);
    const ivec3 last = sides - ivec3(forward), beyond = sides - ivec3(not(forward)),
                cell = clamp(ivec3(floor(ray.origin + ray.dir * ray.t)), min(ray.cell, last),
                             max(ray.cell, last));
    ray.cell = ivec3(exit_axis == 0 ? beyond.x : cell.x, exit_axis == 1 ? beyond.y : cell.y,
                     exit_axis == 2 ? beyond.z : cell.z);
}

/* A ray that has met a sub-voxel may have gone farther than its range by then. */
uint sdfgi_trace_end(sdfgi_trace_query query, sdfgi_trace_state ray)
{
    return sdfgi_trace_length(ray) >= query.range ? SDFGI_TRACE_MISS : SDFGI_TRACE_HIT;
}

#ifdef SDFGI_SOFTWARE

/* Software drivers run what is under a condition for every thread. The walk through a cell and the way into
 * the next cascade, which few steps take, have loops of their own around that over steps: threads wait for
 * one another, and take them together. Steps and results are those of the loop for GPUs, which take longer in
 * this form. */
uint sdfgi_trace_march(sdfgi_trace_query query, inout sdfgi_trace_state ray)
{
    const sdfgi_trace_way way = sdfgi_trace_way_of(query, ray);
    uint end = SDFGI_TRACE_CAPPED;
    bool goes_on, walks;
    do {
        do {
            uvec2 bits = uvec2(0u);
            ivec3 sides = ivec3(0);
            int exit_axis = 0;
            float t_exit = 0.0;
            goes_on = walks = false;
            while (ray.steps < SDFGI_TRACE_STEP_CAP) {
                ray.steps++;
                if (sdfgi_trace_is_at_border(ray)) {
                    goes_on = sdfgi_trace_goes_on(query, ray);
                    end = goes_on ? end : SDFGI_TRACE_MISS;
                    break;
                }
                bits = sdfgi_bits_at(sdfgi_trace_cell_index(ray.volume, ray.cell));
                sides = sdfgi_trace_box(bits, way, ray.cell);
                exit_axis = sdfgi_trace_sides_exit(ray.origin, ray.inv_dir, vec3(sides), t_exit);
                t_exit = max(ray.t, t_exit);
                walks = !sdfgi_has_boxes(bits) && (bits.x | bits.y) != 0u;
                if (walks)
                    break;
                sdfgi_trace_leave_box(sides, exit_axis, t_exit, way.forward, ray);
            }
            if (walks && sdfgi_trace_meets_subvoxel(bits, t_exit, ray)) {
                end = sdfgi_trace_end(query, ray);
                walks = false;
            }
            if (walks)
                sdfgi_trace_leave_box(sides, exit_axis, t_exit, way.forward, ray);
        } while (walks);
        if (goes_on)
            sdfgi_trace_enter_coarser(query, ray);
    } while (goes_on);
    return end;
}

#else

/* Arithmetic is what GPUs spend most time on. So a cell with sub-voxels is crossed like a box of one cell:
 * all threads of a subgroup do the same then, but for the walk. */
uint sdfgi_trace_march(sdfgi_trace_query query, inout sdfgi_trace_state ray)
{
    const sdfgi_trace_way way = sdfgi_trace_way_of(query, ray);
    for (int i = 0; i < SDFGI_TRACE_STEP_CAP; i++) {
        ray.steps++;
        if (sdfgi_trace_is_at_border(ray)) {
            if (!sdfgi_trace_goes_on(query, ray))
                return SDFGI_TRACE_MISS;
            sdfgi_trace_enter_coarser(query, ray);
            continue;
        }
        const uvec2 bits = sdfgi_bits_at(sdfgi_trace_cell_index(ray.volume, ray.cell));
        const ivec3 sides = sdfgi_trace_box(bits, way, ray.cell);
        float t_exit;
        const int exit_axis = sdfgi_trace_sides_exit(ray.origin, ray.inv_dir, vec3(sides), t_exit);
        t_exit = max(ray.t, t_exit);
        if (!sdfgi_has_boxes(bits) && sdfgi_trace_meets_subvoxel(bits, t_exit, ray))
            return sdfgi_trace_end(query, ray);
        sdfgi_trace_leave_box(sides, exit_axis, t_exit, way.forward, ray);
    }
    return SDFGI_TRACE_CAPPED;
}

#endif

#endif
