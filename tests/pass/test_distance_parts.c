/* SPDX-License-Identifier: MIT
 * Distances made in parts, after scrolls and edits, are those made as a whole, and only what a change reaches
 * is searched. Bits are written straight into the volume: what matters here is nothing but bits. */
#include "frame/stage.h"
#include "hard_case.h"
#include "oracle_edt.h"
#include "pass_scene.h"
#include "require.h"
#include "test_group.h"
#include "test_memory.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

enum { N = 64, BLOCKS = N / 4, CELLS = N * N * N, MAX_EDITS = 20, ONE_BIT = 100 };

/* As stored. */
enum { FARTHEST = SDFGI_DISTANCE_REACH * 32768 / N };

/* A world of bits without end, and the part of it that the cascade covers. */
struct world {
    int64_t origin[3];
    struct {
        int64_t low[3], high[3];
        uint32_t seed;
    } edits[MAX_EDITS];
    uint32_t edit_count;
};

static uint64_t hash(uint64_t x)
{
    x ^= x >> 31;
    x *= UINT64_C(0x7fb5d329728ea185);
    x ^= x >> 27;
    x *= UINT64_C(0x81dadef4bc2dd44d);
    return x ^ x >> 33;
}

static uint64_t hash_at(int64_t x, int64_t y, int64_t z, uint64_t seed)
{
    return hash(hash(hash(hash(seed) + (uint64_t)x) + (uint64_t)y) + (uint64_t)z);
}

/* Empty and sparse regions, 16 cells wide, and one in eight that is full of dust. */
static uint64_t random_cell(int64_t x, int64_t y, int64_t z, uint32_t seed)
{
    const uint64_t kind = hash_at(sdfgi_floor_div(x, 16), sdfgi_floor_div(y, 16), sdfgi_floor_div(z, 16),
                                  seed + UINT64_C(1000)) %
                          8;
    const uint64_t cell = hash_at(x, y, z, seed), bits = hash(cell);
    if (kind < 4)
        return 0;
    if (kind < 7)
        return cell % 512 ? 0 : UINT64_C(1) << bits % 64;
    return cell % 16 ? 0 : bits & hash(bits) & hash(bits + 1);
}

static bool inside(const int64_t at[3], const int64_t low[3], const int64_t high[3])
{
    for (int i = 0; i < 3; i++)
        if (at[i] < low[i] || at[i] >= high[i])
            return false;
    return true;
}

static uint64_t world_cell(const struct world *w, uint32_t x, uint32_t y, uint32_t z)
{
    const int64_t at[3] = { w->origin[0] + x, w->origin[1] + y, w->origin[2] + z };
    uint32_t seed = 1;
    for (uint32_t i = 0; i < w->edit_count; i++)
        if (inside(at, w->edits[i].low, w->edits[i].high))
            seed = w->edits[i].seed;
    if (seed == ONE_BIT)
        return UINT64_C(1) << 21; /* in the middle */
    return seed ? random_cell(at[0], at[1], at[2], seed) : 0;
}

/* ---- The device's side */

static uint16_t *read_distances(struct gi_test *t)
{
    return gi_test_read(t, RESOURCE_DISTANCE, NULL);
}

/* Where cells are stored, as volume/params.c has it. */
static void write_cells(struct gi_test *t, const struct world *w)
{
    ivec3 *wrap = &t->gi->volume.state.params.cascades[0].wrap;
    *wrap = (ivec3){ (int32_t)sdfgi_floor_mod(w->origin[0], N), (int32_t)sdfgi_floor_mod(w->origin[1], N),
                     (int32_t)sdfgi_floor_mod(w->origin[2], N) };
    pass_scene_write(t, RESOURCE_FRAME, &t->gi->volume.state.params, sizeof t->gi->volume.state.params);
    uint64_t *bits = test_array_alloc(CELLS, sizeof *bits);
    for (uint32_t z = 0; z < N; z++)
        for (uint32_t y = 0; y < N; y++)
            for (uint32_t x = 0; x < N; x++)
                bits[gi_test_cell(t, 0, x, y, z)] = world_cell(w, x, y, z);
    pass_scene_write(t, RESOURCE_BITS, bits, CELLS * sizeof *bits);
    free(bits);
}

