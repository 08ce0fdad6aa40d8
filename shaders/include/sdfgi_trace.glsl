/* SPDX-License-Identifier: MIT
 * Rays through the cascades. The distance field crosses empty space (Hart 1996, "Sphere tracing"), but the
 * occupancy bits alone decide what a ray hits: near a surface the ray walks from sub-voxel to sub-voxel
 * (Amanatides and Woo 1987). Distances are read at cell centres and never interpolated, so a ray cannot slip
 * through a wall, however thin.
 *
 * A ray's parameter t counts cell widths of the cascade that it crosses, from where it entered it. */
#ifndef SDFGI_TRACE_GLSL
#define SDFGI_TRACE_GLSL

#include "sdfgi_space.glsl"
#include "sdfgi_trace_cell.glsl"

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

/* A cell with a greater stored distance has no sub-voxel of its own: sqrt(3) 3 / 8, rounded up. */
#define SDFGI_TRACE_OCCUPIED_DISTANCE 0.65
/* Walking through a cell is cheaper than a step of the distance field that is shorter than this. */
#define SDFGI_TRACE_MIN_STEP 0.5

/* ---- The march from cell to cell and from cascade to cascade */

/* What a ray needs to find the cells of a cascade. A ray loads this once per cascade, not once per step. */
struct sdfgi_trace_volume {
    ivec3 wrap; /* texel of the ray's base cell */
    uint first; /* index of the cascade's first cell */
};

sdfgi_trace_volume sdfgi_trace_volume_of(uint cascade, ivec3 base)
{
    return sdfgi_trace_volume(sdfgi_frame.cascades[cascade].wrap + base,
                              cascade << (3u * sdfgi_frame.resolution_log2));
}

uint sdfgi_trace_cell_index(sdfgi_trace_volume volume, ivec3 cell)
{
    return sdfgi_texel_index(uvec3(cell + volume.wrap) & (sdfgi_frame.resolution - 1u)) | volume.first;
}

/* The parameter at which a ray that begins in the valid region leaves it. `origin` counts from `base`. */
float sdfgi_trace_border(uint cascade, ivec3 base, vec3 origin, vec3 inv_dir)
{
    const vec3 low = vec3(sdfgi_frame.cascades[cascade].valid_low - base),
               high = vec3(sdfgi_frame.cascades[cascade].valid_high - base),
               far = (mix(low, high, greaterThan(inv_dir, vec3(0.0))) - origin) * inv_dir;
    return min(far.x, min(far.y, far.z));
}

/* What to trace. Positions and cells in the first cascade count from the cell `base`: rounding is then the
 * same wherever the cascade stands. */
struct sdfgi_trace_query {
    uint cascade, last_cascade; /* where the ray begins, and the coarsest cascade that it may enter */
    ivec3 base;
    vec3 pos;           /* in cells */
    vec3 dir;           /* metric, of length 1 */
    float range;        /* in cell widths of the first cascade */
    float longest_step; /* cells that one step of the distance field may cross at most */
    bool skips_empty;   /* the ray goes straight to the box around all geometry */
};

/* The state of a ray during the march. */
struct sdfgi_trace_state {
    vec3 dir, inv_dir; /* in cells per cell width; no component of dir is 0 */
    float scale;       /* cell widths of the first cascade per cell width of this one */
    float travelled;   /* in all finer cascades, in cell widths of the first */
    uint cascade;
    ivec3 base;
    sdfgi_trace_volume volume;
    vec3 origin;  /* where the ray entered this cascade, in cells from `base`: t = 0 */
    float border; /* parameter at which nothing is left for it in this cascade; the cell counts before it */
    float t;
    ivec3 cell; /* that holds the ray at t */
    int axis;   /* along which the ray entered the cell or the sub-voxel, if it walked there */
    uint steps; /* of the march */
};

/* Length of a ray so far, in cell widths of the first cascade. */
float sdfgi_trace_length(sdfgi_trace_state ray)
{
    return ray.travelled + ray.t * ray.scale;
}

/* A ray that begins beyond the valid region finds nothing in this cascade. One that crosses cells up to the
 * border is there exactly when it leaves the region: both parameters are computed alike. */
