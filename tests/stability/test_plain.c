/* SPDX-License-Identifier: MIT
 * A sunlit plain under four cascades, seen from above: what looks down on it gets the same light everywhere,
 * whichever cascade answers. */
#include "light_scene.h"
#include "require.h"
#include "test_group.h"

#include <math.h>
#include <stdio.h>

/* 32 cells of 0.25 m to 2 m: the last cascade reaches 32 m and fades to the sky from 14 m on. */
static const double FADE_M = 14, EDGE_M = 32, LAST_CELL_M = 2;
static const double SUN = 4, SKY = 0.05, ALBEDO = 0.5, PLAIN_Y = -2;
enum { PLACES = 30, SIDES = 4 };

static int open_plain(void **state)
{
    static struct gi_test t;
    struct sdfgi_settings settings = light_settings(32, 0.25f);
    settings.cascades = 4;
    gi_test_open(&t, &settings);
    const float grey[3] = { (float)ALBEDO, (float)ALBEDO, (float)ALBEDO };
    light_add_box(&t, (double[]){ -600, PLAIN_Y - 1, -600 }, (double[]){ 600, PLAIN_Y, 600 }, grey, 0);
    const struct sdfgi_light_desc sun = light_sun(0, -1, 0, (float)SUN);
    const float s = (float)SKY;
    const struct sdfgi_sky sky = { { s, s, s }, { s, s, s }, { 0, 0, 0 } };
    light_create(&t, &sun);
    REQUIRE_CMP(sdfgi_set_sky(t.gi, &sky), ==, SDFGI_OK);
    gi_test_converge(&t, 400);
    *state = &t;
    return 0;
}

static int close_plain(void **state)
{
    gi_test_close(*state);
    return 0;
}

/* What faces down at 0.3 m, 1.3 m and so on towards a side, over what an endless plain would give it. */
static void look_down(struct gi_test *t, int side, double height, double light[static PLACES])
{
    struct gi_test_point points[PLACES];
    float found[PLACES][3];
    for (int i = 0; i < PLACES; i++) {
        const float along = (side % 2 ? -1.0f : 1.0f) * ((float)i + 0.3f);
        points[i] = (struct gi_test_point){
            { side < 2 ? along : 0.5f, (float)(PLAIN_Y + height), side < 2 ? 0.5f : along }, { 0, -1, 0 }
        };
    }
    gi_test_irradiance(t, points, PLACES, found);
    for (int i = 0; i < PLACES; i++)
        light[i] = (double)found[i][1] / (ALBEDO * (SUN + PI * SKY));
}

/* Cascades end at 4, 8 and 16 m, some of their probes stand behind the plain, and at 0.2 m a point is nearer
 * to it than a fifth of a cell. */
static void light_is_even_wherever_cascades_answer(void **state)
{
    static const double heights[] = { 0.2, 0.3, 0.6, 1, 1.5, 2.3, 4, 6 };
    for (int side = 0; side < SIDES; side++)
        for (size_t h = 0; h < sizeof heights / sizeof *heights; h++) {
            double light[PLACES], low = INFINITY, high = 0;
            look_down(*state, side, heights[h], light);
            for (int i = 0; i + 0.3 < FADE_M; i++) {
                low = fmin(low, light[i]);
                high = fmax(high, light[i]);
            }
            printf("side %d, %.1f m above the plain: %.3f to %.3f of its light\n", side, heights[h], low,
                   high);
            REQUIRE_CMP(low, >=, 0.97);
            REQUIRE_CMP(high, <=, 1.01);
        }
}

/* Where the last cascade fades, its light and that of the sky add up to as much on opposite sides, and its
 * outermost probes see the plain on their inner side, not the sky alone. */
static void the_last_cascade_fades_alike_on_all_sides(void **state)
{
    static const double heights[] = { 2.3, 4, 8 };
    for (size_t h = 0; h < sizeof heights / sizeof *heights; h++) {
        double light[SIDES][PLACES];
        for (int side = 0; side < SIDES; side++)
            look_down(*state, side, heights[h], light[side]);
        for (int i = (int)FADE_M; i < PLACES; i++) {
            const double cells = (EDGE_M - i - 0.3) / LAST_CELL_M, weight = fmin((cells - 1) / 8, 1);
            for (int side = 0; side < SIDES; side++) {
                REQUIRE_NEAR(light[side][i], light[0][i], 0.02);
                REQUIRE_CMP(light[side][i], >=, 0.7 * weight);
            }
        }
    }
}

TEST_GROUP(plain)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(light_is_even_wherever_cascades_answer),
        cmocka_unit_test(the_last_cascade_fades_alike_on_all_sides),
    };
    return cmocka_run_group_tests_name("plain", tests, open_plain, close_plain);
}
