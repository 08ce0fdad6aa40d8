/* SPDX-License-Identifier: MIT */
#include "plan_rules.h"

#include "require.h"
#include "test_memory.h"

#include <stdlib.h>

/* ---- Pure */

/* Field by field: padding holds anything. */
static bool same_work(const struct work *a, const struct work *b)
{
    return a->kind == b->kind && a->pass == b->pass && a->reason == b->reason && a->cascade == b->cascade &&
           memcmp(&a->box, &b->box, sizeof a->box) == 0 && a->first == b->first && a->count == b->count &&
           a->indirect == b->indirect && a->records == b->records && a->group == b->group &&
           a->units == b->units && memcmp(&a->args, &b->args, sizeof a->args) == 0 &&
           a->resource == b->resource && a->offset == b->offset && a->bytes == b->bytes;
}

static void require_same_plan(const struct frame *a, const struct frame *b)
{
    REQUIRE_CMP(a->work.count, ==, b->work.count);
    REQUIRE_CMP(a->work.groups, ==, b->work.groups);
    for (uint32_t i = 0; i < a->work.count; i++)
        REQUIRE_TRUE(same_work(&a->work.items[i], &b->work.items[i]));
    REQUIRE_BYTES(&a->situation, &b->situation, sizeof a->situation);
    REQUIRE_BYTES(a->reasons, b->reasons, sizeof a->reasons);
    REQUIRE_BYTES(&a->next.params, &b->next.params, sizeof a->next.params);
    REQUIRE_TRUE(a->uploads == b->uploads && a->cycle_ends == b->cycle_ends);
}

void plan_rules_pure(const struct drive *d)
{
    static struct drive before;
    static struct frame first, second;
    before = *d;
    memset(&first, 0, sizeof first);
    memset(&second, 0xff, sizeof second);
    drive_plan(d, &first);
    drive_plan(d, &second);
    require_same_plan(&first, &second);
    REQUIRE_BYTES(&before.state, &d->state, sizeof before.state);
    REQUIRE_BYTES(&before.scene, &d->scene, sizeof before.scene);
    REQUIRE_BYTES(&before.journal, &d->journal, sizeof before.journal);
    REQUIRE_BYTES(before.counters, d->counters, sizeof before.counters);
}

/* ---- Reasons */

/* Needs that may hold without an item: cells wait to be lit again where a frame has enough to do; and where
 * all rays were cleared, none is left to forget. */
static bool may_have_no_item(enum pass pass, const struct situation *s)
{
    return (pass == PASS_LIGHT_DIRECT && s->relights && s->scroll_completes) ||
           (pass == PASS_RAY_INVALIDATE && s->list_grew);
}

void plan_rules_reasons(const struct frame *frame)
{
    const struct situation_needs needs = sdfgi_frame_needs(&frame->situation);
    for (int i = 0; i < PASS_COUNT; i++) {
        const enum pass pass = (enum pass)i;
        const enum need need = sdfgi_pass_row(pass)->need;
        const bool runs = sdfgi_work_has(&frame->work, pass);
        REQUIRE_TRUE(frame->reasons[i] == (runs ? sdfgi_need_reason(need) : sdfgi_need_reason_not(need)));
        REQUIRE_TRUE(sdfgi_need_reason(need) != sdfgi_need_reason_not(need));
        if (runs && !needs.holds[need])
            require_fail(__FILE__, __LINE__, "%s runs, and nothing calls for it", sdfgi_pass_row(pass)->name);
        if (!runs && needs.holds[need] && !may_have_no_item(pass, &frame->situation))
            require_fail(__FILE__, __LINE__, "%s does not run although it is called for",
                         sdfgi_pass_row(pass)->name);
    }
    for (uint32_t i = 0; i < frame->work.count; i++) {
        const struct work *work = &frame->work.items[i];
        if (work->kind == WORK_PASS)
            REQUIRE_TRUE(work->reason == frame->reasons[work->pass]);
    }
}

/* ---- Groups */

static uint64_t reads_of(const struct work *work)
{
    return sdfgi_pass_row(work->pass)->reads |
           (work->indirect != WORK_DIRECT ? UINT64_C(1) << work->records : 0);
}

static void require_apart(const struct work *a, const struct work *b)
{
    const uint64_t a_writes = sdfgi_pass_row(a->pass)->writes, b_writes = sdfgi_pass_row(b->pass)->writes;
    const uint64_t common = (a_writes & (reads_of(b) | b_writes)) | (b_writes & reads_of(a));
    if (common)
        require_fail(__FILE__, __LINE__, "%s and %s run side by side and share resources %#llx",
                     sdfgi_pass_row(a->pass)->name, sdfgi_pass_row(b->pass)->name,
                     (unsigned long long)common);
}

