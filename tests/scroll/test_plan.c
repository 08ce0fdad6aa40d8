/* SPDX-License-Identifier: MIT
 * How work is spread over frames while the camera moves, without a device (HARD_CASES rows 22 to 24; the
 * budget of sdfgi_max_scroll_cells_per_frame). */
#include "hard_case.h"
#include "require.h"
#include "scroll_drive.h"
#include "test_memory.h"

#include <math.h>
#include <stdio.h>

/* The camera's step a frame, from near the world's origin. */
static void straight_on(const void *user, uint32_t i, double camera[static 3])
{
    const double *step = user;
    for (int k = 0; k < 3; k++)
        camera[k] = 0.1 + i * step[k];
}

static struct trip travel(struct scroll_drive *drive, const char *what, const double step[static 3])
{
    return scroll_drive_trip(drive, what, 120, 2000, straight_on, step);
}

static void the_first_frame_does_everything(void **state)
{
    (void)state;
    struct scroll_drive drive = scroll_drive_begin(128, 4194304);
    REQUIRE_CMP(scroll_drive_frame(&drive, (double[]){ 3, 4, 5 }), ==, 4u * 2 * 128 * 128 * 128);
    REQUIRE_TRUE(drive.plan.from_nothing && sdfgi_cascades_rest(&drive.cascades));
    REQUIRE_CMP(scroll_drive_frame(&drive, (double[]){ 3, 4, 5 }), ==, 0u);
}

/* The coarsest cascade first, one a frame. Then lookups sample what they do after a start at once. */
static void a_start_in_parts_keeps_to_the_budget(void **state)
{
    (void)state;
    const double camera[3] = { 3, 4, 5 };
    struct scroll_drive drive = scroll_drive_begin(128, 4194304), at_once = drive;
    drive.limits.starts_in_parts = true;
    scroll_drive_frame(&at_once, camera);
    for (uint32_t frame = 0; frame < 4; frame++) {
        REQUIRE_CMP(scroll_drive_frame(&drive, camera), ==, 4194304u);
        REQUIRE_TRUE(scroll_drive_covers(&drive.cascades.at[3], camera, 55));
    }
    REQUIRE_CMP(scroll_drive_frame(&drive, camera), ==, 0u);
    REQUIRE_TRUE(sdfgi_cascades_rest(&drive.cascades) && drive.scroll.blends_moving == 0);
    for (uint32_t c = 0; c < 4; c++)
        for (int k = 0; k < 3; k++) {
            REQUIRE_CMP(drive.cascades.at[c].origin[k], ==, at_once.cascades.at[c].origin[k]);
            REQUIRE_NEAR(drive.cascades.at[c].blend_low[k], at_once.cascades.at[c].blend_low[k], 0);
            REQUIRE_NEAR(drive.cascades.at[c].blend_high[k], at_once.cascades.at[c].blend_high[k], 0);
        }
}

static void a_walk_costs_the_same_in_every_frame(void **state)
{
    (void)state;
    struct scroll_drive drive = scroll_drive_begin(128, 4194304);
    const struct trip j = travel(&drive, "walk at 5 m/s", (double[]){ 5.0 / 60, 0, 0 });
    REQUIRE_CMP(j.most, <=, 4194304u);
    REQUIRE_CMP((double)j.p99, <=, 1.2 * (double)j.median);
    for (int c = 0; c < 4; c++)
        REQUIRE_CMP(j.covered[c], ==, 2000u);
}

static void a_flight_stays_within_the_budget(void **state)
{
    (void)state;
    struct scroll_drive drive = scroll_drive_begin(128, 8388608);
    const double step[3] = { 80.0 / 60, 10.0 / 60, 60.0 / 60 };
    struct trip j = travel(&drive, "flight at 100 m/s, 8 Mi cells", step);
    REQUIRE_CMP(j.most, <=, 8388608u);
    REQUIRE_CMP((double)j.p99, <=, 1.2 * (double)j.median);
    for (int c = 1; c < 4; c++)
        REQUIRE_CMP(j.covered[c], >=, 1980u);
    drive = scroll_drive_begin(128, 1048576);
    j = travel(&drive, "flight at 100 m/s, 1 Mi cells", step);
    REQUIRE_CMP(j.most, <=, 1048576u);
    REQUIRE_CMP(j.covered[3], >=, 1980u);
}

