/* SPDX-License-Identifier: MIT
 * Cells, probes and cages: where they are, and where they are stored.
 *
 * Cell space of a cascade: one unit is one cell along each axis, and a cell is y_scale times as high as wide.
 * A local cell or probe counts from the cascade's low corner. Volumes are toroidal: when a cascade scrolls,
 * what stays keeps its texel or slot. */
#ifndef SDFGI_SPACE_GLSL
#define SDFGI_SPACE_GLSL

#include "sdfgi_resources.glsl"
#include "sdfgi_boxes.glsl"

int sdfgi_space_resolution()
{
    return int(sdfgi_frame.resolution);
}

/* Height of a cell over its width. */
float sdfgi_space_y_scale()
{
    return sdfgi_frame.y_scale;
}

/* From a vector in cell space to a metric one, in cell widths, and back. */
vec3 sdfgi_metric_from_cells(vec3 v)
{
    return vec3(v.x, v.y * sdfgi_space_y_scale(), v.z);
}

vec3 sdfgi_cells_from_metric(vec3 v)
{
    return vec3(v.x, v.y * (1.0 / sdfgi_space_y_scale()), v.z);
}

/* A direction without a component that is 0: each can be divided by. */
vec3 sdfgi_nonzero(vec3 dir)
{
    return mix(dir, vec3(1e-20), lessThan(abs(dir), vec3(1e-20)));
}

/* Unit vector of axis 0 +x, 1 -x, 2 +y, 3 -y, 4 +z, 5 -z. */
ivec3 sdfgi_axis_direction(uint axis)
{
    const uint major = axis >> 1u;
    return ivec3(major == 0u, major == 1u, major == 2u) * ((axis & 1u) == 0u ? 1 : -1);
}

bool sdfgi_cell_is_inside(ivec3 cell)
{
    return all(greaterThanEqual(cell, ivec3(0))) && all(lessThan(cell, ivec3(sdfgi_space_resolution())));
}

/* True for cells of the valid region. While a cascade scrolls, its old and its new place share them. */
bool sdfgi_cell_is_valid(uint cascade, ivec3 cell)
{
    return all(greaterThanEqual(cell, sdfgi_frame.cascades[cascade].valid_low)) &&
           all(lessThan(cell, sdfgi_frame.cascades[cascade].valid_high));
}

/* Texel of a local cell. */
uvec3 sdfgi_cell_texel(uint cascade, ivec3 cell)
{
    return uvec3(cell + sdfgi_frame.cascades[cascade].wrap) & (sdfgi_frame.resolution - 1u);
}

uint sdfgi_texel_index(uvec3 texel)
{
    const uint bits = sdfgi_frame.resolution_log2;
    return texel.x | texel.y << bits | texel.z << (2u * bits);
}

/* Index of a local cell in buffers with one element per cell of all cascades. */
uint sdfgi_cascade_texel_index(uint cascade, uvec3 texel)
{
    return sdfgi_texel_index(texel) | cascade << (3u * sdfgi_frame.resolution_log2);
}

uint sdfgi_cell_index(uint cascade, ivec3 cell)
{
    return sdfgi_cascade_texel_index(cascade, sdfgi_cell_texel(cascade, cell));
}

ivec3 sdfgi_cell_from_texel(uint cascade, uvec3 texel)
{
    return ivec3((texel - uvec3(sdfgi_frame.cascades[cascade].wrap)) & (sdfgi_frame.resolution - 1u));
}

uvec3 sdfgi_texel_from_index(uint index)
{
    const uint bits = sdfgi_frame.resolution_log2;
    return uvec3(index, index >> bits, index >> (2u * bits)) & (sdfgi_frame.resolution - 1u);
}

/* Index of the albedo block (2x2x2 cells) that holds a cell, within its cascade. */
uint sdfgi_albedo_block_index(uint cascade, ivec3 cell)
{
    const uvec3 block = sdfgi_cell_texel(cascade, cell) >> 1u;
    const uint bits = sdfgi_frame.resolution_log2 - 1u;
    return block.x | block.y << bits | block.z << (2u * bits);
}

/* The first texel of an albedo block, from its index within its cascade. */
uvec3 sdfgi_albedo_block_texel(uint block)
{
    const uint bits = sdfgi_frame.resolution_log2 - 1u, mask = (1u << bits) - 1u;
    return 2u * (uvec3(block, block >> bits, block >> (2u * bits)) & mask);
}

uint sdfgi_albedo_block_count()
{
    return 1u << (3u * (sdfgi_frame.resolution_log2 - 1u));
}

/* The set sub-voxels of a cell, from its index. */
uvec2 sdfgi_subvoxels(uint index)
{
    const uvec2 bits = sdfgi_bits_at(index);
    return sdfgi_has_boxes(bits) ? uvec2(0u) : bits;
}

/* True if there are none. */
bool sdfgi_is_empty(uint index)
{
    const uvec2 bits = sdfgi_bits_at(index);
    return sdfgi_has_boxes(bits) || (bits.x | bits.y) == 0u;
}

uvec2 sdfgi_cell_bits(uint cascade, ivec3 cell)
{
    return sdfgi_subvoxels(sdfgi_cell_index(cascade, cell));
}

bool sdfgi_cell_is_empty(uint cascade, ivec3 cell)
{
    return sdfgi_is_empty(sdfgi_cell_index(cascade, cell));
}

/* Units of a stored distance per cell width. The diagonal of a cascade, N sqrt(3) cells, fits 16 bits. */
float sdfgi_distance_units()
{
    return float(32768u >> sdfgi_frame.resolution_log2);
}

