/* SPDX-License-Identifier: MIT
 * Sizes and codes that C and GLSL must agree on. */
#ifndef SDFGI_SHARED_CONSTANTS_H
#define SDFGI_SHARED_CONSTANTS_H

#define SDFGI_MAX_CASCADES 8
/* Dirty boxes of a cascade: a scroll adds up to three slabs, and as many leave the cascade. */
#define SDFGI_MAX_CHANGES 6

/* Dirty bounds: a box around what a change removed and one around what it added, for each of so many strips
 * across the cascade. See sdfgi/dirty_bounds.glsl. */
#define SDFGI_BOUNDS_STRIPS 16
/* Words from box to box: 128 bytes, because atomics on one cache line wait for each other. */
#define SDFGI_BOUNDS_STRIDE 32
#define SDFGI_BOUNDS_BYTES  (2 * SDFGI_BOUNDS_STRIPS * SDFGI_BOUNDS_STRIDE * 4) /* of one cascade */
/* Cells: boxes are stored relative to this, and no cell that leaves a cascade is so far from it. */
#define SDFGI_BOUNDS_ORIGIN 4096

#define SDFGI_PROBE_SPACING 8 /* cells from probe to probe */
#define SDFGI_SUBVOXELS     4 /* sub-voxels along a side of a cell: 64 bits per cell */
/* Hashes of a probe's place in the world repeat after so many probes: a scene that is moved by that has the
 * same light to the bit. */
#define SDFGI_HASH_PERIOD 64
/* Cells: the longest distance that is stored. A multiple of 8. */
#define SDFGI_DISTANCE_REACH 16

/* Irradiance atlas: each probe has an octahedral map with so many texels along a side and in all. The
 * outermost texels lie on the edges of the map. */
#define SDFGI_IRRADIANCE_TEXELS 5
#define SDFGI_IRRADIANCE_COUNT  25
/* vec4 per probe: the sums of its texels, and one for the history of the probe (probe_common.glsl). */
#define SDFGI_SUMS_STRIDE 26
/* Depths: texels along a side of a probe's octahedral map, without its border and with it. */
#define SDFGI_OCCLUSION_TEXELS 16
#define SDFGI_OCCLUSION_STRIDE 18
/* Cells: the greatest depth. Probes are read from within their cages, whose diagonal is 8 sqrt(3) = 13.9. */
#define SDFGI_OCCLUSION_RANGE 14.0

/* Steps of a ray at most. The longest path through a cascade of 256 cells crosses 3 * 256 cells, but steps of
 * the distance field are longer than a cell. A ray that needs more steps grazes a surface, and counts as a
 * hit (HARD_CASES row 10). */
#define SDFGI_TRACE_STEP_CAP 512

/* Codes in the ray cache besides packed hits: the ray must be traced, it ended in the sky, it hit a surface
 * that has no light cell, or it ran out of steps. */
#define SDFGI_RAY_UNKNOWN 0u
#define SDFGI_RAY_SKY     0xffffffffu
#define SDFGI_RAY_UNLIT   0xfffffffeu
#define SDFGI_RAY_CAPPED  0xfffffffdu

/* A probe's state, which sdfgi_space.glsl packs. NEW is set when the probe entered the cascade or was moved;
 * its light then belongs to another position. The next placement clears NEW. */
#define SDFGI_PROBE_DEAD       0x80000000u /* it has no place to stand */
#define SDFGI_PROBE_MOVED      0x40000000u /* it stands off its lattice point */
#define SDFGI_PROBE_NEW        0x20000000u
#define SDFGI_PROBE_LINK_SHIFT 15u /* three bits: it sees the next probe along x, y, z */

/* Set in the second word of the direct light of every light cell. */
#define SDFGI_LIGHT_VALID 0x40000000u
/* Boxes around geometry that has changed, for rays that tell whether they cross one. */
#define SDFGI_EDITED_BOXES 8
/* Words of the direct light of a light cell: see sdfgi/light_cells.glsl. */
#define SDFGI_DIRECT_WORDS 3
/* Bits of lights, and a mask of all. A number above them tells which change of lights has lit a cell last,
 * from 1 to _MOST_LIT; _DRIFTED: suns that have changed a little. */
#define SDFGI_LIGHT_BITS     24
#define SDFGI_LIGHT_ALL      0xffffffu
#define SDFGI_LIGHT_MOST_LIT 254
#define SDFGI_LIGHT_DRIFTED  255
/* Irradiance of a light cell along an axis that no surface faces, and of a surface of which nothing is known.
 * As RGB9E5 they are the largest whites. */
