/* SPDX-License-Identifier: MIT
 * Where answers end: probes in solid bodies, the edge of the last cascade, pictures of one row, and contexts
 * with nothing to see (HARD_CASES rows 44, 68 and 69). */
#include "hard_case.h"
#include "light_scene.h"
#include "require.h"
#include "test_group.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

struct range {
    double low, high;
};

/* ---- Probes in solid bodies */

/* A body that is full of set sub-voxels: layers so close that none is missed. */
static void add_full_box(struct gi_test *t, const double low[static 3], const double high[static 3],
                         double step_m)
{
    struct test_mesh layers = { 0 };
    const double u[3] = { (high[0] - low[0]) / 2, 0, 0 }, v[3] = { 0, 0, (high[2] - low[2]) / 2 };
    for (double y = low[1]; y < high[1]; y += step_m) {
        struct test_mesh layer = test_mesh_plane((double[]){ low[0] + u[0], y, low[2] + v[2] }, u, v, 1);
        test_mesh_append(&layers, &layer);
        test_mesh_destroy(&layer);
    }
    light_add(t, layers, 1, 0);
    light_add_box(t, low, high, (float[]){ 1, 1, 1 }, 0);
}

enum { BODY_POINTS = 6 * 25 * 2 };

/* On the faces of a box, and in the air a little before them, looking along all axes in turn. */
static void place_body_points(const double low[static 3], const double high[static 3],
                              struct gi_test_point points[static BODY_POINTS])
{
    for (int i = 0; i < BODY_POINTS; i++) {
        const int face = i / 50, axis = face / 2, sign = face % 2 ? 1 : -1, place = i % 25;
        struct gi_test_point p = { 0 };
        for (int k = 0; k < 3; k++) {
            const int other = (k - axis + 3) % 3;
            const double part = other == 1 ? place % 5 : (double)(place / 5);
            p.position[k] = (float)(low[k] + (high[k] - low[k]) * (0.05 + 0.9 * part / 4));
        }
        const bool in_air = i / 25 % 2;
        p.position[axis] = (float)(sign > 0 ? high[axis] : low[axis]) + (in_air ? 0.55f * (float)sign : 0);
        p.normal[in_air ? (axis + place) % 3 : axis] = (float)sign;
        points[i] = p;
    }
}

/* Light over pi at a white body under a white sky. A convex one changes nothing: all is as bright as the sky,
 * as far as it may be white. `from` to `to` are in cells around a probe. */
static struct range light_around_body(struct gi_test *t, double from, double to, uint32_t cascades,
                                      uint32_t *dead)
{
    const double cell_m = 0.25, low[3] = { from * cell_m, from * cell_m, from * cell_m },
                 high[3] = { to * cell_m, to * cell_m, to * cell_m };
    static struct gi_test_point points[BODY_POINTS];
    static float found[BODY_POINTS][3];
    struct sdfgi_settings settings = light_settings(32, (float)cell_m);
    settings.cascades = cascades;
    gi_test_restart(t, &settings);
    add_full_box(t, low, high, cell_m / 4);
    light_set_uniform_sky(t, 1);
    gi_test_converge(t, 400);
    uint32_t *counters = gi_test_read(t, RESOURCE_COUNTERS, NULL);
    *dead = counters[SDFGI_COUNTER_DEAD_PROBES];
    free(counters);
    place_body_points(low, high, points);
    gi_test_irradiance(t, points, BODY_POINTS, found);
    struct range range = { INFINITY, 0 };
    for (int i = 0; i < BODY_POINTS; i++) {
        REQUIRE_TRUE(isfinite(found[i][1]));
        range.low = fmin(range.low, (double)found[i][1] / PI);
        range.high = fmax(range.high, (double)found[i][1] / PI);
    }
    printf("body from %.1f to %.1f cells, %u cascades: %u dead probes, light %.4f to %.4f\n", from, to,
           cascades, *dead, range.low, range.high);
    return range;
}

static void hard_44_a_probe_in_a_body_leaves_its_light_to_others(void **state)
{
    uint32_t dead;
    const struct range found = light_around_body(*state, -4.6, 4.7, 1, &dead);
    HARD_CASE_AT_LEAST(44, "dead probes", dead, 1);
    HARD_CASE_AT_LEAST(44, "light around a body in which one probe is, of exact", found.low, 0.97);
    HARD_CASE_AT_MOST(44, "light around a body in which one probe is, over exact", found.high, 1.01);
}

static void hard_44_eight_probes_in_a_body_leave_their_light_to_others(void **state)
{
    uint32_t dead;
    const struct range found = light_around_body(*state, -4.6, 12.7, 2, &dead);
    HARD_CASE_AT_LEAST(44, "dead probes of a whole cage", dead, 8);
    HARD_CASE_AT_LEAST(44, "light around a body in which a cage is, of exact", found.low, 0.97);
    HARD_CASE_AT_MOST(44, "light around a body in which a cage is, over exact", found.high, 1.01);
}