void sdfgi_trace_enter_cascade(uint cascade, ivec3 base, vec3 origin, float range,
                               inout sdfgi_trace_state ray)
{
    ray.cascade = cascade;
    ray.base = base;
    ray.origin = origin;
    ray.t = 0.0;
    ray.volume = sdfgi_trace_volume_of(cascade, base);
    /* A ray that begins on the far face of the valid region, as those of probes there do, and leads back into
     * it begins in the last cell. */
    ray.cell =
        ivec3(floor(origin)) - ivec3(equal(origin, vec3(sdfgi_frame.cascades[cascade].valid_high - base))) *
                                   ivec3(lessThan(ray.dir, vec3(0.0)));
    const float border =
        min(sdfgi_trace_border(cascade, base, origin, ray.inv_dir), (range - ray.travelled) / ray.scale);
    ray.border = sdfgi_cell_is_valid(cascade, ray.cell + base) ? border : 0.0;
}

/* Distances do not include what lies beyond the cascade, so no step leads further than the border. Rounding
 * could put a place just before the border beyond it. */
void sdfgi_trace_leap(float step_length, inout sdfgi_trace_state ray)
{
    const float t = ray.t + step_length;
    ray.t = t < ray.border - SDFGI_TRACE_EDGE ? t : ray.border;
    ray.cell = ivec3(floor(ray.origin + ray.dir * ray.t));
}

/* The box around all geometry, as a ray meets it. */
struct sdfgi_trace_content {
    float enters, leaves; /* parameters */
    bool misses;          /* the ray meets nothing in any cascade */
};

sdfgi_trace_content sdfgi_trace_content_of(uint cascade, ivec3 base, vec3 origin, vec3 inv_dir)
{
    const bvec3 forward = greaterThan(inv_dir, vec3(0.0));
    const vec3 low = vec3(sdfgi_frame.cascades[cascade].content_low - base),
               high = vec3(sdfgi_frame.cascades[cascade].content_high - base);
    const vec3 near = (mix(high, low, forward) - origin) * inv_dir,
               far = (mix(low, high, forward) - origin) * inv_dir;
    const float enters = max(near.x, max(near.y, near.z)), leaves = min(far.x, min(far.y, far.z));
    return sdfgi_trace_content(enters, leaves, leaves <= max(enters, 0.0));
}

/* Goes on to the box around all geometry. A ray leaves the cascade where it leaves that box, or at once if
 * the box lies beyond the cascade: in coarser ones it goes on from there. */
void sdfgi_trace_skip_empty(uint last_cascade, inout sdfgi_trace_state ray)
{
    const sdfgi_trace_content content =
        sdfgi_trace_content_of(ray.cascade, ray.base, ray.origin, ray.inv_dir);
    if (content.misses)
        ray.cascade = last_cascade;
    ray.border = min(ray.border, content.leaves);
    if (content.enters >= ray.border)
        ray.border = 0.0;
    else if (content.enters > 0.0)
        sdfgi_trace_leap(content.enters, ray);
}

sdfgi_trace_state sdfgi_trace_start(sdfgi_trace_query query)
{
    sdfgi_trace_state ray;
    ray.dir = sdfgi_trace_cells_direction(query.dir);
    ray.inv_dir = 1.0 / ray.dir;
    ray.scale = 1.0;
    ray.travelled = 0.0;
    ray.axis = 0;
    ray.steps = 0u;
    sdfgi_trace_enter_cascade(query.cascade, query.base, query.pos, query.range, ray);
    if (query.skips_empty)
        sdfgi_trace_skip_empty(query.last_cascade, ray);
    return ray;
}

