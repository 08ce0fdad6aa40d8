/* SPDX-License-Identifier: MIT
 * The changes of a cascade: how each begins, and its stages (volume/change.h); what a scene notes for them
 * (scene/journal.h). */
#include "core/box.h"
#include "require.h"
#include "scene/journal.h"
#include "test_memory.h"
#include "volume/change.h"
#include "volume/volume.h"

#include <math.h>

enum { N = 32 };

static const double camera[3] = { 1, 2, 3 };

/* A cascade of 32^3 cells of 1 m that holds everything around the origin. */
static struct cascade current(void)
{
    return (struct cascade){ .origin = { -16, -16, -16 },
                             .cell_size = { 1, 1, 1 },
                             .place = CASCADE_CURRENT,
                             .valid = { { 0, 0, 0 }, { N, N, N } },
                             .blend_high = { N, N, N } };
}

/* How many of the change's boxes hold a cell. */
static uint32_t boxes_with(const struct change *change, const int32_t cell[static 3])
{
    uint32_t count = 0;
    for (uint32_t i = 0; i < change->count; i++) {
        bool inside = true;
        for (int k = 0; k < 3; k++)
            inside = inside && cell[k] >= change->boxes[i].low[k] && cell[k] < change->boxes[i].high[k];
        count += inside;
    }
    return count;
}

static bool holds(const struct cell_box *box, const int32_t cell[static 3])
{
    for (int k = 0; k < 3; k++)
        if (cell[k] < box->low[k] || cell[k] >= box->high[k])
            return false;
    return true;
}

/* ---- How changes begin */

static void a_rebuild_makes_all_cells_and_keeps_none(void **state)
{
    (void)state;
    struct cascade cascade = current();
    cascade.place = CASCADE_OUTDATED;
    cascade.edit_count = 2;
    sdfgi_change_begin_rebuild(&cascade, N, camera);
    REQUIRE_TRUE(cascade.change.cause == CHANGE_REBUILD && cascade.change.stage == CHANGE_BEGUN);
    REQUIRE_TRUE(cascade.place == CASCADE_CURRENT);
    REQUIRE_TRUE(sdfgi_cell_box_empty(&cascade.valid) && sdfgi_cell_box_empty(&cascade.change.kept));
    REQUIRE_CMP(cascade.change.cells_left, ==, 2u * N * N * N);
    REQUIRE_CMP(cascade.edit_count, ==, 0u);
    REQUIRE_CMP(sdfgi_change_bounds_axis(&cascade.change), ==, -1);
    for (int k = 0; k < 3; k++)
        REQUIRE_TRUE(cascade.blend_low[k] == camera[k] + 16 && cascade.blend_high[k] == camera[k] + 16);
}

/* Of the old and the new place together, each cell lies in what is kept or in one box, and never in two. */
static void require_scroll_cut(const struct cascade *cascade, const int32_t shift[static 3])
{
    const struct cell_box whole = sdfgi_cell_box_whole(N), old = sdfgi_cell_box_shifted(&whole, shift);
    const struct change *change = &cascade->change;
    uint64_t made = 0;
    for (int32_t x = -N; x < 2 * N; x++)
        for (int32_t y = -N; y < 2 * N; y++)
            for (int32_t z = -N; z < 2 * N; z++) {
                const int32_t cell[3] = { x, y, z };
                const bool is_new = holds(&whole, cell), was = holds(&old, cell);
                REQUIRE_TRUE(holds(&change->kept, cell) == (is_new && was));
                REQUIRE_CMP(boxes_with(change, cell), ==, (uint32_t)(is_new != was));
                made += is_new && !was;
            }
    REQUIRE_CMP(change->cells_left, ==, made + N * N * N);
    REQUIRE_BYTES(change->before, shift, sizeof change->before);
    REQUIRE_BYTES(&cascade->valid, &change->kept, sizeof cascade->valid);
}

