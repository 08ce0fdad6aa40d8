/* SPDX-License-Identifier: MIT
 * A closed box whose walls all emit Le and reflect a share rho of what arrives holds the radiance Le / (1 -
 * rho) everywhere: energy in equals energy out through every stage (HARD_CASES rows 33 and 34). */
#include "light_scene.h"
#include "require.h"

#include "shaders/shared/constants.h"

#include <stdio.h>

/* The middle and points near walls, edges and a corner of a room of 8 m; 0.3 m is beyond the wall's own
 * cells. */
static const struct gi_test_point points[] = {
    { { 0, 0, 0 }, { 0, 1, 0 } },          { { 0.7f, -0.4f, 1.1f }, { 0.577f, -0.577f, 0.577f } },
    { { 0.3f, -4, 0.6f }, { 0, 1, 0 } },   { { 4, 0.2f, -1.3f }, { -1, 0, 0 } },
    { { 1.1f, 4, -2.3f }, { 0, -1, 0 } },  { { -3.9f, -4, 0.4f }, { 0, 1, 0 } },
    { { -3.7f, -3.7f, -4 }, { 0, 0, 1 } },
};
enum { POINT_COUNT = sizeof points / sizeof points[0] };

static void open_furnace(struct gi_test *t, float albedo, float feedback)
{
    struct sdfgi_settings settings = light_settings(64, 0.25f);
    settings.bounce_feedback = feedback;
    gi_test_open(t, &settings);
    const double center[3] = { 0, 0, 0 }, half[3] = { 4, 4, 4 };
    light_add(t, test_mesh_room(center, half, 1, test_rotation_none), albedo, 1);
}

static void check_furnace(float albedo)
{
    struct gi_test t;
    open_furnace(&t, albedo, 1);
    const uint32_t frames = gi_test_converge(&t, 200);
    float found[POINT_COUNT][3];
    gi_test_irradiance(&t, points, POINT_COUNT, found);
    const double expected = 1 / (1 - (double)albedo);
    for (int i = 0; i < POINT_COUNT; i++)
        printf("furnace %.2f, point %d: L %.4f, exact %.4f, ratio %.4f (%u frames)\n", (double)albedo, i,
               (double)found[i][0] / PI, expected, (double)found[i][0] / PI / expected, frames);
    for (int i = 0; i < POINT_COUNT; i++)
        for (int k = 0; k < 3; k++)
            REQUIRE_NEAR((double)found[i][k] / PI / expected, 1, 0.025);
    gi_test_close(&t);
}

static void hard_33_furnace_of_albedo_half(void **state)
{
    (void)state;
    check_furnace(0.5f);
}

static void hard_33_furnace_of_albedo_four_fifths(void **state)
{
    (void)state;
    check_furnace(0.8f);
}

/* Gain 1.99: without the clamp light would double every round. */
static void hard_34_gain_above_one_stays_bounded(void **state)
{
    (void)state;
    struct gi_test t;
    open_furnace(&t, 1, 1.99f);
    gi_test_update(&t, 60);
    float found[POINT_COUNT][3];
    gi_test_irradiance(&t, points, POINT_COUNT, found);
    for (int i = 0; i < POINT_COUNT; i++)
        for (int k = 0; k < 3; k++) {
            REQUIRE_TRUE(isfinite(found[i][k]));
            REQUIRE_CMP((double)found[i][k], <=, PI / (1 - SDFGI_MAX_BOUNCE_GAIN) * 1.025);
            REQUIRE_CMP((double)found[i][k], >=, PI);
        }
    REQUIRE_CMP(light_health(&t, SDFGI_MESSAGE_BOUNCE_CLAMPED), >, 0ul);
    gi_test_close(&t);
}

static void hard_34_gain_below_the_clamp_is_not_reported(void **state)
{
    (void)state;
    struct gi_test t;
    open_furnace(&t, 0.9f, 1);
    gi_test_update(&t, 6);
    REQUIRE_CMP(light_health(&t, SDFGI_MESSAGE_BOUNCE_CLAMPED), ==, 0ul);
    gi_test_close(&t);
}

int main(void)
{
    if (!gpu_test_available())
        return GPU_TEST_SKIP;
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(hard_33_furnace_of_albedo_half),
        cmocka_unit_test(hard_33_furnace_of_albedo_four_fifths),
        cmocka_unit_test(hard_34_gain_above_one_stays_bounded),
        cmocka_unit_test(hard_34_gain_below_the_clamp_is_not_reported),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
