/* SPDX-License-Identifier: MIT
 * Light cells as lookups see them. A light cell is an empty cell next to a surface. It keeps, for each axis
 * along which a surface faces, the irradiance that arrives at that surface. A surface point reads the light
 * cells around it and interpolates. No ray is sent: that a cell lies on the point's own side of a wall
 * follows from the occupancy bits of a single cell. */
#ifndef SDFGI_CELLS_GLSL
#define SDFGI_CELLS_GLSL

#include "sdfgi_space.glsl"
#include "sdfgi_trace_cell.glsl"
#include "../lib/rgbe.glsl"

/* Cells. A point that leaves a cell goes so far into the next one. */
#define SDFGI_CELLS_INSIDE 0.01
/* Cell widths: farthest place towards the viewer from which a surface point reads. */
#define SDFGI_CELLS_REACH 2.5
/* Part of that by which a point in a set sub-voxel moves: half a cell, beyond the far side of its sub-voxel.
 * The second place is as far away, the third four times as far. */
#define SDFGI_CELLS_TOWARDS_EYE 0.2
/* Cell widths. Beyond the sub-voxels of a flat surface, which are a quarter of a cell wide. */
#define SDFGI_CELLS_OFF_SURFACE 0.35
/* Cell widths from a surface to the middle of what is interpolated. The light cells before a level surface
 * are then always among the cells around. */
#define SDFGI_CELLS_MIDDLE 0.5
/* That place, and the number of those from which a surface point tries to read after it. */
#define SDFGI_CELLS_MOVING (-1)
#define SDFGI_CELLS_TRIES  3
/* A bit for each face of a cell, and after these one for each axis: the cells before and behind the cell
 * count, on both sides of what stands in it. */
#define SDFGI_CELLS_ALL_FACES 63u
#define SDFGI_CELLS_ASTRIDE   6
/* Square of the normal's component along an axis from which on the surface faces it: steps of light cells are
 * one cell high then, up to an angle of 39 degrees. From an occupied cell the way out is along the longest
 * component, or the two that are as long. */
#define SDFGI_CELLS_FACED          0.6
#define SDFGI_CELLS_FACED_IN_SOLID 0.45
/* The normal's component upwards from which on ground is level: up to 6 degrees. */
#define SDFGI_CELLS_FLAT 0.995
/* Inverse of the sine of the angle, 6 degrees, from which on cells count that are a step up or down, and how
 * much they count where the surface is level. */
#define SDFGI_CELLS_STEEP          10.0
#define SDFGI_CELLS_LEVEL          0.02
#define SDFGI_CELLS_LEVEL_IN_SOLID 0.1
/* Less of an axis is not worth its loads. */
#define SDFGI_CELLS_LEAST_SHARE 0.01
/* Added to each weight, so that a cell that is alone counts although the point lies on the edge of its
 * reach. */
#define SDFGI_CELLS_LEAST_WEIGHT 1e-4
/* How much light counts that leaves no surface: where surfaces of a light cell face along other axes alone,
 * their mean stands for it. It tells where nothing else does. */
#define SDFGI_CELLS_STAND_IN 1e-5

/* ---- The list of light cells */

/* What sdfgi_light_blocks holds for the half of a block in which a texel lies. */
uvec2 sdfgi_light_block_of_texel(uint cascade, uvec3 texel)
{
    const uint bits = sdfgi_frame.resolution_log2 - 2u;
    const uvec3 block = texel >> 2u;
    const uint index = block.x | block.y << bits | block.z << (2u * bits) | cascade << (3u * bits);
    return sdfgi_light_blocks_at(2u * index + (texel.z >> 1u & 1u));
}

/* Whether a texel of half a light block is a light cell; its entry in the light list. */
bool sdfgi_light_block_entry(uvec2 part, uvec3 texel, out uint entry)
{
    const uint bit = texel.x & 3u | (texel.y & 3u) << 2u | (texel.z & 1u) << 4u;
    entry = part.y + bitCount(bitfieldExtract(part.x, 0, int(bit)));
    return (part.x >> bit & 1u) != 0u && entry < sdfgi_frame.light_cell_room;
}

