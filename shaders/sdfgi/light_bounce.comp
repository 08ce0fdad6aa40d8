/* SPDX-License-Identifier: MIT
 * Per light cell, and per axis along which a surface faces: the irradiance that arrives, which lookups read;
 * and outgoing radiance, that is, direct light, and the irradiance times bounce gain. Emission is not part of
 * it: whoever reads outgoing light adds that of the surface which a ray hits.
 * A thread per light cell that is visited (visits.glsl), per dirty light cell, or for all. */
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
#define SDFGI_WRITES_LIGHT
#define SDFGI_WRITES_SURFACES
#include "../lib/on_cpu.glsl"
#include "light_blocks.glsl"
#include "gathered.glsl"
#include "bounce.glsl"
#include "../include/sdfgi_cells.glsl"

layout(local_size_x = SDFGI_GROUP_LINEAR) in;
SDFGI_PUSH(sdfgi_light_bounce_args);
#include "visits_or_all.glsl"

/* Albedo times feedback, capped below 1 so that light in a closed white room stays finite. */
vec3 bounce_gain(vec3 albedo)
{
    const vec3 gain = albedo * sdfgi_frame.bounce_feedback;
    if (any(greaterThan(gain, vec3(SDFGI_MAX_BOUNCE_GAIN))))
        counter_add(SDFGI_COUNTER_BOUNCE_CLAMPED, 1u);
    return min(gain, vec3(SDFGI_MAX_BOUNCE_GAIN));
}

/* Irradiance over pi times exposure at a surface. */
struct surface_light {
    bool known;
    vec3 estimate;  /* what its outgoing light follows */
    vec3 displayed; /* what lookups show */
};

surface_light light_from_probes(uint cascade, ivec3 cell, vec3 normal)
{
    const bounce_light light =
        bounce_light_cell(cascade, cell, normal, visibility_bits_of_cell(cascade, cell));
    return surface_light(light.weight > 0.0, light.estimate, light.displayed);
}

/* True if what probes tell matters: as long as the cell has gathered little or nothing itself. */
bool asks_probes(uint cascade, uint entry)
{
    return args.without_probes == 0u &&
           (!gathers() || gathered_load_state(cascade, entry).mean == GATHERED_NOTHING);
}

/* What the cell has gathered itself, or what probes tell if it asks them. */
surface_light light_arriving(uint cascade, uint entry, ivec3 cell, uint axis, vec3 normal, bool asks)
{
    gathered_state state = gathered_state(0u, GATHERED_NOTHING, 0u, 0u);
    gathered_light gathered = gathered_light(vec3(0.0), vec3(0.0));
    if (gathers()) {
        state = gathered_load_state(cascade, entry);
        gathered = gathered_load(cascade, entry, axis);
    }
    surface_light probes = surface_light(false, vec3(0.0), vec3(0.0));
    if (asks)
        probes = light_from_probes(cascade, cell, normal);
    if (!gathers())
        return probes;
    surface_light light;
    light.known =
        gathered_irradiance(state, gathered, vec4(probes.displayed, float(probes.known)), light.displayed);
    light.known =
        gathered_irradiance(state, gathered, vec4(probes.estimate, float(probes.known)), light.estimate);
    return light;
}

/* Of outgoing light: so much has to change at least if cells that see a surface are to be woken. Rounding
 * makes less of what is stored. */
const float CHANGED = 1.0 / 32.0;

float brightest_channel(vec3 light)
{
    return max(light.r, max(light.g, light.b));
}

/* What direct light on a surface has become since its outgoing light was added up: what is not bounced of
 * that was direct light. Nothing if a sun has changed a little alone: that wakes no cell. */
