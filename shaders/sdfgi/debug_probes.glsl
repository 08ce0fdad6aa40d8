/* SPDX-License-Identifier: MIT
 * Probes as balls, for debug views. */
#ifndef SDFGI_DEBUG_PROBES_GLSL
#define SDFGI_DEBUG_PROBES_GLSL

#include "probe_common.glsl"
#include "../include/sdfgi_irradiance.glsl"
#include "../include/sdfgi_trace.glsl"

/* Cell widths. A probe stands less than half the probe spacing from its corner, and its ball as well: no two
 * meet, and a ball lies in the box around its own corner. */
const float DEBUG_BALL_RADIUS = 0.75;

struct debug_ball {
    bool hit;
    uint cascade;
    ivec3 probe;
    vec3 normal;
    float distance_m;
};

/* A ray through the boxes around the corners of a cascade. */
struct debug_walk {
    uint cascade;
    vec3 origin, dir, inv_dir; /* in cells, and cells per cell width */
    float t, end;              /* cell widths: where it is, and where it leaves the valid region */
    ivec3 probe;               /* whose box it is in */
};

debug_walk debug_walk_from(uint cascade, vec3 first, vec3 dir, float way_m)
{
    debug_walk walk;
    walk.cascade = cascade;
    walk.origin = sdfgi_cascade_from_first(cascade, first);
    walk.dir = sdfgi_trace_cells_direction(dir);
    walk.inv_dir = 1.0 / walk.dir;
    walk.t = way_m / sdfgi_frame.cascades[cascade].cell_m;
    const vec3 at = walk.origin + walk.dir * walk.t;
    walk.probe = ivec3(floor(at / float(SDFGI_PROBE_SPACING) + 0.5));
    walk.end = sdfgi_cell_is_valid(cascade, ivec3(floor(at)))
                   ? sdfgi_trace_border(cascade, ivec3(0), walk.origin, walk.inv_dir)
                   : walk.t;
    return walk;
}

bool debug_probe_exists(uint cascade, ivec3 probe)
{
    return all(greaterThanEqual(probe, ivec3(0))) &&
           all(lessThan(probe, ivec3(sdfgi_frame.probes_per_side))) && sdfgi_probe_is_valid(cascade, probe);
}

/* Meets the ball of the walk's probe. */
bool debug_walk_meets(debug_walk walk, vec3 dir, inout debug_ball ball)
{
    if (!debug_probe_exists(walk.cascade, walk.probe))
        return false;
    const uint state = sdfgi_probes_at(sdfgi_probe_index(walk.cascade, walk.probe));
    const vec3 to_probe = sdfgi_metric_from_cells(sdfgi_probe_position(walk.probe, state) - walk.origin);
    const float along = dot(to_probe, dir);
    const vec3 beside = to_probe - along * dir;
    const float half2 = DEBUG_BALL_RADIUS * DEBUG_BALL_RADIUS - dot(beside, beside);
    const float range = along - sqrt(max(half2, 0.0));
    if (half2 <= 0.0 || range <= 0.0)
        return false;
    ball = debug_ball(true, walk.cascade, walk.probe, (dir * range - to_probe) / DEBUG_BALL_RADIUS,
                      range * sdfgi_frame.cascades[walk.cascade].cell_m);
    return true;
}

void debug_walk_on(inout debug_walk walk)
{
    const float spacing = float(SDFGI_PROBE_SPACING);
    float t_exit;
    const int axis =
        sdfgi_trace_box_exit(walk.origin, walk.inv_dir, spacing * (vec3(walk.probe) - 0.5), spacing, t_exit);
    walk.t = max(walk.t, t_exit);
    walk.probe += sdfgi_trace_offset(sdfgi_trace_signs(walk.dir), axis);
}

/* The first ball on a ray, of the cascade that each piece of the ray lies in. `first` is where the ray
 * begins, in cell space of cascade 0; `most` is the number of steps that it may take. */
debug_ball debug_ball_on_ray(vec3 first, vec3 dir, int most)
{
    debug_ball ball = debug_ball(false, 0u, ivec3(0), vec3(0.0), 0.0);
    debug_walk walk = debug_walk_from(0u, first, dir, 0.0);
    for (int i = 0; i < most && !ball.hit; i++) {
        if (walk.t < walk.end) {
            if (!debug_walk_meets(walk, dir, ball))
                debug_walk_on(walk);
            continue;
        }
        if (walk.cascade + 1u >= sdfgi_frame.cascade_count)
            break;
        const float way_m = walk.t * sdfgi_frame.cascades[walk.cascade].cell_m;
        walk = debug_walk_from(walk.cascade + 1u, first, dir, way_m);
    }
    return ball;
}

/* ---- What probes hold */

bool debug_float_is_bad(uvec4 bits)
{
    return any(equal(bits & 0x7f800000u, uvec4(0x7f800000u)));
}

bool debug_half_is_bad(uvec2 halves)
{
    const uvec4 each = uvec4(halves.x, halves.x >> 16u, halves.y, halves.y >> 16u);
    return any(equal(each & 0x7c00u, uvec4(0x7c00u)));
}

/* True if a sum or a texel of the `count` first probes of a cage is infinite or no number. */
bool debug_cage_is_bad(uint cascade, ivec3 cage, int count)
{
    bool bad = false;
    for (int i = 0; i < count * SDFGI_SUMS_STRIDE; i++) {
        const uint word = uint(i % SDFGI_SUMS_STRIDE);
        const uint slot = sdfgi_probe_index(cascade, cage + sdfgi_cage_corner(i / SDFGI_SUMS_STRIDE));
        bad = bad || debug_float_is_bad(floatBitsToUint(sdfgi_sums_at(probe_sums(slot) + word)));
        const uint texel = min(word, uint(SDFGI_IRRADIANCE_COUNT) - 1u);
        bad =
            bad || debug_half_is_bad(sdfgi_irradiance_texels_at(slot * uint(SDFGI_IRRADIANCE_COUNT) + texel));
    }
    return bad;
}

#endif
