/* SPDX-License-Identifier: MIT
 * Invalidates cached hits of rays that may end elsewhere, because a change was completed in this frame: in
 * the cascade of their probe, or in a coarser one that they go on into. These are rays that cross the dirty
 * bounds of the change, where it removed or added sub-voxels, and rays whose light cell is near a dirty box.
 * A ray through a dirty box that is only air ends as before. One workgroup per probe and cascade. */
#version 460
#extension GL_GOOGLE_include_directive : require
#define SDFGI_WRITES_RAYS
#include "../lib/on_cpu.glsl"
#include "dirty.glsl"
#include "dirty_bounds.glsl"
#include "emitter_samples.glsl"
#include "probe_common.glsl"
#include "ray_cache.glsl"

/* Cells by which boxes are widened: a light cell is up to two cells before its surface, and half a cell is
 * for rounding. */
const float MARGIN = 2.5;
const uint STRIPS = uint(SDFGI_BOUNDS_STRIPS);

/* Cells of a cascade, widened by MARGIN. Empty if low > high. */
struct bounds_box {
    vec3 low, high;
};

/* A cascade with a change, as the rays of this probe see it. */
struct changed_cascade {
    uint cascade;
    vec3 start;                /* where the rays begin, in cells of this cascade */
    float nearest;             /* distance from there to the nearest dirty box, widened by MARGIN */
    bounds_box removed, added; /* around the dirty bounds of either kind */
};

/* In cells of a cascade; `end` is the parameter at which the ray ends. */
struct bounds_ray {
    vec3 start, dir, inv_dir;
    float end;
};

uint own_cascade()
{
    return gl_WorkGroupID.y;
}

/* Axis across which a cascade is cut into strips; below 0 if its change has no dirty bounds. */
int bounds_axis(uint cascade)
{
    return sdfgi_frame.cascades[cascade].bounds_axis;
}

/* ---- Dirty bounds */

/* Box `i` of a cascade, in the order of dirty_bounds.glsl. */
bounds_box box_of(uint cascade, uint i)
{
    return bounds_any(cascade, i)
               ? bounds_box(vec3(bounds_low(cascade, i)) - MARGIN, vec3(bounds_high(cascade, i)) + MARGIN)
               : bounds_box(vec3(1e9), vec3(-1e9));
}

/* The same, where threads share boxes; once they have loaded those of the cascade. */
bounds_box loaded_box(uint cascade, uint i);

bounds_box box_around(bounds_box a, bounds_box b)
{
    return bounds_box(min(a.low, b.low), max(a.high, b.high));
}

bounds_ray make_ray(vec3 start, vec3 dir, float end)
{
    return bounds_ray(start, dir, 1.0 / sdfgi_nonzero(dir), end);
}

/* Parameters between which a ray is inside a box: empty if x > y. */
vec2 box_interval(bounds_box box, bounds_ray ray)
{
    if (box.low.x > box.high.x)
        return vec2(1.0, 0.0);
    const vec3 a = (box.low - ray.start) * ray.inv_dir, b = (box.high - ray.start) * ray.inv_dir;
    const vec3 first = min(a, b), last = max(a, b);
    return vec2(max(max(first.x, first.y), max(first.z, 0.0)),
                min(min(last.x, last.y), min(last.z, ray.end)));
}

/* Strip at a coordinate along the axis of the strips. */
int strip_at(float coordinate)
{
    return clamp(int(floor(coordinate)) * int(STRIPS) >> int(sdfgi_frame.resolution_log2), 0,
                 int(STRIPS) - 1);
}

/* True if a ray crosses a box of the kind that begins at `first_box`. `around` holds all boxes of the kind:
 * only the strips that the ray crosses inside it matter. */
bool strips_hit(uint cascade, uint first_box, bounds_box around, int axis, bounds_ray ray)
{
    const vec2 inside = box_interval(around, ray);
    if (inside.x > inside.y)
        return false;
    const vec2 ends = ray.start[axis] + ray.dir[axis] * inside;
    const int last = strip_at(max(ends.x, ends.y) + MARGIN + 1.0);
    for (int strip = strip_at(min(ends.x, ends.y) - MARGIN - 1.0); strip <= last; strip++) {
        const vec2 interval = box_interval(loaded_box(cascade, first_box + uint(strip)), ray);
        if (interval.x <= interval.y)
            return true;
    }
    return false;
}

