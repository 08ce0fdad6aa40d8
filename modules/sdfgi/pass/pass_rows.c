/* SPDX-License-Identifier: MIT */
#include "pass_rows.h"

/* Sizes of the argument structs, by the names that the table has for them. */
#define ARGS_SIZE(name) sizeof(((union work_args *)0)->name)
enum {
    ARGS_none = 0,
    ARGS_cascade = ARGS_SIZE(cascade),
    ARGS_region = ARGS_SIZE(region),
    ARGS_voxelize = sizeof(struct sdfgi_voxelize_args),
    ARGS_distance_prepare = ARGS_SIZE(distance_prepare),
    ARGS_distance_search = ARGS_SIZE(distance_search),
    ARGS_flood = ARGS_SIZE(flood),
    ARGS_light_mark = ARGS_SIZE(light_mark),
    ARGS_light_direct = ARGS_SIZE(light_direct),
    ARGS_light_bounce = ARGS_SIZE(light_bounce),
    ARGS_probe_blend = ARGS_SIZE(probe_blend),
    ARGS_gather = ARGS_SIZE(gather),
};

static const struct pass_row rows[PASS_COUNT] = {
#define R(id) RESOURCE_BIT(id)
#define ROW(id, kind_, shader, unit_, need_, made_, domain_, args, group_, set_, reads_, writes_)            \
    [PASS_##id] = {                                                                                          \
        .name = #shader,                                                                                     \
        .unit = unit_,                                                                                       \
        .kind = PASS_KIND_##kind_,                                                                           \
        .need = NEED_##need_,                                                                                \
        .made = PASS_MADE_##made_,                                                                           \
        .domain = DOMAIN_##domain_,                                                                          \
        .args_size = ARGS_##args,                                                                            \
        .group = group_,                                                                                     \
        .set = PASS_SET_##set_,                                                                              \
        .reads = (reads_) | R(FRAME),                                                                        \
        .writes = (writes_),                                                                                 \
    },
    SDFGI_PASSES(ROW)
#undef ROW
#undef R
};

const struct pass_row *pass_row(enum pass pass)
{
    return &rows[pass];
}
