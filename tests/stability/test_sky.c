/* SPDX-License-Identifier: MIT
 * Sky light: exact where nothing is in the way, and cut by exactly what black surfaces hide (HARD_CASES rows
 * 5, 38). */
#include "hard_case.h"
#include "light_scene.h"
#include "require.h"
#include "test_group.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

static const float black[3] = { 0, 0, 0 }, white[3] = { 1, 1, 1 };

static void empty_scene_is_the_uniform_sky_exactly(void **state)
{
    (void)state;
    struct gi_test t;
    const struct sdfgi_settings settings = light_quick_settings(32, 0.25f);
    gi_test_open(&t, &settings);
    light_set_uniform_sky(&t, 1);
    gi_test_converge(&t, 60);
    struct gi_test_point points[] = {
        { { 0, 0, 0 }, { 0, 1, 0 } },
        { { 0.3f, 1.2f, -2.1f }, { 0, -1, 0 } },
        { { 3.9f, 0, 0 }, { 1, 0, 0 } },
        { { 500, 2, 1 }, { 0.6f, 0, 0.8f } },
    };
    float found[4][3];
    gi_test_irradiance(&t, points, 4, found);
    for (int i = 0; i < 4; i++) {
        printf("empty scene, point %d: E / pi %.6f\n", i, (double)found[i][0] / PI);
        for (int k = 0; k < 3; k++)
            HARD_CASE_AT_MOST(40, "constant sky, off by", fabs((double)found[i][k] / PI - 1), 1e-3);
    }
    gi_test_close(&t);
}

/* E of the gradient sky, in the middle of equal areas of the sphere: 10^-4 exact. */
static double gradient_irradiance(const struct sdfgi_sky *sky, const float n[static 3])
{
    enum { ROWS = 400, COLUMNS = 800 };
    double sum = 0;
    for (int r = 0; r < ROWS; r++)
        for (int c = 0; c < COLUMNS; c++) {
            const double y = (r + 0.5) / ROWS * 2 - 1, flat = sqrt(1 - y * y),
                         angle = 2 * PI * (c + 0.5) / COLUMNS;
            const double cosine =
                flat * cos(angle) * (double)n[0] + y * (double)n[1] + flat * sin(angle) * (double)n[2];
            const double end = (double)(y >= 0 ? sky->zenith[0] : sky->ground[0]),
                         horizon = (double)sky->horizon[0];
            sum += fmax(cosine, 0) * (horizon + (end - horizon) * fabs(y));
        }
    return sum * 4 * PI / (ROWS * COLUMNS);
}

/* Five by five texels carry a gradient to 3.5 % of its brightest value (HARD_CASES row 40). */
static void empty_scene_follows_a_gradient_sky(void **state)
{
    (void)state;
    struct gi_test t;
    const struct sdfgi_settings settings = light_quick_settings(32, 0.25f);
    gi_test_open(&t, &settings);
    const struct sdfgi_sky sky = { { 3, 3, 3 }, { 1, 1, 1 }, { 0.2f, 0.2f, 0.2f } };
    REQUIRE_CMP(sdfgi_set_sky(t.gi, &sky), ==, SDFGI_OK);
    gi_test_converge(&t, 60);
    const double brightest = gradient_irradiance(&sky, (float[]){ 0, 1, 0 });
    const float normals[][3] = {
        { 0, 1, 0 }, { 0, -1, 0 }, { 1, 0, 0 }, { 0, 0.6f, 0.8f }, { 0.8f, -0.6f, 0 }
    };
    for (int i = 0; i < 5; i++) {
        struct gi_test_point point = { { 0.4f, 0.2f, -0.3f },
                                       { normals[i][0], normals[i][1], normals[i][2] } };
        const double exact = gradient_irradiance(&sky, normals[i]), found = light_white_at(&t, point);
        printf("gradient sky, normal %d: E / pi %.4f, exact %.4f\n", i, found / PI, exact / PI);
        HARD_CASE_AT_MOST(40, "gradient sky, off by, of its brightest", fabs(found - exact) / brightest,
                          0.035);
    }
    gi_test_close(&t);
}