/* Finds the entry of a local cell in the light list. False if the cell is no light cell. */
bool sdfgi_cell_entry(uint cascade, ivec3 cell, out uint entry)
{
    const uvec3 texel = sdfgi_cell_texel(cascade, cell);
    return sdfgi_light_block_entry(sdfgi_light_block_of_texel(cascade, texel), texel, entry);
}

/* Index of the irradiance along an axis of a light cell, and of its outgoing light. */
uint sdfgi_surface_index(uint cascade, uint entry, uint axis)
{
    return (cascade * 6u + axis) * sdfgi_frame.light_cell_room + entry;
}

/* What lookups read of a surface: the irradiance that arrives at it, the radiance that leaves it, or what a
 * lobe answers to what arrives: sdfgi_rough_lobes.glsl. */
const uint SDFGI_CELLS_ARRIVING = 0u;
const uint SDFGI_CELLS_LEAVING = 1u;
const uint SDFGI_CELLS_ANSWER = 2u;

#ifdef SDFGI_ROUGH_LOBES
vec4 sdfgi_lobe_answer_of_surface(uint surface, uint arriving, uint axis, float weight);
#endif

/* The light of the surface of a light cell that faces an axis, times weight, in rgb; its weight in a, which
 * is 0 where there is none. */
vec4 sdfgi_cell_surface(uint cascade, uint entry, uint axis, float weight, uint what)
{
    const uint index = sdfgi_surface_index(cascade, entry, axis), arriving = sdfgi_surfaces_at(index);
#ifdef SDFGI_ROUGH_LOBES
    if (what == SDFGI_CELLS_ANSWER)
        return sdfgi_lobe_answer_of_surface(index, arriving, axis, weight);
#endif
#ifdef SDFGI_REFLECTIONS
    if (what == SDFGI_CELLS_LEAVING) {
        const float counts = arriving == SDFGI_SURFACE_NONE ? SDFGI_CELLS_STAND_IN * weight : weight;
        return vec4(sdfgi_rgbe_decode_weighted(sdfgi_light_at(index), counts), counts);
    }
#endif
    const float counts = arriving < SDFGI_SURFACE_UNKNOWN ? weight : 0.0;
    return vec4(sdfgi_rgbe_decode_weighted(arriving, counts), counts);
}

/* How much a surface counts that stands for one smaller than a cell, by the cosine between their normals. */
float sdfgi_cells_share_around(float along)
{
    return max(along + 0.5, 0.0);
}

/* ---- The point from which a surface point reads */

bool sdfgi_cell_is_light(uint cascade, ivec3 cell)
{
    uint entry;
    return sdfgi_cell_entry(cascade, cell, entry);
}

/* The bits along the lines of four sub-voxels through one of a cell, for each axis. */
uvec3 sdfgi_cells_lines(uvec2 bits, uvec3 subvoxel)
{
    const uint slice = (subvoxel.z > 1u ? bits.y : bits.x) >> (16u * (subvoxel.z & 1u));
    const uint y = slice >> subvoxel.x;
    const uvec2 z = bits >> (subvoxel.x + 4u * subvoxel.y);
    return uvec3(slice >> (4u * subvoxel.y) & 15u,
                 (y & 1u) | (y >> 3u & 2u) | (y >> 6u & 4u) | (y >> 9u & 8u),
                 (z.x & 1u) | (z.x >> 15u & 2u) | (z.y & 1u) << 2u | (z.y >> 13u & 8u));
}

/* The faces of a cell towards which no sub-voxel of it is set, a bit each, seen from a point in the cell. */
uint sdfgi_cells_open_faces(uvec2 bits, vec3 at)
{
    const uvec3 subvoxel = uvec3(ivec3(floor(at * 4.0)) & 3);
    const uvec3 lines = sdfgi_cells_lines(bits, subvoxel), ahead = lines >> subvoxel,
                behind = lines & ((uvec3(2u) << subvoxel) - 1u);
    return uint(ahead.x == 0u) | uint(behind.x == 0u) << 1u | uint(ahead.y == 0u) << 2u |
           uint(behind.y == 0u) << 3u | uint(ahead.z == 0u) << 4u | uint(behind.z == 0u) << 5u;
}

