/* SPDX-License-Identifier: MIT
 * A list of work: what a frame does on the device, decided before anything is recorded. Plain data. */
#ifndef SDFGI_WORK_H
#define SDFGI_WORK_H

#include "core/box.h"
#include "core/extent.h"
#include "pass_table.h"
#include "resource_table.h"

#include "shaders/shared/args.h"
#include "shaders/shared/counters.h"
#include "shaders/shared/frame.h"
#include "shaders/shared/instances.h"
#include "shaders/shared/seen.h"

enum {
    SDFGI_MAX_LIGHTS = 1024,
    SDFGI_MAX_MATERIALS = 4096,
    SDFGI_MAX_FRAMES_IN_FLIGHT = 8,
    SDFGI_READBACK_WORDS = SDFGI_COUNTER_COUNT + 1, /* counters, and the number of the frame */
    SDFGI_MAX_WORK = 1024,                          /* the plan of a frame never has more: asserted */
};

/* What a pass runs over; sdfgi_work_groups() tells how many workgroups that takes. */
enum domain {
    DOMAIN_INSTANCES,     /* mesh instances that touch a box: sized by the voxeliser */
    DOMAIN_BOX,           /* cells of a box */
    DOMAIN_CELLS,         /* all cells of a cascade */
    DOMAIN_BLOCKS,        /* all albedo blocks of a cascade */
    DOMAIN_CUBES,         /* tiles of a cascade and before it: shaders/sdfgi/cubes.glsl */
    DOMAIN_CASCADE,       /* a cascade, for one workgroup */
    DOMAIN_DISTANCE_ROWS, /* columns of cells, if asked for, and the light blocks of `count` layers along x */
    DOMAIN_DISTANCE_LAYERS,  /* layers of sub-voxels, for cells [4 first, 4 (first + count)) along x */
    DOMAIN_DISTANCE_COLUMNS, /* columns of cells, for `count` layers of blocks along x */
    DOMAIN_PROBES,           /* of a cascade */
    DOMAIN_ALL_PROBES,       /* of `count` cascades */
    DOMAIN_ALL_RAYS,         /* `count` rays of each cascade */
    DOMAIN_LIGHT_BLOCKS,     /* `count` cells, of which a workgroup looks at one block or more in turn */
    DOMAIN_LIGHT_ROWS,       /* rows of light blocks of a cascade */
    DOMAIN_LIGHT_CELLS,      /* `count` entries of the light lists of all cascades */
    DOMAIN_ALL_LIGHT_CELLS,  /* `count` entries of the light lists, one list after another */
    DOMAIN_SEEN_WORDS,       /* `count` words of marks of each cascade */
    DOMAIN_STORED_LIGHT,     /* axes of light cells, and texels of probes, of all cascades */
    DOMAIN_PIXELS,           /* of a picture */
    DOMAIN_TILE_LIST,        /* tiles of a picture that a list names: indirect */
    DOMAIN_TILES,            /* of a picture, between SDFGI_SAMPLES_X x SDFGI_SAMPLES_Y samples */
};

union work_args {
    struct sdfgi_cascade_args cascade;
    struct sdfgi_region_args region;
    struct sdfgi_distance_prepare_args distance_prepare;
    struct sdfgi_distance_search_args distance_search;
    struct sdfgi_flood_args flood;
    struct sdfgi_light_mark_args light_mark;
    struct sdfgi_light_direct_args light_direct;
    struct sdfgi_light_bounce_args light_bounce;
    struct sdfgi_visit_list_args visit_list;
    struct sdfgi_cell_gather_args cell_gather;
    struct sdfgi_cell_filter_args cell_filter;
    struct sdfgi_light_rescale_args light_rescale;
    struct sdfgi_probe_blend_args probe_blend;
    struct sdfgi_gather_args gather; /* also the beginning of what other passes of DOMAIN_PIXELS have */
    struct sdfgi_debug_view_args debug_view;
};

enum work_kind {
    WORK_PASS,  /* one dispatch of a pass; of voxelisers one per instance */
    WORK_CLEAR, /* zeros a part of a buffer */
};

#define WORK_DIRECT UINT32_MAX /* `indirect`: the size follows from the domain */

/* Shaders of a pass: as they are, and for materials with textures, for rough lobes or for metal. */
enum pass_variant {
    PASS_PLAIN,
    PASS_TEXTURED,
    PASS_LOBES = PASS_TEXTURED,
    PASS_METAL = PASS_TEXTURED,
    PASS_VARIANTS
};

struct work {
    enum work_kind kind;
    enum pass pass;
    enum pass_variant variant; /* but for voxelisers, which choose one for each instance */
    const char *reason;        /* static: why the pass runs */
    uint32_t cascade;
    struct cell_box box;   /* DOMAIN_BOX, DOMAIN_INSTANCES */
    struct cell_box made;  /* DOMAIN_INSTANCES: triangles of what touches this have been checked; or empty */
    uint32_t first, count; /* a range of the domain */
    uint32_t indirect; /* record of indirect arguments: SDFGI_INDIRECT_*, SDFGI_VISITS_*, or WORK_DIRECT */
    enum resource records; /* where it is: INDIRECT or SEEN */
    uint32_t group;        /* neighbours with the same number run side by side and share one time; 0: alone */
    uint64_t units;        /* what the report counts as work */
    union work_args args;
    enum resource resource; /* WORK_CLEAR: bytes [offset, offset + bytes) of this */
    uint64_t offset, bytes;
};

struct work_list {
    struct work items[SDFGI_MAX_WORK];
    uint32_t count, groups; /* groups: the last number given out */
};

/* Appends an item with this pass and reason, and zeros otherwise; the caller fills it in. */
struct work *sdfgi_work_add(struct work_list *list, enum pass pass, uint32_t cascade, const char *reason);
void sdfgi_work_add_clear(struct work_list *list, enum resource resource, uint64_t offset, uint64_t bytes);
/* True if an item runs the pass. */
bool sdfgi_work_has(const struct work_list *list, enum pass pass);

/* Elements of its domain that a workgroup of a pass takes. */
uint32_t sdfgi_work_group_size(enum pass pass, const struct extent *e, bool software);

struct work_groups {
    uint32_t x, y, z;
};

/* Workgroups of an item that is neither indirect nor of DOMAIN_INSTANCES; `software`: of the shaders for
 * software drivers. */
struct work_groups sdfgi_work_groups(const struct work *work, const struct extent *extent, bool software);

#endif
