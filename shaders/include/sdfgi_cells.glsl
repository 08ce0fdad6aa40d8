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
/* Places from which a surface point tries to read. */
#define SDFGI_CELLS_TRIES 3
/* Added to each weight, so that a cell that is alone counts although the point lies on the edge of its
 * reach. */
#define SDFGI_CELLS_LEAST_WEIGHT 1e-4

/* ---- The list of light cells */

/* What sdfgi_light_blocks holds for the block of a texel. */
uvec4 sdfgi_light_block_of_texel(uint cascade, uvec3 texel)
{
    const uint bits = sdfgi_frame.resolution_log2 - 2u;
    const uvec3 block = texel >> 2u;
    return sdfgi_light_blocks[block.x | block.y << bits | block.z << (2u * bits) | cascade << (3u * bits)];
}

/* Whether a texel of a light block is a light cell; its entry in the light list. */
bool sdfgi_light_block_entry(uvec4 block, uvec3 texel, out uint entry)
{
    const uvec3 inside = texel & 3u;
    const uint bit = inside.x | inside.y << 2u | (inside.z & 1u) << 4u;
    const bool high = inside.z > 1u;
    const uint word = high ? block.y : block.x;
    entry = block.z + (high ? bitCount(block.x) : 0u) + bitCount(bitfieldExtract(word, 0, int(bit)));
    return (word >> bit & 1u) != 0u && entry < sdfgi_frame.light_cell_room;
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

/* What lookups read of a surface: the irradiance that arrives at it, or the radiance that leaves it. */
const uint SDFGI_CELLS_ARRIVING = 0u;
const uint SDFGI_CELLS_LEAVING = 1u;

/* The light of the surface of a light cell that faces an axis in rgb, and 1 in a; 0 where there is none. */
vec4 sdfgi_cell_surface(uint cascade, uint entry, uint axis, uint what)
{
    const uint index = sdfgi_surface_index(cascade, entry, axis), arriving = sdfgi_surfaces[index];
#ifdef SDFGI_REFLECTIONS
    if (what == SDFGI_CELLS_LEAVING)
        return arriving == SDFGI_SURFACE_NONE ? vec4(0.0) : vec4(sdfgi_rgbe_decode(sdfgi_light[index]), 1.0);
#endif
    return arriving < SDFGI_SURFACE_UNKNOWN ? vec4(sdfgi_rgbe_decode(arriving), 1.0) : vec4(0.0);
}

/* Light of a light cell along a normal, times weight, in rgb; its weight in a. The axes along which surfaces
 * face are weighed by the squares of the normal's components. */
vec4 sdfgi_cell_along(uint cascade, uint entry, vec3 normal, uint what)
{
    vec4 sum = vec4(0.0);
    for (uint major = 0u; major < 3u; major++) {
        const float along = sdfgi_trace_component(normal, int(major));
        /* Less than a hundredth of the weight: not worth a load. */
        if (abs(along) < 0.1)
            continue;
        const uint axis = 2u * major + (along < 0.0 ? 1u : 0u);
        sum += along * along * sdfgi_cell_surface(cascade, entry, axis, what);
    }
    return sum;
}

/* The same for a surface that is smaller than a cell, and faces along none of its cell's axes: the surfaces
 * around it stand for it, those that face away excepted. */
vec4 sdfgi_cell_around(uint cascade, uint entry, vec3 normal, uint what)
{
    vec4 sum = vec4(0.0);
    for (uint axis = 0u; axis < 6u; axis++) {
        const float along = sdfgi_trace_component(normal, int(axis >> 1u)) * ((axis & 1u) == 0u ? 1.0 : -1.0);
        sum += max(along + 0.5, 0.0) * sdfgi_cell_surface(cascade, entry, axis, what);
    }
    return sum;
}

/* ---- The point from which a surface point reads */

bool sdfgi_cell_is_light(uint cascade, ivec3 cell)
{
    uint entry;
    return sdfgi_cell_entry(cascade, cell, entry);
}

/* Moves a point out of an occupied cell, into a neighbouring light cell. Between the point and the face that
 * it leaves by, no sub-voxel of the cell is set: both are on the same side of a wall in the cell. Of several
 * faces the one along the normal is taken, or else the nearest. */
bool sdfgi_cells_leave(uint cascade, uvec2 bits, vec3 normal, inout vec3 at)
{
    const ivec3 cell = ivec3(floor(at)), subvoxel = ivec3(floor(at * 4.0)) & 3;
    const vec3 inside = at - vec3(cell);
    float best = -1e9;
    vec3 result = at;
    for (uint side = 0u; side < 6u; side++) {
        const ivec3 unit = sdfgi_axis_direction(side), axis = abs(unit);
        const bool forward = (side & 1u) == 0u;
        const ivec3 low = forward ? subvoxel : subvoxel * (1 - axis);
        const ivec3 high = forward ? max(subvoxel, 3 * axis) : subvoxel;
        const float along = dot(inside, vec3(axis)), range = forward ? 1.0 - along : along;
        const float score = 2.0 * dot(normal, vec3(unit)) - range;
        if (score <= best || (bits & sdfgi_trace_box_bits(uvec3(low), uvec3(high))) != uvec2(0u) ||
            !sdfgi_cell_is_light(cascade, cell + unit))
            continue;
        best = score;
        result = at + vec3(unit) * (range + SDFGI_CELLS_INSIDE);
    }
    at = result;
    return best > -1e9;
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

/* Moves a point into an empty cell, if it is not in one. A point in a set sub-voxel is first moved a little
 * towards the viewer, who is known to be on the open side of the surface. False if there is no way. */
bool sdfgi_cells_find_open(uint cascade, vec3 normal, vec3 eye, inout vec3 at)
{
    uvec2 bits = sdfgi_cell_bits(cascade, ivec3(floor(at)));
    if (sdfgi_cells_is_set(bits, at)) {
        at += sdfgi_cells_from_metric(eye) * SDFGI_CELLS_TOWARDS_EYE;
        bits = sdfgi_cell_bits(cascade, ivec3(floor(at)));
        if (sdfgi_cells_is_set(bits, at)) {
            if (!sdfgi_cells_step_out(cascade, bits, normal, eye, at))
                return false;
            bits = sdfgi_cell_bits(cascade, ivec3(floor(at)));
        }
    }
    return bits == uvec2(0u) || sdfgi_cells_leave(cascade, bits, normal, at);
}

/* ---- Interpolation */

/* The cells of an interpolation are numbered by the axes along which they differ from the cell that holds the
 * point, a bit each: first that cell, then those that share a face with it, an edge, and a corner. */
const uint SDFGI_CELLS_ORDER = 0x76534210u;

/* Interpolates the light cells around a point in an empty cell. Those beyond an edge or a corner take part
 * only if a light cell that shares a face with the point's cell leads to them: others may be behind walls. */
vec4 sdfgi_cells_interpolate(uint cascade, vec3 at, vec3 normal, bool around, uint what)
{
    const ivec3 own = ivec3(floor(at));
    const vec3 off = at - vec3(own) - 0.5;
    const ivec3 side = ivec3(sign(off));
    uint open = 0u; /* a bit per axis: the neighbour along it is a light cell */
    vec4 sum = vec4(0.0);
    for (uint i = 0u; i < 8u; i++) {
        const uint moved = SDFGI_CELLS_ORDER >> (4u * i) & 7u;
        const bool beyond_face = bitCount(moved) > 1;
        if (beyond_face && (moved & open) == 0u)
            continue;
        const ivec3 axes = ivec3(moved & 1u, moved >> 1u & 1u, moved >> 2u);
        const vec3 near = mix(1.0 - abs(off), abs(off), vec3(axes));
        uint entry;
        if (!sdfgi_cell_entry(cascade, own + axes * side, entry))
            continue;
        open |= beyond_face ? 0u : moved;
        const float weight = near.x * near.y * near.z + SDFGI_CELLS_LEAST_WEIGHT;
        if (around)
            sum += weight * sdfgi_cell_around(cascade, entry, normal, what);
        else
            sum += weight * sdfgi_cell_along(cascade, entry, normal, what);
    }
    return sum;
}

/* Light of the surface at a point in the cell space of a cascade, times weight, in rgb, and its weight in a:
 * radiance, or irradiance over pi, times exposure. The weight is 0 if no light cell on the point's side of
 * the surface is near. `eye` leads towards the viewer, in cell widths, and is at most SDFGI_CELLS_REACH long.
 *
 * A first try begins right above the surface. Where that finds nothing, in a niche or at a small thing,
 * others begin farther off and nearer to the viewer. A point in the air has no other places: what is near it
 * need not be on its side of a wall, and its normal may lead into one. But the surfaces around stand for one
 * that the air's cell does not know. */
vec4 sdfgi_cells_lookup(uint cascade, vec3 pos, vec3 normal, vec3 eye, uint what)
{
    const vec3 low = vec3(sdfgi_frame.cascades[cascade].valid_low) + 1.5,
               high = vec3(sdfgi_frame.cascades[cascade].valid_high) - 1.5;
    const bool at_surface = sdfgi_cell_bits(cascade, ivec3(floor(clamp(pos, low, high)))) != uvec2(0u);
    const int tries = at_surface ? SDFGI_CELLS_TRIES : 2;
    vec4 sum = vec4(0.0);
    for (int i = 0; i < tries && sum.a <= 0.0; i++) {
        const float place = at_surface ? float(i) : 0.0;
        const vec3 above = (place + 1.0) * SDFGI_CELLS_OFF_SURFACE * sdfgi_frame.normal_bias * normal;
        const vec3 towards = SDFGI_CELLS_TOWARDS_EYE * place * place * eye;
        vec3 at = clamp(pos + sdfgi_cells_from_metric(above + towards), low, high);
        if (!at_surface && sdfgi_cell_bits(cascade, ivec3(floor(at))) != uvec2(0u))
            at = clamp(pos, low, high);
        if (sdfgi_cells_find_open(cascade, normal, eye, at))
            sum = sdfgi_cells_interpolate(cascade, at, normal, i > 0, what);
    }
    return sum;
}

#endif
