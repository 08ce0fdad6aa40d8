/* SPDX-License-Identifier: MIT
 * A hollow ball on a floor under an even sky. Where the two meet, all cells around are occupied, and those of
 * the ball's inside are dark: the floor must not show them. */
#include "light_scene.h"
#include "require.h"

#include <math.h>
#include <stdio.h>

static const double RADIUS = 0.95;
enum { SIDES = 8, PLACES = 20 };

static int open_ball(void **state)
{
    static struct gi_test t;
    struct sdfgi_settings settings = light_settings(32, 0.2f);
    settings.cascades = 2;
    gi_test_open(&t, &settings);
    light_add_box(&t, (double[]){ -20, -1, -20 }, (double[]){ 20, 0, 20 }, (float[]){ 0.5f, 0.5f, 0.5f }, 0);
    light_add(&t, test_mesh_sphere((double[]){ 0, RADIUS, 0 }, RADIUS, 4), 0.8f, 0);
    const struct sdfgi_sky sky = { { 1, 1, 1 }, { 1, 1, 1 }, { 0, 0, 0 } };
    REQUIRE_CMP(sdfgi_set_sky(t.gi, &sky), ==, SDFGI_OK);
    gi_test_converge(&t, 400);
    *state = &t;
    return 0;
}

static int close_ball(void **state)
{
    gi_test_close(*state);
    return 0;
}

/* The darkest of points on the floor from 0.3 m to 1.25 m from where the ball stands, towards a viewer on a
 * side, over what an open floor gets; and how many are black. Nearer, at 0.1 m below the ball and less, the
 * floor does show the dark inside. */
static double darkest_towards(struct gi_test *t, int side, uint32_t *black)
{
    const double turn = 2 * PI * side / SIDES + 0.1;
    const float viewer[3] = { (float)(5 * cos(turn)), 2, (float)(5 * sin(turn)) };
    struct gi_test_point points[PLACES];
    float found[PLACES][3];
    double darkest = INFINITY;
    for (int i = 0; i < PLACES; i++) {
        const double away = 0.3 + 0.05 * i;
        points[i] = (struct gi_test_point){ { (float)(away * cos(turn)), 0, (float)(away * sin(turn)) },
                                            { 0, 1, 0 } };
    }
    gi_test_irradiance_from(t, viewer, points, PLACES, found);
    for (int i = 0; i < PLACES; i++) {
        darkest = fmin(darkest, (double)found[i][1] / PI);
        *black += found[i][1] < 0.02f;
    }
    return darkest;
}

static void the_floor_below_a_ball_is_not_black(void **state)
{
    uint32_t black = 0;
    double darkest = INFINITY;
    for (int side = 0; side < SIDES; side++)
        darkest = fmin(darkest, darkest_towards(*state, side, &black));
    printf("darkest %.3f of an open floor, %u of %d points black\n", darkest, black, SIDES * PLACES);
    REQUIRE_CMP(black, ==, 0u);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_floor_below_a_ball_is_not_black),
    };
    return cmocka_run_group_tests_name("contact", tests, open_ball, close_ball);
}