static void check_plane(enum sdfgi_y_scale y_scale, const float albedo[static 3])
{
    struct gi_test t;
    struct sdfgi_settings settings = light_quick_settings(64, 0.25f);
    settings.y_scale = y_scale;
    gi_test_open(&t, &settings);
    light_add_box(&t, (double[]){ -20, -1, -20 }, (double[]){ 20, 0.05, 20 }, albedo, 0);
    light_set_uniform_sky(&t, 1);
    gi_test_converge(&t, 80);
    const struct gi_test_point points[] = {
        { { 0, 0.05f, 0 }, { 0, 1, 0 } },
        { { 1.3f, 0.05f, -2.7f }, { 0, 1, 0 } },
        { { -3.2f, 0.05f, 0.9f }, { 0, 1, 0 } },
        { { 0.6f, 1, 0.6f }, { 0, 1, 0 } },
    };
    float found[4][3];
    gi_test_irradiance(&t, points, 4, found);
    for (int i = 0; i < 4; i++)
        printf("plane of albedo %.0f, Y scale %d, point %d: E / pi %.4f\n", (double)albedo[0], (int)y_scale,
               i, (double)found[i][0] / PI);
    for (int i = 0; i < 4; i++)
        HARD_CASE_AT_MOST(38, "sky over a plane, off by", fabs((double)found[i][1] / PI - 1), 0.01);
    gi_test_close(&t);
}

/* A plane hides no part of the half space above it, whatever its colour and the height of a cell. */
static void hard_38_sky_on_a_plane_is_pi_at_y_scale_100(void **state)
{
    (void)state;
    check_plane(SDFGI_Y_SCALE_100, black);
    check_plane(SDFGI_Y_SCALE_100, white);
}

static void hard_38_sky_on_a_plane_is_pi_at_y_scale_75(void **state)
{
    (void)state;
    check_plane(SDFGI_Y_SCALE_75, black);
}

static void hard_38_sky_on_a_plane_is_pi_at_y_scale_50(void **state)
{
    (void)state;
    check_plane(SDFGI_Y_SCALE_50, black);
}

/* Form factor from a floor element to a wall at distance d, as wide as -half_width to half_width and `height`
 * tall (Howell, catalogue of radiation configuration factors, B-4, twice). */
static double wall_form_factor(double d, double half_width, double height)
{
    const double slant = sqrt(d * d + height * height);
    return (atan(half_width / d) - d / slant * atan(half_width / slant)) / PI;
}

#define CELL_M 0.25

/* A black wall on a black floor. The wall ends where the cascades do, and is as wide as they are. */
struct right_angle {
    enum sdfgi_y_scale y_scale;
    uint32_t cascades;
    int axis;      /* 0: the wall faces +x, 2: +z */
    double wall_m; /* where its face is; probes stand every 2 m from 0 on */
};

static void build_right_angle(struct gi_test *t, const struct right_angle *angle)
{
    struct sdfgi_settings settings = light_quick_settings(32, (float)CELL_M);
    settings.y_scale = angle->y_scale;
    settings.cascades = angle->cascades;
    settings.surface_light = SDFGI_SURFACE_LIGHT_CELLS;
    settings.cell_rays_per_frame = 1 << 18;
    gi_test_open(t, &settings);
    light_add_box(t, (double[]){ -40, -1, -40 }, (double[]){ 40, 0.05, 40 }, black, 0);
    double low[3] = { -40, 0.05, -40 }, high[3] = { 40, 40, 40 };
    low[angle->axis] = angle->wall_m - 1;
    high[angle->axis] = angle->wall_m;
    light_add_box(t, low, high, black, 0);
    light_set_uniform_sky(t, 1);
    gi_test_converge(t, 300);
}

