/* SPDX-License-Identifier: MIT
 * The list of light cells: empty cells with an occupied face neighbour. An entry is the cell's texel index.
 * Direct light stands apart from it, as lib/light_pack.glsl packs it. */
#ifndef SDFGI_LIGHT_CELLS_GLSL
#define SDFGI_LIGHT_CELLS_GLSL

#include "surface.glsl"
#include "../lib/light_pack.glsl"
#include "../lib/random.glsl"

/* Where a light cell's rays to probes begin. From its middle many of them would run along edges of
 * sub-voxels, and rounding would decide what they hit: another driver, another answer (HARD_CASES row 57). */
const vec3 LIGHT_CELL_EYE = vec3(0.5) + vec3(0.0137, 0.0093, 0.0171);

layout(std430, set = SDFGI_SET_WORK, binding = SDFGI_BINDING_LIGHT_CELLS) buffer sdfgi_light_cells_buffer
{
    uint sdfgi_light_cells[];
};

/* Per cascade SDFGI_DIRECT_WORDS planes with a word per entry of the light list: two of direct light, as
 * lib/light_pack.glsl packs it, and the lights that it comes from. */
layout(std430, set = SDFGI_SET_WORK, binding = SDFGI_BINDING_DIRECT) buffer sdfgi_direct_buffer
{
    uint sdfgi_direct[];
};

uint light_cell_count(uint cascade)
{
    return min(indirect_number(uint(SDFGI_INDIRECT_CELLS) + cascade), sdfgi_frame.light_cell_room);
}

/* Depends only on the cell's place in the world, and not on the texel that stores it. */
uint light_cell_hash(uint cascade, ivec3 cell)
{
    const ivec3 base = sdfgi_frame.cascades[cascade].probe_base * SDFGI_PROBE_SPACING;
    return sdfgi_random_hash3((base + cell) & (SDFGI_HASH_PERIOD * SDFGI_PROBE_SPACING - 1), cascade);
}

/* A place within a cell, -0.5 to 0.5 from its middle, of a lattice: along any row of cells, and over any
 * patch of them, places are spread evenly. Each component is a sum of multiples of generalised golden ratios
 * (Roberts 2018, "The unreasonable effectiveness of quasirandom sequences"), modulo 1. They are rounded so
 * that places repeat where hashes do. */
vec3 light_cell_place(uint cascade, ivec3 cell)
{
    const uint period = uint(SDFGI_HASH_PERIOD * SDFGI_PROBE_SPACING);
    const ivec3 base = sdfgi_frame.cascades[cascade].probe_base * SDFGI_PROBE_SPACING;
    const uvec3 at = uvec3(base + cell), a = 419u * at, b = 343u * at, c = 281u * at,
                sum = uvec3(c.x + a.y + b.z, b.x + c.y + a.z, a.x + b.y + c.z);
    return (vec3(sum & (period - 1u)) + 0.5) / float(period) - 0.5;
}

/* Index of an entry. */
uint light_cell_slot(uint cascade, uint entry)
{
    return cascade * sdfgi_frame.light_cell_room + entry;
}

/* Word `plane` of the direct light of an entry. */
uint direct_word(uint cascade, uint plane, uint entry)
{
    return (cascade * uint(SDFGI_DIRECT_WORDS) + plane) * sdfgi_frame.light_cell_room + entry;
}

const uint DIRECT_LIGHTS = 2u;

uvec2 direct_load(uint cascade, uint entry)
{
    return uvec2(sdfgi_direct_at(direct_word(cascade, 0u, entry)),
                 sdfgi_direct_at(direct_word(cascade, 1u, entry)));
}

#ifdef SDFGI_WRITES_DIRECT
void direct_store(uint cascade, uint entry, uvec2 direct, uint lights)
{
    sdfgi_direct[direct_word(cascade, 0u, entry)] = direct.x;
    sdfgi_direct[direct_word(cascade, 1u, entry)] = direct.y;
    sdfgi_direct[direct_word(cascade, DIRECT_LIGHTS, entry)] = lights;
}
#endif

/* The lights whose direct light a cell has, in SDFGI_LIGHT_BITS bits; and above them the number of the change
 * of lights in which it was lit, 0 if that was none. */
uint direct_lights_pack(uint lights, uint lit)
{
    return lights | lit << uint(SDFGI_LIGHT_BITS);
}

uint direct_lights(uint packed)
{
    return packed & SDFGI_LIGHT_ALL;
}

uint direct_lit(uint packed)
{
    return packed >> uint(SDFGI_LIGHT_BITS);
}

/* The local cell with a texel index. */
ivec3 light_cell_from_index(uint cascade, uint index)
{
    return sdfgi_cell_from_texel(cascade, sdfgi_texel_from_index(index));
}

/* True if a surface of the cell faces along an axis: the neighbour behind it is occupied. */
bool light_cell_faces(uint cascade, ivec3 cell, uint axis)
{
    const ivec3 behind = cell - sdfgi_axis_direction(axis);
    return sdfgi_cell_is_valid(cascade, behind) && !sdfgi_cell_is_empty(cascade, behind);
}

/* A bit per axis along which a surface faces. */
uint light_cell_facing(uint cascade, ivec3 cell)
{
    uint facing = 0u;
    for (uint axis = 0u; axis < 6u; axis++)
        if (light_cell_faces(cascade, cell, axis))
            facing |= 1u << axis;
    return facing;
}

/* Gives axes along which no surface faces the mean of the others. A ray may hit a sub-voxel of a slope on a
 * side along which the slope does not face, and then reads the slope's light instead of black. */
void light_fill_axes(uint facing, inout vec3 axes[6])
{
    vec3 mean = vec3(0.0);
    for (int a = 0; a < 6; a++)
        mean += (facing >> a & 1u) != 0u ? axes[a] : vec3(0.0);
    mean /= float(max(bitCount(facing), 1));
    for (int a = 0; a < 6; a++)
        axes[a] = (facing >> a & 1u) != 0u ? axes[a] : mean;
}

#endif
