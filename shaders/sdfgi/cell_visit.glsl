/* SPDX-License-Identifier: MIT
 * What a visit of cell_gather does for a surface of a cell: its rays, and what becomes of what they find. Who
 * includes this keeps the cells that are visited, and calls for rays: cell_visit_shared.glsl and
 * cell_visit_alone.glsl. */
#ifndef SDFGI_CELL_VISIT_GLSL
#define SDFGI_CELL_VISIT_GLSL

#include "cell_states.glsl"
#include "emitters.glsl"
#include "gather_cycle.glsl"
#include "metal.glsl"
#include "../include/sdfgi_cells.glsl"
#include "../include/sdfgi_sky.glsl"
#include "../include/sdfgi_trace.glsl"
#include "../lib/irradiance_pack.glsl"

SDFGI_PUSH(sdfgi_cell_gather_args);
#include "visit_light.glsl"
#include "visits.glsl"

const uint RAYS = uint(SDFGI_VISIT_RAYS);
const uint EMITTER_RAYS = uint(SDFGI_VISIT_EMITTER_RAYS), MOST_RAYS = RAYS + EMITTER_RAYS;

/* ---- Cells that are visited: `own` is the number of one */

struct visited_cell {
    ivec3 cell;
    uint entry;
    gathered_state state; /* with which the visit begins */
    uint times_rays;      /* how many times RAYS and EMITTER_RAYS its surfaces send */
    bool begins;          /* a cycle anew, since something has changed */
    float importance;     /* of all emitters, for the cell */
    bool watched;         /* what its rays hit is marked */
};

/* What a visit has found, of all surfaces of a cell. */
struct visit_notes {
    float change; /* how far a mean has changed */
    float light;  /* luminance of the brightest mean */
    float noise;  /* gathered_noise of the visit */
};

visited_cell cell_of(uint own);
visit_notes notes_of(uint own);
/* A ray of the cell has met what has changed. */
void wake(uint own);
/* The larger value of each note stays. */
void note(uint own, visit_notes found);

/* Chooses an emitter by its importance for a cell: the one in which `place`, of the sum of all, lies. `place`
 * then tells where in it, 0 to 1. `chance` is the probability of the choice; false if there is nothing to
 * choose. */
bool choose_emitter(uint cascade, uint own, inout float place, out emitter chosen, out float chance);

/* Importance of the cascade's emitters [first, end) for a cell. */
float sum_importance(uint cascade, ivec3 cell, uint first, uint end)
{
    float sum = 0.0;
    for (uint i = first; i < end; i++)
        sum += emitter_importance(emitter_load(cascade, i), vec3(cell) + 0.5);
    return sum;
}

/* Chooses among the emitters [first, end) the one in which `rest` of their importance lies: choose_emitter.
 */
bool choose_among(uint cascade, visited_cell own, uint first, uint end, float rest, out float place,
                  out emitter chosen, out float chance)
{
    float share = 0.0;
    for (uint i = first; i < end; i++) {
        rest -= share;
        chosen = emitter_load(cascade, i);
        share = emitter_importance(chosen, vec3(own.cell) + 0.5);
        if (rest < share)
            break;
    }
    place = clamp(rest / max(share, 1e-30), 0.0, 1.0);
    chance = share / max(own.importance, 1e-30);
    return share > 0.0;
}

/* ---- A surface */

/* What rays of a surface need to know of it. */
struct ray_source {
    uint own;         /* the number of its cell */
    vec3 pos, normal; /* pos: in the open, within the cell and close to the surface */
    vec3 surface;     /* where the surface is: on the faces of its sub-voxels, in the mean */
    uint visits;      /* before this one in the sequence of rays */
    uint shift;       /* of its random sequences */
};

/* Cells. So far from all surfaces rays start at least: closer, those of a slanted surface would meet its own
 * steps. Rays from the cell's centre saw a wall beside it from half a cell away; the indirect light of rooms
 * was up to 2 % too bright. */
const float RAY_CLEARANCE = 0.4;
/* Cells: how far within a light cell a ray goes on from metal, at least. */
const float INSIDE_CELL = 0.02;

