/* SPDX-License-Identifier: MIT
 * What holds of every plan, over random walks with edits, lights and jumps; and how long a list of work
 * becomes. */
#include "plan_rules.h"
#include "require.h"
#include "walk.h"

#include <stdio.h>

enum { FRAMES = 2000 };

/* What was seen on the way: a walk that sees none of something has not tested it. */
struct seen {
    uint32_t most_work, completed, converged, waiting, dark, grew, ready;
};

static struct walk walk;
static struct plan_coverage coverage;
static struct seen seen;

static int clean_up(void **state)
{
    (void)state;
    drive_end(&walk.d);
    plan_coverage_free(&coverage);
    return 0;
}

static void note(const struct frame *frame)
{
    seen.most_work = frame->work.count > seen.most_work ? frame->work.count : seen.most_work;
    seen.converged += frame->situation.converged;
    seen.waiting += frame->situation.light_waits;
    seen.dark += frame->situation.from_nothing;
    seen.grew += frame->situation.list_grew;
    for (uint32_t c = 0; c < frame->next.cascades.count; c++)
        seen.ready += frame->next.cascades.at[c].change.stage == CHANGE_READY;
}

static void take_frame(void)
{
    struct drive *d = &walk.d;
    plan_rules_pure(d);
    drive_plan(d, &d->frame);
    plan_rules_reasons(&d->frame);
    plan_rules_groups(&d->frame.work);
    plan_rules_barriers(d, &d->frame);
    plan_rules_budget(&d->frame, &d->settings);
    plan_rules_ranges(d, &d->frame);
    plan_rules_cover(&coverage, &d->frame);
    if (d->frame.situation.converged)
        REQUIRE_CMP(d->frame.work.count, ==, 0u);
    note(&d->frame);
    drive_commit(d);
}

static void walk_for(const struct sdfgi_settings *settings, uint32_t seed, uint32_t frames)
{
    walk_begin(&walk, settings, seed);
    for (uint32_t i = 0; i < frames; i++) {
        walk_on(&walk);
        take_frame();
    }
}

static void require_seen(const char *what)
{
    printf(
        "%s: at most %u items; %u changes complete, %u wait; frames: %u from nothing, %u converged, %u wait "
        "with light, %u with longer lists\n",
        what, seen.most_work, coverage.completed, seen.ready, seen.dark, seen.converged, seen.waiting,
        seen.grew);
    REQUIRE_TRUE(seen.dark > 0 && seen.grew > 0);
    REQUIRE_TRUE(coverage.completed > 20);
    seen = (struct seen){ 0 };
}

/* ---- Walks */

static void plans_keep_the_rules_with_three_cascades(void **state)
{
    (void)state;
    const struct sdfgi_settings settings = drive_settings(3, 32);
    walk_for(&settings, 1, 2 * FRAMES);
    require_seen("three cascades");
}

static void plans_keep_the_rules_with_a_small_budget(void **state)
{
    (void)state;
    struct sdfgi_settings settings = drive_settings(2, 64);
    settings.max_scroll_cells = 64 * 64 * SDFGI_PROBE_SPACING;
    walk_for(&settings, 2, 2 * FRAMES);
    require_seen("small budget");
}

static void plans_keep_the_rules_with_a_flood(void **state)
{
    (void)state;
    struct sdfgi_settings settings = drive_settings(3, 32);
    settings.sdf_method = SDFGI_SDF_FLOOD;
    settings.max_scroll_cells = 16384;
    settings.voxelizer = SDFGI_VOXELIZER_RASTER;
    walk_for(&settings, 3, FRAMES);
    require_seen("flood and raster");
}

static void plans_keep_the_rules_with_depths_around_probes(void **state)
{
    (void)state;
    struct sdfgi_settings settings = drive_settings(2, 32);
    settings.visibility = SDFGI_VISIBILITY_PROBE_DEPTH;
    settings.y_scale = SDFGI_Y_SCALE_50;
    walk_for(&settings, 4, FRAMES);
    require_seen("probe depth, flat cells");
}

static void plans_keep_the_rules_where_probes_show_seldom(void **state)
{
    (void)state;
    struct sdfgi_settings settings = drive_settings(4, 32);
    settings.frames_to_update_lights = 3;
    settings.frames_to_converge = 7;
    settings.use_occlusion = false;
    walk_for(&settings, 5, FRAMES);
    require_seen("probes show every third frame");
}

static void plans_keep_the_rules_with_eight_cascades(void **state)
{
    (void)state;
    const struct sdfgi_settings settings = drive_settings(8, 32);
    walk_for(&settings, 6, FRAMES);
    require_seen("eight cascades");
}

static void plans_keep_the_rules_at_the_highest_resolution(void **state)
{
    (void)state;
    struct sdfgi_settings settings = drive_settings(2, 256);
    settings.ray_count = 128;
    settings.max_scroll_cells = 524288;
    walk_for(&settings, 7, FRAMES);
    require_seen("256^3 cells, least budget");
}

