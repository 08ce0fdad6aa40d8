/* SPDX-License-Identifier: MIT
 * What settings and units do to light, and nothing else: energy, exposure, feedback, colour. */
#include "hard_case.h"
#include "light_scene.h"
#include "require.h"
#include "test_group.h"

#include <math.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>

static const struct gi_test_point points[] = {
    { { 0.2f, -1.95f, 0.1f }, { 0, 1, 0 } },
    { { -1.6f, 0.3f, 0.4f }, { 1, 0, 0 } },
    { { 0.5f, 0.2f, -0.7f }, { 0, -1, 0 } },
};
enum { POINT_COUNT = sizeof points / sizeof points[0] };

/* A floor and two coloured walls under sun and sky, all lights and the exposure scaled. */
static void light_corner(struct sdfgi_settings settings, float lights, float exposure,
                         float found[static POINT_COUNT][3])
{
    struct gi_test t;
    gi_test_open(&t, &settings);
    t.frame.exposure = exposure;
    light_add_box(&t, (double[]){ -3, -3, -3 }, (double[]){ 3, -2, 3 }, (float[]){ 0.7f, 0.7f, 0.7f }, 0);
    light_add_box(&t, (double[]){ -3, -2, -3 }, (double[]){ -2, 3, 3 }, (float[]){ 0.8f, 0.1f, 0.05f }, 0);
    light_add_box(&t, (double[]){ 2, -2, -3 }, (double[]){ 3, 0, 3 }, (float[]){ 0.2f, 0.6f, 0.3f },
                  0.5f * lights);
    const struct sdfgi_light_desc sun = light_sun(-0.6f, -0.8f, 0, 10 * lights);
    light_create(&t, &sun);
    const struct sdfgi_light_desc lamp = light_point(0.3, 1, 0.5, 5 * lights);
    light_create(&t, &lamp);
    light_set_uniform_sky(&t, 0.3f * lights);
    gi_test_converge(&t, 120);
    gi_test_irradiance(&t, points, POINT_COUNT, found);
    /* With too many surfaces for the list, which of them go unlit would be a matter of order. */
    REQUIRE_CMP(light_health(&t, SDFGI_MESSAGE_LIGHT_CELLS_OVERFLOW), ==, 0ul);
    gi_test_close(&t);
}

static double worst_ratio(float a[static POINT_COUNT][3], float b[static POINT_COUNT][3], double factor)
{
    double worst = 0;
    for (int i = 0; i < POINT_COUNT; i++)
        for (int k = 0; k < 3; k++)
            worst = fmax(worst, fabs((double)a[i][k] / ((double)b[i][k] * factor) - 1));
    return worst;
}

static void energy_scales_lookups_and_nothing_else(void **state)
{
    (void)state;
    struct sdfgi_settings settings = light_settings(32, 0.4f);
    float one[POINT_COUNT][3], three[POINT_COUNT][3];
    light_corner(settings, 1, 1, one);
    settings.energy = 3;
    light_corner(settings, 1, 1, three);
    REQUIRE_CMP(worst_ratio(three, one, 3), <=, 1e-5);
}

/* With exposure the stored values are the same, so the light is (HARD_CASES row 31). */
static void hard_31_lights_of_any_scale_give_the_same_picture(void **state)
{
    (void)state;
    const struct sdfgi_settings settings = light_settings(32, 0.4f);
    float one[POINT_COUNT][3], scaled[POINT_COUNT][3];
    light_corner(settings, 1, 1, one);
    static const int powers[] = { -20, 10, 30 };
    for (int i = 0; i < 3; i++) {
        light_corner(settings, ldexpf(1, powers[i]), ldexpf(1, -powers[i]), scaled);
        const double worst = worst_ratio(scaled, one, ldexp(1, powers[i]));
        printf("lights times 2^%d: off by %.2e at most\n", powers[i], worst);
        HARD_CASE_AT_MOST(31, "light times a power of two, off by", worst, 4e-3);
    }
}

