/* SPDX-License-Identifier: MIT */
#include "work.h"

#include "pass_rows.h"
#include "shaders/shared/boxes.h"
#include "shaders/shared/threads.h"

#include <assert.h>

struct work *sdfgi_work_add(struct work_list *list, enum pass pass, uint32_t cascade, const char *reason)
{
    assert(list->count < SDFGI_MAX_WORK);
    struct work *work = &list->items[list->count++];
    *work = (struct work){ .pass = pass,
                           .cascade = cascade,
                           .reason = reason,
                           .indirect = WORK_DIRECT,
                           .records = RESOURCE_INDIRECT };
    return work;
}

void sdfgi_work_add_clear(struct work_list *list, enum resource resource, uint64_t offset, uint64_t bytes)
{
    assert(list->count < SDFGI_MAX_WORK);
    list->items[list->count++] =
        (struct work){ .kind = WORK_CLEAR, .resource = resource, .offset = offset, .bytes = bytes };
}

bool sdfgi_work_has(const struct work_list *list, enum pass pass)
{
    for (uint32_t i = 0; i < list->count; i++)
        if (list->items[i].kind == WORK_PASS && list->items[i].pass == pass)
            return true;
    return false;
}

/* Workgroups that share a row of light blocks: along the ground it holds a thousand cells. On software
 * drivers one has the row: most rows hold no cell, and each workgroup takes its time nevertheless. */
#define LIST_SHARES 4

static uint32_t groups_for(uint64_t elements, uint64_t per_group)
{
    return (uint32_t)((elements + per_group - 1) / per_group);
}

/* In rows of as many workgroups as every device takes. */
static struct work_groups in_rows(uint32_t groups)
{
    const uint32_t most = SDFGI_MAX_GROUPS;
    return (struct work_groups){ groups < most ? groups : most, groups_for(groups, most), 1 };
}

/* Runs of cells that hold the cells of `count` blocks along x. */
static uint32_t runs_of(const struct work *work, uint32_t per_run)
{
    const uint32_t first = 4 * work->first / per_run;
    return groups_for(4 * ((uint64_t)work->first + work->count), per_run) - first;
}

static struct work_groups tiles(const struct sdfgi_gather_args *args)
{
    return (struct work_groups){ groups_for(args->width, (SDFGI_SAMPLES_X - 1) * args->step),
                                 groups_for(args->height, (SDFGI_SAMPLES_Y - 1) * args->step), 1 };
}

static uint64_t stored_light(const struct extent *e)
{
    const uint64_t axes = 6 * e->light_cells, texels = SDFGI_IRRADIANCE_COUNT * e->probes;
    return e->cascades * (axes > texels ? axes : texels);
}

/* Elements that a workgroup takes on software drivers, where each of its threads does alone what a workgroup
 * shares elsewhere, or what several of its threads do; 0: as many as elsewhere. */
static const uint32_t software_groups[PASS_COUNT] = {
    [PASS_VOXEL_RESOLVE] = 8 * SDFGI_GROUP_LINEAR * SDFGI_RESOLVE_BLOCKS,
    [PASS_DISTANCE_PLANE] = 2 * SDFGI_LINES, /* two lines for each thread */
    [PASS_DISTANCE_EXACT] = 2 * SDFGI_LINES,
    [PASS_CELL_GATHER] = SDFGI_SEEN_BITS,
    [PASS_LIGHT_BOUNCE] = SDFGI_GROUP_LINEAR * SDFGI_BOUNCE_BLOCKS,
    [PASS_CELL_FILTER] = SDFGI_GROUP_LINEAR,
    [PASS_CELL_FILTER_FAR] = SDFGI_GROUP_LINEAR,
    [PASS_LIGHT_MARK] = SDFGI_GROUP_LINEAR * 64, /* a light block, of 64 cells, for each thread */
    [PASS_PROBE_PLACE] = SDFGI_GROUP_PROBE,
    [PASS_PROBE_SUM] = SDFGI_GROUP_PROBE,
    [PASS_PROBE_BLEND] = SDFGI_GROUP_PROBE,
};

uint32_t sdfgi_work_group_size(enum pass pass, const struct extent *e, bool software)
{
    if (software && pass == PASS_RAY_INVALIDATE) /* several threads share the rays of a probe */
        return SDFGI_GROUP_LINEAR / sdfgi_invalidate_threads((uint32_t)e->cycle_samples);
    return software && software_groups[pass] ? software_groups[pass] : sdfgi_pass_row(pass)->group;
}

struct work_groups sdfgi_work_groups(const struct work *work, const struct extent *e, bool software)
{
    const uint32_t group = sdfgi_work_group_size(work->pass, e, software), probes = (uint32_t)e->probes,
                   cascades = (uint32_t)e->cascades, n = 8 * ((uint32_t)e->probes_per_side - 1);
    switch (sdfgi_pass_row(work->pass)->domain) {
    case DOMAIN_INSTANCES:
    case DOMAIN_TILE_LIST:
        break;
    case DOMAIN_BOX:
        return in_rows(groups_for(sdfgi_cell_box_cells(&work->box), group));
    case DOMAIN_CELLS:
        return (struct work_groups){ n / group, n / group, n / group };
    case DOMAIN_BLOCKS:
        return in_rows(groups_for(e->blocks, group));
    case DOMAIN_CUBES:
        return (struct work_groups){ n / 32 + 1, n / SDFGI_CUBES_ROWS + 1, n / SDFGI_CUBES_ROWS + 1 };
    case DOMAIN_CASCADE:
        return (struct work_groups){ 1, 1, 1 };
    case DOMAIN_DISTANCE_ROWS:
        return (struct work_groups){ work->args.distance_prepare.row_groups + n / 4 * work->count, 1, 1 };
    case DOMAIN_DISTANCE_LAYERS:
        return (struct work_groups){ runs_of(work, group), SDFGI_SUBVOXELS * n, 1 };
    case DOMAIN_DISTANCE_COLUMNS:
        return (struct work_groups){ 4 * n / group, work->count, 1 };
    case DOMAIN_PROBES:
        return (struct work_groups){ groups_for(probes, group), 1, 1 };
    case DOMAIN_ALL_PROBES:
        return (struct work_groups){ groups_for(probes, group), work->count, 1 };
    case DOMAIN_ALL_RAYS:
    case DOMAIN_SEEN_WORDS:
        return (struct work_groups){ groups_for(work->count, group), cascades, 1 };
    case DOMAIN_LIGHT_BLOCKS:
        return (struct work_groups){ in_rows(groups_for(work->count, group)).x, 1, 1 };
    case DOMAIN_LIGHT_ROWS:
        return (struct work_groups){ (uint32_t)(e->cells / 64 / group), software ? 1 : LIST_SHARES, 1 };
    case DOMAIN_LIGHT_CELLS: {
        const struct work_groups of_cascade = in_rows(groups_for(work->count, group));
        return (struct work_groups){ of_cascade.x, of_cascade.y, cascades };
    }
    case DOMAIN_ALL_LIGHT_CELLS:
        return in_rows(groups_for(work->count, group));
    case DOMAIN_STORED_LIGHT:
        return in_rows(groups_for(stored_light(e), group));
    case DOMAIN_PIXELS:
        return (struct work_groups){ groups_for(work->args.gather.width, group),
                                     groups_for(work->args.gather.height, group), 1 };
    case DOMAIN_TILES:
        return tiles(&work->args.gather);
    }
    assert(false);
    return (struct work_groups){ 0, 0, 0 };
}