/* True if a ray from the probe crosses what a change may have altered, up to parameter `end`. */
bool dirty_bounds_hit(changed_cascade c, vec3 dir, float end)
{
    const int axis = bounds_axis(c.cascade);
    if (axis < 0)
        return dirty_crosses(c.cascade, c.start, dir, end, MARGIN);
    const bounds_ray ray = make_ray(c.start, dir, end);
    return strips_hit(c.cascade, BOUNDS_REMOVED, c.removed, axis, ray) ||
           strips_hit(c.cascade, BOUNDS_ADDED, c.added, axis, ray);
}

/* ---- Hits */

/* What a hit alone tells. */
const uint HIT_IS_KEPT = 0u;
const uint HIT_IS_DIRTY = 1u;
const uint HIT_ASKS_RAY = 2u;

/* Whether the ray of a hit may end elsewhere because a cascade changed. `end` is where it ends. */
uint hit_state(changed_cascade c, uint code, out float end)
{
    end = 1e9;
    if (code == SDFGI_RAY_UNKNOWN)
        return HIT_IS_KEPT;
    /* A hit without a light cell may lie beside the edge of the valid region, which has moved. */
    if (code == SDFGI_RAY_UNLIT || code == SDFGI_RAY_CAPPED)
        return HIT_IS_DIRTY;
    if (code == SDFGI_RAY_SKY)
        return HIT_ASKS_RAY;
    uint hit_cascade;
    const ivec3 cell = ray_cell(code, hit_cascade);
    /* The ray ended before it reached this cascade. */
    if (hit_cascade < c.cascade)
        return HIT_IS_KEPT;
    const vec3 hit =
        sdfgi_cascade_from_first(c.cascade, sdfgi_first_from_cascade(hit_cascade, vec3(cell) + 0.5));
    const float margin = MARGIN * exp2(float(hit_cascade - c.cascade));
    if (dirty_near(c.cascade, ivec3(floor(hit)), ivec3(ceil(hit)), int(ceil(MARGIN + margin))))
        return HIT_IS_DIRTY;
    end = length(sdfgi_metric_from_cells(hit - c.start)) + margin;
    return end < c.nearest ? HIT_IS_KEPT : HIT_ASKS_RAY;
}

/* True if the ray of a sample crosses what changed before it ends. */
bool ray_is_dirty(changed_cascade c, ivec3 probe, uint s, float end)
{
    float solid_angle;
    const vec3 dir = sdfgi_cells_from_metric(probe_sample_direction(own_cascade(), probe, s, solid_angle));
    return dirty_bounds_hit(c, dir, end);
}

/* A change of a cascade for rays that begin at `start`, in cells of the first cascade. */
changed_cascade changed(uint cascade, vec3 start, bounds_box removed, bounds_box added)
{
    const vec3 here = sdfgi_cascade_from_first(cascade, start);
    return changed_cascade(cascade, here, dirty_distance(cascade, here, MARGIN), removed, added);
}

/* ---- Probes */

struct changed_probe {
    ivec3 probe;
    uint slot;
    uint cache;     /* index of its first hit in the ray cache */
    vec3 start;     /* of its rays, in cells of the first cascade */
    bool all_dirty; /* the rays began elsewhere */
};

/* False if the probe has no rays. */
bool find_probe(uint linear, out changed_probe found)
{
    found.probe = probe_from_linear(linear);
    found.slot = sdfgi_probe_index(own_cascade(), found.probe);
    found.cache = found.slot * emitter_cache_stride();
    const uint state = sdfgi_probes_at(found.slot);
    const vec3 pos = sdfgi_probe_position(found.probe, state);
    found.start = sdfgi_first_from_cascade(own_cascade(), pos);
    /* Rays of a probe on the edge of the valid region began outside it, in the next cascade. */
    found.all_dirty = (state & SDFGI_PROBE_NEW) != 0u || dirty_contains(own_cascade(), ivec3(floor(pos)));
    return !sdfgi_probe_is_dead(state);
}

/* A change of the own cascade has made a new list of emitters. */
void forget_emitters(uint slot, uint first, uint stride)
{
    const uint count = sdfgi_frame.emitter_samples;
    for (uint i = first; i < count && dirty_count(own_cascade()) > 0; i += stride)
        emitter_sample_forget(emitter_sample_word(slot, i));
}

#ifdef SDFGI_SOFTWARE
#include "ray_invalidate_alone.glsl"
#else
#include "ray_invalidate_shared.glsl"
#endif