vec3 direct_change(uint cascade, uint entry, uint axis, vec3 direct, vec3 gain)
{
    const uint lights = sdfgi_direct_at(direct_word(cascade, DIRECT_LIGHTS, entry));
    if (direct_lit(lights) == uint(SDFGI_LIGHT_DRIFTED))
        return vec3(0.0);
    const vec3 leaving = sdfgi_rgbe_decode(sdfgi_light_at(sdfgi_surface_index(cascade, entry, axis)));
    const uint arriving = sdfgi_gathered_at(gathered_word(cascade, GATHERED_RAW + axis, entry));
    const vec3 bounced = arriving < SDFGI_SURFACE_UNKNOWN ? gain * sdfgi_rgbe_decode(arriving) : vec3(0.0);
    return abs(direct - (leaving - bounced));
}

/* By how much a woken cell has found more light or less than it showed before, if that is no noise: more than
 * three deviations. In its first cycle the newest visits count most. */
vec3 bounce_change(uint cascade, uint entry, uint axis, vec3 gain)
{
    const gathered_state state = gathered_load_state(cascade, entry);
    const gathered_light gathered = gathered_load(cascade, entry, axis);
    const float visits = float(state.visits),
                noise = gathered_load_noise(cascade, entry).sum / max(visits, 1.0);
    const vec3 change = abs(gathered.sum - gathered.mean);
    const bool sure = state.mean == GATHERED_OUTDATED && visits > 1.0 &&
                      brightest_channel(change) > 3.0 * sqrt(noise / GATHERED_RECENT_VISITS) *
                                                      brightest_channel(max(gathered.sum, gathered.mean));
    return sure ? gain * change : vec3(0.0);
}

/* True if the cells that see a surface are to be woken. */
bool wakes_others(uint cascade, uint entry, uint axis, vec3 direct, vec3 gain, vec3 leaving)
{
    if (!gathers() || sdfgi_frame.changes_are_local == 0u)
        return false;
    const vec3 change =
        direct_change(cascade, entry, axis, direct, gain) + bounce_change(cascade, entry, axis, gain);
    return brightest_channel(change) > CHANGED * (brightest_channel(leaving) + sdfgi_frame.dark);
}

uint packed_light(surface_light light)
{
    return light.known ? min(sdfgi_rgbe_encode(light.displayed), SDFGI_SURFACE_UNKNOWN - 1u)
                       : SDFGI_SURFACE_UNKNOWN;
}

/* True if lookups show what arrives without the filter: where there is none, and until the filter comes to a
 * surface that is new. One that was there before shows what the filter has made of it. */
bool shows_at_once(uint index)
{
    return !gathers() || args.only_dirty != 0u && sdfgi_surfaces_at(index) >= SDFGI_SURFACE_UNKNOWN;
}

