/* SPDX-License-Identifier: MIT
 * Direct light on the surfaces around each light cell: sun, point and spot lights with traced shadows,
 * reflected by the surface's albedo, one value per axis along which a surface faces.
 *
 * A thread per axis of each light cell finds the lights that would light its surface. All threads of the
 * workgroup then share the shadow rays from its surfaces to those lights; if each thread traced its own rays,
 * most would wait for the one with the most. A surface adds its lights in the order of the light list, so
 * that sums do not depend on which thread traces which ray. Shared memory: 9 KiB. */
#version 460
#extension GL_GOOGLE_include_directive : require
#define SDFGI_WRITES_DIRECT
#include "../lib/on_cpu.glsl"
#include "light_blocks.glsl"
#include "workgroup.glsl"
#include "../include/sdfgi_trace.glsl"

layout(local_size_x = SDFGI_GROUP_SURFACES) in;
SDFGI_PUSH(sdfgi_light_direct_args);
layout(std430, set = SDFGI_SET_WORK, binding = SDFGI_BINDING_LIGHTS) readonly buffer sdfgi_lights_buffer
{
    sdfgi_light_params sdfgi_lights[];
};

const float PI = 3.14159265;
const uint CELLS = uint(SDFGI_CELLS_OF_SURFACES);
const uint BATCH = 16u; /* lights at once, a bit each */

shared ivec3 cells[CELLS];
shared uint facing[CELLS];
shared uint lights[CELLS];   /* bits of those whose direct light a cell has */
shared uint affected[CELLS]; /* 1: the change of lights reaches the cell */
shared uint some_wanted;
shared uint unshadowed[SDFGI_GROUP_SURFACES]; /* bits of the batch's lights in which a surface lies */
shared vec3 starts[SDFGI_GROUP_SURFACES];     /* of a surface's shadow rays */
/* A surface's thread times BATCH, plus a light's number in the batch. */
shared uint rays[SDFGI_GROUP_SURFACES * BATCH];
shared uint ray_count;
shared vec3 reflected[CELLS][6];

/* The cascade whose cells this workgroup lights. */
uint lit_cascade()
{
    return args.cascade + gl_WorkGroupID.z;
}

/* Irradiance of a light at `position`, on a surface that faces it; the direction to the light, and its
 * distance in metres. The inverse square stops growing within half a cell, because the place of a voxelised
 * surface is not known more closely (HARD_CASES row 47). */
vec3 light_arriving(sdfgi_light_params light, vec3 position, out vec3 to_light, out float range)
{
    if ((light.kind & 3u) == SDFGI_LIGHT_KIND_DIRECTIONAL) {
        to_light = -light.direction;
        range = 1e9;
        return light.intensity;
    }
    const vec3 offset = light.position - position;
    const float floor_m = 0.5 * sdfgi_frame.cascades[lit_cascade()].cell_m;
    range = length(offset);
    to_light = range > 0.0 ? offset / range : vec3(0.0, 1.0, 0.0);
    if (light.range_m > 0.0 && range > light.range_m)
        return vec3(0.0);
    float cone = 1.0;
    if ((light.kind & 3u) == SDFGI_LIGHT_KIND_SPOT) {
        const float edge = dot(-to_light, light.direction) - light.cos_outer;
        cone = clamp(edge * light.cone_scale, 0.0, 1.0);
        cone *= cone;
    }
    return light.intensity * (cone / max(range * range, floor_m * floor_m));
}

/* The surface behind a cell that faces along an axis. */
struct surface {
    vec3 position, normal;
    vec3 start; /* of its shadow rays, in the cell space of the cascade */
    uint block;
};

/* Cosine of the largest angle between a surface that counts as level with the grid and an axis. */
const float LEVEL = 0.999;
/* Cells. Shadow rays start so far from the middle of their cell at most: within it, since what lies behind
 * its faces may be open only beside the surface. */
const float INSIDE = 0.47;
/* Cells. So far from surfaces that are not level shadow rays start at least: nearer, they would meet steps of
 * the surface itself. */
const float CLEARANCE = 0.4;

/* Shadow rays start near the surface: from the middle of the cell, surfaces on both sides of an edge were lit
 * by the same light, and a room with a patch of sun on its floor and a wall was 2 % too bright. They start
 * elsewhere over each surface, so that of the cells on the edge of a shadow as many are lit as the light
 * covers of them: from the middles, a patch of sun was up to a row of cells too wide or too narrow. */
