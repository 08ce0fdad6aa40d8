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

layout(local_size_x = SDFGI_GROUP_RAYS) in;

/* Hits that a thread tests together, because their loads overlap. */
const uint HITS = 4u;
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

/* Dirty bounds of a cascade, in the order of dirty_bounds.glsl; then one box around those of either kind. */
shared bounds_box boxes[2u * STRIPS + 2u];

/* The cached hits that this thread tests, and whether they are to be invalidated. */
uint hit_codes[HITS];
bool hit_dirty[HITS];

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

/* Fills `boxes`. Called by the whole workgroup. */
void load_bounds(uint cascade)
{
    const uint lane = gl_LocalInvocationIndex;
    barrier();
    if (lane < 2u * STRIPS) {
        const bool any_bounds = bounds_any(cascade, lane);
        boxes[lane] = any_bounds ? bounds_box(vec3(bounds_low(cascade, lane)) - MARGIN,
                                              vec3(bounds_high(cascade, lane)) + MARGIN)
                                 : bounds_box(vec3(1e9), vec3(-1e9));
    }
    barrier();
    if (lane < 2u) {
        bounds_box all = boxes[lane * STRIPS];
        for (uint i = lane * STRIPS + 1u; i < (lane + 1u) * STRIPS; i++) {
            all.low = min(all.low, boxes[i].low);
            all.high = max(all.high, boxes[i].high);
        }
        boxes[2u * STRIPS + lane] = all;
    }
    barrier();
}

bounds_ray make_ray(vec3 start, vec3 dir, float end)
{
    return bounds_ray(start, dir, 1.0 / mix(dir, vec3(1e-20), lessThan(abs(dir), vec3(1e-20))), end);
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
bool strips_hit(uint first_box, bounds_box around, int axis, bounds_ray ray)
{
    const vec2 inside = box_interval(around, ray);
    if (inside.x > inside.y)
        return false;
    const vec2 ends = ray.start[axis] + ray.dir[axis] * inside;
    const int last = strip_at(max(ends.x, ends.y) + MARGIN + 1.0);
    for (int strip = strip_at(min(ends.x, ends.y) - MARGIN - 1.0); strip <= last; strip++) {
        const vec2 interval = box_interval(boxes[first_box + uint(strip)], ray);
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
    return strips_hit(BOUNDS_REMOVED, c.removed, axis, ray) || strips_hit(BOUNDS_ADDED, c.added, axis, ray);
}

/* ---- Hits */

/* Sample of a thread's k-th hit, of those from `first` on. */
uint hit_sample(uint first, uint k)
{
    return first + k * uint(SDFGI_GROUP_RAYS) + gl_LocalInvocationIndex;
}

/* True if the ray of a sample may end elsewhere because a cascade changed. */
bool hit_is_dirty(changed_cascade c, ivec3 probe, uint s, uint code)
{
    /* A hit without a light cell may lie beside the edge of the valid region, which has moved. */
    if (code == SDFGI_RAY_UNLIT || code == SDFGI_RAY_CAPPED)
        return true;
    float end = 1e9;
    if (code != SDFGI_RAY_SKY) {
        uint hit_cascade;
        const ivec3 cell = ray_cell(code, hit_cascade);
        /* The ray ended before it reached this cascade. */
        if (hit_cascade < c.cascade)
            return false;
        const vec3 hit =
            sdfgi_cascade_from_first(c.cascade, sdfgi_first_from_cascade(hit_cascade, vec3(cell) + 0.5));
        const float margin = MARGIN * exp2(float(hit_cascade - c.cascade));
        if (dirty_near(c.cascade, ivec3(floor(hit)), ivec3(ceil(hit)), int(ceil(MARGIN + margin))))
            return true;
        end = length(sdfgi_metric_from_cells(hit - c.start)) + margin;
    }
    if (end < c.nearest)
        return false;
    float solid_angle;
    const vec3 dir = sdfgi_cells_from_metric(probe_sample_direction(own_cascade(), probe, s, solid_angle));
    return dirty_bounds_hit(c, dir, end);
}

/* `cache` is the index of the probe's first hit in the ray cache. */
void load_hits(uint cache, uint first, bool all_dirty)
{
    for (uint k = 0u; k < HITS; k++) {
        const uint s = hit_sample(first, k);
        hit_codes[k] = s < sdfgi_frame.cycle_samples ? sdfgi_rays_at(cache + s) : SDFGI_RAY_UNKNOWN;
        hit_dirty[k] = all_dirty;
    }
}

/* Tests the hits against the change of a cascade; `start` is where the rays begin, in cells of the first
 * cascade. Called by the whole workgroup. */
void test_hits(uint cascade, vec3 start, ivec3 probe, uint first)
{
    if (bounds_axis(cascade) >= 0)
        load_bounds(cascade);
    changed_cascade c;
    c.cascade = cascade;
    c.removed = boxes[2u * STRIPS];
    c.added = boxes[2u * STRIPS + 1u];
    c.start = sdfgi_cascade_from_first(cascade, start);
    c.nearest = dirty_distance(cascade, c.start, MARGIN);
    for (uint k = 0u; k < HITS; k++)
        if (hit_codes[k] != SDFGI_RAY_UNKNOWN && !hit_dirty[k])
            hit_dirty[k] = hit_is_dirty(c, probe, hit_sample(first, k), hit_codes[k]);
}

void store_hits(uint cache, uint first)
{
    for (uint k = 0u; k < HITS; k++)
        if (hit_codes[k] != SDFGI_RAY_UNKNOWN && hit_dirty[k])
            sdfgi_rays[cache + hit_sample(first, k)] = SDFGI_RAY_UNKNOWN;
}

/* A change of the own cascade has made a new list of emitters. */
void forget_emitters(uint slot)
{
    const uint lane = gl_LocalInvocationIndex, count = sdfgi_frame.emitter_samples;
    for (uint i = lane; i < count && dirty_count(own_cascade()) > 0; i += uint(SDFGI_GROUP_RAYS))
        emitter_sample_forget(emitter_sample_word(slot, i));
}

void main()
{
    const ivec3 probe = probe_from_linear(gl_WorkGroupID.x);
    const uint slot = sdfgi_probe_index(own_cascade(), probe);
    const uint state = sdfgi_probes_at(slot), cache = slot * emitter_cache_stride();
    if (sdfgi_probe_is_dead(state))
        return;
    const vec3 pos = sdfgi_probe_position(probe, state);
    const vec3 start = sdfgi_first_from_cascade(own_cascade(), pos);
    /* Rays of a probe on the edge of the valid region began outside it, in the next cascade. */
    const bool all_dirty =
        (state & SDFGI_PROBE_NEW) != 0u || dirty_contains(own_cascade(), ivec3(floor(pos)));
    for (uint first = 0u; first < sdfgi_frame.cycle_samples; first += HITS * uint(SDFGI_GROUP_RAYS)) {
        load_hits(cache, first, all_dirty);
        for (uint c = own_cascade(); c < sdfgi_frame.cascade_count; c++)
            if (dirty_count(c) > 0)
                test_hits(c, start, probe, first);
        store_hits(cache, first);
    }
    forget_emitters(slot);
}