ray_source source_of(uint cascade, uint surface)
{
    const uint own = surface / 6u, axis = surface % 6u;
    const ivec3 cell = cell_of(own).cell;
    const uint block = sdfgi_block_index(cascade, cell - sdfgi_axis_direction(axis));
    const uint shift = sdfgi_random_hash(light_cell_hash(cascade, cell) + 6u * sdfgi_frame.seed + axis);
    const float distance = sdfgi_cell_distance(cascade, cell),
                depth = clamp(distance - 0.5 / float(SDFGI_SUBVOXELS), 0.5, 1.0);
    const vec3 centre = vec3(cell) + 0.5, towards = -vec3(sdfgi_axis_direction(axis));
    return ray_source(own, centre + towards * clamp(distance - RAY_CLEARANCE, 0.0, 0.49),
                      surface_normal(block, axis), centre + towards * depth,
                      gather_cycle_visits_before(cell_of(own).state), shift);
}

/* ---- Changes */

/* True if rays of a cell tell whether a change reaches it. */
bool looks_for_changes(uint own)
{
    return sdfgi_frame.changes_are_local != 0u && gathered_epochs_behind(cell_of(own).state) > 0u;
}

const float NO_EDIT = 1e30;

/* Cells of its cascade from where a ray begins to the first place that it crosses where geometry has changed.
 */
float way_to_edit(uint cascade, vec3 from, vec3 dir)
{
    const vec3 inv_dir = 1.0 / sdfgi_nonzero(sdfgi_cells_from_metric(dir));
    float nearest = NO_EDIT;
    for (uint i = 0u; i < sdfgi_frame.edited_count; i++) {
        const vec3 low = sdfgi_cascade_from_first(cascade, vec3(sdfgi_frame.edited[i].low)) - from,
                   high = sdfgi_cascade_from_first(cascade, vec3(sdfgi_frame.edited[i].high)) - from;
        const vec3 a = low * inv_dir, b = high * inv_dir, near = min(a, b), far = max(a, b);
        const float enters = max(max(near.x, near.y), max(near.z, 0.0));
        if (enters <= min(far.x, min(far.y, far.z)))
            nearest = min(nearest, enters);
    }
    return nearest;
}

/* Wakes a cell if its ray, so many cells long, gets as far as such a place. */
void wake_within(uint own, float edit, float range)
{
    if (edit <= range + 1.0)
        wake(own);
}

void wake_by_edit(uint cascade, uint own, vec3 from, vec3 dir, float range)
{
    if (looks_for_changes(own))
        wake_within(own, way_to_edit(cascade, from, dir), range);
}

/* Wakes a cell if its ray has hit a surface whose light has changed. */
void wake_by_light(ray_source source, uint cascade, uint entry)
{
    if (looks_for_changes(source.own) &&
        gathered_is_behind(cell_of(source.own).state,
                           sdfgi_gathered_at(gathered_word(cascade, GATHERED_CHANGED, entry))))
        wake(source.own);
}

/* ---- Emitters */

/* How much of an emitter's light rays towards emitters bring; the others bring the rest. The balance
 * heuristic (Veach and Guibas 1995, "Optimally combining sampling techniques for Monte Carlo rendering"):
 * shares follow how densely each kind of ray meets the emitter. */
float share_of_emitter_rays(emitter e, float chance, vec3 dir, float range, float cosine)
{
    const float nearest = max(range, EMITTER_NEAR), shown = emitter_area_towards(e, -dir);
    const float towards = float(EMITTER_RAYS) * chance * nearest * nearest,
                at_random = float(RAYS) * max(cosine, 0.0) / 3.14159265 * shown;
    return towards / max(towards + at_random, 1e-30);
}

/* Light that a surface gets from the emitters, by one ray along `dir`: the `index`-th of a cycle. */
vec4 send_emitter_ray(uint cascade, ray_source source, uint index, out vec3 dir)
{
    dir = source.normal;
    vec3 place = sdfgi_random_r3(index, source.shift);
    emitter chosen;
    float chance;
    if (!choose_emitter(cascade, source.own, place.x, chosen, chance))
        return vec4(0.0);
    const emitter_point point = emitter_point_at(chosen, source.surface, place);
    const vec3 light = emitter_light(chosen, source.surface, source.normal, point.inside);
    const emitter_way way = emitter_way_to(source.pos, point.face);
    dir = way.dir;
    /* Rays at random start in the open, too: what they cannot meet does not count here either. */
    const float cosine = dot(source.normal, way.dir);
    if (light == vec3(0.0) || cosine <= 0.0)
        return vec4(0.0);
    /* Before the ray is traced, as less has to be kept then. */
    const float edit = looks_for_changes(source.own) ? way_to_edit(cascade, source.pos, way.dir) : NO_EDIT;
    const sdfgi_trace_hit hit = emitter_trace(cascade, chosen, source.pos, way);
    wake_within(source.own, edit, hit.hit ? hit.distance : way.range);
    if (hit.hit && !emitter_is_hit(chosen, hit, way.range))
        return vec4(0.0);
    const float share = share_of_emitter_rays(chosen, chance, way.dir, way.range, cosine);
    return vec4(light * (share / chance), 1.0);
}