/* Exposure is a hint about range: light does not depend on it. */
static void exposure_does_not_change_light(void **state)
{
    (void)state;
    const struct sdfgi_settings settings = light_settings(32, 0.4f);
    float one[POINT_COUNT][3], other[POINT_COUNT][3];
    light_corner(settings, 1, 1, one);
    static const int powers[] = { -5, 3, 8 };
    for (int i = 0; i < 3; i++) {
        light_corner(settings, 1, ldexpf(1, powers[i]), other);
        const double worst = worst_ratio(other, one, 1);
        printf("exposure 2^%d: off by %.2e at most\n", powers[i], worst);
        REQUIRE_CMP(worst, <=, 5e-3);
    }
}

/* What light is stored in: with SDFGI_SURFACE_LIGHT_CELLS also what light cells gather, a visit a cycle. */
static void open_floor_with(struct gi_test *t, float albedo, enum sdfgi_surface_light surface_light)
{
    struct sdfgi_settings settings = light_settings(32, 0.4f);
    settings.surface_light = surface_light;
    settings.cell_rays = SDFGI_VISIT_RAYS;
    gi_test_open(t, &settings);
    light_add_box(t, (double[]){ -3, -3, -3 }, (double[]){ 3, -2, 3 }, (float[]){ albedo, albedo, albedo },
                  0);
}

/* Exposure may change in every frame, and settings may be given again with other bytes between their fields:
 * light stays what it is, to the bit, and nothing begins anew. */
static void change_exposures_and_settings(enum sdfgi_surface_light surface_light)
{
    struct gi_test t;
    open_floor_with(&t, 0.7f, surface_light);
    light_set_uniform_sky(&t, 0.3f);
    gi_test_converge(&t, 200);
    float before[POINT_COUNT][3], found[POINT_COUNT][3];
    gi_test_irradiance(&t, points, POINT_COUNT, before);
    static const float exposures[] = { 1, 16, 1 / 16.0f, 1.1f, 200, 0.005f };
    for (size_t i = 0; i < sizeof exposures / sizeof *exposures; i++) {
        t.frame.exposure = exposures[i];
        struct sdfgi_settings again = t.gi->settings;
        ((unsigned char *)&again)[offsetof(struct sdfgi_settings, bounce_feedback) - 1] ^= 0xff;
        REQUIRE_CMP(sdfgi_set_settings(t.gi, &again), ==, SDFGI_OK);
        gi_test_update(&t, 1);
        gi_test_irradiance(&t, points, POINT_COUNT, found);
        REQUIRE_CMP(worst_ratio(found, before, 1), ==, 0.0);
        gi_test_converge(&t, 2); /* it still is */
    }
    gi_test_close(&t);
}

static void exposures_and_settings_in_every_frame_cost_nothing(void **state)
{
    (void)state;
    change_exposures_and_settings(SDFGI_SURFACE_LIGHT_PROBES);
    change_exposures_and_settings(SDFGI_SURFACE_LIGHT_CELLS);
}

/* Fades to black and back, and cuts between caves and deserts: in the very frame the light is what it was.
 * The first change darkens light that has settled: nothing but the rescaling runs. */
static void change_exposures_far(enum sdfgi_surface_light surface_light)
{
    static struct sdfgi_report report;
    struct gi_test t;
    open_floor_with(&t, 0.7f, surface_light);
    light_add_box(&t, (double[]){ 2, -2, -3 }, (double[]){ 3, 0, 3 }, (float[]){ 0.2f, 0.6f, 0.3f }, 0.1f);
    light_set_uniform_sky(&t, 0.3f);
    gi_test_converge(&t, 200);
    float before[POINT_COUNT][3], found[POINT_COUNT][3];
    gi_test_irradiance(&t, points, POINT_COUNT, before);
    static const int powers[] = { -12, 10, -12, 20, -20, 30, 0, 12, 126, -126, 0 };
    uint32_t rescaled = 0;
    for (size_t i = 0; i < sizeof powers / sizeof *powers; i++) {
        t.frame.exposure = ldexpf(1, powers[i]);
        gi_test_update(&t, 1);
        gi_test_irradiance(&t, points, POINT_COUNT, found);
        const double worst = worst_ratio(found, before, 1);
        sdfgi_get_report(t.gi, &report);
        rescaled += report.passes[PASS_LIGHT_RESCALE].dispatches;
        printf("light in %s, exposure 2^%d: off by %.2e at most\n",
               surface_light == SDFGI_SURFACE_LIGHT_CELLS ? "cells" : "probes", powers[i], worst);
        REQUIRE_CMP(worst, <=, 0.01);
    }
    REQUIRE_CMP(rescaled, >=, 4u);
    gi_test_close(&t);
}

