/* SPDX-License-Identifier: MIT
 * The rows of pass_table.h as data. Needs no device. */
#ifndef SDFGI_PASS_ROWS_H
#define SDFGI_PASS_ROWS_H

#include "work.h"

enum pass_kind {
    PASS_KIND_COMPUTE,
    PASS_KIND_COMPUTE_TEXTURED, /* with a second variant for materials with textures */
    PASS_KIND_RASTER_TEXTURED,
};

enum pass_made { PASS_MADE_CREATED, PASS_MADE_DEMAND, PASS_MADE_RASTER };

/* Beside LOOKUP and WORK. */
enum pass_set { PASS_SET_NONE, PASS_SET_MESH, PASS_SET_VIEW, PASS_SET_COUNT };

/* Conditions of the scene: frame/frame_needs.c. */
enum need {
    NEED_VOXELS,
    NEED_VOXELS_RASTER,
    NEED_GENERATE,
    NEED_COMPLETE,
    NEED_SEED,
    NEED_LIST,
    NEED_EXACT,
    NEED_FLOOD,
    NEED_OCCLUSION,
    NEED_MASKS,
    NEED_DIRECT,
    NEED_LIGHT,
    NEED_TRACE,
    NEED_RAYS,
    NEED_BLEND,
    NEED_GATHER,
    NEED_COUNT,
};

struct pass_row {
    const char *name, *unit;
    enum pass_kind kind;
    enum need need;
    enum pass_made made;
    enum domain domain;
    uint32_t args_size;
    uint32_t group;
    enum pass_set set;
    uint64_t reads, writes; /* bits of enum resource */
};

const struct pass_row *pass_row(enum pass pass);

#define RESOURCE_BIT(id) (UINT64_C(1) << RESOURCE_##id)

#endif
