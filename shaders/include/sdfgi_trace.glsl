/* SPDX-License-Identifier: MIT
 * Rays through the cascades. Empty space is crossed by the distance field (Hart 1996, "Sphere tracing"), but
 * hits are decided by the solid bits alone: a walk from sub-voxel to sub-voxel (Amanatides and Woo 1987).
 * Distances are read at cell centres and never interpolated, so no wall is thin enough to slip through. */
#ifndef SDFGI_TRACE_GLSL
#define SDFGI_TRACE_GLSL

#include "sdfgi_space.glsl"

struct sdfgi_trace_hit {
    bool hit;
    bool capped;   /* ran out of steps: counted as a hit */
    bool has_cell; /* cell is an empty cell next to the surface that was hit */
    uint cascade;
    ivec3 cell;
    uint axis;      /* of the face that was hit: 0 +x, 1 -x, 2 +y, 3 -y, 4 +z, 5 -z */
    float distance; /* cell widths of the cascade in which the ray started */
};

/* Distances are between centres: from the nearest sub-voxel's centre to its corner it is at most sqrt(3) / 8,
 * and the flood may overstep by 0.1. */
#define SDFGI_TRACE_MARGIN 0.32
/* A cell with sub-voxels of its own has one this near, flood included: sqrt(3) 3 / 8 and 0.1. */
#define SDFGI_TRACE_OWN 0.75
/* Shorter steps than this are not worth leaving the cell walk for. */
#define SDFGI_TRACE_MIN_STEP 0.5

/* Sub-voxels by which rounding may misplace a ray that runs exactly through an edge. */
#define SDFGI_TRACE_EDGE 0.00025

/* Place of a sub-voxel in its cell, a byte per coordinate. One step out of the cell sets the third bit of a
 * byte. */
uint sdfgi_trace_pack_sub(ivec3 sub)
{
    return uint(sub.x | sub.y << 8 | sub.z << 16);
}

const uint SDFGI_TRACE_SUB_OUTSIDE = 0x040404u;

bool sdfgi_trace_bit(uvec2 bits, uint sub)
{
    const uint shift = (sub & 3u) | (sub >> 6u & 12u) | (sub >> 12u & 16u);
    return (((sub & 0x20000u) == 0u ? bits.x : bits.y) >> shift & 1u) != 0u;
}

/* Axis along which the ray leaves the box [low, low + size] and the parameter where it does. */
int sdfgi_trace_exit(vec3 origin, vec3 inv_dir, vec3 low, float size, out float t)
{
    const vec3 far = (low + size * vec3(greaterThan(inv_dir, vec3(0.0))) - origin) * inv_dir;
    t = min(far.x, min(far.y, far.z));
    return far.x <= t ? 0 : (far.y <= t ? 1 : 2);
}

/* A vector's component. Indexed by what differs between threads, vectors go through memory. */
float sdfgi_trace_along(vec3 v, int axis)
{
    return axis == 0 ? v.x : (axis == 1 ? v.y : v.z);
}

/* The signs of a direction. */
ivec3 sdfgi_trace_forward(vec3 dir)
{
    return 2 * ivec3(greaterThan(dir, vec3(0.0))) - 1;
}

/* The way to the next cell along an axis. */
ivec3 sdfgi_trace_step(ivec3 forward, int axis)
{
    return ivec3(axis == 0, axis == 1, axis == 2) * forward;
}

uint sdfgi_trace_face(int axis, vec3 dir)
{
    return uint(2 * axis) + (sdfgi_trace_along(dir, axis) > 0.0 ? 1u : 0u);
}

/* Walks the sub-voxels of one cell from parameter t. Returns true at a set one; else t and axis tell where it
 * left. Others of a subgroup wait for this: no operation needs an index. */
