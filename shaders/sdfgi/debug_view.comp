/* SPDX-License-Identifier: MIT
 * A debug view: what the library holds of the scene, as a camera sees it. A thread per pixel sends a ray
 * through the cascades, and the view colours what it meets. sdfgi/debug.h says what the colours mean. */
#version 460
#extension GL_GOOGLE_include_directive : require
#include "../lib/on_cpu.glsl"
#include "debug_colors.glsl"
#include "debug_probes.glsl"
#include "dirty.glsl"
#include "gathered.glsl"
#include "visibility.glsl"
#include "../include/sdfgi.glsl"
#include "../shared/debug.h"

layout(local_size_x = SDFGI_GROUP_PIXELS, local_size_y = SDFGI_GROUP_PIXELS) in;

SDFGI_PUSH(sdfgi_debug_view_args);
layout(set = SDFGI_SET_VIEW, binding = SDFGI_BINDING_VIEW_DIFFUSE,
       rgba16f) uniform writeonly image2D output_image;

/* ---- Rays of pixels */

struct pixel_ray {
    vec3 start; /* on the near plane, in metres relative to the host's origin */
    vec3 dir;   /* unit */
};

/* How a position changes with its depth, times a square, tells the direction, also where the far plane is
 * infinitely far. */
pixel_ray ray_at(vec2 ndc)
{
    const mat4 to_position = mat4(args.inverse_view_projection[0], args.inverse_view_projection[1],
                                  args.inverse_view_projection[2], args.inverse_view_projection[3]);
    const float near = 1.0 - args.background_depth;
    const vec4 at_0 = to_position * vec4(ndc, 0.0, 1.0), by_depth = to_position[2],
               start = at_0 + near * by_depth;
    const vec3 change = (near > 0.5 ? -1.0 : 1.0) * (by_depth.xyz * at_0.w - at_0.xyz * by_depth.w),
               size = abs(change);
    return pixel_ray(start.xyz / start.w, normalize(change / max(size.x, max(size.y, size.z))));
}

bool ray_is_finite(pixel_ray ray)
{
    return dot(ray.start, ray.start) < 1e30 && abs(dot(ray.dir, ray.dir) - 1.0) < 0.1;
}

/* Moves the start of a ray that begins outside of all cascades into the coarsest one, if it leads there. */
vec3 start_in_cascades(pixel_ray ray)
{
    const uint last = sdfgi_frame.cascade_count - 1u;
    const float cell_m = sdfgi_frame.cascades[last].cell_m;
    const vec3 at = sdfgi_cascade_from_first(last, sdfgi_first_from_position(ray.start)),
               inv_dir = 1.0 / sdfgi_trace_cells_direction(ray.dir),
               low = (vec3(sdfgi_frame.cascades[last].valid_low) - at) * inv_dir,
               high = (vec3(sdfgi_frame.cascades[last].valid_high) - at) * inv_dir, near = min(low, high);
    const float enters = max(near.x, max(near.y, near.z));
    return ray.start + (enters > 0.0 ? (enters + 0.01) * cell_m : 0.0) * ray.dir;
}

/* ---- What a ray meets */

struct surface_hit {
    uint end; /* SDFGI_TRACE_* */
    uint cascade, axis, steps;
    ivec3 solid; /* the occupied cell */
    float distance_m;
    bool has_entry; /* the light cell before it is in the light list */
    ivec3 cell;
    uint entry;
};

/* With a range of 0 the ray meets nothing. */
surface_hit trace_surface(vec3 first, vec3 dir, float range)
{
    const sdfgi_trace_query query =
        sdfgi_trace_query(0u, sdfgi_frame.cascade_count - 1u, ivec3(0), first, dir, range, 1e9, false);
    sdfgi_trace_state ray = sdfgi_trace_start(query);
    surface_hit hit;
    hit.end = sdfgi_trace_march(query, ray);
    hit.cascade = ray.cascade;
    hit.axis = sdfgi_trace_face(ray.axis, ray.dir);
    hit.steps = ray.steps;
    hit.solid = hit.cell = ray.cell + ray.base;
    hit.distance_m = sdfgi_trace_length(ray) * sdfgi_frame.cascades[0].cell_m;
    hit.has_entry = false;
    if (hit.end == SDFGI_TRACE_HIT) {
        const sdfgi_trace_path path =
            sdfgi_trace_path(ray.origin, ray.inv_dir, ray.base, -ray.travelled / ray.scale);
        ivec3 cell = ray.cell;
        hit.has_entry = sdfgi_trace_light_cell(ray.cascade, path, ray.axis, cell);
        hit.cell = cell + ray.base;
        hit.has_entry = hit.has_entry && sdfgi_cell_entry(ray.cascade, hit.cell, hit.entry);
    }
    return hit;
}

