/* SPDX-License-Identifier: MIT
 * Push constants, at most 128 bytes each, and material constants. */
#ifndef SDFGI_SHARED_ARGS_H
#define SDFGI_SHARED_ARGS_H

#include "types.h"
#include "constants.h"

#define SDFGI_MESH_INDEX_NONE 0u
#define SDFGI_MESH_INDEX_16 1u
#define SDFGI_MESH_INDEX_32 2u
#define SDFGI_MESH_HAS_UV 4u
#define SDFGI_MESH_HAS_COLOR 8u
#define SDFGI_MESH_MIRRORED 16u /* the transform turns triangles inside out */

struct sdfgi_voxelize_args {
    vec4 rows[3];        /* object space to sub-voxels from the instance's anchor: row-major 3x4 */
    ivec4 anchor;        /* xyz: the anchor's sub-voxel in the cascade; w: low corner of the box of cells to fill, 10 bits each */
    uint cascade;
    uint triangle_count;
    uint groups;         /* of SDFGI_GROUP_TRIANGLE triangles */
    uint slices;         /* workgroups that share the columns of a group of triangles */
    uint material;
    uint flags;          /* SDFGI_MESH_* */
    uint position_offset, position_stride; /* in words, as all that follow */
    uint uv_offset, uv_stride;
    uint color_offset, color_stride;
    uint index_offset;
    uint vertex_count;
    uint group_width;    /* workgroups along x */
    uint box_high;       /* high corner of the box, as anchor.w */
};
SDFGI_ASSERT_SIZE(sdfgi_voxelize_args, 128);

#define SDFGI_MATERIAL_ALBEDO_TEXTURE 1u
#define SDFGI_MATERIAL_EMISSION_TEXTURE 2u
#define SDFGI_MATERIAL_DOUBLE_SIDED_EMISSION 4u

struct sdfgi_material_params {
    vec4 albedo;          /* w: alpha */
    vec4 emission;        /* in units of the scene's brightest emission; w: alpha cutoff, 0: opaque */
    vec4 albedo_uv[2];    /* rows of uv' = M (u, v, 1); w unused */
    vec4 emission_uv[2];
    uvec4 flags;          /* x: SDFGI_MATERIAL_* */
};
SDFGI_ASSERT_SIZE(sdfgi_material_params, 112);

/* Passes over cells, probes and light cells. */
struct sdfgi_pass_args {
    ivec4 low, high;      /* xyz: the box of cells that the pass is about, [low, high); x: the light cells, likewise */
    ivec4 before;         /* xyz: low corner of the cells whose storage the box takes; w: axis of content.glsl's strips, -1: none */
    uint cascade;
    uint step;            /* flood: jump length in cells; distance_plane, distance_exact: first cell along x; probe_blend: 1 at
                             the end of a ring; light cells: 1 for those in renewed blocks */
    uint source;          /* flood: which of the two pointer halves is read; distance_plane, distance_exact: where the cells
                             along x end; light_direct: how many threads there are to a ray at most */
    uint fresh;           /* 1: light_mark, no earlier list counts; bit per cascade: probe_blend, no earlier ring counts;
                             light_bounce, no probe has a value yet */
};
SDFGI_ASSERT_SIZE(sdfgi_pass_args, 64);

/* Boxes of cells that changed: distances near them are searched anew. */

struct sdfgi_stale_args {
    uint cascade;
    uint first;           /* block along x */
    uint box_count;       /* 0: everything changed */
    uint corners[3 * SDFGI_MAX_CHANGES]; /* per box and axis: first cell, and 16 bits above the one after the last */
};
SDFGI_ASSERT_SIZE(sdfgi_stale_args, 84);

struct sdfgi_gather_args {
    vec4 inverse_view_projection[4]; /* columns */
    uint width, height;
    float background_depth;
    uint reserved;
};
SDFGI_ASSERT_SIZE(sdfgi_gather_args, 80);

#endif