static void exposures_of_any_sequence_show_the_same_light(void **state)
{
    (void)state;
    change_exposures_far(SDFGI_SURFACE_LIGHT_PROBES);
}

static void exposures_of_any_sequence_show_the_same_light_by_light_cells(void **state)
{
    (void)state;
    change_exposures_far(SDFGI_SURFACE_LIGHT_CELLS);
}

static void open_floor(struct gi_test *t, float albedo)
{
    open_floor_with(t, albedo, SDFGI_SURFACE_LIGHT_PROBES);
}

/* The scene itself tells that light has to be stored smaller. */
static void blinding_skies_need_no_exposure(void **state)
{
    (void)state;
    struct gi_test t;
    open_floor(&t, 1);
    for (int i = 0; i < 3; i++) {
        const float sky = (float[]){ 1, 1e6f, 1 }[i];
        float found[1][3];
        light_set_uniform_sky(&t, sky);
        gi_test_converge(&t, 400);
        gi_test_irradiance(&t, &(struct gi_test_point){ { 0, -2, 0 }, { 0, 1, 0 } }, 1, found);
        printf("under a sky of %g: %.5f of it\n", (double)sky, (double)(found[0][0] / sky) / 3.14159265);
        REQUIRE_NEAR(found[0][0] / sky / 3.14159265f, 1, 0.01);
        REQUIRE_CMP(light_health(&t, SDFGI_MESSAGE_VALUE_CLAMPED), ==, 0ul);
    }
    gi_test_close(&t);
}

/* A lamp that is so bright at every surface that no exposure stores its light. */
static void light_that_is_cut_is_reported(void **state)
{
    (void)state;
    for (int cells = 0; cells < 2; cells++) {
        struct gi_test t;
        open_floor_with(&t, 0.7f, cells ? SDFGI_SURFACE_LIGHT_CELLS : SDFGI_SURFACE_LIGHT_PROBES);
        const struct sdfgi_light_desc lamp = light_point(0.3, 1, 0.5, 1e20f);
        const sdfgi_light light = light_create(&t, &lamp);
        uint64_t cut = 0; /* direct light is computed once, and counts in one cycle */
        for (int frame = 0; frame < 12; frame++) {
            gi_test_update(&t, 1);
            const uint64_t now = light_health(&t, SDFGI_MESSAGE_VALUE_CLAMPED);
            cut = now > cut ? now : cut;
        }
        printf("under a lamp of 1e20 W/sr light was cut %llu times\n", (unsigned long long)cut);
        REQUIRE_CMP(cut, >, 0ul);
        REQUIRE_CMP((int)sdfgi_light_destroy(t.gi, light), ==, (int)SDFGI_OK);
        gi_test_update(&t, 24);
        REQUIRE_CMP(light_health(&t, SDFGI_MESSAGE_VALUE_CLAMPED), ==, 0ul);
        gi_test_close(&t);
    }
}

