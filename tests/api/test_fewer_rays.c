/* SPDX-License-Identifier: MIT
 * Views that send fewer rays than pixels: how many they send, and that pictures show the same. */
#include "require.h"
#include "test_group.h"
#include "view_stage.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

static struct view_stage stage;

/* Resolves a picture in a view of its own. Returns how many rays that sends. */
static uint32_t resolve(enum sdfgi_gather_resolution resolution, float roughness, float (*pixels)[4])
{
    sdfgi_view *view = view_stage_view_at(&stage, resolution);
    view_stage_resolve(&stage, view, roughness);
    view_stage_read(&stage, &view->reflection, pixels);
    uint32_t header[SDFGI_TILES_HEADER];
    gpu_test_buffer_read(&stage.t.gpu, view->tiles.handle, 0, sizeof header, header);
    sdfgi_view_destroy(stage.t.gi, view);
    return header[SDFGI_TILES_RAYS + 3];
}

/* A quarter and a sixteenth of the rays, and those of pixels that lie fewer than a step beside the wall,
 * which is background, and of a ridge that lies between rays. So do rough surfaces at full resolution. Rays
 * of sixteen places hold all parts of the lobe, however far apart they are: the mean is little off. */
static void fewer_rays_show_the_same(void **state)
{
    (void)state;
    static float full[VIEW_STAGE_PIXELS][4], other[VIEW_STAGE_PIXELS][4];
    static const struct {
        enum sdfgi_gather_resolution resolution;
        float roughness, beside; /* of the picture that it is compared with */
        uint32_t step;
        double off; /* of the mean luminance, at most */
    } rows[] = {
        { SDFGI_GATHER_HALF, 0, 0, 2, 1e-5 },          { SDFGI_GATHER_QUARTER, 0, 0, 4, 1e-5 },
        { SDFGI_GATHER_HALF, 0.2f, 0.2f, 2, 0.006 },   { SDFGI_GATHER_QUARTER, 0.2f, 0.2f, 4, 0.012 },
        { SDFGI_GATHER_HALF, 0.3f, 0.3f, 2, 0.006 },   { SDFGI_GATHER_QUARTER, 0.3f, 0.3f, 4, 0.012 },
        { SDFGI_GATHER_FULL, 0.56f, 0.54f, 2, 0.012 }, { SDFGI_GATHER_FULL, 0.65f, 0.63f, 4, 0.012 }
    };
    stage.ridge = 13;
    view_stage_open(&stage, 1);
    for (size_t k = 0; k < sizeof rows / sizeof *rows; k++) {
        const float roughness = rows[k].roughness;
        const uint32_t all = resolve(SDFGI_GATHER_FULL, rows[k].beside, full),
                       sent = resolve(rows[k].resolution, roughness, other), step = rows[k].step;
        REQUIRE_TRUE(all == VIEW_STAGE_SURFACES || rows[k].beside > 0.55f);
        const double off = fabs(view_stage_luminance(other) / view_stage_luminance(full) - 1);
        for (int i = 0; i < VIEW_STAGE_PIXELS; i++)
            REQUIRE_TRUE(other[i][3] >= 0 && (other[i][3] > 0) == (stage.depths[i] < 1));
        for (int i = 13; i < VIEW_STAGE_PIXELS && roughness == 0; i += VIEW_STAGE_SIDE)
            REQUIRE_TRUE(fabsf(other[i][0] / full[i][0] - 1) < 1e-3f && full[i][2] < view_stage_zenith[2]);
        printf("roughness %.2f: %u rays instead of %u, mean off by %.4f\n", (double)roughness, sent, all,
               off);
        REQUIRE_CMP(sent, >=, VIEW_STAGE_SURFACES / (step * step));
        REQUIRE_CMP(sent, <, VIEW_STAGE_SURFACES / (step * step) + (2 * step + 1) * VIEW_STAGE_SIDE);
        REQUIRE_CMP(off, <=, rows[k].off);
    }
    view_stage_close(&stage);
}

/* Where all pixels send rays, these are those of full resolution: each shows its own part of the lobe. At a
 * quarter, squares in which the wall begins send too few for that. */
