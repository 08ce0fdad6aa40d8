/* SPDX-License-Identifier: MIT
 * Rays through the cascades, the light cells in front of what they hit, and what hosts and passes ask for.
 * How a ray finds what it hits: sdfgi_trace_march.glsl. */
#ifndef SDFGI_TRACE_GLSL
#define SDFGI_TRACE_GLSL

#include "sdfgi_trace_march.glsl"

struct sdfgi_trace_hit {
    bool hit;
    bool capped;   /* the ray ran out of steps, which counts as a hit */
    bool has_cell; /* `cell` is the light cell in front of the surface that was hit */
    uint cascade;
    ivec3 cell;     /* otherwise the occupied cell that was hit */
    ivec3 solid;    /* the occupied cell that was hit */
    uint axis;      /* of the face that was hit: 0 +x, 1 -x, 2 +y, 3 -y, 4 +z, 5 -z */
    float distance; /* cell widths of the cascade in which the ray began; the range if nothing was hit */
};

/* The cell of a hit counts from ray.base. */
sdfgi_trace_hit sdfgi_trace_result(sdfgi_trace_query query, sdfgi_trace_state ray, uint end)
{
    sdfgi_trace_hit result =
        sdfgi_trace_hit(false, false, false, ray.cascade, ivec3(0), ivec3(0), 0u, query.range);
    if (end != SDFGI_TRACE_MISS) {
        result.hit = true;
        result.distance = sdfgi_trace_length(ray);
        result.capped = end == SDFGI_TRACE_CAPPED;
    }
    if (end == SDFGI_TRACE_HIT) {
        result.axis = sdfgi_trace_face(ray.axis, ray.dir);
        result.cell = result.solid = ray.cell;
    }
    return result;
}

/* ---- The light cell in front of a hit */

bool sdfgi_trace_is_empty(uint cascade, ivec3 cell)
{
    return sdfgi_cell_is_valid(cascade, cell) && sdfgi_cell_is_empty(cascade, cell);
}

/* The path of a ray through the cascade in which it ended. */
struct sdfgi_trace_path {
    vec3 origin, inv_dir;
    ivec3 base;
    float start; /* parameter at which the ray began; below 0 if that was in a finer cascade */
};

/* Steps from a cell to the one through which the ray came, and returns the parameter at which it crossed from
 * one into the other. False if that is before the ray's beginning. */
bool sdfgi_trace_step_back(uint cascade, sdfgi_trace_path path, inout ivec3 cell, out float t)
{
    const int axis = sdfgi_trace_box_exit(path.origin, -path.inv_dir, vec3(cell), 1.0, t);
    t = -t;
    cell += sdfgi_trace_offset(sdfgi_trace_signs(-path.inv_dir), axis);
    return t >= path.start && sdfgi_cell_is_valid(cascade, cell + path.base);
}

/* Finds an empty neighbour of an occupied cell, on the side from which the ray came. No sub-voxel of the cell
 * may lie between that neighbour and the point `entry`, where the ray entered the cell. The neighbour along
 * the axis `first_axis` is tried first. */
bool sdfgi_trace_open_neighbour(uint cascade, sdfgi_trace_path path, ivec3 cell, vec3 entry, int first_axis,
                                out ivec3 neighbour)
{
    const ivec3 subvoxel = clamp(ivec3(floor(entry * 4.0)) - cell * SDFGI_SUBVOXELS, ivec3(0), ivec3(3));
    const uvec2 bits = sdfgi_cell_bits(cascade, cell + path.base);
    for (int i = int(SDFGI_FIRST); i < 3; i++) {
        const int k = (first_axis + i) % 3;
        const bool forward = path.inv_dir[k] > 0.0;
        ivec3 low = subvoxel, high = subvoxel;
        low[k] = forward ? 0 : subvoxel[k] + 1;
        high[k] = forward ? subvoxel[k] - 1 : 3;
        neighbour = cell;
        neighbour[k] += forward ? -1 : 1;
        const bool open =
            low[k] > high[k] || (bits & sdfgi_trace_box_bits(uvec3(low), uvec3(high))) == uvec2(0u);
        if (open && sdfgi_trace_is_empty(cascade, neighbour + path.base))
            return true;
    }
    return false;
}

/* The second search for the light cell of a hit, for a ray that began in a finer cascade and ran so close
 * along a wall that all its cells of this cascade are occupied: the first open neighbour of one of them,
 * going back. */
bool sdfgi_trace_light_cell_beside(uint cascade, sdfgi_trace_path path, int first_axis, inout ivec3 cell)
{
    bool more = true;
    for (int i = 0; more && i < SDFGI_TRACE_STEP_CAP; i++) {
        const ivec3 occupied = cell;
        float t;
        more = sdfgi_trace_step_back(cascade, path, cell, t);
        /* Before its beginning the ray's line may be on the other side of a wall. */
        const vec3 entry = path.origin + max(t, path.start) / path.inv_dir;
        ivec3 neighbour;
        if (sdfgi_trace_open_neighbour(cascade, path, occupied, entry, first_axis, neighbour)) {
            cell = neighbour;
            return true;
        }
    }
    return false;
}

