/* SPDX-License-Identifier: MIT
 * Where cascades are placed, without a device (HARD_CASES rows 22, 24 and 25). */
#include "hard_case.h"
#include "require.h"
#include "test_memory.h"
#include "volume/change.h"

static struct cascade cascade_of(double cell_size)
{
    return (struct cascade){ .cell_size = { cell_size, cell_size, cell_size } };
}

static bool place(struct cascade *cascade, double x, double y, double z)
{
    return sdfgi_cascade_place(cascade, 64, (double[]){ x, y, z });
}

static void division_rounds_down_on_both_sides_of_zero(void **state)
{
    (void)state;
    static const int64_t rows[][4] = { { 7, 8, 0, 7 },     { 8, 8, 1, 0 },     { -1, 8, -1, 7 },
                                       { -8, 8, -1, 0 },   { -9, 8, -2, 7 },   { 0, 8, 0, 0 },
                                       { -17, 17, -1, 0 }, { -18, 17, -2, 16 } };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        REQUIRE_CMP(sdfgi_floor_div(rows[i][0], rows[i][1]), ==, rows[i][2]);
        REQUIRE_CMP(sdfgi_floor_mod(rows[i][0], rows[i][1]), ==, rows[i][3]);
    }
    for (int64_t a = -INT64_C(5000000000); a < INT64_C(5000000000); a += 77777777) {
        REQUIRE_CMP(sdfgi_floor_div(a, 17) * 17 + sdfgi_floor_mod(a, 17), ==, a);
        REQUIRE_TRUE(sdfgi_floor_mod(a, 17) >= 0 && sdfgi_floor_mod(a, 17) < 17);
    }
}

/* Origin on a probe, camera's cell within half a spacing of the middle after a move and one spacing without.
 */
static void require_centred(const struct cascade *c, const double camera[3], bool moved)
{
    for (int i = 0; i < 3; i++) {
        REQUIRE_CMP(sdfgi_floor_mod(c->origin[i], SDFGI_PROBE_SPACING), ==, 0);
        const double off = camera[i] / c->cell_size[i] - (double)(c->origin[i] + 32);
        REQUIRE_TRUE(off >= -8 && off < 9);
        if (moved)
            REQUIRE_TRUE(off >= -4 && off < 5);
    }
}

static void a_new_cascade_is_centred_anywhere(void **state)
{
    (void)state;
    struct test_random random = { 22 };
    for (int i = 0; i < 2000; i++) {
        struct cascade c = cascade_of(i & 1 ? 0.2 : 0.25);
        c.cell_size[1] *= i & 2 ? 0.75 : 1;
        const double reach = i < 1000 ? 100 : 1e9;
        double camera[3];
        for (int k = 0; k < 3; k++)
            camera[k] = test_random_real(&random, -reach, reach);
        REQUIRE_TRUE(sdfgi_cascade_place(&c, 64, camera));
        require_centred(&c, camera, true);
        REQUIRE_TRUE(!sdfgi_cascade_place(&c, 64, camera));
    }
}

static void a_walk_stays_centred(void **state)
{
    (void)state;
    struct test_random random = { 21 };
    struct cascade c = cascade_of(0.25);
    double camera[3] = { -3, 0.01, 5 };
    place(&c, camera[0], camera[1], camera[2]);
    uint32_t moves = 0;
    for (int frame = 0; frame < 5000; frame++) {
        for (int k = 0; k < 3; k++)
            camera[k] += test_random_real(&random, -0.5, 0.5);
        moves += sdfgi_cascade_place(&c, 64, camera);
        require_centred(&c, camera, false);
    }
    REQUIRE_CMP(moves, >, 10);
    REQUIRE_CMP(moves, <, 2500);
}

/* One that moves along one axis leaves the others where hysteresis holds them. */
static void axes_move_alone(void **state)
{
    (void)state;
    struct cascade c = cascade_of(1);
    place(&c, 0.5, 0.5, 0.5);
    const int64_t y = c.origin[1], z = c.origin[2];
    REQUIRE_TRUE(place(&c, 20.5, 5.5, -5.5));
    REQUIRE_CMP(c.origin[1], ==, y);
    REQUIRE_CMP(c.origin[2], ==, z);
    REQUIRE_CMP(c.origin[0], ==, 16 - 32); /* up to the camera, not past it */
}