/* Boxes around what went and what came, as dirty_bounds.glsl has them: here a whole changed box each. */
static void write_content(struct gi_test *t, const struct cell_box *changed, uint32_t count)
{
    uint32_t words[SDFGI_BOUNDS_BYTES / 4] = { 0 };
    for (uint32_t b = 0; b < count; b++)
        for (uint32_t i = 0; i < 3 && !sdfgi_cell_box_empty(&changed[b]); i++) {
            words[SDFGI_BOUNDS_STRIDE * b + i] = (uint32_t)(SDFGI_BOUNDS_ORIGIN - changed[b].low[i]);
            words[SDFGI_BOUNDS_STRIDE * b + 3 + i] = (uint32_t)(SDFGI_BOUNDS_ORIGIN + changed[b].high[i]);
        }
    pass_scene_write(t, RESOURCE_BOUNDS, words, sizeof words);
}

/* A part of a change: layers of blocks along x. Without boxes all is dirty. */
struct part {
    uint32_t first, count;
    const struct cell_box *changed;
    uint32_t changed_count;
};

static void plan_part(const struct part *part, struct frame *frame)
{
    static const struct frame_input input;
    const struct situation_needs needs = { .holds = { [NEED_EXACT] = true } };
    struct cascades *cascades = &frame->next.cascades;
    memset(frame, 0, sizeof *frame);
    cascades->count = 1;
    cascades->resolution = N;
    struct change *change = &cascades->at[0].change;
    change->count = part->changed_count;
    if (part->changed_count > 0) {
        memcpy(change->boxes, part->changed, part->changed_count * sizeof *part->changed);
        change->kept = sdfgi_cell_box_whole(N);
    }
    frame->scroll.piece_count = 1;
    frame->scroll.pieces[0] = (struct scroll_piece){
        .kind = PIECE_DISTANCES, .first = part->first, .count = part->count, .finds_bits = part->first == 0
    };
    sdfgi_stage_generate(&(struct plan_stage){ frame, &input, &needs });
}

static void make_part(struct gi_test *t, struct part part)
{
    static struct frame frame;
    plan_part(&part, &frame);
    pass_scene_fill(t, RESOURCE_SCRATCH, 0xa5);
    pass_scene_run(t, &frame.work);
}

static void make_whole(struct gi_test *t)
{
    make_part(t, (struct part){ .count = BLOCKS });
}

/* In parts of so many layers of blocks, each in a submission of its own. Returns how many cells were
 * searched. */
static uint32_t make_parts(struct gi_test *t, const struct cell_box *changed, uint32_t dirty_count)
{
    static const uint32_t layers[] = { 3, 1, 12 };
    uint32_t first = 0;
    pass_scene_fill(t, RESOURCE_COUNTERS, 0);
    write_content(t, changed, dirty_count);
    for (uint32_t i = 0; i < 3; first += layers[i++])
        make_part(t, (struct part){ first, layers[i], changed, dirty_count });
    uint32_t *counters = gi_test_read(t, RESOURCE_COUNTERS, NULL);
    const uint32_t searched = counters[SDFGI_COUNTER_DISTANCE_CELLS];
    free(counters);
    return searched;
}

static void open_world(struct gi_test *t, enum sdfgi_y_scale y_scale)
{
    struct sdfgi_settings settings = gi_test_settings();
    settings.y_scale = y_scale;
    gi_test_renew(t, &settings);
    gi_test_update(t, 1);
}

/* ---- Exact */

/* The least squared length is a whole number of units, few of which lie close together: the oracle's floats
 * name it. */
static uint16_t stored_from_exact(double cells, double y_scale)
{
    if (cells >= SDFGI_DISTANCE_REACH)
        return FARTHEST;
    /* In 1/16 of the square of half a sub-voxel; odd numbers squared differ by multiples of 8. */
    const double least = 32 + 16 * y_scale * y_scale;
    const double length2 = least + 8 * round((1024 * cells * cells - least) / 8);
    return (uint16_t)floor(sqrt(length2) / 32 * (32768 / N));
}