bool sdfgi_trace_cell(uvec2 bits, ivec3 cell, vec3 origin, vec3 dir, vec3 inv_dir, inout float t,
                      inout int axis)
{
    const ivec3 low = cell * SDFGI_SUBVOXELS;
    const ivec3 forward = ivec3(greaterThan(dir, vec3(0.0)));
    /* A ray that enters through an edge of sub-voxels still visits those beside it: it starts a little
     * behind, as a step across an edge would pass between two that only touch there. */
    const vec3 behind = t > 0.0 ? sign(dir) * SDFGI_TRACE_EDGE : vec3(0.0);
    const ivec3 first = clamp(ivec3(floor((origin + dir * t) * 4.0 - behind)) - low, ivec3(0), ivec3(3));
    vec3 next = ((vec3(low + first + forward) * 0.25) - origin) * inv_dir;
    const vec3 delta = abs(inv_dir) * 0.25;
    const ivec3 step = (forward * 2 - 1) * ivec3(1, 1 << 8, 1 << 16);
    uint sub = sdfgi_trace_pack_sub(first);
    for (int i = 0; i < 3 * SDFGI_SUBVOXELS; i++) {
        if (sdfgi_trace_bit(bits, sub))
            return true;
        const bool x = next.x <= min(next.y, next.z), y = !x && next.y <= next.z;
        t = max(t, x ? next.x : (y ? next.y : next.z));
        axis = x ? 0 : (y ? 1 : 2);
        sub += uint(x ? step.x : (y ? step.y : step.z));
        next.x += x ? delta.x : 0.0;
        next.y += y ? delta.y : 0.0;
        next.z += x || y ? 0.0 : delta.z;
        if ((sub & SDFGI_TRACE_SUB_OUTSIDE) != 0u)
            return false;
    }
    return false;
}

/* Sub-voxels [low, high] of a cell, as bits. */
uvec2 sdfgi_trace_box_bits(uvec3 low, uvec3 high)
{
    const uint row = (15u << low.x) & (15u >> 3u - high.x);
    const uint slice = row * 0x1111u & (0xffffu << 4u * low.y) & (0xffffu >> 4u * (3u - high.y));
    const uint slices = (15u << low.z) & (15u >> 3u - high.z);
    return slice * uvec2((slices & 1u) | (slices & 2u) << 15u, (slices >> 2u & 1u) | (slices & 8u) << 13u);
}

/* The sub-voxels of a cell that a ray may come by from parameter t until it leaves the cell: those in the box
 * around its way. */
uvec2 sdfgi_trace_near(ivec3 cell, vec3 origin, vec3 dir, float t, float t_exit)
{
    const vec3 edge = sign(dir) * SDFGI_TRACE_EDGE, low = vec3(cell * SDFGI_SUBVOXELS);
    const vec3 from = clamp((origin + dir * t) * 4.0 - edge - low, 0.0, 3.0);
    const vec3 to = clamp((origin + dir * t_exit) * 4.0 + edge - low, 0.0, 3.0);
    return sdfgi_trace_box_bits(uvec3(min(from, to)), uvec3(max(from, to)));
}

/* What it takes to find the cells of a cascade, which count from `base`: which are served, and where they are
 * stored. Loaded once per ray and cascade, not once per step. */
struct sdfgi_trace_volume {
    ivec3 low, high, wrap;
    uint first;
};

sdfgi_trace_volume sdfgi_trace_volume_of(uint cascade, ivec3 base)
{
    return sdfgi_trace_volume(
        sdfgi_frame.cascades[cascade].valid_low - base, sdfgi_frame.cascades[cascade].valid_high - base,
        sdfgi_frame.cascades[cascade].wrap + base, cascade << (3u * sdfgi_frame.resolution_log2));
}

bool sdfgi_trace_serves(sdfgi_trace_volume volume, ivec3 cell)
{
    return all(greaterThanEqual(cell, volume.low)) && all(lessThan(cell, volume.high));
}

uint sdfgi_trace_index(sdfgi_trace_volume volume, ivec3 cell)
{
    return sdfgi_texel_index(uvec3(cell + volume.wrap) & (sdfgi_frame.resolution - 1u)) | volume.first;
}

