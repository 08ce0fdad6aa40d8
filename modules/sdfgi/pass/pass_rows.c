/* SPDX-License-Identifier: MIT */
#include "pass_rows.h"

#include "shaders/shared/bindings.h"

#define ARGS_SIZE(name) sizeof(((union work_args *)0)->name)
enum {
    SIZE_none = 0,
    SIZE_cascade = ARGS_SIZE(cascade),
    SIZE_region = ARGS_SIZE(region),
    SIZE_voxelize = sizeof(struct sdfgi_voxelize_args),
    SIZE_distance_prepare = ARGS_SIZE(distance_prepare),
    SIZE_distance_search = ARGS_SIZE(distance_search),
    SIZE_flood = ARGS_SIZE(flood),
    SIZE_light_mark = ARGS_SIZE(light_mark),
    SIZE_light_direct = ARGS_SIZE(light_direct),
    SIZE_light_bounce = ARGS_SIZE(light_bounce),
    SIZE_visit_list = ARGS_SIZE(visit_list),
    SIZE_cell_gather = ARGS_SIZE(cell_gather),
    SIZE_cell_filter = ARGS_SIZE(cell_filter),
    SIZE_light_rescale = ARGS_SIZE(light_rescale),
    SIZE_probe_blend = ARGS_SIZE(probe_blend),
    SIZE_gather = ARGS_SIZE(gather),
    SIZE_debug_view = ARGS_SIZE(debug_view),
};

static const struct pass_row rows[PASS_COUNT] = {
#define R(id) RESOURCE_BIT(id)
#define V(id) VIEW_BIT(id)
#define ROW(id, kind_, shader, unit_, need_, phase_, made_, domain_, args_, group_, set_, reads_, writes_)   \
    [PASS_##id] = {                                                                                          \
        .name = #shader,                                                                                     \
        .object_name = "sdfgi " #shader,                                                                     \
        .unit = UNIT_##unit_,                                                                                \
        .kind = PASS_KIND_##kind_,                                                                           \
        .need = NEED_##need_,                                                                                \
        .phase = PHASE_##phase_,                                                                             \
        .made = PASS_MADE_##made_,                                                                           \
        .domain = DOMAIN_##domain_,                                                                          \
        .args = ARGS_##args_,                                                                                \
        .args_size = SIZE_##args_,                                                                           \
        .group = group_,                                                                                     \
        .set = PASS_SET_##set_,                                                                              \
        .reads = (reads_) | R(FRAME),                                                                        \
        .writes = (writes_),                                                                                 \
    },
    SDFGI_PASSES(ROW)
#undef ROW
#undef R
#undef V
};

const char *sdfgi_pass_unit_name(enum pass_unit unit)
{
    static const char *const names[UNIT_COUNT] = {
        [UNIT_CELLS] = "cells",   [UNIT_TRIANGLES] = "triangles", [UNIT_BLOCKS] = "blocks",
        [UNIT_PROBES] = "probes", [UNIT_RAYS] = "rays",           [UNIT_LIGHT_CELLS] = "light cells",
        [UNIT_PIXELS] = "pixels",
    };
    return names[unit];
}

const struct pass_row *sdfgi_pass_row(enum pass pass)
{
    return &rows[pass];
}

bool sdfgi_pass_fits(enum pass pass, const struct sdfgi_settings *settings)
{
    const bool depths = settings->visibility == SDFGI_VISIBILITY_PROBE_DEPTH;
    switch (rows[pass].need) {
    case NEED_VOXELS:
        return settings->voxelizer == SDFGI_VOXELIZER_COMPUTE;
    case NEED_VOXELS_RASTER:
        return settings->voxelizer == SDFGI_VOXELIZER_RASTER;
    case NEED_EXACT:
        return settings->sdf_method == SDFGI_SDF_EXACT;
    case NEED_FLOOD:
        return settings->sdf_method == SDFGI_SDF_FLOOD;
    case NEED_OCCLUSION:
        return settings->use_occlusion && depths;
    case NEED_MASKS:
        return settings->use_occlusion && !depths;
    case NEED_CELLS:
    case NEED_FILTER:
        return settings->surface_light == SDFGI_SURFACE_LIGHT_CELLS;
    default:
        return true;
    }
}