static void a_scroll_makes_what_enters_and_names_what_leaves(void **state)
{
    (void)state;
    static const int64_t steps[][3] = {
        { 8, 0, 0 }, { 0, -8, 0 }, { 0, 0, 16 }, { 8, 0, -8 }, { -24, 8, 16 }
    };
    for (size_t i = 0; i < sizeof steps / sizeof *steps; i++) {
        struct cascade cascade = current();
        int64_t origin[3];
        int32_t shift[3];
        for (int k = 0; k < 3; k++) {
            origin[k] = cascade.origin[k] + steps[i][k];
            shift[k] = (int32_t)-steps[i][k];
        }
        sdfgi_change_begin_scroll(&cascade, N, origin, camera);
        REQUIRE_TRUE(cascade.change.cause == CHANGE_SCROLL && cascade.last_turn == CHANGE_SCROLL);
        REQUIRE_BYTES(cascade.origin, origin, sizeof origin);
        require_scroll_cut(&cascade, shift);
        for (int k = 0; k < 3; k++)
            REQUIRE_TRUE(cascade.blend_low[k] == shift[k] && cascade.blend_high[k] == N + shift[k]);
    }
}

static void strips_lie_across_z_unless_a_scroll_is_along_z_alone(void **state)
{
    (void)state;
    static const struct {
        int64_t step[3];
        int32_t axis;
    } rows[] = { { { 8, 0, 0 }, 2 }, { { 0, 8, 0 }, 2 }, { { 0, 0, 8 }, 0 }, { { 8, 0, 8 }, 2 } };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        struct cascade cascade = current();
        int64_t origin[3];
        for (int k = 0; k < 3; k++)
            origin[k] = cascade.origin[k] + rows[i].step[k];
        sdfgi_change_begin_scroll(&cascade, N, origin, camera);
        REQUIRE_CMP(sdfgi_change_bounds_axis(&cascade.change), ==, rows[i].axis);
    }
}

/* Nothing is shared, what is stored is out of date, or the way is longer than 32 bits hold. */
static void a_scroll_that_can_keep_nothing_is_a_rebuild(void **state)
{
    (void)state;
    static const int64_t far[] = { -16 + N, -16 - N, INT64_C(1) << 52 };
    for (size_t i = 0; i <= sizeof far / sizeof *far; i++) {
        struct cascade cascade = current();
        const bool outdated = i == sizeof far / sizeof *far;
        cascade.place = outdated ? CASCADE_OUTDATED : CASCADE_CURRENT;
        const int64_t origin[3] = { outdated ? -8 : far[i], -16, -16 };
        sdfgi_change_begin_scroll(&cascade, N, origin, camera);
        REQUIRE_TRUE(cascade.change.cause == CHANGE_REBUILD && cascade.last_turn == CHANGE_SCROLL);
        REQUIRE_CMP(cascade.origin[0], ==, origin[0]);
        REQUIRE_TRUE(sdfgi_cell_box_empty(&cascade.valid));
    }
}

static void an_edit_makes_its_boxes_and_keeps_all(void **state)
{
    (void)state;
    struct cascade cascade = current();
    const struct box boxes[] = { { { -3, -3, -3 }, { -1, -1, -1 } }, { { 3, 3, 3 }, { 9, 9, 9 } } };
    for (size_t i = 0; i < 2; i++)
        REQUIRE_TRUE(sdfgi_cascade_add_edit(&cascade, N, &boxes[i]));
    sdfgi_change_begin_edit(&cascade, N);
    const struct change *change = &cascade.change;
    REQUIRE_TRUE(change->cause == CHANGE_EDIT && cascade.last_turn == CHANGE_EDIT);
    REQUIRE_TRUE(change->count == 2 && cascade.edit_count == 0);
    const struct cell_box expected[] = { { { 8, 8, 8 }, { 16, 16, 16 } },
                                         { { 16, 16, 16 }, { 32, 32, 32 } } };
    REQUIRE_BYTES(change->boxes, expected, sizeof expected);
    REQUIRE_CMP(change->cells_left, ==, 8u * 8 * 8 + 16u * 16 * 16 + N * N * N);
    const struct cell_box whole = sdfgi_cell_box_whole(N);
    REQUIRE_BYTES(&cascade.valid, &whole, sizeof whole);
    REQUIRE_CMP(sdfgi_change_bounds_axis(change), ==, 2);
}