void sdfgi_trace_enter_coarser(sdfgi_trace_query query, inout sdfgi_trace_state ray)
{
    ray.travelled += ray.t * ray.scale;
    ray.scale *= 2.0;
    const vec3 first = sdfgi_first_from_cascade(ray.cascade, ray.origin + ray.dir * ray.t + vec3(ray.base));
    sdfgi_trace_enter_cascade(ray.cascade + 1u, ivec3(0), sdfgi_cascade_from_first(ray.cascade + 1u, first),
                              query.range, ray);
    if (query.skips_empty)
        sdfgi_trace_skip_empty(query.last_cascade, ray);
}

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
bool sdfgi_trace_cross_cell(uint index, float distance, inout sdfgi_trace_state ray)
{
    float t_exit;
    const int exit_axis = sdfgi_trace_box_exit(ray.origin, ray.inv_dir, vec3(ray.cell), 1.0, t_exit);
    t_exit = max(ray.t, t_exit);
    uvec2 bits = uvec2(0u);
    if (distance < SDFGI_TRACE_OCCUPIED_DISTANCE)
        bits = sdfgi_bits_at(index) & sdfgi_trace_bits_near_ray(ray.cell, ray.origin, ray.dir, ray.t, t_exit);
    if (bits != uvec2(0u) &&
        sdfgi_trace_walk_subvoxels(bits, ray.cell, ray.origin, ray.dir, ray.inv_dir, ray.t, ray.axis))
        return true;
    ray.axis = exit_axis;
    ray.t = t_exit;
    return false;
}

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

#ifdef SDFGI_SOFTWARE

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
 * one another, and take them together. Steps and results are those of the loop for GPUs, which take longer in
 * this form. */
uint sdfgi_trace_march(sdfgi_trace_query query, inout sdfgi_trace_state ray)
{
    const ivec3 signs = sdfgi_trace_signs(ray.dir);
    uint end = SDFGI_TRACE_CAPPED;
    bool goes_on, walks;
    do {
        do {
            uint index = 0u;
            float distance = 0.0;
            goes_on = walks = false;
            while (ray.steps < SDFGI_TRACE_STEP_CAP) {
                ray.steps++;
                if (sdfgi_trace_is_at_border(ray)) {
                    goes_on = sdfgi_trace_goes_on(query, ray);
                    end = goes_on ? end : SDFGI_TRACE_MISS;
                    break;
                }
                index = sdfgi_trace_cell_index(ray.volume, ray.cell);
                distance = sdfgi_stored_distance(index);
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
            if (walks && sdfgi_trace_cross_cell(index, distance, ray)) {
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

uint sdfgi_trace_march(sdfgi_trace_query query, inout sdfgi_trace_state ray)
{
    const ivec3 signs = sdfgi_trace_signs(ray.dir);
    for (int i = 0; i < SDFGI_TRACE_STEP_CAP; i++) {
        ray.steps++;
        if (sdfgi_trace_is_at_border(ray)) {
            if (!sdfgi_trace_goes_on(query, ray))
                return SDFGI_TRACE_MISS;
            sdfgi_trace_enter_coarser(query, ray);
            continue;
        }
        const uint index = sdfgi_trace_cell_index(ray.volume, ray.cell);
        const float distance = sdfgi_stored_distance(index);
        const float step_length = min(sdfgi_trace_free_length(ray, distance), query.longest_step);
        if (step_length > SDFGI_TRACE_MIN_STEP) {
            sdfgi_trace_leap(step_length, ray);
            continue;
        }
        if (sdfgi_trace_cross_cell(index, distance, ray))
            return sdfgi_trace_length(ray) >= query.range ? SDFGI_TRACE_MISS : SDFGI_TRACE_HIT;
        ray.cell += sdfgi_trace_offset(signs, ray.axis);
    }
    return SDFGI_TRACE_CAPPED;
}

#endif

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
    return sdfgi_cell_is_valid(cascade, cell) && sdfgi_cell_bits(cascade, cell) == uvec2(0u);
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
 * step of the distance field may have crossed it, so the march cannot simply keep the last empty cell. */
bool sdfgi_trace_light_cell(uint cascade, sdfgi_trace_path path, int first_axis, inout ivec3 cell)
{
    const ivec3 hit = cell;
    float t;
    for (int i = 0; i < SDFGI_TRACE_STEP_CAP && sdfgi_trace_step_back(cascade, path, cell, t); i++)
        if (sdfgi_cell_bits(cascade, cell + path.base) == uvec2(0u))
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

/* Longest step, in cells, of rays whose results are kept while a cascade scrolls. Distances far from a ray
 * may have changed where nothing near it has; with longer steps they could change rounding. */
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