void plan_rules_groups(const struct work_list *work)
{
    uint32_t last = 0;
    for (uint32_t i = 0; i < work->count; i++) {
        const struct work *item = &work->items[i];
        REQUIRE_TRUE(item->group == 0 || item->kind == WORK_PASS);
        REQUIRE_CMP(item->group, <=, work->groups);
        if (item->group != 0 && item->group != last)
            REQUIRE_CMP(item->group, >, last);
        if (item->group != 0 && i > 0 && item->group == last)
            REQUIRE_CMP(work->items[i - 1].group, ==, item->group);
        for (uint32_t k = i; item->group != 0 && k-- > 0 && work->items[k].group == item->group;)
            require_apart(&work->items[k], item);
        last = item->group > last ? item->group : last;
    }
}

/* ---- The budget */

void plan_rules_budget(const struct frame *frame, const struct sdfgi_settings *settings)
{
    const uint64_t n = settings->resolution;
    /* A flood cannot be cut: the cascade that begins one takes all of it. */
    const uint64_t over = settings->sdf_method == SDFGI_SDF_FLOOD ? n * n * n : 0;
    uint64_t cells = 0;
    for (uint32_t i = 0; i < frame->work.count; i++) {
        const struct work *work = &frame->work.items[i];
        if (work->kind == WORK_PASS && work->pass == PASS_REGION_CLEAR)
            cells += sdfgi_cell_box_cells(&work->box);
        if (work->kind == WORK_PASS && work->pass == PASS_DISTANCE_EXACT)
            cells += 4 * work->count * n * n;
        if (work->kind == WORK_PASS && work->pass == PASS_FLOOD_DISTANCE)
            cells += n * n * n;
    }
    REQUIRE_CMP(cells, ==, frame->scroll.cells);
    if (!frame->situation.from_nothing)
        REQUIRE_CMP(cells, <=, settings->max_scroll_cells + over);
}

/* ---- Ranges */

static void require_box(const struct work *work, uint32_t resolution)
{
    const struct cell_box whole = sdfgi_cell_box_whole(resolution);
    REQUIRE_TRUE(!sdfgi_cell_box_empty(&work->box));
    REQUIRE_TRUE(sdfgi_cell_box_contains(&whole, &work->box));
    for (int i = 0; i < 3; i++)
        REQUIRE_TRUE(work->box.low[i] % SDFGI_PROBE_SPACING == 0 &&
                     work->box.high[i] % SDFGI_PROBE_SPACING == 0);
}

/* Each list takes whole workgroups, and no entry is left out. */
static void require_lists(const struct drive *d, const struct work *work)
{
    const bool filters = work->pass != PASS_LIGHT_BOUNCE;
    const uint32_t *end = filters ? work->args.cell_filter.end : work->args.light_bounce.end;
    uint32_t threads = 0;
    if (work->indirect != WORK_DIRECT)
        return;
    for (uint32_t c = 0; c < SDFGI_MAX_CASCADES; c++) {
        REQUIRE_CMP(end[c], <=, c < d->settings.cascades ? d->extent.light_cells : 0);
        threads += (end[c] + SDFGI_GROUP_LINEAR - 1) / SDFGI_GROUP_LINEAR * SDFGI_GROUP_LINEAR;
    }
    REQUIRE_CMP(work->count, ==, threads);
}

static void require_range(const struct drive *d, const struct work *work)
{
    switch (sdfgi_pass_row(work->pass)->domain) {
    case DOMAIN_INSTANCES:
    case DOMAIN_BOX:
        require_box(work, d->settings.resolution);
        break;
    case DOMAIN_DISTANCE_ROWS:
    case DOMAIN_DISTANCE_LAYERS:
    case DOMAIN_DISTANCE_COLUMNS:
        REQUIRE_CMP(work->count, >, 0u);
        REQUIRE_CMP(work->first + work->count, <=, d->settings.resolution / 4);
        break;
    case DOMAIN_LIGHT_CELLS:
        REQUIRE_CMP(work->first + work->count, <=, d->extent.light_cells);
        break;
    case DOMAIN_ALL_LIGHT_CELLS:
        require_lists(d, work);
        break;
    case DOMAIN_SEEN_WORDS:
        REQUIRE_CMP(work->count, <=, sdfgi_seen_part_words((uint32_t)d->extent.light_cells));
        for (uint32_t c = 0; c < SDFGI_MAX_CASCADES; c++)
            REQUIRE_CMP(work->args.visit_list.end[c], <=, SDFGI_SEEN_BITS * work->count);
        break;
    case DOMAIN_ALL_PROBES:
        REQUIRE_TRUE(work->count > 0 && work->count <= d->settings.cascades);
        break;
    default:
        break;
    }
}