/* Along axes on which cells are left free on the other side, a step may go past the camera into these. */
static void axes_with_spare_cells_move_along(void **state)
{
    (void)state;
    struct cascade c = cascade_of(1);
    place(&c, 0.5, 0.5, 0.5);
    memcpy(c.spare, (double[]){ 4, 2, -4 }, sizeof c.spare);
    REQUIRE_TRUE(!place(&c, 8.5, 7.5, -7.5));
    REQUIRE_TRUE(place(&c, 9.5, 5.5, -3.5));
    REQUIRE_CMP(c.origin[0], ==, 8 - 32);
    REQUIRE_CMP(c.origin[1], ==, -32);
    REQUIRE_CMP(c.origin[2], ==, -32);
    REQUIRE_TRUE(place(&c, 17.5, 6.5, -4.5));
    REQUIRE_CMP(c.origin[0], ==, 16 - 32);
    REQUIRE_CMP(c.origin[1], ==, 8 - 32);
    REQUIRE_CMP(c.origin[2], ==, -8 - 32);
}

/* Along a straight way a cascade steps as often as its fastest axis alone would have it, or hardly more
 * often. */
static void axes_step_together(void **state)
{
    (void)state;
    struct test_random random = { 23 };
    for (int trial = 0; trial < 200; trial++) {
        struct cascade c = cascade_of(1);
        double camera[3] = { 0.5, 0.5, 0.5 }, velocity[3] = { 1, 0, 0 };
        for (int i = 0; i < 3; i++) {
            velocity[i] = i > 0 ? test_random_real(&random, -1, 1) : 1;
            c.spare[i] = velocity[i] > 0 ? 4 : -4;
        }
        place(&c, camera[0], camera[1], camera[2]);
        int moves = 0;
        for (int cell = 0; cell < 800; cell++) {
            for (int i = 0; i < 3; i++)
                camera[i] += velocity[i];
            moves += place(&c, camera[0], camera[1], camera[2]);
            require_centred(&c, camera, false);
        }
        REQUIRE_CMP(moves, <=, 110);
    }
}

/* Anywhere, by next to nothing or by almost a probe spacing. */
static void hard_24_an_oscillating_camera_moves_a_cascade_once(void **state)
{
    (void)state;
    static const double reaches[3] = { 1e-4, 0.5, 3.9 };
    for (int boundary = -40; boundary <= 40; boundary++)
        for (int width = 0; width < 3; width++) {
            struct cascade c = cascade_of(0.25);
            const double low = 0.25 * (boundary - reaches[width]), high = 0.25 * (boundary + reaches[width]);
            place(&c, low, high, low);
            uint32_t moves = 0;
            for (int frame = 0; frame < 1000; frame++)
                moves += frame & 1 ? place(&c, low, high, low) : place(&c, high, low, high);
            HARD_CASE_AT_MOST(24, "moves of a cascade in 1,000 frames", moves, 1);
        }
}

static void hard_22_a_jump_of_any_length_is_one_move(void **state)
{
    (void)state;
    for (double cells = 1e3; cells <= 1e15; cells *= 10) {
        struct cascade c = cascade_of(0.25);
        place(&c, 0, 0, 0);
        const double camera[3] = { 0.25 * cells, -0.25 * cells, 0.125 };
        REQUIRE_TRUE(sdfgi_cascade_place(&c, 64, camera));
        require_centred(&c, camera, false);
        REQUIRE_TRUE(!sdfgi_cascade_place(&c, 64, camera));
        REQUIRE_TRUE(place(&c, 0, 0, 0));
        REQUIRE_CMP(c.origin[0], ==, -32);
    }
}

static void cameras_beyond_all_cells_do_not_overflow(void **state)
{
    (void)state;
    struct cascade c = cascade_of(0.01);
    REQUIRE_TRUE(place(&c, 1e300, -1e300, 1e18));
    for (int i = 0; i < 3; i++)
        REQUIRE_CMP(sdfgi_floor_mod(c.origin[i], SDFGI_PROBE_SPACING), ==, 0);
    REQUIRE_TRUE(!place(&c, 1e300, -1e300, 1e18));
    REQUIRE_TRUE(place(&c, 0, 0, 0));
    require_centred(&c, (double[]){ 0, 0, 0 }, true);
}