/* No exposure makes light infinite or not a number, however little it fits the light. */
static void extreme_exposures_leave_light_finite(void **state)
{
    (void)state;
    struct gi_test t;
    open_floor(&t, 0.7f);
    light_add_box(&t, (double[]){ 2, -2, -3 }, (double[]){ 3, 0, 3 }, (float[]){ 0.2f, 0.6f, 0.3f }, 50);
    light_set_uniform_sky(&t, 100);
    const struct sdfgi_light_desc lamp = light_point(0.3, 1, 0.5, 5e4f), star = light_point(9, 9, 9, 3e38f);
    light_create(&t, &lamp);
    light_create(&t, &star); /* from near by it is brighter than floats can tell */
    static const float exposures[] = { 1e38f, 1e-38f, 1e38f };
    for (int i = 0; i < 3; i++) {
        float found[POINT_COUNT][3];
        t.frame.exposure = exposures[i];
        for (int frame = 0; frame < 12; frame++) {
            gi_test_update(&t, 1);
            gi_test_irradiance(&t, points, POINT_COUNT, found);
            for (int k = 0; k < 3 * POINT_COUNT; k++)
                REQUIRE_TRUE(isfinite(found[k / 3][k % 3]) && found[k / 3][k % 3] >= 0);
        }
    }
    gi_test_close(&t);
}

static void a_red_wall_reddens_what_faces_it(void **state)
{
    (void)state;
    float found[POINT_COUNT][3];
    const struct sdfgi_settings settings = light_settings(32, 0.4f);
    light_corner(settings, 1, 1, found);
    struct gi_test t;
    gi_test_open(&t, &settings);
    light_add_box(&t, (double[]){ -3, -3, -3 }, (double[]){ 3, -2, 3 }, (float[]){ 0.7f, 0.7f, 0.7f }, 0);
    light_add_box(&t, (double[]){ -3, -2, -3 }, (double[]){ -2, 3, 3 }, (float[]){ 0.8f, 0.1f, 0.05f }, 0);
    const struct sdfgi_light_desc sun = light_sun(-0.8f, -0.6f, 0, 10);
    light_create(&t, &sun);
    gi_test_converge(&t, 80);
    float near[3], far[3];
    light_at(&t, (struct gi_test_point){ { -1.2f, 0, 0 }, { -1, 0, 0 } }, near);
    light_at(&t, (struct gi_test_point){ { 1.5f, 0, 0 }, { 0, -1, 0 } }, far);
    printf("before the red wall (%.3f %.3f %.3f), over the white floor (%.3f %.3f %.3f)\n", (double)near[0],
           (double)near[1], (double)near[2], (double)far[0], (double)far[1], (double)far[2]);
    /* The wall reflects eight times as much red as green; the floor in view below it dilutes that. */
    REQUIRE_CMP(near[0], >, 2 * near[1]);
    REQUIRE_CMP(near[1], >, near[2]);
    REQUIRE_CMP(far[0], >, far[1]);
    REQUIRE_CMP(far[0] / far[1], <, near[0] / near[1]);
    gi_test_close(&t);
}

/* Without feedback a second surface throws back direct light alone; with it, strictly more. */
static void feedback_adds_bounces(void **state)
{
    (void)state;
    struct sdfgi_settings settings = light_settings(32, 0.4f);
    float with[POINT_COUNT][3], without[POINT_COUNT][3];
    light_corner(settings, 1, 1, with);
    settings.bounce_feedback = 0;
    light_corner(settings, 1, 1, without);
    for (int i = 0; i < POINT_COUNT; i++)
        for (int k = 0; k < 3; k++)
            REQUIRE_CMP(with[i][k], >, without[i][k]);
}

TEST_GROUP(scaling)
{
    if (!gpu_test_available())
        return GPU_TEST_SKIP;
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(energy_scales_lookups_and_nothing_else),
        cmocka_unit_test(hard_31_lights_of_any_scale_give_the_same_picture),
        cmocka_unit_test(exposure_does_not_change_light),
        cmocka_unit_test(exposures_and_settings_in_every_frame_cost_nothing),
        cmocka_unit_test(exposures_of_any_sequence_show_the_same_light),
        cmocka_unit_test(exposures_of_any_sequence_show_the_same_light_by_light_cells),
        cmocka_unit_test(light_that_is_cut_is_reported),
        cmocka_unit_test(blinding_skies_need_no_exposure),
        cmocka_unit_test(extreme_exposures_leave_light_finite),
        cmocka_unit_test(a_red_wall_reddens_what_faces_it),
        cmocka_unit_test(feedback_adds_bounces),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