/* ---- Views of light cells */

vec3 shown_light(vec3 stored)
{
    return debug_tone(stored * (sdfgi_frame.exposure_inverse * args.exposure));
}

/* Irradiance times weight, in rgb, and its weight in a, for a surface that is smaller than a cell and faces
 * along none of its cell's axes: those around it stand for it, those that face away excepted. */
vec4 light_around(uint cascade, uint entry, vec3 normal)
{
    vec4 sum = vec4(0.0);
    for (uint axis = SDFGI_FIRST; axis < 6u; axis++) {
        const float along = sdfgi_trace_component(normal, int(axis >> 1u)) * ((axis & 1u) == 0u ? 1.0 : -1.0);
        sum +=
            sdfgi_cell_surface(cascade, entry, axis, sdfgi_cells_share_around(along), SDFGI_CELLS_ARRIVING);
    }
    return sum;
}

/* Irradiance over pi times exposure of the surface that was hit, and 1 in a; 0 if none is known. */
vec4 arriving_light(surface_hit hit)
{
    const vec4 facing = sdfgi_cell_surface(hit.cascade, hit.entry, hit.axis, 1.0, SDFGI_CELLS_ARRIVING);
    if (facing.a > 0.0)
        return facing;
    const vec4 around = light_around(hit.cascade, hit.entry, vec3(sdfgi_axis_direction(hit.axis)));
    return around.a > 0.0 ? vec4(around.rgb / around.a, 1.0) : vec4(0.0);
}

float confidence(gathered_state state)
{
    const float cycle = float(sdfgi_frame.cycle_visits), rough = gathered_worth(state),
                visits = float(state.visits);
    if (state.mean >= GATHERED_COMPLETE)
        return 1.0;
    return state.mean >= GATHERED_FIRST ? (visits + rough) / (cycle + rough) : visits / cycle;
}

/* Visits so far over those of a complete cycle, or of a long one. */
float age(gathered_state state)
{
    const uint cycle = state.mean >= GATHERED_GOES_ON ? gathered_long_visits() : sdfgi_frame.cycle_visits;
    return float(state.visits) / float(cycle);
}

float visible_share(surface_hit hit)
{
    const vec3 pos = vec3(hit.cell) + 0.5;
    const sdfgi_visibility v = visibility_of_cage(hit.cascade, sdfgi_cage_of(hit.cascade, pos), pos,
                                                  visibility_bits_of_cell(hit.cascade, hit.cell));
    float sum = 0.0;
    for (int k = 0; k < 8; k++)
        sum += v.of_probe[k];
    return sum / 8.0;
}

/* Light in the air is looked up a cell before the light cell: right at a wall it is that of a coarser
 * cascade.
 */
vec3 leaks(surface_hit hit)
{
    const ivec3 axis = sdfgi_axis_direction(hit.axis);
    const vec3 centre = vec3(hit.cell) + 0.5,
               before = centre + vec3(sdfgi_trace_is_empty(hit.cascade, hit.cell + axis) ? axis : ivec3(0));
    const vec4 arriving = arriving_light(hit);
    const vec3 air = sdfgi_irradiance_air(sdfgi_position_from_cascade(hit.cascade, before), vec3(axis)),
               of_cell = arriving.rgb * (3.14159265 * sdfgi_frame.exposure_inverse * sdfgi_frame.energy);
    if (debug_cage_is_bad(hit.cascade, sdfgi_cage_of(hit.cascade, centre), 8))
        return DEBUG_MAGENTA;
    if (arriving.a <= 0.0)
        return DEBUG_UNKNOWN;
    if (max(arriving.r, max(arriving.g, arriving.b)) >= 0.99 * SDFGI_RGBE_MAX)
        return DEBUG_YELLOW;
    /* Three doublings are as much as is told apart. What is dark counts as equally dark. */
    const float dark = 3.14159265 * sdfgi_frame.dark * sdfgi_frame.exposure_inverse;
    return debug_difference(
        log2((sdfgi_light_luminance(air) + dark) / (sdfgi_light_luminance(of_cell) + dark)) / 3.0);
}