vec3 shadow_start(ivec3 cell, vec3 step, vec3 normal, float distance)
{
    const float depth = dot(normal, step) > LEVEL ? INSIDE : clamp(distance - CLEARANCE, 0.0, INSIDE);
    const vec3 place = light_cell_place(lit_cascade(), cell), aside = place - dot(place, normal) * normal;
    return vec3(cell) + LIGHT_CELL_EYE + clamp(aside, -INSIDE, INSIDE) - step * depth;
}

surface surface_behind(ivec3 cell, uint axis)
{
    const ivec3 step = sdfgi_axis_direction(axis);
    const float distance = sdfgi_cell_distance(lit_cascade(), cell), depth = clamp(distance, 0.5, 1.0);
    const uint block = sdfgi_block_index(lit_cascade(), cell - step);
    const vec3 position = sdfgi_position_from_cascade(lit_cascade(), vec3(cell) + 0.5 - vec3(step) * depth);
    const vec3 normal = surface_normal(block, axis);
    return surface(position, normal, shadow_start(cell, vec3(step), normal, distance), block);
}

vec3 light_on_surface(uint light, surface s)
{
    vec3 to_light;
    float range;
    const vec3 facing_light = light_arriving(sdfgi_lights_at(light), s.position, to_light, range);
    return facing_light * max(dot(s.normal, to_light), 0.0);
}

bool is_unshadowed(vec3 pos, uint light)
{
    vec3 to_light;
    float range_m;
    light_arriving(sdfgi_lights_at(light), sdfgi_position_from_cascade(lit_cascade(), pos), to_light,
                   range_m);
    const float cell_m = sdfgi_frame.cascades[lit_cascade()].cell_m;
    const sdfgi_trace_hit hit =
        sdfgi_trace_solid(lit_cascade(), sdfgi_frame.cascade_count - 1u, pos, to_light, range_m / cell_m);
    if (hit.capped)
        counter_add(SDFGI_COUNTER_TRACE_CAPS, 1u);
    return !hit.hit;
}

/* True for a light of `bits` that would light a surface if nothing stood between them. */
bool is_candidate(uint light, uint bits, surface s)
{
    return (sdfgi_lights_at(light).bit & bits) != 0u &&
           any(greaterThan(light_on_surface(light, s), vec3(0.0)));
}

/* A bit per light from `first` on that is a candidate. */
uint find_candidates(uint first, uint count, uint bits, surface s)
{
    uint candidates = 0u;
    for (uint i = 0u; i < count; i++)
        if (is_candidate(first + i, bits, s))
            candidates |= 1u << i;
    return candidates;
}

/* True if a light that has moved may light the surface. */
bool is_reached(surface s)
{
    bool reached = false;
    for (uint i = 0u; i < sdfgi_frame.light_count && !reached; i++)
        reached = is_candidate(i, args.moved, s);
    return reached;
}

/* Lists a shadow ray from this thread's surface to each of its candidates. Returns those that need none,
 * because they cast no shadows. */
uint list_rays(uint first, uint candidates)
{
    uint shadowless = 0u;
    for (uint rest = candidates; rest != 0u; rest &= rest - 1u) {
        const uint i = uint(findLSB(rest));
        if ((sdfgi_lights_at(first + i).kind & SDFGI_LIGHT_CASTS_SHADOW) != 0u)
            rays[atomicAdd(ray_count, 1u)] = gl_LocalInvocationIndex * BATCH + i;
        else
            shadowless |= 1u << i;
    }
    return shadowless;
}

/* Traces the listed rays. The rays of a subgroup wait for each other. If there are fewer rays than threads,
 * they are spread over the threads evenly, and so over as many subgroups as possible. */
void trace_rays(uint first)
{
    const uint threads_per_ray = clamp(SDFGI_GROUP_SURFACES / max(ray_count, 1u), 1u, args.threads_per_ray);
    for (uint i = gl_LocalInvocationIndex; i < ray_count * threads_per_ray; i += SDFGI_GROUP_SURFACES) {
        const uint from = rays[i / threads_per_ray] / BATCH, light = rays[i / threads_per_ray] % BATCH;
        if (i % threads_per_ray == 0u && is_unshadowed(starts[from], first + light))
            atomicOr(unshadowed[from], 1u << light);
    }
}