/* Emission of what a ray at random has hit. Rays towards emitters bring a share of it if it is listed, but
 * none by way of metal. */
vec3 hit_emission(uint cascade, ray_source source, vec3 dir, sdfgi_trace_hit hit, bool by_metal)
{
    if (!sdfgi_surfaces_emit())
        return vec3(0.0);
    const uint block = sdfgi_block_index(hit.cascade, hit.solid);
    const vec3 emission = sdfgi_block_emission(block, hit.axis);
    if (by_metal || emission == vec3(0.0) || hit.cascade != cascade || !surface_is_listed_emitter(block))
        return emission;
    const emitter e =
        emitter_load(cascade, emitter_of_block(cascade, sdfgi_albedo_block_index(cascade, hit.solid)));
    const visited_cell own = cell_of(source.own);
    const float chance = emitter_importance(e, vec3(own.cell) + 0.5) / max(own.importance, 1e-30);
    return emission * (1.0 - share_of_emitter_rays(e, chance, dir, hit.distance, dot(source.normal, dir)));
}

/* ---- Rays at random */

/* Direction of ray `index` of a cycle: points of one sequence in the unit square, shifted by a hash of the
 * cell, and mapped to the hemisphere so that their density follows the cosine. */
vec3 ray_direction(vec3 normal, uint index, uint shift)
{
    const vec2 point = sdfgi_random_r2(index, shift);
    const float radius = sqrt(point.x), turn = 6.2831853 * point.y;
    const vec3 side =
        normalize(abs(normal.y) < 0.9 ? vec3(-normal.z, 0.0, normal.x) : vec3(0.0, normal.z, -normal.y));
    const vec3 up = cross(normal, side);
    return radius * (cos(turn) * side + sin(turn) * up) + sqrt(max(1.0 - point.x, 0.0)) * normal;
}

/* Where a ray has hit something, moved into the light cell before it: all of that is on the ray's side of
 * walls. */
vec3 place_before(uint cascade, vec3 from, vec3 dir, sdfgi_trace_hit hit)
{
    const vec3 at = sdfgi_first_from_cascade(cascade, from + sdfgi_cells_from_metric(dir) * hit.distance);
    const vec3 low = vec3(hit.cell) + INSIDE_CELL, high = vec3(hit.cell + 1) - INSIDE_CELL;
    return clamp(sdfgi_cascade_from_first(hit.cascade, at), low, high);
}

/* Marks the light cell that a ray of a watched cell hits, for one ray of eight: most are hit by many. */
void mark_hit(ray_source source, uint index, uint cascade, uint entry)
{
    if (!cell_of(source.own).watched || (sdfgi_random_hash(source.shift + index) & 7u) != 0u)
        return;
    const uint bit = 1u << entry % uint(SDFGI_SEEN_BITS);
    if ((atomicOr(sdfgi_seen[hit_word(true, cascade, entry)], bit) & bit) == 0u)
        atomicAdd(sdfgi_gathered[gathered_counter(SDFGI_COUNTER_CELLS_HIT + cascade)], 1u);
}

/* Light at the end of a ray, the `index`-th of a cycle: 0 in a if the surface that it hit has no light cell.
 * One loop, so that drivers compile the ray once. */