/* The coarsest cascade always covers the camera, and finer ones come back once it stops. */
static void hard_23_a_cascade_width_per_frame_leaves_no_hole(void **state)
{
    (void)state;
    struct scroll_drive drive = scroll_drive_begin(128, 4194304);
    double camera[3] = { 0, 0, 0 };
    scroll_drive_frame(&drive, camera);
    uint64_t most = 0, holes = 0;
    for (uint32_t i = 0; i < 100; i++) {
        camera[0] += 25.6;
        const uint64_t cells = scroll_drive_frame(&drive, camera);
        most = cells > most ? cells : most;
        holes += !scroll_drive_covers(&drive.cascades.at[3], camera, 8);
    }
    HARD_CASE_AT_MOST(23, "cells of a frame, of its budget", (double)most / 4194304, 1);
    HARD_CASE_AT_MOST(23, "frames in which the coarsest cascade has a hole", holes, 0);
    for (uint32_t i = 0; i < 200; i++)
        REQUIRE_CMP(scroll_drive_frame(&drive, camera), <=, 4194304u);
    for (uint32_t c = 0; c < 4; c++)
        REQUIRE_TRUE(scroll_drive_covers(&drive.cascades.at[c], camera, 55));
    REQUIRE_TRUE(sdfgi_cascades_rest(&drive.cascades));
}

static void hard_22_a_teleport_is_one_rebuild(void **state)
{
    (void)state;
    for (double far = 1e3; far <= 1e9; far *= 10) {
        struct scroll_drive drive = scroll_drive_begin(128, 4194304);
        const uint64_t whole = scroll_drive_frame(&drive, (double[]){ 0, 0, 0 });
        HARD_CASE_AT_MOST(22, "cells of a teleport over those of a rebuild",
                          (double)scroll_drive_frame(&drive, (double[]){ far, -far, 3 }) / (double)whole, 1);
        REQUIRE_TRUE(drive.plan.from_nothing && sdfgi_cascades_rest(&drive.cascades));
    }
}

static void hard_24_an_oscillating_camera_scrolls_once(void **state)
{
    (void)state;
    struct scroll_drive drive = scroll_drive_begin(128, 4194304);
    scroll_drive_frame(&drive, (double[]){ 1.6, 0, 0 });
    const uint64_t begun = drive.scroll.scrolls_begun;
    for (uint32_t i = 0; i < 1000; i++)
        scroll_drive_frame(&drive, (double[]){ i & 1 ? 1.6 + 2e-5 : 1.6 - 2e-5, 0, 0 });
    HARD_CASE_AT_MOST(24, "steps in 1,000 frames", drive.scroll.scrolls_begun - begun, 1);
}

/* A fine cascade that was left behind comes back while the camera still walks, at any
 * resolution and with the smallest budget. */
static void a_lost_cascade_comes_back_on_the_way(void **state)
{
    (void)state;
    for (uint32_t resolution = 32; resolution <= 256; resolution *= 2)
        for (uint32_t budget = 524288; budget <= 4194304; budget *= 8) {
            struct scroll_drive drive = scroll_drive_begin(resolution, budget);
            double camera[3] = { 0.1, 0.1, 0.1 };
            scroll_drive_frame(&drive, camera);
            camera[0] += 0.2 * resolution * 1.5;
            for (uint32_t i = 0; i < 1200; i++) {
                camera[0] += 1.0 / 60;
                REQUIRE_CMP(scroll_drive_frame(&drive, camera), <=, (uint64_t)budget);
            }
            REQUIRE_TRUE(!sdfgi_cell_box_empty(&drive.cascades.at[0].valid));
            REQUIRE_TRUE(scroll_drive_covers(&drive.cascades.at[0], camera, 2));
        }
}