static void require_exact(struct gi_test *t, double y_scale)
{
    struct oracle_bits bits = gi_test_bits(t, 0);
    float *exact = oracle_edt_cells(&bits, y_scale);
    uint16_t *stored = read_distances(t);
    uint32_t differ = 0;
    for (uint32_t z = 0, i = 0; z < N; z++)
        for (uint32_t y = 0; y < N; y++)
            for (uint32_t x = 0; x < N; x++, i++)
                differ += stored[gi_test_cell(t, 0, x, y, z)] != stored_from_exact((double)exact[i], y_scale);
    HARD_CASE_AT_MOST(8, "distances not the exact ones rounded down", differ, 0);
    free(stored);
    free(exact);
    oracle_bits_destroy(&bits);
}

static void every_stored_bit_is_the_oracles(void **state)
{
    (void)state;
    for (int scale = 0; scale < 3; scale++) {
        open_world(&pass_context, (enum sdfgi_y_scale)scale);
        const struct world w = { .origin = { 24, -40, 8 } };
        write_cells(&pass_context, &w);
        make_whole(&pass_context);
        require_exact(&pass_context, sdfgi_settings_y_scale(&pass_context.gi->settings));
    }
}

/* ---- Changes */

/* What is known of cells in changed boxes is nothing. */
static void spoil_changed(struct gi_test *t, const struct cell_box *changed, uint32_t count)
{
    uint16_t *stored = read_distances(t);
    for (uint32_t b = 0; b < count; b++)
        for (int32_t z = 0; z < N; z++)
            for (int32_t y = 0; y < N; y++)
                for (int32_t x = 0; x < N; x++)
                    if (inside((int64_t[]){ x, y, z },
                               (int64_t[]){ changed[b].low[0], changed[b].low[1], changed[b].low[2] },
                               (int64_t[]){ changed[b].high[0], changed[b].high[1], changed[b].high[2] }))
                        stored[gi_test_cell(t, 0, (uint32_t)x, (uint32_t)y, (uint32_t)z)] =
                            (uint16_t)(b & 1 ? 0 : hash((uint64_t)(x + N * y)));
    pass_scene_write(t, RESOURCE_DISTANCE, stored, CELLS * sizeof *stored);
    free(stored);
}

/* Moves the cascade and names what went and what came, as boxes of its new place. */
static uint32_t scroll(struct world *w, const int32_t by[3], struct cell_box *changed)
{
    uint32_t count = 0;
    for (int i = 0; i < 3; i++) {
        w->origin[i] += by[i];
        if (by[i] == 0)
            continue;
        struct cell_box came = { { 0, 0, 0 }, { N, N, N } }, went = came;
        came.low[i] = by[i] > 0 ? N - by[i] : 0;
        came.high[i] = by[i] > 0 ? N : -by[i];
        went.low[i] = by[i] > 0 ? -by[i] : N;
        went.high[i] = by[i] > 0 ? 0 : N - by[i];
        for (int k = 0; k < 3; k++) /* what went was a box of the old place */
            if (k != i) {
                went.low[k] -= by[k];
                went.high[k] -= by[k];
            }
        changed[count++] = came;
        changed[count++] = went;
    }
    return count;
}

static struct cell_box edit(struct world *w, const int32_t low[3], const int32_t size[3], uint32_t seed)
{
    struct cell_box box;
    for (int i = 0; i < 3; i++) {
        box.low[i] = low[i];
        box.high[i] = low[i] + size[i];
        w->edits[w->edit_count].low[i] = w->origin[i] + box.low[i];
        w->edits[w->edit_count].high[i] = w->origin[i] + box.high[i];
    }
    w->edits[w->edit_count++].seed = seed;
    return box;
}

