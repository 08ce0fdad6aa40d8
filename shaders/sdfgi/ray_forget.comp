/* SPDX-License-Identifier: MIT
 * Forgets remembered rays that may end elsewhere since something became new in this frame, in their own
 * cascade or in one they go on into: those that pass where sub-voxels went or came, and those that end in
 * cells that are new or left. Where only air is new a ray ends as before. One workgroup per probe and
 * cascade. */
#version 460
#extension GL_GOOGLE_include_directive : require
#include "dirty.glsl"
#include "dirty_bounds.glsl"
#include "probe_common.glsl"
#include "ray_cache.glsl"

layout(local_size_x = SDFGI_GROUP_RAYS) in;

/* Remembered rays that a thread reads together: their loads overlap. */
const uint AT_ONCE = 4u;
/* A light cell is up to two cells before its surface; besides, rounding. */
const float MARGIN = 2.5;

const uint STRIPS = uint(SDFGI_BOUNDS_STRIPS);

/* Cells of a cascade, widened by MARGIN. Empty if low > high. */
struct bounds_box {
    vec3 low, high;
};
/* Around what went per strip, around what came, around all that went, around all that came. */
shared bounds_box boxes[2u * STRIPS + 2u];

uint own_cascade()
{
    return gl_WorkGroupID.y;
}

/* Axis across which the boxes of a cascade lie in strips; below 0 where all of it is new. */
int bounds_axis(uint cascade)
{
    return sdfgi_frame.cascades[cascade].bounds_axis;
}

/* Called by the whole workgroup. */
void fetch_boxes(uint cascade)
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

/* Where a ray is in a box, up to parameter `end`: empty if x > y. */
vec2 box_passage(bounds_box box, vec3 pos, vec3 inv_dir, float end)
{
    if (box.low.x > box.high.x)
        return vec2(1.0, 0.0);
    const vec3 a = (box.low - pos) * inv_dir, b = (box.high - pos) * inv_dir;
    const vec3 first = min(a, b), last = max(a, b);
    return vec2(max(max(first.x, first.y), max(first.z, 0.0)), min(min(last.x, last.y), min(last.z, end)));
}

int strip_of(float at)
{
    return clamp(int(floor(at)) * int(STRIPS) >> int(sdfgi_frame.resolution_log2), 0, int(STRIPS) - 1);
}

/* True if a ray passes what went (side = 0) or came (1). Only strips that it crosses meanwhile matter. */
bool passes_bounds(uint side, bounds_box all, int axis, vec3 pos, vec3 dir, float end)
{
    const vec3 inv_dir = 1.0 / mix(dir, vec3(1e-20), lessThan(abs(dir), vec3(1e-20)));
    const vec2 within = box_passage(all, pos, inv_dir, end);
    if (within.x > within.y)
        return false;
    const vec2 way = pos[axis] + dir[axis] * within;
    const int last = strip_of(max(way.x, way.y) + MARGIN + 1.0);
    for (int strip = strip_of(min(way.x, way.y) - MARGIN - 1.0); strip <= last; strip++) {
        const vec2 part = box_passage(boxes[side * STRIPS + uint(strip)], pos, inv_dir, end);
        if (part.x <= part.y)
            return true;
    }
    return false;
}

/* Where the rays of a probe begin, in cells of a cascade that changed. */
struct ray_start {
    vec3 pos;
    float nearest; /* distance from there to anything new */
};

/* Since `cascade` changed. A ray that hit something that was not lit may have done so beside the border. */
bool ends_elsewhere(uint cascade, bounds_box went, bounds_box came, ivec3 probe, ray_start start, uint s,
                    uint code)
{
    if (code == SDFGI_RAY_UNLIT)
        return true;
    float range = 1e9;
    if (code != SDFGI_RAY_SKY) {
        uint hit;
        const ivec3 cell = ray_cell(code, hit);
        if (hit < cascade)
            return false;
        const vec3 end = sdfgi_cascade_from_first(cascade, sdfgi_first_from_cascade(hit, vec3(cell) + 0.5));
        const float margin = MARGIN * exp2(float(hit - cascade));
        if (dirty_near(cascade, ivec3(floor(end)), ivec3(ceil(end)), int(ceil(MARGIN + margin))))
            return true;
        range = length(sdfgi_metric_from_cells(end - start.pos)) + margin;
    }
    if (range < start.nearest)
        return false;
    float solid_angle;
    const vec3 dir = sdfgi_cells_from_metric(probe_sample_direction(own_cascade(), probe, s, solid_angle));
    const int axis = bounds_axis(cascade);
    if (axis < 0)
        return dirty_crosses(cascade, start.pos, dir, range, MARGIN);
    return passes_bounds(0u, went, axis, start.pos, dir, range) ||
           passes_bounds(1u, came, axis, start.pos, dir, range);
}

void main()
{
    const ivec3 probe = probe_from_linear(gl_WorkGroupID.x);
    const uint slot = sdfgi_probe_index(own_cascade(), probe);
    const uint state = sdfgi_probes[slot], cache = slot * sdfgi_frame.cycle_samples;
    if (sdfgi_probe_is_dead(state))
        return;
    const vec3 pos = sdfgi_probe_position(probe, state), first = sdfgi_first_from_cascade(own_cascade(), pos);
    /* On the border of what was complete, rays began beyond it. */
    const bool all_rays = (state & SDFGI_PROBE_NEW) != 0u || dirty_contains(own_cascade(), ivec3(floor(pos)));
    for (uint start = 0u; start < sdfgi_frame.cycle_samples; start += AT_ONCE * uint(SDFGI_GROUP_RAYS)) {
        uint codes[AT_ONCE], samples[AT_ONCE];
        bool forget[AT_ONCE];
        for (uint k = 0u; k < AT_ONCE; k++) {
            samples[k] = start + k * uint(SDFGI_GROUP_RAYS) + gl_LocalInvocationIndex;
            codes[k] =
                samples[k] < sdfgi_frame.cycle_samples ? sdfgi_rays[cache + samples[k]] : SDFGI_RAY_UNKNOWN;
            forget[k] = all_rays;
        }
        for (uint c = own_cascade(); c < sdfgi_frame.cascade_count; c++) {
            if (dirty_count(c) == 0)
                continue;
            if (bounds_axis(c) >= 0)
                fetch_boxes(c);
            const bounds_box went = boxes[2u * STRIPS], came = boxes[2u * STRIPS + 1u];
            const vec3 from = sdfgi_cascade_from_first(c, first);
            const ray_start begin = ray_start(from, dirty_distance(c, from, MARGIN));
            for (uint k = 0u; k < AT_ONCE; k++)
                if (codes[k] != SDFGI_RAY_UNKNOWN && !forget[k])
                    forget[k] = ends_elsewhere(c, went, came, probe, begin, samples[k], codes[k]);
        }
        for (uint k = 0u; k < AT_ONCE; k++)
            if (codes[k] != SDFGI_RAY_UNKNOWN && forget[k])
                sdfgi_rays[cache + samples[k]] = SDFGI_RAY_UNKNOWN;
    }
}