/* From parameter t to where a ray leaves a cell or, returning true, hits a sub-voxel in it. The cell is
 * stored at `index`, `distance` is its distance. */
bool sdfgi_trace_through(uint index, ivec3 cell, float distance, vec3 origin, vec3 dir, vec3 inv_dir,
                         inout float t, inout int axis)
{
    float t_exit;
    const int exit_axis = sdfgi_trace_exit(origin, inv_dir, vec3(cell), 1.0, t_exit);
    t_exit = max(t, t_exit);
    uvec2 bits = uvec2(0u);
    if (distance < SDFGI_TRACE_OWN)
        bits = sdfgi_bits[index] & sdfgi_trace_near(cell, origin, dir, t, t_exit);
    if (bits != uvec2(0u))
        return sdfgi_trace_cell(bits, cell, origin, dir, inv_dir, t, axis);
    axis = exit_axis;
    t = t_exit;
    return false;
}

bool sdfgi_trace_is_light_cell(uint cascade, ivec3 cell)
{
    return sdfgi_cell_is_valid(cascade, cell) &&
           (sdfgi_light[sdfgi_cell_index(cascade, cell)].y & SDFGI_LIGHT_VALID) != 0u;
}

bool sdfgi_trace_is_empty(uint cascade, ivec3 cell)
{
    return sdfgi_cell_is_valid(cascade, cell) && sdfgi_cell_bits(cascade, cell) == uvec2(0u);
}

/* How a ray went through the cascade in which it ended: where it began there, in cells from `base`, at
 * parameter 0, and the parameter at which it had begun, below 0 if in a finer cascade. */
struct sdfgi_trace_path {
    vec3 origin, inv_dir;
    ivec3 base;
    float first;
};

/* From a cell to the one through which the ray came, and the parameter at which it did. False before the
 * ray's beginning. */
bool sdfgi_trace_step_back(uint cascade, sdfgi_trace_path way, inout ivec3 cell, out float t)
{
    const int axis = sdfgi_trace_exit(way.origin, -way.inv_dir, vec3(cell), 1.0, t);
    t = -t;
    cell += sdfgi_trace_step(sdfgi_trace_forward(-way.inv_dir), axis);
    return t >= way.first && sdfgi_cell_is_valid(cascade, cell + way.base);
}

/* An empty cell beside an occupied one, on the side from which the ray came that entered it at `here`, with
 * nothing of what is in the cell between the two; along `face` if there. */
bool sdfgi_trace_beside(uint cascade, sdfgi_trace_path way, ivec3 cell, vec3 here, int face, out ivec3 beside)
{
    const ivec3 sub = clamp(ivec3(floor(here * 4.0)) - cell * SDFGI_SUBVOXELS, ivec3(0), ivec3(3));
    const uvec2 bits = sdfgi_cell_bits(cascade, cell + way.base);
    for (int i = 0; i < 3; i++) {
        const int k = (face + i) % 3;
        const bool forward = way.inv_dir[k] > 0.0;
        ivec3 low = sub, high = sub;
        low[k] = forward ? 0 : sub[k] + 1;
        high[k] = forward ? sub[k] - 1 : 3;
        beside = cell;
        beside[k] += forward ? -1 : 1;
        const bool open =
            low[k] > high[k] || (bits & sdfgi_trace_box_bits(uvec3(low), uvec3(high))) == uvec2(0u);
        if (open && sdfgi_trace_is_empty(cascade, beside + way.base))
            return true;
    }
    return false;
}

/* The light cell of a hit where a ray that began in a finer cascade came so close along a wall that all its
 * cells of this one are occupied: the first beside them. */