/* ---- The edge of the last cascade */

/* As lib/sky.glsl has it, which tests/pass/test_encodings.c compares with quadrature. */
static double ramp(double y)
{
    return 0.212207 + y * (0.333333 + y * 0.121126);
}

static double sky_light(const struct sdfgi_sky *sky, const float normal[static 3])
{
    const double y = (double)normal[1], horizon = (double)sky->horizon[1];
    return horizon + ((double)sky->zenith[1] - horizon) * ramp(y) +
           ((double)sky->ground[1] - horizon) * ramp(-y);
}

enum { EDGE_CELL_STEPS = 4, EDGE_STEPS = 40 * EDGE_CELL_STEPS };

/* From the middle of the cascade outwards, over the plane y = 0. Probes end 16 cells from the middle, and
 * light is the sky's from one cell before that on. */
static void walk_out(struct gi_test *t, double cell_m, const double aside[static 2],
                     const float normal[static 3], double light[static EDGE_STEPS])
{
    static struct gi_test_point points[EDGE_STEPS];
    static float found[EDGE_STEPS][3];
    for (int i = 0; i < EDGE_STEPS; i++) {
        const double x = cell_m * i / EDGE_CELL_STEPS;
        points[i] = (struct gi_test_point){ { (float)x, (float)aside[0], (float)aside[1] },
                                            { normal[0], normal[1], normal[2] } };
    }
    gi_test_irradiance(t, points, EDGE_STEPS, found);
    for (int i = 0; i < EDGE_STEPS; i++) {
        REQUIRE_TRUE(isfinite(found[i][1]) && found[i][1] >= 0);
        light[i] = (double)found[i][1] / PI;
    }
}

static void hard_68_light_fades_to_the_sky_over_one_probe(void **state)
{
    static const double asides[][2] = { { 1.3, 0 }, { 0.4, 1.1 }, { 2.1, -0.7 } };
    static const float normals[][3] = { { 0, 1, 0 }, { 0, -1, 0 }, { 1, 0, 0 }, { -0.6f, 0, 0.8f } };
    const double cell_m = 0.4;
    struct gi_test *t = *state;
    const struct sdfgi_settings settings = light_settings(32, (float)cell_m);
    const struct sdfgi_sky sky = { { 3, 3, 3 }, { 1, 1, 1 }, { 0.2f, 0.2f, 0.2f } };
    gi_test_restart(t, &settings);
    light_add_box(t, (double[]){ -40, -1, -40 }, (double[]){ 40, 0, 40 }, (float[]){ 0, 0, 0 }, 0);
    REQUIRE_CMP((int)sdfgi_set_sky(t->gi, &sky), ==, (int)SDFGI_OK);
    gi_test_converge(t, 200);
    double beyond = 0, step = 0, within = 0;
    for (int i = 0; i < 12; i++) {
        double light[EDGE_STEPS];
        const double exact = sky_light(&sky, normals[i % 4]);
        walk_out(t, cell_m, asides[i / 4], normals[i % 4], light);
        for (int k = 1; k < EDGE_STEPS; k++) {
            if (k >= 15 * EDGE_CELL_STEPS)
                beyond = fmax(beyond, fabs(light[k] - exact));
            step = fmax(step, fabs(light[k] - light[k - 1]) / exact);
            if (k < 7 * EDGE_CELL_STEPS && i % 4 == 1) /* nothing but black ground is seen */
                within = fmax(within, light[k]);
        }
    }
    printf("edge: beyond it off by %.6f, steps of %.4f of it at most, %.4f of light from black ground\n",
           beyond, step, within);
    HARD_CASE_AT_MOST(68, "light beyond the last cascade, off the sky's by", beyond, 2e-3);
    /* A thirty-second of the way from black is 0.03. */
    HARD_CASE_AT_MOST(68, "largest change over a quarter cell, of the sky's light", step, 0.06);
    REQUIRE_CMP(within, <=, 0.1);
}

/* ---- Slits */

/* A wall before x = 0 with an upright slit, half a cell wide, and a panel that glows before it. */
static void build_slit(struct gi_test *t, double depth_m)
{
    const struct sdfgi_settings settings = light_cell_settings(32, 0.25f);
    const float black[3] = { 0, 0, 0 };
    gi_test_restart(t, &settings);
    light_add_box(t, (double[]){ -2, -3, -3 }, (double[]){ -depth_m, 3, 3 }, black, 0);
    light_add_box(t, (double[]){ -2, -3, -3 }, (double[]){ 0, 3, -0.06 }, black, 0);
    light_add_box(t, (double[]){ -2, -3, 0.06 }, (double[]){ 0, 3, 3 }, black, 0);
    light_add_box(t, (double[]){ 0.6, -0.4, -0.4 }, (double[]){ 0.8, 0.4, 0.4 }, black, 1);
    gi_test_update(t, 40);
}

/* At the bottom of a slit no light cell is near. A place nearer to the viewer answers, from the
 * light cells that the wall beside the slit reads, too, and at most a tenth of a metre off: 0.002 of it. With
 * one place alone the bottom is black. */