vec3 view_of_cell(surface_hit hit, float shade)
{
    gathered_state state = gathered_state(0u, GATHERED_COMPLETE, 0u, 0u);
    if (gathers())
        state = gathered_load_state(hit.cascade, hit.entry);
    const bool changed = dirty_contains(hit.cascade, hit.solid);
    switch (args.view) {
    case SDFGI_SHADER_DEBUG_LIGHT:
        return shown_light(
            sdfgi_rgbe_decode(sdfgi_light_at(sdfgi_surface_index(hit.cascade, hit.entry, hit.axis))));
    case SDFGI_SHADER_DEBUG_IRRADIANCE: {
        const vec4 arriving = arriving_light(hit);
        return arriving.a > 0.0 ? shown_light(arriving.rgb) : DEBUG_UNKNOWN;
    }
    case SDFGI_SHADER_DEBUG_CONFIDENCE:
        return gathers() ? shade * debug_red_to_green(confidence(state)) : DEBUG_UNKNOWN;
    case SDFGI_SHADER_DEBUG_AGE:
        return gathers() ? shade * debug_blue_to_red(age(state)) : DEBUG_UNKNOWN;
    case SDFGI_SHADER_DEBUG_VISIBILITY:
        return shade * debug_red_to_green(visible_share(hit));
    case SDFGI_SHADER_DEBUG_LEAKS:
        return leaks(hit);
    }
    return shade * (changed                          ? DEBUG_RED
                    : state.mean == GATHERED_NOTHING ? DEBUG_ORANGE
                    : state.mean < GATHERED_COMPLETE ? DEBUG_YELLOW
                                                     : DEBUG_GREY);
}

/* ---- Views of surfaces */

vec3 view_of_surface(surface_hit hit)
{
    const uint block = sdfgi_block_index(hit.cascade, hit.solid);
    const float shade = DEBUG_SHADES[hit.axis];
    if (hit.end == SDFGI_TRACE_MISS)
        return DEBUG_SKY;
    if (hit.end == SDFGI_TRACE_CAPPED)
        return DEBUG_UNKNOWN;
    switch (args.view) {
    case SDFGI_SHADER_DEBUG_SOLID:
        return vec3(shade);
    case SDFGI_SHADER_DEBUG_DISTANCE: {
        const float doublings = log2(max(hit.distance_m, 1e-6) * 10.0);
        return shade * debug_band(4.0 * doublings) * debug_blue_to_red(doublings / log2(1e4));
    }
    case SDFGI_SHADER_DEBUG_CASCADE:
        return shade * DEBUG_CASCADES[hit.cascade];
    case SDFGI_SHADER_DEBUG_ALBEDO:
        return surface_albedo(block, hit.axis);
    case SDFGI_SHADER_DEBUG_EMISSION:
        return sdfgi_surfaces_emit() ? shown_light(sdfgi_block_emission(block, hit.axis)) : vec3(0.0);
    case SDFGI_SHADER_DEBUG_PROBES_IRRADIANCE:
    case SDFGI_SHADER_DEBUG_PROBES_STATE:
        return vec3(0.1 * shade);
    case SDFGI_SHADER_DEBUG_REFLECTION_TIER: /* volumes do not know how rough a surface is */
        return DEBUG_UNKNOWN;
    }
    return hit.has_entry ? view_of_cell(hit, shade) : DEBUG_UNKNOWN;
}

/* ---- Probes */