/* Two jumps in a row look like a pace that is too fast to follow. The camera rests, and there is work until
 * all cascades are around it. */
static void a_cascade_that_waits_is_work_to_do(void **state)
{
    (void)state;
    struct scroll_drive drive = scroll_drive_begin(128, 4194304);
    double camera[3] = { 0.1, 0.1, 0.1 };
    scroll_drive_frame(&drive, camera);
    for (uint32_t i = 0; i < 2; i++) {
        camera[1] -= 2.4;
        scroll_drive_frame(&drive, camera);
    }
    REQUIRE_TRUE(drive.cascades.at[0].following != CASCADE_KEEPS_UP);
    uint32_t frames = 0;
    for (; !sdfgi_cascades_rest(&drive.cascades) && frames < 200; frames++)
        scroll_drive_frame(&drive, camera);
    REQUIRE_CMP(frames, <, 200u);
    for (uint32_t c = 0; c < drive.cascades.count; c++)
        REQUIRE_TRUE(scroll_drive_covers(&drive.cascades.at[c], camera, 55));
}

/* It cannot be cut, and is done all the same. */
static void a_flood_is_done_whole(void **state)
{
    (void)state;
    struct scroll_drive drive = scroll_drive_begin(128, 524288);
    drive.limits.flood = true;
    double camera[3] = { 0.1, 0.1, 0.1 };
    scroll_drive_frame(&drive, camera);
    const uint64_t begun = drive.scroll.scrolls_begun;
    for (uint32_t i = 0; i < 600; i++) {
        camera[0] += 5.0 / 60;
        scroll_drive_frame(&drive, camera);
    }
    REQUIRE_CMP(drive.scroll.scrolls_begun - begun, >, 50u);
    REQUIRE_TRUE(scroll_drive_covers(&drive.cascades.at[0], camera, 40));
}

/* Lookups never read beyond the valid region, and their border moves hardly faster than the camera, or by a
 * thirtieth of a cell. */
static void borders_move_with_the_camera(void **state)
{
    (void)state;
    struct scroll_drive drive = scroll_drive_begin(128, 4194304);
    struct test_random random = { 5 };
    double camera[3] = { 0, 0, 0 }, velocity[3] = { 0.08, 0, 0.03 };
    scroll_drive_frame(&drive, camera);
    double worst = 0;
    for (uint32_t i = 0; i < 4000; i++) {
        double before[4], step = 0;
        for (uint32_t c = 0; c < 4; c++)
            before[c] = (double)drive.cascades.at[c].origin[0] + drive.cascades.at[c].blend_high[0];
        for (int k = 0; k < 3; k++) {
            velocity[k] = i % 97 == 0 ? test_random_real(&random, -0.12, 0.12) * (i % 2) : velocity[k];
            camera[k] += velocity[k];
            step = fmax(step, fabs(velocity[k]));
        }
        scroll_drive_frame(&drive, camera);
        for (uint32_t c = 0; c < 4; c++) {
            const struct cascade *cascade = &drive.cascades.at[c];
            const double after = (double)cascade->origin[0] + cascade->blend_high[0];
            worst = fmax(worst, fabs(after - before[c]) - fmax(1.25 * step / cascade->cell_size[0], 0.03));
            for (int k = 0; k < 3; k++) {
                REQUIRE_CMP(cascade->blend_low[k], >=, (double)cascade->valid.low[k]);
                REQUIRE_CMP(cascade->blend_high[k], <=, (double)cascade->valid.high[k]);
            }
        }
    }
    printf("borders move by at most %.3f cells more than 1.25 times the camera\n", worst);
    REQUIRE_CMP(worst, <=, 0.031);
}