bool sdfgi_trace_cell_along(uint cascade, sdfgi_trace_path way, int face, inout ivec3 cell)
{
    bool more = true;
    for (int i = 0; more && i < SDFGI_TRACE_STEP_CAP; i++) {
        const ivec3 occupied = cell;
        float t;
        more = sdfgi_trace_step_back(cascade, way, cell, t);
        ivec3 beside;
        /* Before the ray's beginning there may be another side of a wall. */
        if (sdfgi_trace_beside(cascade, way, occupied, way.origin + max(t, way.first) / way.inv_dir, face,
                               beside)) {
            cell = beside;
            return true;
        }
    }
    return false;
}

/* The light cell of a hit: from the cell that was hit back along the ray to the first empty one. That shares
 * a face with an occupied one, and is on the ray's side of however thin a wall. Steps of the distance field
 * may have passed over it. */
bool sdfgi_trace_light_cell(uint cascade, sdfgi_trace_path way, int face, inout ivec3 cell)
{
    const ivec3 hit = cell;
    float t;
    for (int i = 0; i < SDFGI_TRACE_STEP_CAP && sdfgi_trace_step_back(cascade, way, cell, t); i++)
        if (sdfgi_cell_bits(cascade, cell + way.base) == uvec2(0u))
            return true;
    cell = hit;
    return sdfgi_trace_cell_along(cascade, way, face, cell);
}

/* Parameter at which a ray leaves the cells of a cascade that may be read; below 0 if it starts beyond them.
 */
float sdfgi_trace_leave(sdfgi_trace_volume volume, vec3 origin, vec3 inv_dir)
{
    const vec3 far =
        (mix(vec3(volume.low), vec3(volume.high), greaterThan(inv_dir, vec3(0.0))) - origin) * inv_dir;
    return min(far.x, min(far.y, far.z));
}

/* Follows a ray from `pos` for at most `range` cell widths of its cascade, walking on into coarser cascades
 * up to `last_cascade`. `pos` and all cells in the first cascade count from the cell `base`, so that rounding
 * can be made the same wherever a cascade stands; no step is longer than `longest` cells. The cell of the
 * result is the occupied one that was hit, counted from way.base. */
sdfgi_trace_hit sdfgi_trace_from(uint cascade, uint last_cascade, ivec3 base, vec3 pos, vec3 dir, float range,
                                 float longest, out sdfgi_trace_path way)
{
    sdfgi_trace_hit result = sdfgi_trace_hit(false, false, false, cascade, ivec3(0), 0u, range);
    vec3 dir_cell = sdfgi_cells_from_metric(dir);
    dir_cell = mix(dir_cell, vec3(1e-20), lessThan(abs(dir_cell), vec3(1e-20)));
    const vec3 inv_dir = 1.0 / dir_cell;

    vec3 origin = pos;
    float t = 0.0;
    float scale = 1.0;     /* cell widths of the first cascade per cell width of this one */
    float travelled = 0.0; /* before `origin`, in the first cascade's cell widths */
    sdfgi_trace_volume volume = sdfgi_trace_volume_of(cascade, base);
    float leave = sdfgi_trace_leave(volume, origin, inv_dir);
    bool left = false;
    const ivec3 forward = sdfgi_trace_forward(dir_cell);
    ivec3 cell = ivec3(floor(origin));
    int axis = 0;

    for (int i = 0; i < SDFGI_TRACE_STEP_CAP; i++) {
        if (travelled + t * scale >= range)
            return result;

        /* Leave for the next coarser cascade, or for the sky. */
        if (left || !sdfgi_trace_serves(volume, cell)) {
            if (cascade >= last_cascade)
                return result;
            travelled += t * scale;
            const vec3 first = sdfgi_first_from_cascade(cascade, origin + dir_cell * t + vec3(base));
            cascade += 1u;
            scale *= 2.0;
            base = ivec3(0);
            origin = sdfgi_cascade_from_first(cascade, first);
            t = 0.0;
            volume = sdfgi_trace_volume_of(cascade, base);
            leave = sdfgi_trace_leave(volume, origin, inv_dir);
            left = false;
            cell = ivec3(floor(origin));
            continue;
        }

        const uint index = sdfgi_trace_index(volume, cell);
        const float distance = sdfgi_stored_distance(index);
        const vec3 here = origin + dir_cell * t;
        const float free =
            min(distance - length(sdfgi_metric_from_cells(here - vec3(cell) - 0.5)) - SDFGI_TRACE_MARGIN,
                longest);
        if (free > SDFGI_TRACE_MIN_STEP) {
            /* The distance knows nothing of what lies beyond the cascade: no step leads further than its
             * border. */
            t = min(t + free, leave);
            left = t >= leave;
            cell = ivec3(floor(origin + dir_cell * t));
            continue;
        }

        if (sdfgi_trace_through(index, cell, distance, origin, dir_cell, inv_dir, t, axis)) {
            result.distance = travelled + t * scale;
            if (result.distance >= range)
                return sdfgi_trace_hit(false, false, false, cascade, ivec3(0), 0u, range);
            result.hit = true;
            result.cascade = cascade;
            result.axis = sdfgi_trace_face(axis, dir_cell);
            result.cell = cell;
            way = sdfgi_trace_path(origin, inv_dir, base, -travelled / scale);
            return result;
        }
        cell += sdfgi_trace_step(forward, axis);
    }
    result.hit = true;
    result.capped = true;
    result.cascade = cascade;
    result.distance = travelled + t * scale;
    return result;
}