/* Updates in parts, then makes all anew from the same bits: the same bytes. */
static void require_parts_equal_whole(struct gi_test *t, const struct world *w,
                                      const struct cell_box *changed, uint32_t count, const char *what)
{
    write_cells(t, w);
    spoil_changed(t, changed, count);
    const uint32_t searched = make_parts(t, changed, count);
    uint16_t *parts = read_distances(t);
    pass_scene_fill(t, RESOURCE_DISTANCE, 0x5a);
    make_whole(t);
    uint16_t *whole = read_distances(t);
    printf("%s: %.1f %% searched\n", what, 100.0 * searched / CELLS);
    REQUIRE_BYTES((const uint8_t *)parts, (const uint8_t *)whole, CELLS * sizeof *parts);
    free(parts);
    free(whole);
}

/* Two bits 29 cells apart, one of which goes: cells halfway between them find the other almost as far away as
 * distances reach. */
static void play_apart(struct gi_test *t, struct world *w, int axis)
{
    static const int32_t one[3] = { 1, 1, 1 };
    int32_t a[3] = { 30, 30, 30 }, b[3] = { 30, 30, 30 };
    a[axis] = 20;
    b[axis] = 49;
    struct cell_box changed[2] = { edit(w, a, one, ONE_BIT), edit(w, b, one, ONE_BIT) };
    require_parts_equal_whole(t, w, changed, 2, "two bits");
    changed[0] = edit(w, a, one, 0);
    require_parts_equal_whole(t, w, changed, 1, "one of them gone");
    changed[0] = edit(w, b, one, 0);
    require_parts_equal_whole(t, w, changed, 1, "both gone");
}

static void play(struct gi_test *t, struct world *w)
{
    static const int32_t ways[][3] = { { 8, 0, 0 },   { 0, -8, 0 }, { 0, 0, 16 },  { 0, 8, 0 },
                                       { -24, 0, 0 }, { 8, -8, 8 }, { 0, 16, -8 }, { 48, 0, 0 } };
    struct cell_box changed[SDFGI_MAX_CHANGES];
    for (size_t i = 0; i < sizeof ways / sizeof *ways; i++) {
        char what[64];
        snprintf(what, sizeof what, "scroll %d %d %d", ways[i][0], ways[i][1], ways[i][2]);
        require_parts_equal_whole(t, w, changed, scroll(w, ways[i], changed), what);
    }
    changed[0] = edit(w, (int32_t[]){ 20, 30, 13 }, (int32_t[]){ 7, 5, 9 }, 2);
    require_parts_equal_whole(t, w, changed, 1, "new bits");
    changed[0] = edit(w, (int32_t[]){ 20, 30, 13 }, (int32_t[]){ 7, 5, 9 }, 0);
    changed[1] = edit(w, (int32_t[]){ 50, -9, 60 }, (int32_t[]){ 3, 17, 40 }, 3);
    require_parts_equal_whole(t, w, changed, 2, "bits gone and bits half outside");
    changed[0] = edit(w, (int32_t[]){ -8, -8, -8 }, (int32_t[]){ 80, 80, 70 }, 0);
    require_parts_equal_whole(t, w, changed, 1, "almost nothing left");
    changed[0] = edit(w, (int32_t[]){ -8, -8, -8 }, (int32_t[]){ 80, 80, 80 }, 0);
    require_parts_equal_whole(t, w, changed, 1, "nothing left");
    for (int axis = 0; axis < 3; axis++)
        play_apart(t, w, axis);
    changed[0] = edit(w, (int32_t[]){ 61, 2, 33 }, (int32_t[]){ 1, 1, 1 }, 4);
    require_parts_equal_whole(t, w, changed, 1, "one cell in nothing");
}

static void scrolls_and_edits_in_parts_equal_a_fresh_search(void **state)
{
    (void)state;
    const int last = getenv("SDFGI_TEST_FULL") ? SDFGI_Y_SCALE_100 : SDFGI_Y_SCALE_50;
    for (int scale = SDFGI_Y_SCALE_50; scale <= last; scale++) {
        open_world(&pass_context, (enum sdfgi_y_scale)scale);
        struct world w = { .origin = { 0, 0, 0 } };
        write_cells(&pass_context, &w);
        make_whole(&pass_context);
        play(&pass_context, &w);
    }
}

/* ---- Skipping */