/* Wherever a journey ended, what lookups read around a still camera is what they read after a fresh start. */
static void borders_come_to_rest(void **state)
{
    (void)state;
    struct test_random random = { 6 };
    uint32_t longest = 0;
    for (int trial = 0; trial < 50; trial++) {
        struct scroll_drive drive = scroll_drive_begin(128, 4194304);
        double camera[3] = { 0, 0, 0 }, velocity[3];
        for (int k = 0; k < 3; k++)
            velocity[k] = test_random_real(&random, -0.15, 0.15) * (trial < 40 ? 1 : 12);
        for (uint32_t i = 0; i < 200; i++) {
            for (int k = 0; k < 3; k++)
                camera[k] += velocity[k];
            scroll_drive_frame(&drive, camera);
        }
        uint32_t frames = 0;
        for (; drive.scroll.blends_moving > 0 || !sdfgi_cascades_rest(&drive.cascades); frames++)
            scroll_drive_frame(&drive, camera);
        longest = frames > longest ? frames : longest;
        REQUIRE_CMP(frames, <=, 400u + 200u * (trial >= 40));
        for (uint32_t c = 0; c < 4; c++)
            for (int k = 0; k < 3; k++) {
                const struct cascade *cascade = &drive.cascades.at[c];
                const double at = camera[k] / cascade->cell_size[k] - (double)cascade->origin[k];
                REQUIRE_NEAR(cascade->blend_low[k], fmax(at - 64, 0), 0);
                REQUIRE_NEAR(cascade->blend_high[k], fmin(at + 64, 128), 0);
            }
    }
    printf("borders come to rest within %u frames\n", longest);
}

static void boxes_are_cut_without_overlap(void **state)
{
    (void)state;
    struct test_random random = { 9 };
    for (int trial = 0; trial < 200; trial++) {
        const struct cell_box whole = sdfgi_cell_box_whole(32);
        int32_t shift[3];
        for (int i = 0; i < 3; i++)
            shift[i] = 8 * ((int32_t)(test_random_uint(&random) % 5) - 2);
        const struct cell_box moved = sdfgi_cell_box_shifted(&whole, shift),
                              kept = sdfgi_cell_box_common(&whole, &moved);
        struct cell_box parts[3];
        const uint32_t count = sdfgi_cell_box_difference(&whole, &kept, parts);
        uint64_t cells = sdfgi_cell_box_cells(&kept);
        for (uint32_t i = 0; i < count; i++) {
            cells += sdfgi_cell_box_cells(&parts[i]);
            for (uint32_t k = 0; k < i; k++) {
                const struct cell_box both = sdfgi_cell_box_common(&parts[i], &parts[k]);
                REQUIRE_TRUE(sdfgi_cell_box_empty(&both));
            }
        }
        REQUIRE_CMP(cells, ==, 32u * 32 * 32);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_first_frame_does_everything),
        cmocka_unit_test(a_start_in_parts_keeps_to_the_budget),
        cmocka_unit_test(a_walk_costs_the_same_in_every_frame),
        cmocka_unit_test(a_flight_stays_within_the_budget),
        cmocka_unit_test(hard_22_a_teleport_is_one_rebuild),
        cmocka_unit_test(hard_23_a_cascade_width_per_frame_leaves_no_hole),
        cmocka_unit_test(hard_24_an_oscillating_camera_scrolls_once),
        cmocka_unit_test(a_lost_cascade_comes_back_on_the_way),
        cmocka_unit_test(a_cascade_that_waits_is_work_to_do),
        cmocka_unit_test(a_flood_is_done_whole),
        cmocka_unit_test(borders_move_with_the_camera),
        cmocka_unit_test(borders_come_to_rest),
        cmocka_unit_test(boxes_are_cut_without_overlap),
    };
    return cmocka_run_group_tests_name("scroll_plan", tests, NULL, NULL);
}