/* The same from `pos` in cell space of `cascade`: what is hit, and where. */
sdfgi_trace_hit sdfgi_trace_solid(uint cascade, uint last_cascade, vec3 pos, vec3 dir, float range)
{
    sdfgi_trace_path unused;
    return sdfgi_trace_from(cascade, last_cascade, ivec3(0), pos, dir, range, 1e9, unused);
}

/* With the light cell of the hit. */
sdfgi_trace_hit sdfgi_trace_ray(uint cascade, uint last_cascade, vec3 pos, vec3 dir, float range)
{
    sdfgi_trace_path way;
    sdfgi_trace_hit result = sdfgi_trace_from(cascade, last_cascade, ivec3(0), pos, dir, range, 1e9, way);
    if (result.hit && !result.capped) {
        result.has_cell = sdfgi_trace_light_cell(result.cascade, way, int(result.axis >> 1u), result.cell);
        result.cell += way.base;
    }
    return result;
}

/* Longest step, in cells, of rays whose results are kept while a cascade scrolls. Distances far from a ray
 * may have changed where nothing near it has; longer steps would let them change the rounding of the result.
 */
#define SDFGI_TRACE_STABLE_STEP 3.0

/* A ray through one cascade from `pos`, which counts from the cell `base`. The result depends only on cells
 * near the ray, and is the same wherever the cascade stands. */
sdfgi_trace_hit sdfgi_trace_stable(uint cascade, ivec3 base, vec3 pos, vec3 dir, float range)
{
    sdfgi_trace_path unused;
    return sdfgi_trace_from(cascade, cascade, base, pos, dir, range, SDFGI_TRACE_STABLE_STEP, unused);
}

/* True if no set sub-voxel lies between two points, which count from the cell `base`: the same at the same
 * place, wherever the cascade stands. */
bool sdfgi_trace_visible_from(uint cascade, ivec3 base, vec3 from, vec3 to)
{
    const vec3 offset = sdfgi_metric_from_cells(to - from);
    const float range = length(offset);
    return range < 1e-4 || !sdfgi_trace_stable(cascade, base, from, offset / range, range).hit;
}

/* True if no set sub-voxel lies between two points of a cascade's cell space. */
bool sdfgi_trace_visible(uint cascade, vec3 from, vec3 to)
{
    const vec3 way = sdfgi_metric_from_cells(to - from);
    const float range = length(way);
    return range < 1e-4 || !sdfgi_trace_solid(cascade, cascade, from, way / range, range).hit;
}

#endif