static void hard_25_negative_places_mirror_positive_ones_by_whole_spacings(void **state)
{
    (void)state;
    for (int step = -131072; step <= 131072; step += 8192) {
        struct cascade here = cascade_of(0.25), there = cascade_of(0.25);
        place(&here, 0.3, 1.1, -0.7);
        place(&there, 0.3 + 0.25 * 8 * step, 1.1 - 0.25 * 8 * step, -0.7 + 0.25 * 8 * step);
        REQUIRE_CMP(there.origin[0], ==, here.origin[0] + 8 * step);
        REQUIRE_CMP(there.origin[1], ==, here.origin[1] - 8 * step);
        REQUIRE_CMP(there.origin[2], ==, here.origin[2] + 8 * step);
    }
}

/* And a sub-voxel more on either side. */
static void boxes_cover_their_cells(void **state)
{
    (void)state;
    struct cascade c = cascade_of(0.25);
    c.cell_size[1] = 0.125;
    place(&c, 0, 0, 0);
    const struct cell_box whole = sdfgi_cell_box_whole(64);
    const struct box box = sdfgi_cascade_world_box(&c, &whole);
    REQUIRE_CMP(box.min[0], ==, -8.0625);
    REQUIRE_CMP(box.max[0], ==, 8.0625);
    REQUIRE_CMP(box.min[1], ==, -4.03125);
    REQUIRE_CMP(box.max[1], ==, 4.03125);
    const struct box touching = { { 8.0625, -1, -1 }, { 9, 1, 1 } },
                     apart = { { -1, 4.032, -1 }, { 1, 5, 1 } };
    REQUIRE_TRUE(sdfgi_box_overlaps(&box, &touching) && sdfgi_box_overlaps(&touching, &box));
    REQUIRE_TRUE(!sdfgi_box_overlaps(&box, &apart) && !sdfgi_box_overlaps(&apart, &box));
}

/* An edit was noted, and then the cascade moved away from it. */
static void an_edit_without_a_cell_begins_no_change(void **state)
{
    (void)state;
    const struct box edit = { { -1, -1, -1 }, { 1, 1, 1 } };
    for (int away = 0; away < 2; away++) {
        struct cascade c = cascade_of(0.25);
        place(&c, 0, 0, 0);
        c.place = CASCADE_CURRENT;
        c.valid = sdfgi_cell_box_whole(64);
        REQUIRE_TRUE(sdfgi_cascade_add_edit(&c, 64, &edit));
        c.origin[0] += 64 * away;
        sdfgi_change_begin_edit(&c, 64);
        REQUIRE_CMP((int)c.change.cause, ==, (int)(away ? CHANGE_NONE : CHANGE_EDIT));
        REQUIRE_CMP(c.edit_count, ==, 0u);
        REQUIRE_CMP(sdfgi_cell_box_cells(&c.valid), ==, 64ul * 64 * 64);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(division_rounds_down_on_both_sides_of_zero),
        cmocka_unit_test(a_new_cascade_is_centred_anywhere),
        cmocka_unit_test(a_walk_stays_centred),
        cmocka_unit_test(axes_move_alone),
        cmocka_unit_test(axes_with_spare_cells_move_along),
        cmocka_unit_test(axes_step_together),
        cmocka_unit_test(hard_24_an_oscillating_camera_moves_a_cascade_once),
        cmocka_unit_test(hard_22_a_jump_of_any_length_is_one_move),
        cmocka_unit_test(cameras_beyond_all_cells_do_not_overflow),
        cmocka_unit_test(hard_25_negative_places_mirror_positive_ones_by_whole_spacings),
        cmocka_unit_test(boxes_cover_their_cells),
        cmocka_unit_test(an_edit_without_a_cell_begins_no_change),
    };
    return cmocka_run_group_tests_name("placement", tests, NULL, NULL);
}