/* Moves a point out of an occupied cell, into a neighbouring light cell. Between the point and the face that
 * it leaves by, no sub-voxel of the cell is set: both are on the same side of a wall in the cell. The best
 * way, the one along the normal or else the nearest, mostly leads to a light cell, so few are looked at. */
bool sdfgi_cells_leave(uint cascade, uvec2 bits, vec3 normal, inout vec3 at)
{
    const vec3 inside = at - floor(at), forward = 2.0 * normal - 1.0 + inside,
               backward = -2.0 * normal - inside;
    const float scores[6] = float[6](forward.x, backward.x, forward.y, backward.y, forward.z, backward.z);
    uint open = sdfgi_cells_open_faces(bits, at);
    while (open != 0u) {
        uint best = uint(findLSB(open)); /* of scores that are no numbers, any */
        float score = -1e9;
        for (uint side = 0u; side < 6u; side++)
            if ((open >> side & 1u) != 0u && scores[side] > score) {
                best = side;
                score = scores[side];
            }
        const ivec3 unit = sdfgi_axis_direction(best);
        if (sdfgi_cell_is_light(cascade, ivec3(floor(at)) + unit)) {
            const float along = dot(at - floor(at), vec3(abs(unit)));
            at += vec3(unit) * (((best & 1u) == 0u ? 1.0 - along : along) + SDFGI_CELLS_INSIDE);
            return true;
        }
        open &= ~(1u << best);
    }
    return false;
}

bool sdfgi_cells_is_set(uvec2 bits, vec3 at)
{
    return sdfgi_trace_is_set(bits, sdfgi_trace_pack_subvoxel(ivec3(floor(at * 4.0)) & 3));
}

/* Moves a point off level ground, or a ceiling: out of a layer of sub-voxels that are all set, into one above
 * or below it that is not set and is nearer to the viewer. A sight line that grazes the ground runs in its
 * set sub-voxels for many cells, and a level normal does not lead out of them either. A surface at an angle
 * fills no layer: there the way up could lead to its far side. */
bool sdfgi_cells_step_out(uint cascade, uvec2 bits, vec3 normal, vec3 eye, inout vec3 at)
{
    const bool along_z = (sdfgi_frame.up_axis & 1u) != 0u;
    const bvec3 vertical = bvec3(false, !along_z, along_z);
    const vec3 axis = vec3(vertical);
    const uvec3 depth = uvec3(vertical) * (uint(floor(dot(at, axis) * 4.0)) & 3u);
    const uvec2 layer = sdfgi_trace_box_bits(depth, depth + 3u * uvec3(not(vertical)));
    const vec3 up = axis * sign(dot(eye, axis));
    at += 0.25 * up;
    return (bits & layer) == layer && dot(normal, up) > -0.5 &&
           !sdfgi_cells_is_set(sdfgi_cell_bits(cascade, ivec3(floor(at))), at);
}

/* Moves a point that is in a set sub-voxel out of it: a little towards the viewer, who is known to be on the
 * open side of the surface. `bits` are those of its cell. False if there is no way. */
bool sdfgi_cells_unset(uint cascade, vec3 normal, vec3 eye, inout vec3 at, inout uvec2 bits)
{
    if (!sdfgi_cells_is_set(bits, at))
        return true;
    at += sdfgi_cells_from_metric(eye) * SDFGI_CELLS_TOWARDS_EYE;
    bits = sdfgi_cell_bits(cascade, ivec3(floor(at)));
    if (!sdfgi_cells_is_set(bits, at))
        return true;
    const bool found = sdfgi_cells_step_out(cascade, bits, normal, eye, at);
    bits = sdfgi_cell_bits(cascade, ivec3(floor(at)));
    return found;
}

/* Where light is interpolated. */
struct sdfgi_cells_place {
    vec3 at;
    uint open;     /* the faces by which a point may leave the cell that holds the place, and
                      SDFGI_CELLS_ASTRIDE */
    bool in_solid; /* sub-voxels of that cell are set */
};

/* A place near a point, if that is in the same cell, or in an empty one beyond an open face; or else as far
 * as the point's cell goes. `bits` and `open` are of the point's cell. */