#define SDFGI_SURFACE_NONE    0xffffffffu
#define SDFGI_SURFACE_UNKNOWN 0xfffffffeu
/* Words of what a light cell has gathered: see sdfgi/gathered.glsl. */
#define SDFGI_GATHERED_WORDS 33
/* Words of a light cell that are kept when the light list is written again: its direct light; its outgoing
 * light and its irradiance along six axes each; and what it has gathered. */
#define SDFGI_LIGHT_KEPT_WORDS (SDFGI_DIRECT_WORDS + 6 + 6 + SDFGI_GATHERED_WORDS)
/* Visits in a rough gather cycle, rays that a visit sends from a light cell along one axis, and cells that a
 * workgroup visits. */
#define SDFGI_ROUGH_VISITS 8
#define SDFGI_VISIT_RAYS   16
#define SDFGI_VISIT_CELLS  8
/* Frames of an epoch at least, if something changes in each of them. An odd number: the first visits of an
 * epoch count most, and a lamp that is switched in every frame would be on in all of them, or off. With 16
 * the mean of its light was 1.06 of what it should be. */
#define SDFGI_EPOCH_FRAMES 17
/* In the first frames of all, and in those after lights have changed, a visit in a first cycle sends so many
 * times as many rays, and a workgroup visits so many times fewer cells. */
#define SDFGI_NEW_RAYS     4
#define SDFGI_FILTER_CELLS 16 /* that a workgroup of the filter takes */
/* Entries whose bits share a word of SEEN, and parts of that buffer: see shared/seen.h. */
#define SDFGI_SEEN_BITS  32
#define SDFGI_SEEN_PARTS 3

/* A small relative change of a light cell over a gather cycle: stored radiance is rounded by as much. */
#define SDFGI_SMALL_CHANGE (1.0 / 512.0)
/* Emitters: an albedo block in which something emits. A cascade lists so many at most; words of one in the
 * list, and of the list of a cascade: see sdfgi/emitters.glsl. */
#define SDFGI_MAX_EMITTERS    256
#define SDFGI_EMITTER_WORDS   8
#define SDFGI_EMITTERS_STRIDE (8 + SDFGI_EMITTER_WORDS * SDFGI_MAX_EMITTERS)
/* Rays that a visit sends from a light cell along one axis towards listed emitters. */
#define SDFGI_VISIT_EMITTER_RAYS 4
/* A probe has a sample towards an emitter for so many at random; its words in the ray cache: see
 * sdfgi/emitter_samples.glsl. */
#define SDFGI_SAMPLES_PER_EMITTER_SAMPLE 25
#define SDFGI_EMITTER_SAMPLE_WORDS       4

/* Bounce gain is capped below 1, so that light between white surfaces converges (HARD_CASES row 34). */
#define SDFGI_MAX_BOUNCE_GAIN 0.99

/* Every device accepts so many workgroups along an axis. */
#define SDFGI_MAX_GROUPS 65535
/* Workgroups along x that voxelise an instance at most: few, so that meshes in use have some along z, too. */
#define SDFGI_VOXELIZE_WIDTH 1024
/* Workgroup sizes. Devices are asked for the most threads that any has. */
#define SDFGI_MOST_THREADS      192 /* they share the rays of SDFGI_VISIT_CELLS light cells */
#define SDFGI_GROUP_CELLS       4  /* 4x4x4: one thread per cell */
#define SDFGI_GROUP_LINEAR      64 /* one thread per element of a list */
#define SDFGI_CELLS_OF_SURFACES 16 /* light cells that a workgroup lights directly */
#define SDFGI_RESOLVE_BLOCKS    16 /* albedo blocks of a thread of voxel_resolve on software drivers */
#define SDFGI_BOUNCE_BLOCKS     4  /* light cells of a thread of light_bounce on software drivers, about */
#define SDFGI_GROUP_SURFACES    (6 * SDFGI_CELLS_OF_SURFACES) /* one thread per axis of a light cell */
#define SDFGI_GROUP_LINES       128 /* threads that share SDFGI_LINES lines of cells, or a layer */
#define SDFGI_LINES             8   /* lines of cells per workgroup */
#define SDFGI_GROUP_CUBES       128 /* threads that find the empty cubes of a tile: shared/boxes.h */
#define SDFGI_GROUP_BOXES       128 /* threads that choose the empty boxes of as many words and octants */
#define SDFGI_GROUP_COLUMNS     32  /* columns of cells per workgroup */
#define SDFGI_GROUP_TRIANGLE    64  /* threads that share as many triangles */
#define SDFGI_GROUP_PROBE       32  /* threads that share one probe */
#define SDFGI_LISTED_RAYS       4   /* rays that a thread of ray_list looks at */
#define SDFGI_GROUP_RAYS        128 /* one thread per ray of a frame, or threads that share a probe's rays */
#define SDFGI_GROUP_OCCLUSION   64  /* threads that share one probe's 256 depths */
#define SDFGI_GROUP_EMITTERS    128 /* threads that list the emitters of a cascade */
#define SDFGI_GROUP_VISITS      128 /* threads that list visits, one per word of SEEN */
#define SDFGI_GROUP_PIXELS      8   /* 8x8: one thread per pixel */
#define SDFGI_GROUP_REFLECT     128 /* one thread per ray of a picture */
#define SDFGI_GROUP_TILES       16  /* pixels along a side of the square of tiles that a workgroup lists */