/* Replaces the occupied cell of a hit by its light cell: the first empty cell that the ray passed, going back
 * from the hit. It shares a face with an occupied cell, and lies on the ray's side of a wall, however thin. A
 * step through a box may have crossed it, so the march cannot simply keep the last empty cell. */
bool sdfgi_trace_light_cell(uint cascade, sdfgi_trace_path path, int first_axis, inout ivec3 cell)
{
    const ivec3 hit = cell;
    float t;
    for (int i = 0; i < SDFGI_TRACE_STEP_CAP && sdfgi_trace_step_back(cascade, path, cell, t); i++)
        if (sdfgi_cell_is_empty(cascade, cell + path.base))
            return true;
    cell = hit;
    return sdfgi_trace_light_cell_beside(cascade, path, first_axis, cell);
}

/* ---- Rays */

/* The axis along which a ray leads farthest. */
int sdfgi_trace_main_axis(vec3 dir)
{
    const vec3 along = abs(dir);
    return along.x >= max(along.y, along.z) ? 0 : (along.y >= along.z ? 1 : 2);
}

/* What is hit, and where. `pos` is in the cell space of `cascade`; `range` in its cell widths. A ray that
 * begins in a set sub-voxel hits the face through which it would most likely have come. */
sdfgi_trace_hit sdfgi_trace_solid(uint cascade, uint last_cascade, vec3 pos, vec3 dir, float range)
{
    const sdfgi_trace_query query =
        sdfgi_trace_query(cascade, last_cascade, ivec3(0), pos, dir, range, 1e9, false);
    sdfgi_trace_state ray = sdfgi_trace_start(query);
    ray.axis = sdfgi_trace_main_axis(dir);
    const uint end = sdfgi_trace_march(query, ray);
    return sdfgi_trace_result(query, ray, end);
}

/* The same, with the light cell of the hit. */
sdfgi_trace_hit sdfgi_trace_ray(uint cascade, uint last_cascade, vec3 pos, vec3 dir, float range)
{
    const sdfgi_trace_query query =
        sdfgi_trace_query(cascade, last_cascade, ivec3(0), pos, dir, range, 1e9, true);
    sdfgi_trace_state ray = sdfgi_trace_start(query);
    const uint end = sdfgi_trace_march(query, ray);
    sdfgi_trace_hit result = sdfgi_trace_result(query, ray, end);
    if (end == SDFGI_TRACE_HIT) {
        const sdfgi_trace_path path =
            sdfgi_trace_path(ray.origin, ray.inv_dir, ray.base, -ray.travelled / ray.scale);
        result.has_cell = sdfgi_trace_light_cell(ray.cascade, path, ray.axis, result.cell);
        result.cell += ray.base;
        result.solid += ray.base;
    }
    return result;
}

/* Longest step, in cells, of rays whose results are kept while a cascade scrolls. What lies far from a ray
 * may have changed where nothing near it has; with longer steps that could change rounding. */
#define SDFGI_TRACE_STABLE_STEP 3.0

/* A ray through one cascade from `pos`, which counts from the cell `base`. The result depends only on cells
 * near the ray, and is the same wherever the cascade stands. */
sdfgi_trace_hit sdfgi_trace_stable(uint cascade, ivec3 base, vec3 pos, vec3 dir, float range)
{
    const sdfgi_trace_query query =
        sdfgi_trace_query(cascade, cascade, base, pos, dir, range, SDFGI_TRACE_STABLE_STEP, false);
    sdfgi_trace_state ray = sdfgi_trace_start(query);
    const uint end = sdfgi_trace_march(query, ray);
    return sdfgi_trace_result(query, ray, end);
}

/* True if no set sub-voxel lies between two points, which count from the cell `base`. Stable as above. */
bool sdfgi_trace_visible_from(uint cascade, ivec3 base, vec3 from, vec3 to)
{
    const vec3 offset = sdfgi_metric_from_cells(to - from);
    const float range = length(offset);
    return range < 1e-4 || !sdfgi_trace_stable(cascade, base, from, offset / range, range).hit;
}

/* True if no set sub-voxel lies between two points of a cascade's cell space. */
bool sdfgi_trace_visible(uint cascade, vec3 from, vec3 to)
{
    const vec3 offset = sdfgi_metric_from_cells(to - from);
    const float range = length(offset);
    return range < 1e-4 || !sdfgi_trace_solid(cascade, cascade, from, offset / range, range).hit;
}

#endif