sdfgi_cells_place sdfgi_cells_move(vec3 from, uvec2 bits, uint open, vec3 to, bool to_empty)
{
    const vec3 cell = floor(from), way = floor(to) - cell;
    const float steps = dot(abs(way), vec3(1.0));
    const uvec3 sides = uvec3(greaterThan(way, vec3(0.0))) | uvec3(lessThan(way, vec3(0.0))) << 1u;
    const bool beyond = steps == 1.0 && to_empty && ((sides.x | sides.y << 2u | sides.z << 4u) & open) != 0u;
    return sdfgi_cells_place(steps == 0.0 || beyond ? to : clamp(to, cell, cell + (1.0 - SDFGI_CELLS_INSIDE)),
                             beyond ? SDFGI_CELLS_ALL_FACES : open, bits != uvec2(0u) && !beyond);
}

/* Level ground may run on below the edge of a thing that hangs into the upper quarter of an occupied cell,
 * from one side of it to the other. Across the thing the cells on both sides count then, instead of that cell
 * and one beside it: in the middle of the cell light would jump from one side to the other. The place moves
 * half a cell to the nearer one, and the farther one is beside it there. Few points are on such ground:
 * whether this one is is asked first. */
void sdfgi_cells_stand_astride(uvec2 bits, vec3 normal, inout sdfgi_cells_place place)
{
    const bool z_is_up = (sdfgi_frame.up_axis & 1u) != 0u, against = (sdfgi_frame.up_axis & 2u) != 0u;
    const float along_up = z_is_up ? normal.z : normal.y;
    if ((against ? -along_up : along_up) < SDFGI_CELLS_FLAT)
        return;
    const uvec2 upper = z_is_up ? (against ? uvec2(0xffffu, 0u) : uvec2(0u, 0xffff0000u))
                                : uvec2(against ? 0x000f000fu : 0xf000f000u);
    const uvec2 thing = bits & upper;
    const uint slices = thing.x | thing.y;
    const bool along_x = (slices & 0x11111111u) != 0u && (slices & 0x88888888u) != 0u,
               along_y = (slices & 0x000f000fu) != 0u && (slices & 0xf000f000u) != 0u,
               along_z = (thing.x & 0xffffu) != 0u && (thing.y >> 16u) != 0u,
               along_other = z_is_up ? along_y : along_z;
    const uint axis = along_other ? 0u : (z_is_up ? 1u : 2u);
    if (along_x == along_other || (place.open >> 2u * axis & 3u) != 3u)
        return;
    const vec3 unit = vec3(axis == 0u, axis == 1u, axis == 2u);
    place.at += unit * (0.5 * sign(dot(unit, fract(place.at)) - 0.5));
    place.open = SDFGI_CELLS_ALL_FACES | 1u << SDFGI_CELLS_ASTRIDE + axis;
}

/* ---- Interpolation */

/* The light cells of an interpolation, numbered by the axes along which they differ from the cell that holds
 * the point, a bit each. A weight is 0 where a cell takes no part; its entry then is any. */
struct sdfgi_cells_cage {
    uint entries[8];
    float weights[8];
};

/* Where the others of an interpolation lie: on the low side of the place's cell along an axis, or on the high
 * one. `use`: how much those count that lie along the axis that the surface faces, 0 to 1. */
struct sdfgi_cells_steps {
    bvec3 low;
    float use;
};

/* The light cells before a surface at an angle stand in steps. Across the axis that the surface faces, the
 * others lie where the place is nearest; along it towards the normal, if the place's cell is occupied, or
 * else up or down with the surface. Where the surface is level, what lies up or down belongs to a ledge.
 * `square`: of the normal's components. */
sdfgi_cells_steps sdfgi_cells_steps_at(bvec3 nearest, vec3 normal, vec3 square, bool in_solid)
{
    const bvec3 faced = greaterThan(square, vec3(in_solid ? SDFGI_CELLS_FACED_IN_SOLID : SDFGI_CELLS_FACED)),
                towards = lessThan(normal, vec3(0.0));
    const vec3 along = mix(mix(normal, -normal, nearest), vec3(0.0), faced);
    const float rise = along.x + along.y + along.z, tilt = 1.0 - max(square.x, max(square.y, square.z)),
                least = in_solid ? SDFGI_CELLS_STEEP * tilt + SDFGI_CELLS_LEVEL_IN_SOLID : SDFGI_CELLS_LEVEL;
    return sdfgi_cells_steps(mix(nearest, equal(towards, bvec3(in_solid || rise <= 0.0)), faced),
                             min(max(SDFGI_CELLS_STEEP * abs(rise), least), 1.0));
}

