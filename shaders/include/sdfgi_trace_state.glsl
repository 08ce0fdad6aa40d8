/* SPDX-License-Identifier: MIT
 * Where a ray is: its way through the valid region of a cascade, and from cascade to cascade.
 *
 * A ray's parameter t counts cell widths of the cascade that it crosses, from where it entered it. */
#ifndef SDFGI_TRACE_STATE_GLSL
#define SDFGI_TRACE_STATE_GLSL

#include "sdfgi_space.glsl"
#include "sdfgi_trace_cell.glsl"

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
    float longest_step; /* cells that one step through empty space may cross at most */
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

/* No step leads further than the border. Rounding could put a place just before the border beyond it. */
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

#endif