/* Full of dust but for what lies near: every cell has something close by. */
static void fill_with_dust(struct gi_test *t)
{
    uint64_t *bits = test_array_alloc(CELLS, sizeof *bits);
    for (uint32_t i = 0; i < CELLS; i++)
        bits[i] = UINT64_C(1) << hash(i) % 64;
    pass_scene_write(t, RESOURCE_BITS, bits, CELLS * sizeof *bits);
    free(bits);
}

static const struct cell_box small_box = { { 21, 33, 14 }, { 23, 36, 17 } };

/* Cells of blocks within `reach` blocks of the box. */
static uint32_t cells_near_box(int32_t reach, uint32_t cell)
{
    uint32_t near = 1;
    for (int i = 0; i < 3; i++, cell /= N) {
        const int32_t block = (int32_t)(cell % N) / 4;
        near &= block >= small_box.low[i] / 4 - reach && block <= (small_box.high[i] - 1) / 4 + reach;
    }
    return near;
}

/* The bits are all taken away, which nobody says: what is searched finds nothing, what is not stays. */
static void blocks_that_no_change_reaches_are_left_alone(void **state)
{
    (void)state;
    open_world(&pass_context, SDFGI_Y_SCALE_100);
    const struct world w = { .origin = { 0, 0, 0 } };
    write_cells(&pass_context, &w);
    fill_with_dust(&pass_context);
    make_whole(&pass_context);
    uint16_t *before = read_distances(&pass_context);
    pass_scene_fill(&pass_context, RESOURCE_BITS, 0);
    const uint32_t searched = make_parts(&pass_context, &small_box, 1);
    uint16_t *after = read_distances(&pass_context);
    uint32_t gone = 0;
    for (uint32_t i = 0; i < CELLS; i++) {
        gone += after[i] == FARTHEST;
        if (cells_near_box(0, i))
            REQUIRE_CMP(after[i], ==, FARTHEST);
        if (!cells_near_box(1, i))
            REQUIRE_CMP(after[i], ==, before[i]);
        REQUIRE_TRUE(after[i] == FARTHEST || after[i] == before[i]);
    }
    printf("%u of %u cells searched\n", searched, (uint32_t)CELLS);
    REQUIRE_CMP(gone, ==, searched);
    free(before);
    free(after);
}

static void a_box_without_cells_reaches_nothing(void **state)
{
    (void)state;
    open_world(&pass_context, SDFGI_Y_SCALE_75);
    const struct world w = { .origin = { 8, 0, 0 } };
    write_cells(&pass_context, &w);
    make_whole(&pass_context);
    uint16_t *before = read_distances(&pass_context);
    const struct cell_box changed[2] = { { { 3, 3, 3 }, { 3, 9, 9 } }, small_box };
    const uint32_t searched = make_parts(&pass_context, &changed[1], 1);
    REQUIRE_CMP(searched, >, 0u);
    REQUIRE_CMP(make_parts(&pass_context, changed, 2), ==, searched);
    uint16_t *after = read_distances(&pass_context);
    REQUIRE_BYTES((const uint8_t *)after, (const uint8_t *)before, CELLS * sizeof *before);
    free(before);
    free(after);
}

static void where_nothing_is_kept_all_is_searched(void **state)
{
    (void)state;
    open_world(&pass_context, SDFGI_Y_SCALE_75);
    const struct world w = { .origin = { 8, 0, 0 } };
    write_cells(&pass_context, &w);
    REQUIRE_CMP(make_parts(&pass_context, NULL, 0), ==, (uint32_t)CELLS);
}

TEST_GROUP(distance_parts)
{
    if (!gpu_test_available())
        return GPU_TEST_SKIP;
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_stored_bit_is_the_oracles),
        cmocka_unit_test(scrolls_and_edits_in_parts_equal_a_fresh_search),
        cmocka_unit_test(blocks_that_no_change_reaches_are_left_alone),
        cmocka_unit_test(a_box_without_cells_reaches_nothing),
        cmocka_unit_test(where_nothing_is_kept_all_is_searched),
    };
    return cmocka_run_group_tests_name("distance_parts", tests, NULL, pass_context_close);
}