bool sdfgi_cells_is_empty(uint cascade, uvec3 texel)
{
    return sdfgi_is_empty(sdfgi_cascade_texel_index(cascade, texel));
}

/* The cells of a cage to which those lead that share a face with the place's cell, and that cell, a bit each.
 * `ways`: 1 for each axis along which the neighbour leads on. */
uint sdfgi_cells_led(uvec3 ways)
{
    return 1u | 0xaau * ways.x | 0xccu * ways.y | 0xf0u * ways.z;
}

/* The light cells around a place. Those that share a face with its cell take part if that face is open, and
 * those beyond an edge or a corner if an empty cell beyond an open face leads there: others may be behind
 * walls. Weights are trilinear, but the more even along an axis the more the surface faces it: only one of
 * two cells in a row has the surface then. All blocks are loaded before any is looked at, and so are the
 * surfaces afterwards: a load that waits for another one takes most of the time of a lookup. Light cells are
 * empty, and mostly they lead to all others: then no occupancy is loaded. */
sdfgi_cells_cage sdfgi_cells_cage_at(uint cascade, sdfgi_cells_place place, vec3 normal)
{
    const ivec3 own = ivec3(floor(place.at));
    const vec3 off = place.at - vec3(own) - 0.5, square = normal * normal;
    const sdfgi_cells_steps steps =
        sdfgi_cells_steps_at(lessThan(off, vec3(0.0)), normal, square, place.in_solid);
    const ivec3 apart = 1 + (ivec3(int(place.open)) >> ivec3(0, 1, 2) + SDFGI_CELLS_ASTRIDE & 1);
    const uvec3 here = sdfgi_cell_texel(cascade, own),
                beside = sdfgi_cell_texel(cascade, own + apart * (1 - 2 * ivec3(steps.low)));
    sdfgi_cells_cage cage;
    uint light = 0u; /* a bit per cell: it is a light cell */
    for (uint i = 0u; i < 8u; i++) {
        const uvec3 texel = mix(here, beside, bvec3(i & 1u, i & 2u, i & 4u));
        const bool is_light =
            sdfgi_light_block_entry(sdfgi_light_block_of_texel(cascade, texel), texel, cage.entries[i]);
        light |= is_light ? 1u << i : 0u;
    }
    /* Astride, the place's cell alone leads to those beside it. */
    const uint faces = place.open > SDFGI_CELLS_ALL_FACES && (light & 1u) == 0u ? 0u : place.open;
    const uvec3 open = uvec3(faces, faces >> 2u, faces >> 4u) >> uvec3(steps.low) & 1u;
    uvec3 ways = open & uvec3(light >> 1u, light >> 2u, light >> 4u);
    if ((light & ~sdfgi_cells_led(ways)) != 0u)
        ways = open & uvec3(sdfgi_cells_is_empty(cascade, uvec3(beside.x, here.yz)),
                            sdfgi_cells_is_empty(cascade, uvec3(here.x, beside.y, here.z)),
                            sdfgi_cells_is_empty(cascade, uvec3(here.xy, beside.z)));
    light &= sdfgi_cells_led(ways);
    const vec3 fall = min(2.0 - 2.0 * square, 1.0), near_here = 1.0 - fall * abs(off),
               near_beside = steps.use * (1.0 - fall) + fall * max(mix(off, -off, steps.low), 0.0);
    for (uint i = 0u; i < 8u; i++) {
        const bool counts = (light >> i & 1u) != 0u;
        const vec3 near = mix(near_here, near_beside, bvec3(i & 1u, i & 2u, i & 4u));
        cage.weights[i] = counts ? near.x * near.y * near.z + SDFGI_CELLS_LEAST_WEIGHT : 0.0;
        cage.entries[i] = counts ? cage.entries[i] : 0u;
    }
    return cage;
}