static void detail_of_each_pixel_is_as_at_full_resolution(void **state)
{
    (void)state;
    static float full[VIEW_STAGE_PIXELS][4], other[VIEW_STAGE_PIXELS][4];
    stage.detail = VIEW_STAGE_COBBLES;
    view_stage_open(&stage, 1);
    resolve(SDFGI_GATHER_FULL, 0.1f, full);
    for (int quarter = 0; quarter < 2; quarter++) {
        const uint32_t sent = resolve(quarter ? SDFGI_GATHER_QUARTER : SDFGI_GATHER_HALF, 0.1f, other);
        REQUIRE_CMP(sent, ==, (uint32_t)VIEW_STAGE_SURFACES);
        for (int i = 0; i < VIEW_STAGE_PIXELS; i++)
            if (!quarter || i % VIEW_STAGE_SIDE >= 4)
                REQUIRE_TRUE(memcmp(full[i], other[i], sizeof full[i]) == 0);
    }
    view_stage_close(&stage);
}

/* Columns between those of the grid send all of their rays, and take the mean of as many as at full
 * resolution. The others send half of theirs. */
static void grooves_are_as_at_full_resolution_where_they_send_rays(void **state)
{
    (void)state;
    static float full[VIEW_STAGE_PIXELS][4], other[VIEW_STAGE_PIXELS][4];
    stage.detail = VIEW_STAGE_GROOVES;
    view_stage_open(&stage, 1);
    resolve(SDFGI_GATHER_FULL, 0.1f, full);
    const uint32_t sent = resolve(SDFGI_GATHER_HALF, 0.1f, other);
    REQUIRE_CMP(sent, ==, VIEW_STAGE_SURFACES * 3 / 4u);
    for (int i = 1; i < VIEW_STAGE_PIXELS; i += 2)
        REQUIRE_TRUE(memcmp(full[i], other[i], sizeof full[i]) == 0);
    REQUIRE_CMP(memcmp(full, other, sizeof full), !=, 0);
    view_stage_close(&stage);
}

/* Rays of the grid, but for those beside the wall and at the picture's border, and those of them that stand
 * for a part of the lobe as at full resolution. */
struct grid_rays {
    uint32_t all, dense;
};

static struct grid_rays grid_rays_at_half(void)
{
    enum {
        GRID_FIRST = 8,
        FIRST = SDFGI_TILES_HEADER + VIEW_STAGE_PIXELS / (SDFGI_GROUP_PIXELS * SDFGI_GROUP_PIXELS)
    };
    static uint32_t words[FIRST + VIEW_STAGE_PIXELS];
    sdfgi_view *view = view_stage_view_at(&stage, SDFGI_GATHER_HALF);
    view_stage_resolve(&stage, view, 0.1f);
    gpu_test_buffer_read(&stage.t.gpu, view->tiles.handle, 0, sizeof words, words);
    sdfgi_view_destroy(stage.t.gi, view);
    struct grid_rays rays = { 0, 0 };
    for (uint32_t i = 0; i < words[SDFGI_TILES_RAYS + 3]; i++) {
        const uint32_t word = words[FIRST + i];
        const uint32_t x = word & 0x7fff, y = word >> 16, end = VIEW_STAGE_SIDE - 2;
        const bool counts = ((x | y) & 1) == 0 && x >= GRID_FIRST && x < end && y < end;
        rays.all += counts;
        rays.dense += counts && (word & 0x8000) != 0;
    }
    return rays;
}

/* Two of the three pixels between those of the grid, and not one. */
static void squares_are_dense_where_half_of_the_others_send_rays(void **state)
{
    (void)state;
    for (int dots = 0; dots <= 3; dots++) {
        stage.dots = dots;
        view_stage_open(&stage, 1);
        const struct grid_rays rays = grid_rays_at_half();
        printf("%d pixels of a square lean: %u of %u rays of the grid are dense\n", dots, rays.dense,
               rays.all);
        REQUIRE_CMP(rays.all, ==, 7u * 11u);
        REQUIRE_CMP(rays.dense, ==, dots >= 2 ? rays.all : 0u);
        view_stage_close(&stage);
    }
}

static int finish(void **state)
{
    (void)state;
    gi_test_close(&stage.t);
    return 0;
}

TEST_GROUP(fewer_rays)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(fewer_rays_show_the_same),
        cmocka_unit_test(detail_of_each_pixel_is_as_at_full_resolution),
        cmocka_unit_test(grooves_are_as_at_full_resolution_where_they_send_rays),
        cmocka_unit_test(squares_are_dense_where_half_of_the_others_send_rays),
    };
    return cmocka_run_group_tests_name("fewer_rays", tests, NULL, finish);
}