/* Six things take three steps each before the edit begins: more boxes than it has room for. */
static void what_moves_far_apart_is_made_apart(void **state)
{
    (void)state;
    enum { THINGS = 6, STEPS = 3 };
    struct cascade cascade = current();
    for (int i = 0; i < THINGS * STEPS; i++) {
        const int thing = i / STEPS;
        const double x = -14 + 8 * (thing % 3), z = -14 + 16 * (thing / 3) + 0.5 * (i % STEPS);
        const struct box box = { { x, 1, z }, { x + 1, 3, z + 1 } };
        REQUIRE_TRUE(sdfgi_cascade_add_edit(&cascade, N, &box));
    }
    sdfgi_change_begin_edit(&cascade, N);
    REQUIRE_CMP(cascade.change.count, ==, (uint32_t)THINGS);
    for (uint32_t i = 0; i < cascade.change.count; i++)
        REQUIRE_CMP(sdfgi_cell_box_cells(&cascade.change.boxes[i]), ==, 8ul * 8 * 8);
}

/* Triangles set sub-voxels that they touch, and those are a quarter of a cell wide. */
static void an_edit_a_sub_voxel_outside_counts(void **state)
{
    (void)state;
    struct cascade cascade = current();
    const struct box beside = { { 16.2, 1, 1 }, { 17, 2, 2 } }, apart = { { 16.3, 1, 1 }, { 17, 2, 2 } };
    REQUIRE_TRUE(!sdfgi_cascade_add_edit(&cascade, N, &apart));
    REQUIRE_TRUE(sdfgi_cascade_add_edit(&cascade, N, &beside));
    sdfgi_change_begin_edit(&cascade, N);
    const struct cell_box expected = { { 24, 16, 16 }, { 32, 24, 24 } };
    REQUIRE_CMP(cascade.change.count, ==, 1u);
    REQUIRE_BYTES(&cascade.change.boxes[0], &expected, sizeof expected);
}

static void an_edit_without_a_cell_changes_nothing(void **state)
{
    (void)state;
    struct cascade cascade = current();
    const struct box outside = { { 20, 0, 0 }, { 21, 1, 1 } };
    REQUIRE_TRUE(!sdfgi_cascade_add_edit(&cascade, N, &outside));
    /* It was in sight when it was noted, and the cascade has moved since. */
    cascade.edits[0] = outside;
    cascade.edit_count = 1;
    sdfgi_change_begin_edit(&cascade, N);
    REQUIRE_TRUE(cascade.change.cause == CHANGE_NONE && cascade.change.stage == CHANGE_IDLE);
    REQUIRE_TRUE(cascade.edit_count == 0 && cascade.last_turn == CHANGE_EDIT);
}

/* ---- Stages */

/* Every pair of stages that change_enter lets through. It asserts that a change goes on and never back, that
 * only one that is READY completes, and that there is a change at all; change_finish that it has completed
 * and left no cell. */
static void a_change_goes_on_to_any_later_stage(void **state)
{
    (void)state;
    uint32_t pairs = 0;
    for (int from = CHANGE_BEGUN; from <= CHANGE_READY; from++)
        for (int to = from; to <= CHANGE_COMPLETES; to++) {
            if (to == CHANGE_COMPLETES && from != CHANGE_READY)
                continue;
            struct change change = { .cause = CHANGE_SCROLL, .stage = (enum change_stage)from };
            sdfgi_change_enter(&change, (enum change_stage)to);
            REQUIRE_TRUE((int)change.stage == to && change.cause == CHANGE_SCROLL);
            pairs++;
        }
    REQUIRE_CMP(pairs, ==, 4u + 3 + 2 + 1 + 1);
}