vec3 probe_state_color(uint slot, uint state, vec3 normal)
{
    if (sdfgi_probe_is_dead(state))
        return DEBUG_RED;
    if ((state & SDFGI_PROBE_MOVED) != 0u && abs(normal.y) > 0.8)
        return vec3(1.0);
    const uint history = probe_history_state(probe_history_load(slot));
    return history == PROBE_NEW ? DEBUG_ORANGE : history == PROBE_STEADY ? DEBUG_GREEN : DEBUG_YELLOW;
}

/* A ball before what is behind it. Balls are round: their rims are darker. */
vec3 view_of_ball(debug_ball ball, vec3 dir, float surface_m, vec3 behind)
{
    const uint slot = sdfgi_probe_index(ball.cascade, ball.probe);
    const bool shows_state = args.view == SDFGI_SHADER_DEBUG_PROBES_STATE,
               hidden = ball.distance_m > surface_m;
    if (!ball.hit || (hidden && !shows_state))
        return behind;
    if (!shows_state)
        return shown_light(sdfgi_irradiance_of_probe(ball.cascade, ball.probe, ball.normal).light);
    const vec3 color = probe_state_color(slot, sdfgi_probes_at(slot), ball.normal);
    return mix(behind, color * (0.4 - 0.6 * dot(ball.normal, dir)), hidden ? 0.4 : 1.0);
}

/* ---- The slice */

/* The distance field of the finest cascade at a point. */
vec3 view_of_slice(vec3 first)
{
    for (uint c = 0u; c < sdfgi_frame.cascade_count; c++) {
        const vec3 at = sdfgi_cascade_from_first(c, first);
        const ivec3 cell = ivec3(floor(at));
        if (!sdfgi_cell_is_valid(c, cell))
            continue;
        const float cells = sdfgi_cell_distance(c, cell);
        return sdfgi_cells_is_set(sdfgi_cell_bits(c, cell), at)
                   ? vec3(1.0)
                   : debug_band(cells) * debug_blue_to_red(cells / float(SDFGI_DISTANCE_REACH));
    }
    return DEBUG_SKY;
}

vec3 slice_position(pixel_ray ray)
{
    const float quarter_m = 0.25 * float(sdfgi_frame.resolution) * sdfgi_frame.cascades[0].cell_m,
                slice_m = args.slice_m > 0.0 ? args.slice_m : quarter_m;
    return ray.start + ray.dir * (slice_m / max(dot(ray.dir, ray_at(vec2(0.0)).dir), 1e-3));
}

vec3 color_of(pixel_ray ray)
{
    const bool slice = args.view == SDFGI_SHADER_DEBUG_DISTANCE_SLICE,
               probes = args.view == SDFGI_SHADER_DEBUG_PROBES_IRRADIANCE ||
                        args.view == SDFGI_SHADER_DEBUG_PROBES_STATE;
    const vec3 first = sdfgi_first_from_position(start_in_cascades(ray));
    const surface_hit hit = trace_surface(first, ray.dir, slice ? 0.0 : 1e9);
    if (slice)
        return view_of_slice(sdfgi_first_from_position(slice_position(ray)));
    if (args.view == SDFGI_SHADER_DEBUG_STEPS)
        return debug_blue_to_red(log2(float(max(hit.steps, 1u))) / log2(float(SDFGI_TRACE_STEP_CAP)));
    const debug_ball ball = debug_ball_on_ray(first, ray.dir, probes ? SDFGI_TRACE_STEP_CAP : 0);
    const float surface_m = hit.end == SDFGI_TRACE_MISS ? 1e30 : hit.distance_m;
    return view_of_ball(ball, ray.dir, surface_m, view_of_surface(hit));
}

void main()
{
    const ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (pixel.x >= int(args.width) || pixel.y >= int(args.height))
        return;
    const vec2 ndc = (vec2(pixel) + 0.5) / vec2(args.width, args.height) * 2.0 - 1.0;
    const pixel_ray ray = ray_at(ndc);
    const vec3 color = ray_is_finite(ray) ? color_of(ray) : DEBUG_SKY;
    imageStore(output_image, pixel, vec4(color, 1.0));
}