/* What arrives at the cells around a place, times weight, in rgb; its weight in a. The axes along which
 * surfaces face are weighed by the squares of the normal's components. `around`: the surface is smaller than
 * a cell, and faces along none of its cell's axes. Those around it stand for it, those that face away
 * excepted. One loop for both, with as many rounds as there are axes to read: its code takes time at every
 * pixel. */
vec4 sdfgi_cells_interpolate(uint cascade, sdfgi_cells_place place, vec3 normal, bool around, uint what)
{
    const sdfgi_cells_cage cage = sdfgi_cells_cage_at(cascade, place, normal);
    const uint count = around ? 6u : 3u;
    vec4 sum = vec4(0.0);
    for (uint k = 0u; k < count; k++) {
        const float component = sdfgi_trace_component(normal, int(around ? k >> 1u : k));
        const uint axis = around ? k : 2u * k + (component < 0.0 ? 1u : 0u);
        const float along = (axis & 1u) == 0u ? component : -component,
                    share = around ? sdfgi_cells_share_around(along) : along * along;
        if (share < SDFGI_CELLS_LEAST_SHARE)
            continue;
        vec4 of_axis = vec4(0.0);
        for (uint i = 0u; i < 8u; i++)
            of_axis += sdfgi_cell_surface(cascade, cage.entries[i], axis, cage.weights[i], what);
        sum += share * of_axis;
    }
    return sum;
}

#ifdef SDFGI_REFLECTIONS

/* The axis of a normal along an axis. */
uint sdfgi_cells_axis(vec3 normal)
{
    const uint major = abs(normal.x) > 0.5 ? 0u : (abs(normal.y) > 0.5 ? 1u : 2u);
    return 2u * major + (sdfgi_trace_component(normal, int(major)) < 0.0 ? 1u : 0u);
}

/* Light that leaves a surface which a ray hit, times weight, in rgb; its weight in a. `normal` is along an
 * axis. Light cells before such a surface lie side by side, so the four around the point along the surface
 * are all that there are where it is level. One of them that shares no face with the point's cell takes part
 * if another one leads there. */
vec4 sdfgi_cells_leaving(uint cascade, vec3 at, vec3 normal)
{
    const uint axis = sdfgi_cells_axis(normal);
    const ivec3 own = ivec3(floor(at)), right = axis < 2u ? ivec3(0, 1, 0) : ivec3(1, 0, 0),
                up = axis < 4u ? ivec3(0, 0, 1) : ivec3(0, 1, 0);
    const vec3 off = at - vec3(own) - 0.5;
    const ivec3 side = ivec3(sign(off));
    const vec2 far = abs(vec2(dot(off, vec3(right)), dot(off, vec3(up))));
    uint entries[4];
    uint light = 0u; /* a bit per cell: it is a light cell */
    for (uint i = 0u; i < 4u; i++) {
        const ivec3 cell = own + side * (right * int(i & 1u) + up * int(i >> 1u));
        light |= sdfgi_cell_entry(cascade, cell, entries[i]) ? 1u << i : 0u;
    }
    light &= (light & 6u) != 0u ? 15u : 1u;
    vec4 sum = vec4(0.0);
    for (uint i = 0u; i < 4u; i++) {
        const bool counts = (light >> i & 1u) != 0u;
        const vec2 near = mix(1.0 - far, far, bvec2(i & 1u, i & 2u));
        const float weight = counts ? near.x * near.y + SDFGI_CELLS_LEAST_WEIGHT : 0.0;
        sum += sdfgi_cell_surface(cascade, counts ? entries[i] : 0u, axis, weight, SDFGI_CELLS_LEAVING);
    }
    return sum;
}

#endif

/* What a lookup reads around a place. `around`: from all surfaces that do not face away. */
vec4 sdfgi_cells_read(uint cascade, sdfgi_cells_place place, vec3 normal, bool around, uint what)
{
#ifdef SDFGI_REFLECTIONS
    if (what == SDFGI_CELLS_LEAVING)
        return sdfgi_cells_leaving(cascade, place.at, normal);
#endif
    return sdfgi_cells_interpolate(cascade, place, normal, around, what);
}