static void the_bottom_of_a_slit_reads_the_light_before_it(void **state)
{
    const double depth_m = 0.55;
    const struct gi_test_point points[2] = { { { (float)-depth_m, 0.1f, 0 }, { 1, 0, 0 } },
                                             { { 0, 0.1f, 0.1f }, { 1, 0, 0 } } };
    float found[2][3];
    build_slit(*state, depth_m);
    gi_test_irradiance_from(*state, (float[]){ 5, 0.1f, 0 }, points, 2, found);
    const double bottom = (double)found[0][1], beside = (double)found[1][1];
    printf("bottom of a slit: %.4f, wall beside it %.4f\n", bottom, beside);
    REQUIRE_CMP(beside, >, 0.5);
    REQUIRE_CMP(fabs(bottom / beside - 1), <=, 0.02);
}

/* ---- Extremes */

/* Gathers a picture that is `width` x `height` pixels of one place, and returns its range. */
static struct range gather_extreme(struct gi_test *t, uint32_t width, uint32_t height)
{
    const uint32_t pixels = width * height;
    float *depth = calloc(pixels, sizeof *depth), (*normal)[4] = calloc(pixels, sizeof *normal);
    uint16_t(*found)[4] = calloc(pixels, sizeof *found);
    REQUIRE_TRUE(depth && normal && found);
    for (uint32_t i = 0; i < pixels; i++) {
        depth[i] = 0.5f;
        normal[i][1] = 1;
    }
    struct gpu_test_image images[3] = {
        gi_test_gather_image(t, VK_FORMAT_R32_SFLOAT, 4, width, height, depth),
        gi_test_gather_image(t, VK_FORMAT_R32G32B32A32_SFLOAT, 16, width, height, normal),
        gi_test_gather_image(t, VK_FORMAT_R16G16B16A16_SFLOAT, 8, width, height, NULL),
    };
    /* Clip x and y in [-1, 1] are a metre, however many pixels there are. */
    const struct sdfgi_gather_desc desc = {
        .depth = images[0].view,
        .normal = images[1].view,
        .output = images[2].view,
        .width = width,
        .height = height,
        .background_depth = 1,
        .inverse_view_projection = { 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1 },
    };
    gi_test_gather(t, &desc);
    gpu_test_image_read(&t->gpu, images[2].image, VK_IMAGE_LAYOUT_GENERAL, VK_IMAGE_ASPECT_COLOR_BIT,
                        images[2].extent, 8, found);
    struct range range = { INFINITY, 0 };
    for (uint32_t i = 0; i < pixels; i++) {
        const double light = (double)gi_test_half(found[i][1]) / PI;
        REQUIRE_TRUE(isfinite(light));
        range.low = fmin(range.low, light);
        range.high = fmax(range.high, light);
    }
    for (int i = 0; i < 3; i++)
        gpu_test_image_destroy(&t->gpu, &images[i]);
    free(depth);
    free(normal);
    free(found);
    return range;
}

/* Eight cascades around nothing, first without any light, then under a sky. */
static void hard_69_eight_cascades_of_nothing_render(void **state)
{
    struct gi_test *t = *state;
    const uint32_t longest = t->gpu.properties.limits.maxImageDimension2D < 16384
                                 ? t->gpu.properties.limits.maxImageDimension2D
                                 : 16384;
    const uint32_t sizes[][2] = { { 1, 1 }, { longest, 1 }, { 1, longest } };
    struct sdfgi_settings settings = light_settings(32, 0.1f);
    settings.cascades = SDFGI_MAX_CASCADES;
    gi_test_restart(t, &settings);
    double worst = 0;
    for (int sky = 0; sky < 2; sky++) {
        light_set_uniform_sky(t, (float)sky);
        gi_test_converge(t, 100);
        for (int i = 0; i < 3; i++) {
            const struct range found = gather_extreme(t, sizes[i][0], sizes[i][1]);
            printf("sky of %d, picture of %u x %u: %.4f to %.4f\n", sky, sizes[i][0], sizes[i][1], found.low,
                   found.high);
            worst = fmax(worst, fmax(fabs(found.low - sky), fabs(found.high - sky)));
        }
    }
    HARD_CASE_AT_MOST(69, "pictures of eight cascades of nothing, off by", worst, 2e-3);
}

TEST_GROUP(edges)
{
    if (!gpu_test_available())
        return GPU_TEST_SKIP;
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(hard_44_a_probe_in_a_body_leaves_its_light_to_others),
        cmocka_unit_test(hard_44_eight_probes_in_a_body_leave_their_light_to_others),
        cmocka_unit_test(hard_68_light_fades_to_the_sky_over_one_probe),
        cmocka_unit_test(the_bottom_of_a_slit_reads_the_light_before_it),
        cmocka_unit_test(hard_69_eight_cascades_of_nothing_render),
    };
    return cmocka_run_group_tests(tests, light_open, light_close);
}