static void require_dispatch(const struct drive *d, const struct work *work)
{
    if (work->indirect != WORK_DIRECT || sdfgi_pass_row(work->pass)->domain == DOMAIN_INSTANCES)
        return;
    const struct work_groups groups = sdfgi_work_groups(work, &d->extent, false);
    if (groups.x > SDFGI_MAX_GROUPS || groups.y > SDFGI_MAX_GROUPS || groups.z > SDFGI_MAX_GROUPS)
        require_fail(__FILE__, __LINE__, "%s has %u x %u x %u workgroups, and devices may take %d",
                     sdfgi_pass_row(work->pass)->name, groups.x, groups.y, groups.z, SDFGI_MAX_GROUPS);
}

void plan_rules_ranges(const struct drive *d, const struct frame *frame)
{
    REQUIRE_CMP(frame->work.count, <, (uint32_t)SDFGI_MAX_WORK);
    for (uint32_t i = 0; i < frame->work.count; i++) {
        const struct work *work = &frame->work.items[i];
        if (work->kind == WORK_CLEAR) {
            REQUIRE_CMP(work->bytes, >, 0u);
            REQUIRE_TRUE(work->offset % 4 == 0 && work->bytes % 4 == 0);
            REQUIRE_CMP(work->offset + work->bytes, <=, sdfgi_resource_size(work->resource, &d->extent));
        } else {
            REQUIRE_CMP(work->cascade, <, d->settings.cascades);
            require_range(d, work);
            require_dispatch(d, work);
        }
    }
}

/* ---- Changes are made whole */

static uint32_t brick_count(uint32_t resolution)
{
    const uint32_t side = resolution / SDFGI_PROBE_SPACING;
    return side * side * side;
}

static void add_bricks(uint8_t *bricks, uint32_t resolution, const struct cell_box *box)
{
    const int32_t size = SDFGI_PROBE_SPACING, side = (int32_t)resolution / size;
    for (int32_t x = box->low[0] / size; x < box->high[0] / size; x++)
        for (int32_t y = box->low[1] / size; y < box->high[1] / size; y++)
            for (int32_t z = box->low[2] / size; z < box->high[2] / size; z++)
                bricks[(x * side + y) * side + z]++;
}

static void add_work(struct plan_coverage *coverage, const struct work *work, uint32_t resolution)
{
    const uint32_t c = work->cascade;
    if (work->kind != WORK_PASS)
        return;
    if (work->pass == PASS_VOXEL_RESOLVE) {
        REQUIRE_CMP(coverage->layers[c], ==, 0u);
        add_bricks(coverage->bricks[c], resolution, &work->box);
    }
    if (work->pass == PASS_DISTANCE_EXACT) {
        REQUIRE_CMP(work->first, ==, coverage->layers[c]);
        coverage->layers[c] += work->count;
    }
    if (work->pass == PASS_FLOOD_DISTANCE) {
        REQUIRE_CMP(coverage->layers[c], ==, 0u);
        coverage->layers[c] = resolution / 4;
    }
}

/* Boxes of an edit may share cells: those are made as often as boxes hold them. */
static void require_whole(const struct plan_coverage *coverage, const struct cascade *cascade, uint32_t c,
                          uint32_t resolution)
{
    const struct cell_box whole = sdfgi_cell_box_whole(resolution);
    uint8_t *wanted = test_array_alloc(brick_count(resolution), 1);
    for (uint32_t i = 0; i < cascade->change.count; i++) {
        const struct cell_box inside = sdfgi_cell_box_common(&cascade->change.boxes[i], &whole);
        add_bricks(wanted, resolution, &inside);
    }
    const bool same = memcmp(wanted, coverage->bricks[c], brick_count(resolution)) == 0;
    free(wanted);
    REQUIRE_TRUE(same);
    REQUIRE_CMP(coverage->layers[c], ==, resolution / 4);
}

void plan_rules_cover(struct plan_coverage *coverage, const struct frame *frame)
{
    const struct cascades *cascades = &frame->next.cascades;
    const uint32_t bricks = brick_count(cascades->resolution);
    for (uint32_t c = 0; c < cascades->count; c++) {
        if (!coverage->bricks[c])
            coverage->bricks[c] = test_array_alloc(bricks, 1);
        for (uint32_t i = 0; i < frame->scroll.piece_count; i++)
            if (frame->scroll.pieces[i].cascade == c && frame->scroll.pieces[i].begins) {
                memset(coverage->bricks[c], 0, bricks);
                coverage->layers[c] = 0;
            }
    }
    for (uint32_t i = 0; i < frame->work.count; i++)
        add_work(coverage, &frame->work.items[i], cascades->resolution);
    for (uint32_t c = 0; c < cascades->count; c++)
        if (sdfgi_cascade_completes(&cascades->at[c])) {
            require_whole(coverage, &cascades->at[c], c, cascades->resolution);
            coverage->completed++;
        }
}

void plan_coverage_free(struct plan_coverage *coverage)
{
    for (uint32_t c = 0; c < SDFGI_MAX_CASCADES; c++)
        free(coverage->bricks[c]);
    *coverage = (struct plan_coverage){ 0 };
}
