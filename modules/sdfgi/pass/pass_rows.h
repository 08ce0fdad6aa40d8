/* SPDX-License-Identifier: MIT
 * The rows of pass_table.h as data. Needs no device. */
#ifndef SDFGI_PASS_ROWS_H
#define SDFGI_PASS_ROWS_H

#include "work.h"

enum pass_kind {
    PASS_KIND_COMPUTE,
    PASS_KIND_COMPUTE_TEXTURED, /* with a second variant for materials with textures */
    PASS_KIND_COMPUTE_LOBES,    /* with one for light cells that keep from where they get their light */
    PASS_KIND_COMPUTE_METAL,    /* with one for scenes with metal that reflects what it sees */
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
    NEED_EMITTERS,
    NEED_EXACT,
    NEED_FLOOD,
    NEED_OCCLUSION,
    NEED_MASKS,
    NEED_DIRECT,
    NEED_LIGHT,
    NEED_TRACE,
    NEED_RAYS,
    NEED_BLEND,
    NEED_CELLS,
    NEED_FILTER,
    NEED_RESCALE,
    NEED_GATHER,
    NEED_GATHER_SPARSE,
    NEED_REFLECTIONS,
    NEED_ROUGH_LOBES,
    NEED_DEBUG_VIEW,
    NEED_DEBUG_TIER,
    NEED_COUNT,
};

/* Where in a frame a pass runs; in the order in which phases follow one another. */
enum pass_phase {
    PHASE_VOXELS,    /* for each box whose voxels are due */
    PHASE_DISTANCES, /* for each range of layers whose distances are due */
    PHASE_BOXES,     /* for each cascade that a change completes, before all else */
    PHASE_EMITTERS,  /* for each cascade that a change completes, before its light list is written */
    PHASE_MARK,      /* for each cascade whose light list is written; beside PLACE */
    PHASE_PLACE,     /* for each cascade that a change completes */
    PHASE_LIST,      /* as MARK, afterwards */
    PHASE_SEED,      /* as PLACE, afterwards, beside the new light cells' direct light */
    PHASE_RAYS,      /* before this frame's rays are traced */
    PHASE_SUM,       /* after that */
    PHASE_BLEND,     /* and after that */
    PHASE_OWN,       /* planned by a function of its own */
};

/* What the work of a pass is counted in. */
enum pass_unit {
    UNIT_CELLS,
    UNIT_TRIANGLES,
    UNIT_BLOCKS,
    UNIT_PROBES,
    UNIT_RAYS,
    UNIT_LIGHT_CELLS,
    UNIT_PIXELS,
    UNIT_COUNT,
};

/* struct sdfgi_<name>_args. */
enum pass_args {
    ARGS_none,
    ARGS_cascade,
    ARGS_region,
    ARGS_voxelize,
    ARGS_distance_prepare,
    ARGS_distance_search,
    ARGS_flood,
    ARGS_light_mark,
    ARGS_light_direct,
    ARGS_light_bounce,
    ARGS_visit_list,
    ARGS_cell_gather,
    ARGS_cell_filter,
    ARGS_light_rescale,
    ARGS_probe_blend,
    ARGS_gather,
    ARGS_debug_view,
    ARGS_COUNT,
};

struct pass_row {
    const char *name;
    const char *object_name; /* of its pipeline, for debuggers: "sdfgi light_direct" */
    enum pass_unit unit;
    enum pass_kind kind;
    enum need need;
    enum pass_phase phase;
    enum pass_made made;
    enum domain domain;
    enum pass_args args;
    uint32_t args_size; /* bytes */
    uint32_t group;
    enum pass_set set;
    uint64_t reads, writes; /* bits of enum resource */
};

const struct pass_row *sdfgi_pass_row(enum pass pass);
/* False: no frame with these settings runs the pass, whatever the scene. */
bool sdfgi_pass_fits(enum pass pass, const struct sdfgi_settings *settings);
/* "light cells" */
const char *sdfgi_pass_unit_name(enum pass_unit unit);

#define RESOURCE_BIT(id) (UINT64_C(1) << RESOURCE_##id)
/* What a view owns follows the resources of volumes, in the order of its bindings. */
#define VIEW_BIT(id) (UINT64_C(1) << (RESOURCE_COUNT + SDFGI_BINDING_VIEW_##id))

#endif