void bounce(uint cascade, uint entry, bool asks)
{
    const uint slot = light_cell_slot(cascade, entry);
    const ivec3 cell = light_cell_from_index(cascade, sdfgi_light_cells_at(slot));
    if (!sdfgi_cell_is_valid(cascade, cell))
        return;
    const uint facing = light_cell_facing(cascade, cell);
    const uvec2 direct = direct_load(cascade, entry);

    vec3 axes[6];
    uint arriving[6];
    for (uint a = 0u; a < 6u; a++) {
        axes[a] = vec3(0.0);
        arriving[a] = SDFGI_SURFACE_NONE;
    }
    /* Axes that surfaces face, one after another, and not all six under a condition: threads of a group look
     * at as many as one of them has, and software drivers run what is under a condition in any case. Most
     * have one: a loop that asks at its beginning goes round once more there, for nothing. */
    uint left = facing;
    bool changed = false;
    do {
        if (left == 0u)
            break;
        const uint axis = uint(findLSB(left));
        const uint block = sdfgi_block_index(cascade, cell - sdfgi_axis_direction(axis));
        const surface_light light =
            light_arriving(cascade, entry, cell, axis, surface_normal(block, axis), asks);
        const vec3 gain = bounce_gain(surface_albedo(block, axis)),
                   unbounced = sdfgi_light_unpack_axis(direct, axis),
                   leaving = unbounced + gain * light.estimate;
        changed = changed || wakes_others(cascade, entry, axis, unbounced, gain, leaving);
        if (any(greaterThan(leaving, vec3(SDFGI_RGBE_MAX))))
            counter_add(SDFGI_COUNTER_VALUES_CLAMPED, 1u);
        for (uint a = 0u; a < 6u; a++) {
            axes[a] = a == axis ? leaving : axes[a];
            arriving[a] = a == axis ? packed_light(light) : arriving[a];
        }
        left &= left - 1u;
    } while (left != 0u);
    if (changed && gathered_load_state(cascade, entry).mean != GATHERED_NOTHING)
        sdfgi_gathered[gathered_word(cascade, GATHERED_CHANGED, entry)] = sdfgi_frame.next_epoch;
    for (uint a = 0u; a < 6u; a++) {
        if (gathers())
            sdfgi_gathered[gathered_word(cascade, GATHERED_RAW + a, entry)] = arriving[a];
        if (shows_at_once(sdfgi_surface_index(cascade, entry, a)))
            sdfgi_surfaces[sdfgi_surface_index(cascade, entry, a)] = arriving[a];
    }
    light_fill_axes(facing, axes);
    const float rounding = sdfgi_random_unit(light_cell_hash(cascade, cell));
    for (uint a = 0u; a < 6u; a++)
        sdfgi_light[sdfgi_surface_index(cascade, entry, a)] = sdfgi_rgbe_encode_rounded(axes[a], rounding);
}

/* Entry of the dirty light cell of this thread. False if there is none. */
bool dirty_entry(out uint entry)
{
    return light_entry(args.cascade, true, 0u, 0u, gl_GlobalInvocationID.x, entry);
}

#ifdef SDFGI_SOFTWARE
const uint BLOCKS = uint(SDFGI_BOUNCE_BLOCKS);
#else
const uint BLOCKS = 1u;
#endif

/* True if the dispatch is for a cell, or for all. */
bool was_lit(uint cascade, uint entry)
{
    const uint lights = sdfgi_direct_at(direct_word(cascade, DIRECT_LIGHTS, entry));
    return args.lit == 0u || direct_lit(lights) == args.lit;
}

/* The cell of a thread in the k-th block of its workgroup. A thread has one dirty cell at most. */
bool cell_of_block(uint k, out uint cascade, out uint entry)
{
    if (args.only_dirty == 0u)
        return visit_or_entry((workgroup_index() * BLOCKS + k) * gl_WorkGroupSize.x + gl_LocalInvocationIndex,
                              cascade, entry) &&
               was_lit(cascade, entry);
    cascade = args.cascade;
    return k == 0u && dirty_entry(entry);
}

#ifdef SDFGI_SOFTWARE

/* Goes on to the next cell that asks probes, or to the next one that does not. False if there is none. */
bool next_cell(bool asks, inout uint k, out uint cascade, out uint entry)
{
    const uint blocks = args.only_dirty != 0u ? 1u : BLOCKS;
    bool found = false;
    for (; !found && k < blocks; k++)
        found = cell_of_block(k, cascade, entry) && asks_probes(cascade, entry) == asks;
    k = k < blocks ? k : BLOCKS;
    return found;
}

/* Asks at its end: a loop that asks at its beginning goes round once more on these drivers, for nothing. */
void bounce_all(bool asks)
{
    uint cascade, entry, k = 0u;
    do
        if (next_cell(asks, k, cascade, entry))
            bounce(cascade, entry, asks);
    while (k < BLOCKS);
}

/* Two loops, so that only cells that ask probes take the time that reading them takes. */
void main()
{
    bounce_all(false);
    bounce_all(true);
}
#else
void main()
{
    uint cascade, entry;
    if (cell_of_block(0u, cascade, entry))
        bounce(cascade, entry, asks_probes(cascade, entry));
}
#endif