vec4 send_random_ray(uint cascade, ray_source source, uint index)
{
    vec3 dir = ray_direction(source.normal, index, source.shift), from = source.pos, share = vec3(1.0),
         light = vec3(0.0);
    uint in_cascade = cascade;
    sdfgi_trace_hit hit;
    for (uint i = 0u; i < 2u; i++) {
        hit = sdfgi_trace_ray(in_cascade, sdfgi_frame.cascade_count - 1u, from, dir, 1e9);
        if (i == 0u)
            wake_by_edit(cascade, source.own, from, dir, hit.hit ? hit.distance : 1e9);
        if (!hit.hit)
            return vec4(light + share * sdfgi_sky_towards(dir), 1.0);
        light += share * hit_emission(cascade, source, dir, hit, i > 0u);
        const uint block = sdfgi_block_index(hit.cascade, hit.solid);
        if (i > 0u || !hit.has_cell || surface_metal(block) == 0u)
            break;
        from = place_before(cascade, from, dir, hit);
        dir = metal_direction(block, hit.axis, dir, sdfgi_random_r2(index, source.shift + 1u));
        share = surface_albedo(block, hit.axis);
        in_cascade = hit.cascade;
    }
    uint entry;
    if (!hit.has_cell || !sdfgi_cell_entry(hit.cascade, hit.cell, entry))
        return vec4(0.0);
    mark_hit(source, index, hit.cascade, entry);
    wake_by_light(source, hit.cascade, entry);
    const vec3 leaving = sdfgi_rgbe_decode(sdfgi_light_at(sdfgi_surface_index(hit.cascade, entry, hit.axis)));
    return vec4(light + share * leaving, 1.0);
}

/* ---- Emitters that have changed */

/* Wakes the cell of a surface that sees a box around something that emits, or did. Few rays at random cross a
 * small one. */
void look_out(uint cascade, ray_source source)
{
    const uint i = sdfgi_random_hash(source.shift + source.visits) % sdfgi_frame.edited_emitter_count;
    const vec3 low = sdfgi_cascade_from_first(cascade, vec3(sdfgi_frame.edited_emitters[i].low)),
               high = sdfgi_cascade_from_first(cascade, vec3(sdfgi_frame.edited_emitters[i].high)),
               place = sdfgi_random_r3(source.visits, source.shift);
    const emitter_way way = emitter_way_to(source.pos, mix(low, high, place));
    if (!looks_for_changes(source.own) || dot(source.normal, way.dir) <= 0.0)
        return;
    const sdfgi_trace_hit hit =
        sdfgi_trace_solid(cascade, sdfgi_frame.cascade_count - 1u, source.pos, way.dir, way.range);
    wake_by_edit(cascade, source.own, source.pos, way.dir, hit.hit ? hit.distance : way.range);
}

/* ---- A visit */

/* Rays that a surface of a cell sends in a visit: at random, and towards emitters. */
struct visit_rays {
    uint at_random, to_emitters;
};

visit_rays rays_times(uint cascade, uint times)
{
    return visit_rays(RAYS * times, emitter_count(cascade) > 0u ? EMITTER_RAYS * times : 0u);
}

/* True if each surface sends one ray more, which looks out for emitters that have changed. */
bool surfaces_look_out()
{
    return sdfgi_frame.changes_are_local != 0u && sdfgi_frame.edited_emitter_count > 0u;
}

visit_rays rays_of(uint cascade, uint own)
{
    return rays_times(cascade, cell_of(own).times_rays);
}

/* visited_cell::times_rays of a cell in a state. */
uint times_rays_of(gathered_state state)
{
    return state.mean < GATHERED_FIRST ? args.new_rays : 1u;
}

/* Sum and mean with which a visit begins. Of a cycle that begins anew the mean is what the cell has shown. */
gathered_light load_light(uint cascade, visited_cell own, uint axis)
{
    gathered_light light = gathered_load(cascade, own.entry, axis);
    if (!own.begins)
        return light;
    vec3 shown;
    if (gathered_irradiance(gathered_load_state(cascade, own.entry), light, vec4(0.0), shown))
        light.mean = shown;
    light.sum = vec3(0.0);
    return light;
}

/* The gather cycle of a cell that is visited. */
gather_cycle cycle_of(uint cascade, visited_cell own)
{
    return gather_cycle_of(cascade, own.entry, own.state, args.visits[cascade]);
}

const float MOST_NOISE = 64.0; /* of a visit, so that sums are finite as half floats */

/* A visit counts as one of so many, at most, for from where light comes. */
const float LOW_LIGHT_VISITS = 64.0;

