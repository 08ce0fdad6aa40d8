/* SPDX-License-Identifier: MIT
 * Push constants: the arguments of each pass, at most 128 bytes. pass_table.h names the struct of a pass. */
#ifndef SDFGI_SHARED_ARGS_H
#define SDFGI_SHARED_ARGS_H

#include "types.h"
#include "constants.h"
#include "seen.h"

/* Passes over one cascade as a whole. */
struct sdfgi_cascade_args {
    uint cascade;
};
SDFGI_ASSERT_SIZE(sdfgi_cascade_args, 4);

/* region_clear, voxel_resolve: a box of cells to make again. */
struct sdfgi_region_args {
    ivec3 low; /* cells [low, high) */
    uint cascade;
    ivec3 high;
    int bounds_axis; /* axis across which dirty_bounds.glsl cuts its strips; -1: no bounds are needed */
    ivec3 before;    /* low corner of the cells whose texels the box takes over */
    uint padding_0;
};
SDFGI_ASSERT_SIZE(sdfgi_region_args, 48);

#define SDFGI_MESH_INDEX_BITS         63u /* bits of an index, 0: there are none */
#define SDFGI_MESH_INDEX_OFFSET_SHIFT 8u  /* 8 bits: where the first index begins, in bytes */

/* voxelize, voxelize_raster: instances of one mesh. */
struct sdfgi_voxelize_args {
    vec3 bounds_min; /* of the mesh, object space */
    uint cascade;
    vec3 bounds_max;
    uint triangle_count;
    ivec3 corner_low; /* low corner of the cascade, as the place of an instance: low words */
    uint slices;      /* workgroups that share the columns of a group of triangles */
    ivec3 corner_high;
    uint flags;                           /* SDFGI_MESH_* */
    uint position_fetch, position_stride; /* vertex_fetch.h; bytes */
    uint uv_fetch, uv_stride;             /* 0: there are none */
    uint color_fetch, color_stride;       /* 0: there are none */
    uint vertex_offset;                   /* added to indices, modulo 2^32 */
    uint vertex_count;
    uint box_low, box_high;      /* corners of the box of cells to fill, 10 bits per axis */
    uint first_draw, draw_count; /* in the list of instances */
};
SDFGI_ASSERT_SIZE(sdfgi_voxelize_args, 112);

/* distance_prepare: which light blocks need new distances. */
struct sdfgi_distance_prepare_args {
    uint cascade;
    uint first_block;                    /* along x */
    uint row_groups;                     /* workgroups that find set bits; 0: it is known where they are */
    uint box_count;                      /* dirty boxes; 0: everything is dirty */
    uint corners[3 * SDFGI_MAX_CHANGES]; /* per box and axis: low cell in the low 16 bits, high cell in the
                                            high ones */
};
SDFGI_ASSERT_SIZE(sdfgi_distance_prepare_args, 88);

/* distance_plane, distance_exact: cells [first_x, end_x) along x. */
struct sdfgi_distance_search_args {
    uint cascade;
    uint first_x, end_x;
};
SDFGI_ASSERT_SIZE(sdfgi_distance_search_args, 12);

/* flood_seed, flood_step, flood_distance. */
struct sdfgi_flood_args {
    uint cascade;
    uint jump;   /* length of the jump in cells */
    uint source; /* half of the pointers that is read: 0 or 1 */
};
SDFGI_ASSERT_SIZE(sdfgi_flood_args, 12);

struct sdfgi_light_mark_args {
    uint cascade;
    uint rebuild; /* 1: the previous list holds nothing of use */
};
SDFGI_ASSERT_SIZE(sdfgi_light_mark_args, 8);

/* Entries of the light lists to light directly: per cascade [first, end), or those in dirty blocks. Of these,
 * cells that a change of lights reaches: those that have direct light from lights of `changed`, and those
 * that would have it from lights of `moved` if nothing stood between. SDFGI_LIGHT_ALL in `moved`: all. */
struct sdfgi_light_direct_args {
    uint first[SDFGI_MAX_CASCADES], end[SDFGI_MAX_CASCADES];
    uint cascade;         /* of workgroups with z = 0; the next one follows at z = 1, and so on */
    uint only_dirty;      /* 1: cells in dirty blocks */
    uint threads_per_ray; /* threads over which a shadow ray is spread at most */
    uint changed, moved;  /* bits of lights */
    uint lit;             /* number that cells keep which are lit */
};
SDFGI_ASSERT_SIZE(sdfgi_light_direct_args, 88);

/* Per cascade entries [first, end) of the light list are visited; and how many visits a workgroup of each
 * pass takes. */
struct sdfgi_visit_list_args {
    uint first[SDFGI_MAX_CASCADES], end[SDFGI_MAX_CASCADES];
    uint groups[SDFGI_VISITS_RECORDS];
};
SDFGI_ASSERT_SIZE(sdfgi_visit_list_args, 76);

struct sdfgi_light_bounce_args {
    uint cascade;                 /* whose dirty cells, */
    uint only_dirty;              /* 1: as in sdfgi_light_direct_args; else those of all cascades, */
    uint visited;                 /* 1: that this frame visits */
    uint without_probes;          /* 1: no probe holds light */
    uint lit;                     /* those alone that keep this number; 0: all */
    uint end[SDFGI_MAX_CASCADES]; /* of the light lists */
};
SDFGI_ASSERT_SIZE(sdfgi_light_bounce_args, 52);

struct sdfgi_cell_gather_args {
    uint visits[SDFGI_MAX_CASCADES]; /* in a gather cycle of the cascade */
    uint marks;                      /* a bit per cascade: its cells mark how much light they have */
    uint new_rays; /* times as many rays as others cells send in a first cycle: 1 or SDFGI_NEW_RAYS */
};
SDFGI_ASSERT_SIZE(sdfgi_cell_gather_args, 40);

struct sdfgi_cell_filter_args {
    uint visited, end[SDFGI_MAX_CASCADES]; /* as in sdfgi_light_bounce_args */
};
SDFGI_ASSERT_SIZE(sdfgi_cell_filter_args, 36);

struct sdfgi_light_rescale_args {
    float factor; /* a power of two */
};
SDFGI_ASSERT_SIZE(sdfgi_light_rescale_args, 4);

struct sdfgi_probe_blend_args {
    uint cycle_ends;      /* 1: this is the last frame of a sample cycle */
    uint marks;           /* 1: probes mark how much light they have at the end of it */
    uint without_history; /* 1: no sample cycle has been completed since the cascades were empty */
};
SDFGI_ASSERT_SIZE(sdfgi_probe_blend_args, 12);

/* gather, gather_sparse. */
struct sdfgi_gather_args {
    vec4 inverse_view_projection[4]; /* columns */
    uint width, height;
    float background_depth;
    uint step;        /* gather_sparse: pixels from one sample to the next, a power of two */
    float scale;      /* factor on the output */
    uint ray_step;    /* pixels from one ray to the next, a power of two; 0: there are no reflections */
    uint filter_step; /* reflect_filter: rays from tap to tap */
};
SDFGI_ASSERT_SIZE(sdfgi_gather_args, 92);

/* debug_view. Begins as sdfgi_gather_args does. */
struct sdfgi_debug_view_args {
    vec4 inverse_view_projection[4]; /* columns */
    uint width, height;
    float background_depth;
    uint view;      /* SDFGI_SHADER_DEBUG_* */
    float exposure; /* factor on light */
    float slice_m;  /* from the near plane to the slice; 0: a quarter of the finest cascade */
};
SDFGI_ASSERT_SIZE(sdfgi_debug_view_args, 88);

#endif