/* A floor point sees the wall instead of up to half of the sky: 0.1 m from it the exact value is 0.507. */
static void check_right_angle(struct right_angle angle)
{
    enum { POINTS = 4 };
    static const double distances[POINTS] = { 0.1, 0.25, 0.5, 1 };
    static const double heights[] = {
        [SDFGI_Y_SCALE_50] = 0.5, [SDFGI_Y_SCALE_75] = 0.75, [SDFGI_Y_SCALE_100] = 1
    };
    const double half_m = 4 * (double)(1 << (angle.cascades - 1));
    struct gi_test t;
    build_right_angle(&t, &angle);
    struct gi_test_point at[POINTS];
    float found[POINTS][3];
    for (int i = 0; i < POINTS; i++) {
        at[i] = (struct gi_test_point){ { 0.3f, 0.05f, 0.3f }, { 0, 1, 0 } };
        at[i].position[angle.axis] = (float)(angle.wall_m + distances[i]);
    }
    gi_test_irradiance(&t, at, POINTS, found);
    gi_test_close(&t);
    for (int i = 0; i < POINTS; i++) {
        /* Within a cell of the wall light is that of the nearest light cell. Its centre may be 1.4 cells away
         * from the wall, where light is 7 % more. */
        const double height_m = half_m * heights[angle.y_scale] - 0.05,
                     farthest_m = distances[i] <= CELL_M ? fmax(distances[i], 1.4 * CELL_M) : distances[i];
        const double exact = 1 - wall_form_factor(distances[i], half_m, height_m),
                     most = 1 - wall_form_factor(farthest_m, half_m, height_m);
        const double e = (double)found[i][1] / PI;
        printf("Y scale %d, wall at %c = %.2f m, %.2f m from it: exact %.4f, at most %.4f, ratio %.4f\n",
               (int)angle.y_scale, "xyz"[angle.axis], angle.wall_m, distances[i], exact, most, e / exact);
        HARD_CASE_AT_LEAST(38, "sky beside a black wall, over the exact value", e / exact, 0.97);
        HARD_CASE_AT_MOST(38, "sky beside a black wall, over that at the next cell", e / most, 1.03);
    }
}

/* From just in front of one plane of probes to just in front of the next, along both level axes. One wall in
 * eight without SDFGI_TEST_FULL, which leaves both axes and both ends. */
static void hard_38_black_right_angle_wherever_the_probes_are(void **state)
{
    (void)state;
    static const double walls_m[] = { -1.84, -1.58, -1.34, -1.1, -0.79, -0.53, -0.27, -0.1, 0.03 };
    const size_t stride = getenv("SDFGI_TEST_FULL") ? 1 : 8;
    for (size_t i = 0; i < sizeof walls_m / sizeof *walls_m; i += stride)
        check_right_angle((struct right_angle){ SDFGI_Y_SCALE_100, 1, i / stride & 1 ? 2 : 0, walls_m[i] });
}

static void hard_38_black_right_angle_at_y_scale_75(void **state)
{
    (void)state;
    check_right_angle((struct right_angle){ SDFGI_Y_SCALE_75, 2, 0, -1.1 });
    check_right_angle((struct right_angle){ SDFGI_Y_SCALE_75, 2, 2, -0.4 });
}

static void hard_38_black_right_angle_at_y_scale_50(void **state)
{
    (void)state;
    if (getenv("SDFGI_TEST_FULL"))
        check_right_angle((struct right_angle){ SDFGI_Y_SCALE_50, 2, 2, -1.1 });
    check_right_angle((struct right_angle){ SDFGI_Y_SCALE_50, 2, 0, -1.7 });
}

/* ---- Steps that are lower than a cell */

enum { KERBS = 8, KERB_ROWS = 6, KERB_POINTS = KERBS * KERB_ROWS };

