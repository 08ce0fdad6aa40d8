/* SPDX-License-Identifier: MIT
 * Sizes and codes that C and GLSL must agree on. */
#ifndef SDFGI_SHARED_CONSTANTS_H
#define SDFGI_SHARED_CONSTANTS_H

#define SDFGI_MAX_CASCADES 8
#define SDFGI_MAX_CHANGES                                                                                    \
    6 /* boxes of cells that a cascade makes new at once: three that enter it, three that leave */
/* Strips across a cascade in which boxes around what went and what came are kept, see
 * sdfgi/dirty_bounds.glsl. */
#define SDFGI_BOUNDS_STRIPS 16
#define SDFGI_BOUNDS_STRIDE                                                                                  \
    32 /* words from box to box: 128 bytes, as atomics on one cache line wait for each other */
#define SDFGI_BOUNDS_BYTES  (2 * SDFGI_BOUNDS_STRIPS * SDFGI_BOUNDS_STRIDE * 4) /* of one cascade */
#define SDFGI_BOUNDS_ORIGIN 4096 /* further than any cell that leaves is from the cascade */
#define SDFGI_PROBE_SPACING 8    /* cells between probes */
/* Probes after which hashed places repeat: a scene moved by so many probes has the same light to the bit. */
#define SDFGI_HASH_PERIOD 64
#define SDFGI_SUBVOXELS   4 /* sub-voxels along a side of a cell: 64 bits per cell */
/* Cells: what is further away than this is stored as this. Eight or a multiple. */
#define SDFGI_DISTANCE_REACH 16

/* Probes: an octahedron of this many texels a side, which spans the map from edge to edge. */
#define SDFGI_IRRADIANCE_TEXELS 5
#define SDFGI_IRRADIANCE_COUNT  25
#define SDFGI_SUMS_STRIDE                                                                                    \
    26 /* vec4 per probe: the sums of its texels, and what probe_common.glsl calls its memory */
#define SDFGI_OCCLUSION_TEXELS 16
#define SDFGI_OCCLUSION_STRIDE 18
/* A probe is read from within its cage, whose diagonal is 8 sqrt(3) = 13.9 cells; depths beyond tell nothing
 * more. */
#define SDFGI_OCCLUSION_RANGE 14.0

/* Every loop has a cap. The longest path through a cascade of 256 cells crosses 3 * 256 cells; distance steps
 * are longer, so a ray that needs more than this grazes a surface and counts as a hit (HARD_CASES row 10). */
#define SDFGI_TRACE_STEP_CAP 512

/* Codes in the ray cache besides packed hits. */
#define SDFGI_RAY_UNKNOWN 0u
#define SDFGI_RAY_SKY     0xffffffffu
#define SDFGI_RAY_UNLIT   0xfffffffeu

/* A probe's state, in sdfgi_space.glsl's packing. NEW: until the next placement, as it is new or stands
 * elsewhere, and what it gathered is not its own. */
#define SDFGI_PROBE_DEAD       0x80000000u
#define SDFGI_PROBE_MOVED      0x40000000u
#define SDFGI_PROBE_NEW        0x20000000u
#define SDFGI_PROBE_LINK_SHIFT 15u /* three bits: sees the next probe along x, y, z */

/* Second word of a light cell: it is one. */
#define SDFGI_LIGHT_VALID 0x40000000u

/* Longest contractive loop: HARD_CASES row 34. */
#define SDFGI_MAX_BOUNCE_GAIN 0.95

/* Workgroups along an axis that every device takes. */
#define SDFGI_MAX_GROUPS 65535
/* Workgroup sizes. */
#define SDFGI_GROUP_CELLS       4  /* 4x4x4: one thread per cell */
#define SDFGI_GROUP_LINEAR      64 /* one thread per element of a list */
#define SDFGI_CELLS_OF_SURFACES 16 /* light cells that a workgroup lights directly */
#define SDFGI_GROUP_SURFACES    (6 * SDFGI_CELLS_OF_SURFACES) /* one thread per axis of a light cell */
#define SDFGI_GROUP_LINES       128 /* threads that share eight lines of cells, or a layer */
#define SDFGI_LINES             8   /* lines of a workgroup */
#define SDFGI_GROUP_COLUMNS     32  /* columns of cells that they share */
#define SDFGI_GROUP_TRIANGLE    64  /* threads that share as many triangles */
#define SDFGI_GROUP_PROBE       32  /* threads that share one probe */
#define SDFGI_GROUP_RAYS        128 /* one thread per ray of a frame; threads that share a probe's remembered rays \
                                     */
#define SDFGI_GROUP_OCCLUSION 64 /* threads that share one probe's 256 depths */
#define SDFGI_GROUP_PIXELS    8  /* 8x8: one thread per pixel */

/* Accumulators per albedo block (2x2x2 cells): planes of a word per block in the scratch buffer (scratch.h).
 */
#define SDFGI_ACCUM_ALBEDO   0 /* 3: sum of albedo in 1/255 */
#define SDFGI_ACCUM_EMISSION 3 /* 3: sum of emission in SDFGI_EMISSION_STEPS of the scene's brightest */
#define SDFGI_ACCUM_EMISSION_COVERED                                                                         \
    6 /* cross-sections of columns that emitters cover, in 1/SDFGI_EMISSION_STEPS */
#define SDFGI_ACCUM_EMISSION_FACING 7 /* OR of a bit per axis +x -x +y -y +z -z that emission is seen from   \
                                       */
#define SDFGI_ACCUM_NORMAL   8        /* 3 classes (dominant axis x, y, z) of (count, slope, slope) */
#define SDFGI_ACCUM_PLANES   17
#define SDFGI_EMISSION_STEPS 65535.0
#define SDFGI_SLOPE_STEPS    127.0

/* Lights. */
#define SDFGI_LIGHT_KIND_DIRECTIONAL 0u
#define SDFGI_LIGHT_KIND_POINT       1u
#define SDFGI_LIGHT_KIND_SPOT        2u
#define SDFGI_LIGHT_CASTS_SHADOW     4u

/* Visibility methods, as enum sdfgi_visibility; NONE when sdfgi_use_occlusion is off. */
#define SDFGI_SHADER_VISIBILITY_CELL_MASK   0u
#define SDFGI_SHADER_VISIBILITY_PROBE_DEPTH 1u
#define SDFGI_SHADER_VISIBILITY_TRACED      2u
#define SDFGI_SHADER_VISIBILITY_NONE        3u

#endif