/* ---- The longest list */

static void begin_longest(void)
{
    const struct sdfgi_light_desc lamp = drive_lamp();
    struct sdfgi_settings settings = drive_settings(8, 256);
    settings.sdf_method = SDFGI_SDF_FLOOD;
    settings.max_scroll_cells = UINT32_MAX;
    walk_begin(&walk, &settings, 0);
    drive_add_light(&walk.d, &lamp);
    drive_add_box(&walk.d, (double[]){ -1e6, -1e6, -1e6 }, (double[]){ 1e6, 1e6, 1e6 }, SDFGI_STATIC);
    drive_frames(&walk.d, 8);
}

static uint32_t cascades_that_complete(uint32_t boxes)
{
    uint32_t count = 0;
    for (uint32_t c = 0; c < walk.d.settings.cascades; c++) {
        const struct change *change = &walk.d.frame.next.cascades.at[c].change;
        count += change->stage == CHANGE_COMPLETES && change->count == boxes;
    }
    return count;
}

/* In cells of the finest cascade, cascade c is due at (9 + 8 k) 2^c: 2,063 cells are before what is due at
 * 2,176 for the coarsest one, and for each other one at a cell between. */
static void eight_cascades_that_scroll_along_all_axes_fit_the_list(void **state)
{
    (void)state;
    begin_longest();
    const double cell = walk.d.settings.min_cell_size_m;
    for (uint32_t i = 0; i < 2063; i++)
        drive_move(&walk.d, cell, cell, cell);
    drive_frames(&walk.d, 8);
    for (int i = 0; i < 3; i++)
        walk.d.desc.camera_position[i] += 118 * cell;
    walk.d.list_grew = true;
    drive_begin_frame(&walk.d);
    take_frame();
    REQUIRE_CMP(cascades_that_complete(6), ==, 8u);
    printf("eight cascades scroll: %u items\n", walk.d.frame.work.count);
}

/* As many boxes as a change has room for, in all cascades at once. */
static void eight_cascades_that_are_edited_everywhere_fit_the_list(void **state)
{
    (void)state;
    begin_longest();
    drive_frames(&walk.d, 40);
    for (int i = 0; i < SDFGI_MAX_CHANGES; i++) {
        const double x = -25 + 10 * i;
        sdfgi_scene_invalidate_box(&walk.d.scene, (double[]){ x, 0, 0 }, (double[]){ x + 1, 1, 1 });
    }
    walk.d.list_grew = true;
    walk.d.desc.exposure = 1024;
    drive_begin_frame(&walk.d);
    take_frame();
    REQUIRE_CMP(cascades_that_complete(SDFGI_MAX_CHANGES), ==, 8u);
    printf("eight cascades are edited: %u items\n", walk.d.frame.work.count);
}

/* ---- Clears */

/* Where something begins to emit in the frame in which the light lists grow, rays are cleared twice. */
static void clears_that_overlap_have_a_barrier_between_them(void **state)
{
    (void)state;
    const struct sdfgi_settings settings = drive_settings(2, 32);
    walk_begin(&walk, &settings, 0);
    drive_add_box(&walk.d, (double[]){ -1, -1, -1 }, (double[]){ 1, 1, 1 }, SDFGI_STATIC);
    drive_frames(&walk.d, 40);
    drive_set_emission(&walk.d, 1);
    walk.d.list_grew = true;
    drive_begin_frame(&walk.d);
    REQUIRE_TRUE(walk.d.emitters_added);
    take_frame();
    uint32_t clears = 0;
    for (uint32_t i = 0; i < walk.d.frame.work.count; i++) {
        const struct work *work = &walk.d.frame.work.items[i];
        clears += work->kind == WORK_CLEAR && work->resource == RESOURCE_RAYS;
    }
    REQUIRE_CMP(clears, ==, 3u);
}

int main(void)
{
#define WALK(name) cmocka_unit_test_teardown(name, clean_up)
    const struct CMUnitTest tests[] = {
        WALK(plans_keep_the_rules_with_three_cascades),
        WALK(plans_keep_the_rules_with_a_small_budget),
        WALK(plans_keep_the_rules_with_a_flood),
        WALK(plans_keep_the_rules_with_depths_around_probes),
        WALK(plans_keep_the_rules_where_probes_show_seldom),
        WALK(plans_keep_the_rules_with_eight_cascades),
        WALK(plans_keep_the_rules_at_the_highest_resolution),
        WALK(eight_cascades_that_scroll_along_all_axes_fit_the_list),
        WALK(eight_cascades_that_are_edited_everywhere_fit_the_list),
        WALK(clears_that_overlap_have_a_barrier_between_them),
    };
#undef WALK
    return cmocka_run_group_tests_name("walks", tests, NULL, NULL);
}