/* Black kerbs of 0.15 m on black ground, in cells of 1 m. The ground of each is a little lower than that of
 * the one before it, and each is a little farther off: feet lie anywhere in a sub-voxel. */
static void build_kerbs(struct gi_test *t, struct gi_test_point points[static KERB_POINTS])
{
    const struct sdfgi_settings settings = light_quick_settings(32, 1);
    gi_test_open(t, &settings);
    for (int i = 0; i < KERBS; i++) {
        const double z = 3 * (i - KERBS / 2), ground = -0.07 * i, face = 3 + 0.14 * i;
        light_add_box(t, (double[]){ -16, -4, z }, (double[]){ 16, ground, z + 3 }, black, 0);
        light_add_box(t, (double[]){ face, ground, z }, (double[]){ face + 0.4, ground + 0.15, z + 3 }, black,
                      0);
        for (int k = 0; k < KERB_ROWS; k++)
            points[KERB_ROWS * i + k] =
                (struct gi_test_point){ { (float)face, (float)(ground + 0.005 + 0.028 * k), (float)z + 1.5f },
                                        { -1, 0, 0 } };
    }
    light_set_uniform_sky(t, 1);
    gi_test_converge(t, 80);
}

/* Sight lines to the foot of a kerb far away run close above the ground, in its set sub-voxels. A kerb gets
 * half of the sky. The ground before it stands for it where it is too small for a light cell, and gets all of
 * it. */
static void foot_of_a_low_kerb_is_lit_from_afar(void **state)
{
    (void)state;
    static const double heights_m[] = { 0.5, 1, 1.7 };
    struct gi_test t;
    struct gi_test_point points[KERB_POINTS];
    build_kerbs(&t, points);
    uint32_t dark = 0;
    double least = 1e30, most = 0;
    for (int h = 0; h < 3; h++)
        for (int i = 0; i < KERBS; i++) {
            const struct gi_test_point *foot = &points[KERB_ROWS * i];
            const float viewer[3] = { -12, foot->position[1] + (float)heights_m[h],
                                      foot->position[2] + 0.4f };
            float found[KERB_ROWS][3];
            gi_test_irradiance_from(&t, viewer, foot, KERB_ROWS, found);
            for (int k = 0; k < KERB_ROWS; k++) {
                dark += found[k][1] <= 0;
                least = fmin(least, (double)found[k][1] / PI);
                most = fmax(most, (double)found[k][1] / PI);
            }
        }
    gi_test_close(&t);
    printf("kerbs: %u of %u points are dark, E / pi %.3f to %.3f\n", dark, 3u * KERB_POINTS, least, most);
    REQUIRE_CMP(dark, ==, 0u);
    REQUIRE_CMP(least, >=, 0.4);
    REQUIRE_CMP(most, <=, 1.05);
}

TEST_GROUP(sky)
{
    if (!gpu_test_available())
        return GPU_TEST_SKIP;
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(empty_scene_is_the_uniform_sky_exactly),
        cmocka_unit_test(empty_scene_follows_a_gradient_sky),
        cmocka_unit_test(hard_38_sky_on_a_plane_is_pi_at_y_scale_100),
        cmocka_unit_test(hard_38_sky_on_a_plane_is_pi_at_y_scale_75),
        cmocka_unit_test(hard_38_sky_on_a_plane_is_pi_at_y_scale_50),
        cmocka_unit_test(hard_38_black_right_angle_wherever_the_probes_are),
        cmocka_unit_test(hard_38_black_right_angle_at_y_scale_50),
        cmocka_unit_test(foot_of_a_low_kerb_is_lit_from_afar),
    };
    const struct CMUnitTest slow[] = { cmocka_unit_test(hard_38_black_right_angle_at_y_scale_75) };
    int failed = cmocka_run_group_tests(tests, NULL, NULL);
    if (getenv("SDFGI_TEST_FULL"))
        failed += cmocka_run_group_tests(slow, NULL, NULL);
    return failed;
}