static void a_finished_change_is_none(void **state)
{
    (void)state;
    struct cascade cascade = current();
    sdfgi_change_begin_rebuild(&cascade, N, camera);
    for (int stage = CHANGE_VOXELS; stage <= CHANGE_COMPLETES; stage++)
        sdfgi_change_enter(&cascade.change, (enum change_stage)stage);
    cascade.change.cells_left = 0;
    REQUIRE_TRUE(sdfgi_cascade_completes(&cascade));
    sdfgi_change_finish(&cascade.change);
    REQUIRE_TRUE(cascade.change.cause == CHANGE_NONE && cascade.change.stage == CHANGE_IDLE);
    REQUIRE_TRUE(!sdfgi_cascade_completes(&cascade));
}

/* Boxes that left the cascade hold no cell to voxelise. */
static void boxes_outside_are_passed_over(void **state)
{
    (void)state;
    struct cascade cascade = current();
    const int64_t origin[3] = { -8, -16, -8 };
    sdfgi_change_begin_scroll(&cascade, N, origin, camera);
    struct change *change = &cascade.change;
    REQUIRE_CMP(change->count, ==, 4u);
    uint32_t inside = 0;
    for (;; change->box++, inside++) {
        change->box = sdfgi_change_next_box(change, N);
        if (change->box == change->count)
            break;
        const struct cell_box box = sdfgi_change_box(change, change->box, N);
        REQUIRE_TRUE(!sdfgi_cell_box_empty(&box));
    }
    REQUIRE_CMP(inside, ==, 2u);
}

/* ---- The journal */

static bool covers(const struct journal *journal, const struct box *box)
{
    for (uint32_t i = 0; i < journal->box_count; i++) {
        bool inside = true;
        for (int k = 0; k < 3; k++)
            inside =
                inside && journal->boxes[i].min[k] <= box->min[k] && journal->boxes[i].max[k] >= box->max[k];
        if (inside)
            return true;
    }
    return false;
}

/* Some are flat, a line or a point, as are those of the meshes of hosts. */
static struct box random_box(struct test_random *random)
{
    struct box box;
    const uint32_t flat = test_random_uint(random);
    for (int k = 0; k < 3; k++) {
        box.min[k] = floor(test_random_real(random, -20, 20));
        box.max[k] = box.min[k] + (flat >> k & 1 ? 0 : floor(test_random_real(random, 1, 8)));
    }
    return box;
}

static void more_boxes_than_a_journal_holds_are_covered(void **state)
{
    (void)state;
    struct test_random random = { 1 };
    for (int trial = 0; trial < 50; trial++) {
        struct journal journal = { 0 };
        struct box boxes[4 * JOURNAL_BOXES];
        for (int i = 0; i < 4 * JOURNAL_BOXES; i++) {
            boxes[i] = random_box(&random);
            sdfgi_journal_add_box(&journal, &boxes[i]);
            REQUIRE_CMP(journal.box_count, <=, (uint32_t)JOURNAL_BOXES);
            for (int k = 0; k <= i; k++)
                REQUIRE_TRUE(covers(&journal, &boxes[k]));
        }
        REQUIRE_CMP(journal.box_count, ==, (uint32_t)JOURNAL_BOXES);
    }
}

static void flat_boxes_in_one_plane_are_two(void **state)
{
    (void)state;
    struct journal journal = { 0 };
    const struct box tiles[] = { { { 0, 0, 0 }, { 1, 0, 1 } }, { { 5, 0, 5 }, { 6, 0, 6 } } };
    for (int i = 0; i < 4; i++)
        sdfgi_journal_add_box(&journal, &tiles[i % 2]);
    REQUIRE_CMP(journal.box_count, ==, 2u);
    REQUIRE_BYTES(journal.boxes, tiles, sizeof tiles);
}

static void a_box_inside_another_one_is_left_out(void **state)
{
    (void)state;
    struct journal journal = { 0 };
    const struct box outer = { { 0, 0, 0 }, { 4, 4, 4 } }, inner = { { 1, 1, 1 }, { 2, 1, 4 } };
    sdfgi_journal_add_box(&journal, &outer);
    sdfgi_journal_add_box(&journal, &inner);
    REQUIRE_CMP(journal.box_count, ==, 1u);
}