/* SDFGI_DISTANCE_REACH in these units: the longest distance that is stored. */
uint sdfgi_distance_reach()
{
    return uint(SDFGI_DISTANCE_REACH) << 15u - sdfgi_frame.resolution_log2;
}

/* Distance of the cell that is stored at `index`, in cell widths. It is at most 0.1 cell above the distance
 * to the nearest set sub-voxel, and at most SDFGI_DISTANCE_REACH. */
float sdfgi_stored_distance(uint index)
{
    const uint pair = sdfgi_distances_at(index >> 1u);
    return float((index & 1u) != 0u ? pair >> 16u : pair & 0xffffu) *
           (float(sdfgi_frame.resolution) / 32768.0);
}

float sdfgi_cell_distance(uint cascade, ivec3 cell)
{
    return sdfgi_stored_distance(sdfgi_cell_index(cascade, cell));
}

/* To the cell space of a cascade from that of cascade 0, and back. */
vec3 sdfgi_cascade_from_first(uint cascade, vec3 pos_first)
{
    return sdfgi_frame.cascades[cascade].from_first +
           sdfgi_frame.cascades[cascade].from_first_scale * pos_first;
}

vec3 sdfgi_first_from_cascade(uint cascade, vec3 pos_cascade)
{
    return (pos_cascade - sdfgi_frame.cascades[cascade].from_first) /
           sdfgi_frame.cascades[cascade].from_first_scale;
}

/* To cell space of cascade 0 from metres relative to the host's origin. */
vec3 sdfgi_first_from_position(vec3 position)
{
    return sdfgi_cells_from_metric((position - sdfgi_frame.cascades[0].origin_rel) *
                                   (1.0 / sdfgi_frame.cascades[0].cell_m));
}

vec3 sdfgi_position_from_cascade(uint cascade, vec3 pos_cascade)
{
    return sdfgi_frame.cascades[cascade].origin_rel +
           sdfgi_metric_from_cells(pos_cascade) * sdfgi_frame.cascades[cascade].cell_m;
}

/* False if nothing in the scene emits: the emission of blocks need not be read. */
bool sdfgi_surfaces_emit()
{
    return sdfgi_frame.emission_scale > 0.0;
}

/* ---- Probes: probe k of a cascade belongs to the lattice point at cell 8 k, k in [0, probes_per_side) per
 * axis. */

/* Slot of a local probe. */
ivec3 sdfgi_probe_slot(uint cascade, ivec3 probe)
{
    const ivec3 slot = probe + sdfgi_frame.cascades[cascade].probe_wrap;
    const int side = int(sdfgi_frame.probes_per_side);
    return slot - side * ivec3(greaterThanEqual(slot, ivec3(side)));
}

uint sdfgi_probe_index(uint cascade, ivec3 probe)
{
    const int side = int(sdfgi_frame.probes_per_side);
    const ivec3 slot = sdfgi_probe_slot(cascade, probe);
    return uint(slot.x + side * (slot.y + side * (slot.z + side * int(cascade))));
}

/* The state of a probe that has moved off its lattice point, into the centre of the cell at `offset` from it:
 * 5 bits per axis, biased by 16. */
uint sdfgi_probe_pack_moved(ivec3 offset)
{
    const uvec3 o = uvec3(offset + 16);
    return SDFGI_PROBE_MOVED | o.x | o.y << 5u | o.z << 10u;
}

/* True if a probe and the next one along an axis see each other. */
bool sdfgi_probe_is_linked(uint state, int axis)
{
    return (state >> (SDFGI_PROBE_LINK_SHIFT + uint(axis)) & 1u) != 0u;
}

bool sdfgi_probe_is_dead(uint state)
{
    return (state & SDFGI_PROBE_DEAD) != 0u;
}

/* True if the probe's lattice point is in the valid region or on its border. */
bool sdfgi_probe_is_valid(uint cascade, ivec3 probe)
{
    const ivec3 cell = probe * SDFGI_PROBE_SPACING;
    return all(greaterThanEqual(cell, sdfgi_frame.cascades[cascade].valid_low)) &&
           all(lessThanEqual(cell, sdfgi_frame.cascades[cascade].valid_high)) &&
           all(lessThan(sdfgi_frame.cascades[cascade].valid_low, sdfgi_frame.cascades[cascade].valid_high));
}

/* Position of a probe in cell space. */
vec3 sdfgi_probe_position(ivec3 probe, uint state)
{
    const vec3 lattice_point = vec3(probe * SDFGI_PROBE_SPACING);
    if ((state & SDFGI_PROBE_MOVED) == 0u)
        return lattice_point;
    return lattice_point + vec3(ivec3(uvec3(state, state >> 5u, state >> 10u) & 31u) - 16) + 0.5;
}

/* ---- Cages: a cage is named by its first probe. */

/* Offset from the first probe of a cage to its k-th. */
ivec3 sdfgi_cage_corner(int k)
{
    return ivec3(k & 1, k >> 1 & 1, k >> 2);
}

/* The cage that holds a position, or the nearest one in the valid region. */
ivec3 sdfgi_cage_of(uint cascade, vec3 pos)
{
    const ivec3 low = sdfgi_frame.cascades[cascade].valid_low / SDFGI_PROBE_SPACING;
    const ivec3 high = sdfgi_frame.cascades[cascade].valid_high / SDFGI_PROBE_SPACING - 1;
    return clamp(ivec3(floor(pos / float(SDFGI_PROBE_SPACING))), low, max(low, high));
}

/* A position within its cage, in [0, 1]^3. */
vec3 sdfgi_cage_coords(ivec3 cage, vec3 pos)
{
    return clamp(pos / float(SDFGI_PROBE_SPACING) - vec3(cage), 0.0, 1.0);
}

#endif
