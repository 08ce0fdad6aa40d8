/* SPDX-License-Identifier: MIT
 * Skies of spherical harmonics: light in the air is what they have, however it gets there, and cube maps are
 * projected to what they show. */
#include "light_scene.h"
#include "require.h"
#include "test_group.h"

#include <sdfgi/sky.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { NORMALS = 8, SIDE = 32 };

static const double pi = 3.14159265358979;

static const float normals[NORMALS][3] = { { 0, 1, 0 },
                                           { 0, -1, 0 },
                                           { 1, 0, 0 },
                                           { -1, 0, 0 },
                                           { 0, 0, 1 },
                                           { 0, 0, -1 },
                                           { 0.6f, 0.64f, 0.48f },
                                           { -0.48f, 0.6f, -0.64f } };

/* ---- What is right */

static void functions_at(const double d[static 3], double f[static 9])
{
    const double x = d[0], y = d[1], z = d[2];
    const double values[9] = { 0.282095,
                               0.488603 * y,
                               0.488603 * z,
                               0.488603 * x,
                               1.092548 * x * y,
                               1.092548 * y * z,
                               0.315392 * (3 * z * z - 1),
                               1.092548 * x * z,
                               0.546274 * (x * x - y * y) };
    memcpy(f, values, sizeof values);
}

static double radiance(const struct sdfgi_sky_harmonics *h, const double d[static 3], int channel)
{
    double f[9], sum = 0;
    functions_at(d, f);
    for (int i = 0; i < 9; i++)
        sum += f[i] * (double)h->coefficients[i][channel];
    return fmax(sum, 0);
}

/* By quadrature over the sphere: no factor of the library's is used. `turn`: of the sky, around +Y. */
static double irradiance(const struct sdfgi_sky_harmonics *h, double turn, const float normal[static 3],
                         int channel)
{
    enum { ROWS = 90, COLUMNS = 180 };
    double sum = 0;
    for (int i = 0; i < ROWS * COLUMNS; i++) {
        const double y = 2 * (i / COLUMNS + 0.5) / ROWS - 1, angle = 2 * pi * (i % COLUMNS + 0.5) / COLUMNS;
        const double r = sqrt(1 - y * y), d[3] = { r * sin(angle), y, r * cos(angle) };
        const double back[3] = { r * sin(angle - turn), y, r * cos(angle - turn) };
        const double cosine = d[0] * (double)normal[0] + d[1] * (double)normal[1] + d[2] * (double)normal[2];
        sum += fmax(cosine, 0) * radiance(h, back, channel);
    }
    return sum * 4 * pi / (ROWS * COLUMNS);
}

/* ---- Scenes */

static void start(struct gi_test *t, const struct sdfgi_sky_harmonics *harmonics)
{
    struct sdfgi_settings settings = gi_test_settings();
    settings.resolution = 32;
    settings.ray_count = 125;
    settings.frames_to_converge = 4;
    gi_test_renew(t, &settings);
    REQUIRE_CMP((int)sdfgi_set_sky_harmonics(t->gi, harmonics), ==, (int)SDFGI_OK);
    gi_test_converge(t, 400);
}

static void look_up(struct gi_test *t, const float place[static 3], float found[static NORMALS][3])
{
    struct gi_test_point points[NORMALS];
    for (int i = 0; i < NORMALS; i++) {
        memcpy(points[i].position, place, sizeof points[i].position);
        memcpy(points[i].normal, normals[i], sizeof points[i].normal);
    }
    gi_test_irradiance(t, points, NORMALS, found);
}

/* Of the light at a place with nothing around, relative to what is right. */
static double worst_error(struct gi_test *t, const float place[static 3], double turn, double intensity)
{
    float found[NORMALS][3];
    double worst = 0;
    look_up(t, place, found);
    for (int i = 0; i < NORMALS; i++)
        for (int k = 0; k < 3; k++)
            worst = fmax(worst, fabs((double)found[i][k] /
                                         (intensity * irradiance(&light_tinted_sky, turn, normals[i], k)) -
                                     1));
    return worst;
}

static const float inside[3] = { 0.3f, 0.2f, -0.4f }, outside[3] = { 60, 0, 0 };

/* ---- Claims */

/* Beyond the cascades lookups answer with the factors of the bands; in them with what rays brought. Between
 * the 5 x 5 texels of a probe irradiance is blended: that alone is 5 % of light as uneven as this. */
static void the_air_has_the_light_of_the_sky(void **state)
{
    struct gi_test *t = *state;
    start(t, &light_tinted_sky);
    const double far = worst_error(t, outside, 0, 1), near = worst_error(t, inside, 0, 1);
    printf("largest error beyond the cascades %.4f, in them %.4f\n", far, near);
    REQUIRE_CMP(far, <, 0.002);
    REQUIRE_CMP(near, <, 0.06);
}

static void a_sky_turns_and_brightens(void **state)
{
    static const double turns[] = { 0.5, 1.5707963, -2.1, 40 };
    struct gi_test *t = *state;
    for (int i = 0; i < 4; i++) {
        struct sdfgi_sky_harmonics turned = light_tinted_sky;
        turned.rotation_rad = (float)turns[i];
        turned.intensity = 2.5f;
        start(t, &turned);
        const double error = worst_error(t, outside, turns[i], 2.5);
        printf("turned by %.2f: largest error %.4f\n", turns[i], error);
        REQUIRE_CMP(error, <, 0.002);
    }
}

