/* SPDX-License-Identifier: MIT
 * Edits that are spread over frames: what they touch keeps its light meanwhile. */
#include "light_scene.h"
#include "require.h"
#include "test_group.h"

#include <math.h>
#include <stdio.h>

static const struct gi_test_point points[] = {
    { { 0.8f, -1.1f, 0 }, { 0, 1, 0 } },
    { { 1.3f, -0.5f, 0.3f }, { -1, 0, 0 } },
    { { -1, -1.1f, 1 }, { 0, 1, 0 } },
    { { 1.2f, -1.1f, 0 }, { 0, 1, 0 } },
};
enum { POINTS = sizeof points / sizeof *points };

/* A wall on a floor under a sky. Returns the wall. */
static sdfgi_instance open_scene(struct gi_test *t, enum sdfgi_surface_light surface_light)
{
    struct sdfgi_settings settings = light_settings(128, 0.1f);
    settings.max_scroll_cells = 524288; /* an eighth of the voxels and distances */
    settings.ray_count = 25;
    settings.surface_light = surface_light;
    settings.cell_rays = SDFGI_VISIT_RAYS;
    settings.cell_rays_per_frame = 1 << 20;
    gi_test_open(t, &settings);
    light_set_uniform_sky(t, 1);
    const float albedo[3] = { 0.7f, 0.7f, 0.7f };
    light_add_box(t, (double[]){ -2.5, -1.9, -2.5 }, (double[]){ 2.5, -1.1, 2.5 }, albedo, 0);
    return light_add_box(t, (double[]){ 1.3, -1.3, -2 }, (double[]){ 1.7, 1.3, 2 }, albedo, 0);
}

/* Largest change of the points' light while everything is made again and nothing is another. */
static double worst_change(struct gi_test *t)
{
    static struct sdfgi_report report;
    const double low[3] = { -9, -9, -9 }, high[3] = { 9, 9, 9 };
    float before[POINTS][3], found[POINTS][3];
    double worst = 0;
    bool spread = false;
    gi_test_irradiance(t, points, POINTS, before);
    REQUIRE_CMP((int)sdfgi_invalidate_box(t->gi, low, high), ==, (int)SDFGI_OK);
    for (int i = 0; i < 8; i++) {
        gi_test_update(t, 1);
        gi_test_irradiance(t, points, POINTS, found);
        for (int k = 0; k < POINTS; k++)
            worst = fmax(worst, fabs((double)found[k][1] / (double)before[k][1] - 1));
        sdfgi_get_report(t->gi, &report);
        spread = spread || report.scroll.pending_cells > 0;
    }
    REQUIRE_TRUE(spread);
    return worst;
}

static void edit(enum sdfgi_surface_light surface_light)
{
    static struct gi_test t;
    open_scene(&t, surface_light);
    gi_test_update(&t, 16);
    const double worst = worst_change(&t);
    printf("an edit that changes nothing, light in %s: off by %.4f at most\n",
           surface_light == SDFGI_SURFACE_LIGHT_CELLS ? "cells" : "probes", worst);
    REQUIRE_CMP(worst, <=, 0.02);
    gi_test_close(&t);
}

static void edits_that_change_nothing_keep_the_light(void **state)
{
    (void)state;
    edit(SDFGI_SURFACE_LIGHT_PROBES);
}

static void edits_that_change_nothing_keep_the_light_of_cells(void **state)
{
    (void)state;
    edit(SDFGI_SURFACE_LIGHT_CELLS);
}

/* Cells of the first cascade up to the highest geometry, as rays know it. */
static int32_t content_height(const struct gi_test *t)
{
    return t->gi->volume.state.params.cascades[0].content_high.y;
}

/* Rays pass over what lies beyond all geometry. Voxels of a wall that is gone stay until their edit is
 * complete, and rays meet them as long. */
static void rays_reach_what_is_gone_until_its_voxels_are(void **state)
{
    static struct gi_test t;
    static struct sdfgi_report report;
    (void)state;
    const sdfgi_instance wall = open_scene(&t, SDFGI_SURFACE_LIGHT_PROBES);
    gi_test_update(&t, 2);
    const int32_t before = content_height(&t);
    REQUIRE_CMP((int)sdfgi_instance_destroy(t.gi, wall), ==, (int)SDFGI_OK);
    uint32_t frames = 0;
    do {
        gi_test_update(&t, 1);
        REQUIRE_CMP(content_height(&t), ==, before);
        sdfgi_get_report(t.gi, &report);
        frames++;
    } while (report.scroll.pending_cells > 0 && frames < 64);
    REQUIRE_CMP(frames, >, 1u);
    gi_test_update(&t, 2);
    REQUIRE_CMP(content_height(&t), ==, before - 24); /* 2.4 m in cells of 0.1 m */
    gi_test_close(&t);
}

TEST_GROUP(edits)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(edits_that_change_nothing_keep_the_light),
        cmocka_unit_test(edits_that_change_nothing_keep_the_light_of_cells),
        cmocka_unit_test(rays_reach_what_is_gone_until_its_voxels_are),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