/* Irradiance of those of a batch of lights that have `bits`, on this thread's surface, if it has one. Adds to
 * `from` the bits of those that it comes from. Called by the whole workgroup. */
vec3 light_from_batch(uint first, uint bits, bool faces, surface s, inout uint from)
{
    const uint count = min(sdfgi_frame.light_count - first, BATCH), own = gl_LocalInvocationIndex;
    barrier();
    if (own == 0u)
        ray_count = 0u;
    barrier();
    unshadowed[own] = faces ? list_rays(first, find_candidates(first, count, bits, s)) : 0u;
    barrier();
    trace_rays(first);
    barrier();
    vec3 sum = vec3(0.0);
    for (uint rest = unshadowed[own]; rest != 0u; rest &= rest - 1u) {
        const uint light = first + uint(findLSB(rest));
        sum += light_on_surface(light, s);
        from |= sdfgi_lights_at(light).bit;
    }
    return sum;
}

void store_cell(uint entry, uint own)
{
    vec3 axes[6];
    for (uint a = 0u; a < 6u; a++)
        axes[a] = reflected[own][a];
    light_fill_axes(facing[own], axes);
    for (uint a = 0u; a < 6u; a++)
        if (any(greaterThan(axes[a], vec3(SDFGI_RGBE_MAX))))
            counter_add(SDFGI_COUNTER_VALUES_CLAMPED, 1u);
    direct_store(lit_cascade(), entry, sdfgi_light_pack(axes, light_cell_hash(lit_cascade(), cells[own])),
                 direct_lights_pack(lights[own], args.lit));
}

/* A cell that this workgroup may light. */
struct listed_cell {
    bool wanted;        /* it may have to be lit */
    bool reached;       /* it has */
    uint entry, lights; /* those whose direct light it has had */
    ivec3 cell;
};

listed_cell load_cell(uint own)
{
    listed_cell c;
    const uint cascade = lit_cascade();
    c.wanted = light_entry(cascade, args.only_dirty != 0u, args.first[cascade], args.end[cascade],
                           workgroup_index() * CELLS + own, c.entry);
    c.entry = c.wanted ? c.entry : 0u;
    c.cell = light_cell_from_index(cascade, sdfgi_light_cells_at(light_cell_slot(cascade, c.entry)));
    c.lights = direct_lights(sdfgi_direct_at(direct_word(cascade, DIRECT_LIGHTS, c.entry)));
    c.reached = args.moved == SDFGI_LIGHT_ALL || (c.lights & args.changed) != 0u;
    c.wanted = c.wanted && sdfgi_cell_is_valid(cascade, c.cell) && (args.moved != 0u || c.reached);
    return c;
}

/* Begins with the cells of the workgroup. False, for all threads, if none may have to be lit. */
bool begin_cells(uint own, uint axis, listed_cell c)
{
    if (axis == 0u) {
        cells[own] = c.cell;
        facing[own] = 0u;
        lights[own] = 0u;
        affected[own] = uint(c.reached);
    }
    if (gl_LocalInvocationIndex == 0u)
        some_wanted = 0u;
    barrier();
    if (c.wanted)
        atomicOr(some_wanted, 1u);
    barrier();
    return some_wanted != 0u;
}

void main()
{
    const uint own = gl_LocalInvocationIndex / 6u, axis = gl_LocalInvocationIndex % 6u;
    const listed_cell c = load_cell(own);
    if (!begin_cells(own, axis, c))
        return;
    const bool is_surface = c.wanted && light_cell_faces(lit_cascade(), c.cell, axis);
    if (is_surface)
        atomicOr(facing[own], 1u << axis);
    const surface s = surface_behind(c.cell, axis);
    starts[gl_LocalInvocationIndex] = s.start;
    if (!c.reached && is_surface && is_reached(s))
        atomicOr(affected[own], 1u);
    barrier();
    const bool lit = c.wanted && affected[own] != 0u, faces = is_surface && lit;
    /* What stands between a cell and a light that has not moved is known. */
    const uint bits = c.lights | args.moved;
    uint from = 0u;
    vec3 sum = vec3(0.0);
    for (uint first = 0u; first < sdfgi_frame.light_count; first += BATCH)
        sum += light_from_batch(first, bits, faces, s, from);
    reflected[own][axis] = faces ? sum * surface_albedo(s.block, axis) / PI : vec3(0.0);
    atomicOr(lights[own], from);
    barrier();
    if (lit && axis == 0u)
        store_cell(c.entry, own);
}