/* Adds a visit to what a surface knows of from where its light comes. `before`: luminance of its light. */
void add_low_light(uint cascade, uint axis, visited_cell own, float before, visit_light light)
{
    const float now = sdfgi_light_luminance(light.mean);
    if (!VISITS_KEEP_LOW_LIGHT || !(now > 0.0))
        return;
    const uint word = low_light_word(sdfgi_surface_index(cascade, own.entry, axis)),
               packed = sdfgi_seen[word];
    const float worth = own.state.mean >= GATHERED_FIRST ? gathered_worth(own.state) : 0.0,
                share = 1.0 / min(float(own.state.visits) + worth + 1.0, LOW_LIGHT_VISITS),
                of_visit = packed == 0u ? 1.0 : share * now / (share * now + (1.0 - share) * before);
    const sdfgi_low_light known = sdfgi_low_unpack(packed);
    const float rounding = sdfgi_random_unit(
        sdfgi_random_hash(light_cell_hash(cascade, own.cell) + 64u * axis + own.state.visits));
    sdfgi_seen[word] = sdfgi_low_pack(sdfgi_low_light(mix(known.low, light.low.low / now, of_visit),
                                                      mix(known.around, light.low.around / now, of_visit)),
                                      rounding);
}

/* Adds a visit to the sum of a surface. The last visit of a cycle makes the sum the mean. */
void add_visit(uint cascade, uint surface, visit_light light)
{
    const visited_cell own = cell_of(surface / 6u);
    const uint axis = surface % 6u;
    gathered_light gathered = load_light(cascade, own, axis);
    add_low_light(cascade, axis, own,
                  sdfgi_light_luminance(own.state.mean >= GATHERED_FIRST ? gathered.mean : gathered.sum),
                  light);
    gathered.sum = gathered_add(own.state, gathered, light.mean);
    const float shown =
        sdfgi_light_luminance(own.state.mean >= GATHERED_FIRST ? gathered.mean : gathered.sum) +
        sdfgi_frame.dark;
    visit_notes found = visit_notes(0.0, 0.0, min(light.variance / (shown * shown), MOST_NOISE));
    const gather_cycle cycle = cycle_of(cascade, own);
    if (cycle.ends) {
        const vec3 mean = gathered_mean(own.state, gathered.sum, own.state.visits + 1u);
        found.change = gather_cycle_change(cycle, own.state, mean, gathered.mean);
        found.light = sdfgi_light_luminance(mean);
        gathered = gathered_light(vec3(0.0), mean);
    }
    note(surface / 6u, found);
    gathered_store(cascade, own.entry, axis, gathered);
}

/* Tells how far the light of a cell has changed since its last mark. Returns the next one. Long cycles end
 * too seldom to have marks. While light drifts there are none: that it has, begins a new one. */
uint next_mark(uint cascade, gathered_state state, float light)
{
    if (state.mean == GATHERED_DRIFTS)
        return gathered_mark(light);
    if ((args.marks >> cascade & 1u) == 0u || state.mean >= GATHERED_GOES_ON)
        return state.mark;
    const uint mark = gathered_mark(light);
    atomicMax(sdfgi_gathered[gathered_counter(SDFGI_COUNTER_CELL_DRIFT + cascade)],
              floatBitsToUint(gathered_mark_change(state.mark, mark)));
    return mark;
}

void end_visit(uint cascade, uint number)
{
    const visited_cell own = cell_of(number);
    const visit_notes found = notes_of(number);
    gathered_state state = own.state;
    const gather_cycle cycle = cycle_of(cascade, own);
    const gathered_noise noise = gathered_load_noise(cascade, own.entry);
    const uint mean = cycle.ends ? cycle.mean : GATHERED_NOTHING;
    gathered_store_noise(cascade, own.entry, gathered_add_noise(state, noise, found.noise, mean));
    state.visits++;
    if (state.mean == GATHERED_DRIFTS)
        state.epoch = sdfgi_frame.epoch - min(gathered_epochs_behind(state), 1u) & EPOCH_MASK;
    if (cycle.ends)
        state = gathered_state(0u, gather_cycle_mean(cycle, own.state, found.change),
                               sdfgi_frame.epoch & EPOCH_MASK, next_mark(cascade, own.state, found.light));
    gathered_store_state(cascade, own.entry, state);
    /* Nothing has settled that goes on from what was known before sun or sky changed. */
    const bool drifts = state.mean == GATHERED_DRIFTS && state.visits % 8u == 0u;
    if (found.change != 0.0 || drifts)
        atomicMax(sdfgi_gathered[gathered_counter(SDFGI_COUNTER_CELL_CHANGE + cascade)],
                  floatBitsToUint(drifts ? 1.0 : found.change));
    if (found.change >= SDFGI_SMALL_CHANGE)
        atomicAdd(sdfgi_gathered[gathered_counter(SDFGI_COUNTER_CELLS_CHANGING + cascade)], 1u);
}

#endif