/* Lamps, geometry and what emits wake the cells that they reach, and a sun that changes much all of them.
 * What emits outside the cascades wakes none. */
static void a_journal_tells_which_cells_are_woken(void **state)
{
    (void)state;
    const struct box box = { { 0, 0, 0 }, { 1, 1, 1 } }, outside = { { 900, 0, 0 }, { 901, 1, 1 } };
    const struct edited_places here = { { box }, 1 }, there = { { outside }, 1 };
    const struct {
        struct journal journal;
        bool begins, lights, all;
    } cases[] = {
        { { .boxes = { box }, .box_count = 1 }, true, false, false },
        { { .notes = JOURNAL_LAMPS, .lights = { 1, 0 } }, true, true, false },
        { { .boxes = { box }, .box_count = 1, .emitters = here }, true, true, false },
        { { .boxes = { outside }, .box_count = 1, .emitters = there }, false, false, false },
        { { .boxes = { box, outside }, .box_count = 2, .emitters = there }, true, false, false },
        { { .drift = 0.01f }, true, false, false },
        { { .drift = 1, .lights = { 1, 1 } }, true, true, true },
        { { .drift = 0.01f, .notes = JOURNAL_LAMPS, .lights = { 2, 0 } }, true, true, false },
        { { .flicker = 0.01f, .lights = { 1, 0 } }, true, false, false },
        { { .notes = JOURNAL_MATERIALS }, false, false, false },
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        struct volume_state volume = { .cascades = { .at = { current() }, .count = 1, .resolution = N } };
        sdfgi_gathering_init(&volume.gathering);
        sdfgi_volume_apply_journal(&cases[i].journal, &volume);
        REQUIRE_CMP(volume.gathering.epoch_over, ==, cases[i].begins);
        REQUIRE_CMP(volume.gathering.lights_over, ==, cases[i].lights);
        REQUIRE_CMP(volume.gathering.all_over, ==, cases[i].all);
        REQUIRE_CMP(volume.gathering.emitters.count, ==,
                    cases[i].lights ? cases[i].journal.emitters.count : 0);
    }
}

static void before_the_first_frame_there_is_no_cell_to_wake(void **state)
{
    (void)state;
    const struct journal lamp = { .notes = JOURNAL_LAMPS, .lights = { 1, 0 } };
    struct volume_state fresh = { .cascades = { .count = 1, .resolution = N } };
    sdfgi_gathering_init(&fresh.gathering);
    sdfgi_volume_apply_journal(&lamp, &fresh);
    REQUIRE_TRUE(fresh.gathering.all_over);
    REQUIRE_CMP(fresh.gathering.local_epochs, ==, 0u);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_rebuild_makes_all_cells_and_keeps_none),
        cmocka_unit_test(a_scroll_makes_what_enters_and_names_what_leaves),
        cmocka_unit_test(strips_lie_across_z_unless_a_scroll_is_along_z_alone),
        cmocka_unit_test(a_scroll_that_can_keep_nothing_is_a_rebuild),
        cmocka_unit_test(an_edit_makes_its_boxes_and_keeps_all),
        cmocka_unit_test(what_moves_far_apart_is_made_apart),
        cmocka_unit_test(an_edit_a_sub_voxel_outside_counts),
        cmocka_unit_test(an_edit_without_a_cell_changes_nothing),
        cmocka_unit_test(a_change_goes_on_to_any_later_stage),
        cmocka_unit_test(a_finished_change_is_none),
        cmocka_unit_test(boxes_outside_are_passed_over),
        cmocka_unit_test(more_boxes_than_a_journal_holds_are_covered),
        cmocka_unit_test(flat_boxes_in_one_plane_are_two),
        cmocka_unit_test(a_box_inside_another_one_is_left_out),
        cmocka_unit_test(a_journal_tells_which_cells_are_woken),
        cmocka_unit_test(before_the_first_frame_there_is_no_cell_to_wake),
    };
    return cmocka_run_group_tests_name("changes", tests, NULL, NULL);
}