/* A place near a surface point that sdfgi_cells_lookup reads around. `i`: SDFGI_CELLS_MOVING, or the number
 * of the place. `in_air`: no set sub-voxel is in the point's cell, as places before have found. */
vec4 sdfgi_cells_try(uint cascade, vec3 pos, vec3 normal, vec3 eye, uint what, int i, inout bool in_air)
{
    const vec3 low = sdfgi_frame.cascades[cascade].places_low,
               high = sdfgi_frame.cascades[cascade].places_high;
    const vec3 off = sdfgi_cells_from_metric(sdfgi_frame.normal_bias * normal),
               surface = clamp(pos, low, high), middle = clamp(pos + SDFGI_CELLS_MIDDLE * off, low, high);
    const float place = in_air ? 0.0 : float(max(i, 0));
    const vec3 towards = SDFGI_CELLS_TOWARDS_EYE * place * place * eye;
    vec3 at = clamp(pos + sdfgi_cells_from_metric(towards) + (place + 1.0) * (SDFGI_CELLS_OFF_SURFACE * off),
                    low, high);
    const bool middle_empty = sdfgi_cell_is_empty(cascade, ivec3(floor(middle)));
    uvec2 bits = sdfgi_cell_bits(cascade, ivec3(floor(at)));
    /* What a ray has hit is not in the air, and is tried at no place that moves, nor near one in a set
     * sub-voxel: drivers leave that out. */
    const bool was_hit = what == SDFGI_CELLS_LEAVING;
    in_air = !was_hit && sdfgi_cell_is_empty(cascade, ivec3(floor(surface)));
    if (in_air && bits != uvec2(0u)) {
        at = surface;
        bits = uvec2(0u);
    }
    bool found = was_hit ? !sdfgi_cells_is_set(bits, at) : sdfgi_cells_unset(cascade, normal, eye, at, bits);
    sdfgi_cells_place read = sdfgi_cells_place(at, SDFGI_CELLS_ALL_FACES, false);
    if (!was_hit && found && i < 0 && !in_air) {
        const uint open = bits == uvec2(0u) ? SDFGI_CELLS_ALL_FACES : sdfgi_cells_open_faces(bits, at);
        read = sdfgi_cells_move(at, bits, open, middle, middle_empty);
        if (read.in_solid)
            sdfgi_cells_stand_astride(bits, normal, read);
    } else if (found) {
        found = bits == uvec2(0u) || sdfgi_cells_leave(cascade, bits, normal, read.at);
    }
    return found ? sdfgi_cells_read(cascade, read, normal, i > 0, what) : vec4(0.0);
}

/* Light of the surface at a point in the cell space of a cascade, times weight, in rgb, and its weight in a:
 * radiance, or irradiance over pi, times exposure. The weight is 0 if no light cell on the point's side of
 * the surface is near. `eye` leads towards the viewer, in cell widths, and is at most SDFGI_CELLS_REACH long.
 *
 * A surface point first reads around a place that moves as the point does, so that nothing jumps where
 * surfaces are curved. What a ray hit does without: it is not looked at as closely. Where that finds nothing
 * it tries the light cell that it leaves into, and in a niche or at a small thing places farther off and
 * nearer to the viewer. A point in the air has no other places: what is near it need not be on its side of a
 * wall, and its normal may lead into one. But the surfaces around stand for one that the air's cell does not
 * know. The loop keeps no place: that would cost all threads registers, and few go round twice. */
vec4 sdfgi_cells_lookup(uint cascade, vec3 pos, vec3 normal, vec3 eye, uint what)
{
    vec4 sum = vec4(0.0);
    bool in_air = false;
    for (int i = what == SDFGI_CELLS_ARRIVING ? SDFGI_CELLS_MOVING : 0; i < SDFGI_CELLS_TRIES; i++) {
        sum = sdfgi_cells_try(cascade, pos, normal, eye, what, i, in_air);
        /* In the air the place that moves was the first one. */
        i = in_air ? max(i, 0) : i;
        if (sum.a > 0.0 || (in_air && i > 0))
            break;
    }
    return sum;
}

#endif