/* 1 + y / 2 is a sky of three colours, and one of two harmonics. */
static void one_sky_said_in_two_ways_is_one_light(void **state)
{
    const struct sdfgi_sky colours = { { 1.5f, 1.5f, 1.5f }, { 1, 1, 1 }, { 0.5f, 0.5f, 0.5f } },
                           none = { 0 };
    const float mean = 1 / 0.282095f, slope = 0.5f / 0.488603f;
    const struct sdfgi_sky_harmonics same = { .coefficients = { { mean, mean, mean },
                                                                { slope, slope, slope } } };
    struct gi_test *t = *state;
    float with_harmonics[NORMALS][3], with_colours[NORMALS][3], with_both[NORMALS][3];
    start(t, &same);
    look_up(t, inside, with_harmonics);
    REQUIRE_CMP((int)sdfgi_set_sky(t->gi, &colours), ==, (int)SDFGI_OK);
    gi_test_converge(t, 400);
    look_up(t, inside, with_both);
    start(t, &(struct sdfgi_sky_harmonics){ .intensity = 1 });
    REQUIRE_CMP((int)sdfgi_set_sky(t->gi, &colours), ==, (int)SDFGI_OK);
    gi_test_converge(t, 400);
    look_up(t, inside, with_colours);
    REQUIRE_CMP((int)sdfgi_set_sky(t->gi, &none), ==, (int)SDFGI_OK);
    for (int i = 0; i < NORMALS; i++)
        for (int k = 0; k < 3; k++) {
            const double expected = (double)with_colours[i][k];
            REQUIRE_NEAR((double)with_harmonics[i][k], expected, 0.002 * expected);
            REQUIRE_NEAR((double)with_both[i][k], 2 * expected, 0.004 * expected);
        }
}

static uint32_t commands(struct gi_test *t)
{
    static struct sdfgi_report report;
    gi_test_update(t, 1);
    sdfgi_get_report(t->gi, &report);
    return report.command_count;
}

static void the_same_harmonics_again_wake_nothing(void **state)
{
    struct gi_test *t = *state;
    start(t, &light_tinted_sky);
    gi_test_update(t, 3);
    REQUIRE_CMP(commands(t), ==, 0u);
    REQUIRE_CMP((int)sdfgi_set_sky_harmonics(t->gi, &light_tinted_sky), ==, (int)SDFGI_OK);
    REQUIRE_CMP(commands(t), ==, 0u);
    struct sdfgi_sky_harmonics other = light_tinted_sky;
    other.coefficients[8][2] += 1;
    REQUIRE_CMP((int)sdfgi_set_sky_harmonics(t->gi, &other), ==, (int)SDFGI_OK);
    REQUIRE_CMP(commands(t), >, 0u);
}

static void what_is_not_finite_is_refused(void **state)
{
    struct gi_test *t = *state;
    start(t, &light_tinted_sky);
    for (int i = 0; i < 3; i++) {
        struct sdfgi_sky_harmonics bad = light_tinted_sky;
        *(float *[]){ &bad.coefficients[7][1], &bad.intensity, &bad.rotation_rad }[i] = NAN;
        REQUIRE_CMP((int)sdfgi_set_sky_harmonics(t->gi, &bad), ==, (int)SDFGI_ERROR_INVALID_ARGUMENT);
    }
    REQUIRE_CMP(t->messages[SDFGI_MESSAGE_INVALID_ARGUMENT], ==, 3u);
}

/* ---- Cube maps */

/* Direction of a texel, by Vulkan's rule for the choice of a face and of s and t. */
static void texel_direction(int face, int column, int row, double d[static 3])
{
    const double s = 2 * (column + 0.5) / SIDE - 1, t = 2 * (row + 0.5) / SIDE - 1;
    const double length = sqrt(1 + s * s + t * t);
    switch (face) {
    case 0:
        d[0] = 1, d[2] = -s, d[1] = -t;
        break;
    case 1:
        d[0] = -1, d[2] = s, d[1] = -t;
        break;
    case 2:
        d[1] = 1, d[0] = s, d[2] = t;
        break;
    case 3:
        d[1] = -1, d[0] = s, d[2] = -t;
        break;
    case 4:
        d[2] = 1, d[0] = s, d[1] = -t;
        break;
    default:
        d[2] = -1, d[0] = -s, d[1] = -t;
        break;
    }
    for (int k = 0; k < 3; k++)
        d[k] /= length;
}

static void a_cube_map_of_harmonics_gives_them_back(void **state)
{
    (void)state;
    static float texels[6 * SIDE * SIDE][3];
    struct sdfgi_sky_harmonics found;
    for (int i = 0; i < 6 * SIDE * SIDE; i++) {
        double d[3];
        texel_direction(i / SIDE / SIDE, i % SIDE, i / SIDE % SIDE, d);
        for (int k = 0; k < 3; k++)
            texels[i][k] = (float)radiance(&light_tinted_sky, d, k);
    }
    sdfgi_sky_harmonics_from_cube(texels[0], SIDE, &found);
    REQUIRE_NEAR((double)found.intensity, 1, 0);
    for (int i = 0; i < 9; i++)
        for (int k = 0; k < 3; k++)
            REQUIRE_NEAR((double)found.coefficients[i][k], (double)light_tinted_sky.coefficients[i][k],
                         0.005);
}

static int open_context(void **state)
{
    static struct gi_test t;
    *state = &t;
    return 0;
}

static int close_context(void **state)
{
    gi_test_close(*state);
    return 0;
}

TEST_GROUP(sky_harmonics)
{
    if (!gpu_test_available())
        return GPU_TEST_SKIP;
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_air_has_the_light_of_the_sky),
        cmocka_unit_test(a_sky_turns_and_brightens),
        cmocka_unit_test(one_sky_said_in_two_ways_is_one_light),
        cmocka_unit_test(the_same_harmonics_again_wake_nothing),
        cmocka_unit_test(what_is_not_finite_is_refused),
        cmocka_unit_test(a_cube_map_of_harmonics_gives_them_back),
    };
    return cmocka_run_group_tests(tests, open_context, close_context);
}
