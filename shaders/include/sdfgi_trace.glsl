/* SPDX-License-Identifier: MIT
 * Rays through the cascades. Empty space is crossed by the distance field (Hart 1996, "Sphere tracing"), but hits are
 * decided by the solid bits alone: a walk from sub-voxel to sub-voxel (Amanatides and Woo 1987). Distances are read at
 * cell centres and never interpolated, so no wall is thin enough to slip through. */
#ifndef SDFGI_TRACE_GLSL
#define SDFGI_TRACE_GLSL

#include "sdfgi_space.glsl"

struct trace_hit {
    bool hit;
    bool capped;     /* ran out of steps: counted as a hit */
    bool has_cell;   /* cell is an empty cell next to the surface that was hit */
    uint cascade;
    ivec3 cell;
    uint axis;       /* of the face that was hit: 0 +x, 1 -x, 2 +y, 3 -y, 4 +z, 5 -z */
    float distance;  /* cell widths of the cascade in which the ray started */
};

/* Distances are between centres: from the nearest sub-voxel's centre to its corner it is at most sqrt(3) / 8, and the
 * flood may overstep by 0.1. */
#define TRACE_MARGIN 0.32
/* Shorter steps than this are not worth leaving the cell walk for. */
#define TRACE_MIN_STEP 0.5

/* Sub-voxels by which rounding may misplace a ray that runs exactly through an edge. */
#define TRACE_EDGE 0.00025

bool trace_bit(uvec2 bits, ivec3 sub)
{
    const uint shift = uint(sub.x + 4 * sub.y + 16 * (sub.z & 1));
    return ((sub.z < 2 ? bits.x : bits.y) >> shift & 1u) != 0u;
}

/* Axis along which the ray leaves the box [low, low + size] and the parameter where it does. */
int trace_exit(vec3 origin, vec3 inv_dir, vec3 low, float size, out float t)
{
    const vec3 far = (low + size * vec3(greaterThan(inv_dir, vec3(0.0))) - origin) * inv_dir;
    t = min(far.x, min(far.y, far.z));
    return far.x <= t ? 0 : (far.y <= t ? 1 : 2);
}

uint trace_face(int axis, vec3 dir)
{
    return uint(2 * axis) + (dir[axis] > 0.0 ? 1u : 0u);
}

/* Walks the sub-voxels of one cell from parameter t. Returns true at a set one; else t and axis tell where it left. */
bool trace_cell(uvec2 bits, ivec3 cell, vec3 origin, vec3 dir, vec3 inv_dir, inout float t, inout int axis)
{
    const ivec3 low = cell * SDFGI_SUBVOXELS;
    const ivec3 forward = ivec3(greaterThan(dir, vec3(0.0)));
    /* A ray that enters through an edge of sub-voxels still visits those beside it: it starts a little behind, as a step
     * across an edge would pass between two that only touch there. */
    const vec3 behind = t > 0.0 ? sign(dir) * TRACE_EDGE : vec3(0.0);
    ivec3 sub = clamp(ivec3(floor((origin + dir * t) * 4.0 - behind)) - low, ivec3(0), ivec3(3));
    vec3 next = ((vec3(low + sub + forward) * 0.25) - origin) * inv_dir;
    const vec3 delta = abs(inv_dir) * 0.25;
    for (int i = 0; i < 3 * SDFGI_SUBVOXELS; i++) {
        if (trace_bit(bits, sub))
            return true;
        axis = next.x <= next.y ? (next.x <= next.z ? 0 : 2) : (next.y <= next.z ? 1 : 2);
        t = max(t, next[axis]);
        sub[axis] += forward[axis] * 2 - 1;
        next[axis] += delta[axis];
        if (sub[axis] < 0 || sub[axis] >= SDFGI_SUBVOXELS)
            return false;
    }
    return false;
}

bool trace_is_light_cell(uint cascade, ivec3 cell)
{
    return cell_served(cascade, cell) && (sdfgi_light[cell_index(cascade, cell)].y & SDFGI_LIGHT_VALID) != 0u;
}

/* The light cell of a hit: from the cell that was hit back along the ray to the first empty one. That shares a face with an
 * occupied one, and is on the ray's side of however thin a wall. Steps of the distance field may have passed over it. `first`
 * is the parameter at which the ray began, below 0 if it did in a finer cascade. */
bool trace_light_cell(uint cascade, ivec3 base, vec3 origin, vec3 inv_dir, float first, inout ivec3 cell)
{
    const ivec3 backward = ivec3(lessThan(inv_dir, vec3(0.0))) * 2 - 1;
    for (int i = 0; i < SDFGI_TRACE_STEP_CAP; i++) {
        float back;
        const int axis = trace_exit(origin, -inv_dir, vec3(cell), 1.0, back);
        cell[axis] += backward[axis];
        if (-back < first || !cell_served(cascade, cell + base))
            return false;
        if (cell_bits(cascade, cell + base) == uvec2(0u))
            return true;
    }
    return false;
}