/* Pixels along a side of the square over which the rays of a rough surface are spread. */
#define SDFGI_RAYS_SIDE 4
/* Words before the lists of rays and tiles that a view has. Each list has three words of indirect arguments,
 * and a count. */
#define SDFGI_TILES_RAYS   0
#define SDFGI_TILES_TILES  4
#define SDFGI_TILES_HEADER 8
/* Pixels along each axis from one answer of a rough lobe to the next, and along a side of the square whose
 * answers a workgroup makes. */
#define SDFGI_LOBE_STEP    4
#define SDFGI_GROUP_LOBES  32

/* gather_sparse: a workgroup looks up so many samples, one a thread, and fills the squares between them. Its
 * list of pixels must fit 16 KiB, and 128 threads are what every device has. */
#define SDFGI_SAMPLES_X       16
#define SDFGI_SAMPLES_Y       8
#define SDFGI_SAMPLE_STEP_MAX 4

/* A cascade is voxelised in parts, one after another, which share the accumulators: in SDFGI_VOXEL_PARTS, or
 * fewer if they have less than SDFGI_VOXEL_PART_CELLS. The accumulators of 2^17 cells take less than the
 * distance search of 128^3. */
#define SDFGI_VOXEL_PARTS      16
#define SDFGI_VOXEL_PART_CELLS (1u << 17)

/* Accumulators per albedo block (2^3 cells): planes of a word per block in the scratch buffer (scratch.h).
 * Those from SDFGI_ACCUM_EMISSION on are there only if something emits. Sides are +x -x +y -y +z -z, and a
 * side has two layers of cells along its axis. */
#define SDFGI_ACCUM_ALBEDO         0   /* per side and layer 4 planes: sum in 1/SDFGI_ALBEDO_STEPS, count */
#define SDFGI_ACCUM_NORMAL         48  /* per dominant axis 3 planes: count, sums of two slopes */
#define SDFGI_ACCUM_FRONT          57  /* per side 16 planes: fronts, see surface_front.glsl */
#define SDFGI_ACCUM_METAL          153 /* 2 planes: samples of metal, and the sum of their kinds */
#define SDFGI_ACCUM_EMISSION       155 /* per channel 2 planes: radiance times EMISSION_SIDES, 64 bits */
#define SDFGI_ACCUM_EMISSION_AREA  161 /* the emitters' own area, in 1/SDFGI_AREA_STEPS */
#define SDFGI_ACCUM_EMISSION_SIDES 162 /* 6 planes: columns of it that +x -x +y -y +z -z see, in the same */
#define SDFGI_ACCUM_PLANES         168
#define SDFGI_ALBEDO_STEPS         1023.0 /* as many as 10 bits hold */
#define SDFGI_AREA_STEPS           65535.0
/* Radiance in units of stored emission, W/(m^2 sr) unless something is brighter than the last of these: the
 * step of sums, the weight of their upper word, the most. The sun's disc has 2e7; 1e-4 are 1,678 steps. */
#define SDFGI_EMISSION_STEP  (1.0 / 16777216.0)
#define SDFGI_EMISSION_UPPER 256.0
#define SDFGI_EMISSION_MOST  67108864.0
#define SDFGI_SLOPE_STEPS    127.0
/* Samples of a dominant axis, and area of emitters, beyond which a block takes no more: three times the
 * former times SDFGI_ALBEDO_STEPS fits 32 bits, and so does the brightest emission of the latter and of some
 * threads more. */
#define SDFGI_ACCUM_MOST_SAMPLES (1u << 20)
#define SDFGI_ACCUM_MOST_AREA    (1u << 27)

/* Lights. */
#define SDFGI_LIGHT_KIND_DIRECTIONAL 0u
#define SDFGI_LIGHT_KIND_POINT       1u
#define SDFGI_LIGHT_KIND_SPOT        2u
#define SDFGI_LIGHT_CASTS_SHADOW     4u

/* Visibility methods, as enum sdfgi_visibility; NONE when sdfgi_use_occlusion is off. */
#define SDFGI_SHADER_VISIBILITY_CELL_MASK   0u
#define SDFGI_SHADER_VISIBILITY_PROBE_DEPTH 1u
#define SDFGI_SHADER_VISIBILITY_NONE        2u

#endif