/* Parameter at which a ray leaves the cells of a cascade that may be read; below 0 if it starts beyond them. */
float trace_leave(uint cascade, ivec3 base, vec3 origin, vec3 inv_dir)
{
    const vec3 low = vec3(sdfgi_frame.cascades[cascade].window_low.xyz - base);
    const vec3 high = vec3(sdfgi_frame.cascades[cascade].window_high.xyz - base);
    const vec3 far = (mix(low, high, greaterThan(inv_dir, vec3(0.0))) - origin) * inv_dir;
    return min(far.x, min(far.y, far.z));
}

/* Follows a ray from `pos` for at most `range` cell widths of its cascade, walking on into coarser cascades up to
 * `last_cascade`. `pos` and all cells in the first cascade count from the cell `base`, so that rounding can be made the same
 * wherever a cascade stands; no step is longer than `longest` cells. */
trace_hit trace_from(uint cascade, uint last_cascade, ivec3 base, vec3 pos, vec3 dir, float range, float longest)
{
    trace_hit result = trace_hit(false, false, false, cascade, ivec3(0), 0u, range);
    vec3 dir_cell = cells_from_metric(dir);
    dir_cell = mix(dir_cell, vec3(1e-20), lessThan(abs(dir_cell), vec3(1e-20)));
    const vec3 inv_dir = 1.0 / dir_cell;

    vec3 origin = pos;
    float t = 0.0;
    float scale = 1.0;     /* cell widths of the first cascade per cell width of this one */
    float travelled = 0.0; /* before `origin`, in the first cascade's cell widths */
    float leave = trace_leave(cascade, base, origin, inv_dir);
    bool left = false;
    ivec3 cell = ivec3(floor(origin));
    int axis = 0;

    for (int i = 0; i < SDFGI_TRACE_STEP_CAP; i++) {
        if (travelled + t * scale >= range)
            return result;

        /* Leave for the next coarser cascade, or for the sky. */
        if (left || !cell_served(cascade, cell + base)) {
            if (cascade >= last_cascade)
                return result;
            travelled += t * scale;
            const vec3 first = first_from_cascade(cascade, origin + dir_cell * t + vec3(base));
            cascade += 1u;
            scale *= 2.0;
            base = ivec3(0);
            origin = cascade_from_first(cascade, first);
            t = 0.0;
            leave = trace_leave(cascade, base, origin, inv_dir);
            left = false;
            cell = ivec3(floor(origin));
            continue;
        }

        const float distance = cell_distance(cascade, cell + base);
        const vec3 here = origin + dir_cell * t;
        const float free = min(distance - length(metric_from_cells(here - vec3(cell) - 0.5)) - TRACE_MARGIN, longest);
        if (free > TRACE_MIN_STEP) {
            /* The distance knows nothing of what lies beyond the cascade: no step leads further than its border. */
            t = min(t + free, leave);
            left = t >= leave;
            cell = ivec3(floor(origin + dir_cell * t));
            continue;
        }

        /* Cells whose nearest sub-voxel is further than half their diagonal have none of their own. */
        const uvec2 bits = distance < 1.0 ? cell_bits(cascade, cell + base) : uvec2(0u);
        if (bits == uvec2(0u)) {
            float t_exit;
            axis = trace_exit(origin, inv_dir, vec3(cell), 1.0, t_exit);
            t = max(t, t_exit);
        } else if (trace_cell(bits, cell, origin, dir_cell, inv_dir, t, axis)) {
            result.distance = travelled + t * scale;
            if (result.distance >= range)
                return trace_hit(false, false, false, cascade, ivec3(0), 0u, range);
            result.hit = true;
            result.cascade = cascade;
            result.axis = trace_face(axis, dir_cell);
            result.has_cell = trace_light_cell(cascade, base, origin, inv_dir, -travelled / scale, cell);
            result.cell = cell + base;
            return result;
        }
        cell[axis] += dir_cell[axis] > 0.0 ? 1 : -1;
    }
    result.hit = true;
    result.capped = true;
    result.cascade = cascade;
    result.distance = travelled + t * scale;
    return result;
}

/* The same from `pos` in cell space of `cascade`. */
trace_hit trace_ray(uint cascade, uint last_cascade, vec3 pos, vec3 dir, float range)
{
    return trace_from(cascade, last_cascade, ivec3(0), pos, dir, range, 1e9);
}

/* Longest step, in cells, of rays whose outcome is kept while a cascade scrolls: distances further off may have changed where
 * nothing near has, and with them the rounding of steps. */
#define TRACE_KEPT_STEP 3.0

/* True if no set sub-voxel lies between two points, which count from the cell `base`: the same at the same place, wherever
 * the cascade stands. */
bool trace_visible_from(uint cascade, ivec3 base, vec3 from, vec3 to)
{
    const vec3 way = metric_from_cells(to - from);
    const float range = length(way);
    return range < 1e-4 || !trace_from(cascade, cascade, base, from, way / range, range, TRACE_KEPT_STEP).hit;
}

/* True if no set sub-voxel lies between two points of a cascade's cell space. */
bool trace_visible(uint cascade, vec3 from, vec3 to)
{
    const vec3 way = metric_from_cells(to - from);
    const float range = length(way);
    return range < 1e-4 || !trace_ray(cascade, cascade, from, way / range, range).hit;
}

#endif
