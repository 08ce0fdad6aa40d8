/* SPDX-License-Identifier: MIT
 * A closed box whose walls all emit Le and reflect a share rho of what arrives holds the radiance Le / (1 -
 * rho) everywhere: energy in equals energy out through every stage (HARD_CASES rows 33 to 35). A sphere that
 * a lamp in its middle lights has a known radiance as well (row 37). */
#include "hard_case.h"
#include "light_scene.h"
#include "require.h"
#include "test_group.h"

#include "shaders/shared/constants.h"

#include <stdio.h>
#include <stdlib.h>

/* The middle and points near walls, edges and a corner of a room of 3 m; 0.3 m is beyond the wall's own
 * cells. From 1.75 m on light fades to the sky's. */
static const struct gi_test_point points[] = {
    { { 0, 0, 0 }, { 0, 1, 0 } },
    { { 0.3f, -0.15f, 0.45f }, { 0.577f, -0.577f, 0.577f } },
    { { 0.15f, -1.5f, 0.2f }, { 0, 1, 0 } },
    { { 1.5f, 0.1f, -0.5f }, { -1, 0, 0 } },
    { { 0.4f, 1.5f, -0.9f }, { 0, -1, 0 } },
    { { -1.4f, -1.5f, 0.15f }, { 0, 1, 0 } },
    { { -1.2f, -1.2f, -1.5f }, { 0, 0, 1 } },
};
enum { POINT_COUNT = sizeof points / sizeof points[0] };

static void start_furnace(struct gi_test *t, float albedo, float feedback)
{
    struct sdfgi_settings settings = light_settings(32, 0.25f);
    settings.bounce_feedback = feedback;
    gi_test_restart(t, &settings);
    const double center[3] = { 0, 0, 0 }, half[3] = { 1.5, 1.5, 1.5 };
    light_add(t, test_mesh_room(center, half, 1, test_rotation_none), albedo, 1);
}

struct range {
    double low, high;
};

/* Of the radiance at all points, which must be finite. */
static struct range radiance_now(struct gi_test *t)
{
    struct range range = { INFINITY, 0 };
    float found[POINT_COUNT][3];
    gi_test_irradiance(t, points, POINT_COUNT, found);
    for (int i = 0; i < 3 * POINT_COUNT; i++) {
        const double radiance = (double)found[i / 3][i % 3] / PI;
        REQUIRE_TRUE(isfinite(radiance));
        range.low = fmin(range.low, radiance);
        range.high = fmax(range.high, radiance);
    }
    return range;
}

struct furnace {
    double error;   /* the largest, relative, once light has settled */
    double missing; /* share of light after as many sample cycles as bounces that leave a hundredth out */
};

static struct furnace run_furnace(struct gi_test *t, float albedo)
{
    start_furnace(t, albedo, 1);
    const double exact = 1 / (1 - (double)albedo);
    const uint32_t cycles = (uint32_t)ceil(log(0.01) / log((double)albedo));
    gi_test_update(t, cycles * sdfgi_settings_cycle_frames(&t->gi->settings));
    const double missing = 1 - radiance_now(t).low / exact;
    const uint32_t frames = gi_test_converge(t, 200);
    const struct range found = radiance_now(t);
    printf("furnace %.2f: %.4f of its light is missing after %u cycles; %u frames later L %.4f to %.4f, "
           "exact %.4f\n",
           (double)albedo, missing, cycles, frames, found.low, found.high, exact);
    return (struct furnace){ fmax(fabs(found.low / exact - 1), fabs(found.high / exact - 1)), missing };
}

/* Without 1 / pi light would grow without end; with half of it, it would be a third less. */
static void hard_33_35_furnace_of_albedo_half(void **state)
{
    const struct furnace furnace = run_furnace(*state, 0.5f);
    HARD_CASE_AT_MOST(33, "albedo 0.5, off by", furnace.error, 0.025);
    HARD_CASE_AT_MOST(33, "albedo 0.5, light missing after 7 sample cycles", furnace.missing, 0.02);
    HARD_CASE_AT_MOST(35, "radiance in a furnace, off by", furnace.error, 0.025);
}

static void hard_33_furnace_of_albedo_four_fifths(void **state)
{
    const struct furnace furnace = run_furnace(*state, 0.8f);
    HARD_CASE_AT_MOST(33, "albedo 0.8, off by", furnace.error, 0.025);
    HARD_CASE_AT_MOST(33, "albedo 0.8, light missing after 21 sample cycles", furnace.missing, 0.02);
}

static void hard_33_furnace_of_albedo_nineteen_twentieths(void **state)
{
    const struct furnace furnace = run_furnace(*state, 0.95f);
    HARD_CASE_AT_MOST(33, "albedo 0.95, off by", furnace.error, 0.025);
    HARD_CASE_AT_MOST(33, "albedo 0.95, light missing after 90 sample cycles", furnace.missing, 0.02);
}

/* ---- Without an end */

/* Whose product is 2 at most: the rest of the range. */
static const struct {
    float albedo, feedback;
} pairs[] = { { 1, 1.99f }, { 0.99f, 1 }, { 1, 1.2f }, { 1, 0 }, { 0.6f, 1.7f } };
enum { PAIRS = sizeof pairs / sizeof pairs[0], TURN = 60 };

struct endless {
    struct gi_test *t;
    sdfgi_mesh mesh;
    sdfgi_instance room;
    struct sdfgi_settings settings;
    double worst;  /* radiance over its bound */
    uint32_t idle; /* updates that did nothing */
};

/* Half as large as the others, and with as few rays as a cycle may have: a cycle ends in each frame. */
static void endless_start(struct endless *e, struct gi_test *t)
{
    *e = (struct endless){ .t = t, .settings = light_settings(32, 0.25f) };
    e->settings.ray_count = SDFGI_IRRADIANCE_COUNT;
    e->settings.frames_to_converge = 1;
    gi_test_restart(t, &e->settings);
    const double center[3] = { 0, 0, 0 }, half[3] = { 0.75, 0.75, 0.75 };
    struct test_mesh room = test_mesh_room(center, half, 0.3, test_rotation_none);
    e->mesh = gi_test_mesh(t, &room);
    test_mesh_destroy(&room);
}

static void endless_furnish(struct endless *e, float albedo, float feedback)
{
    const float a[3] = { albedo, albedo, albedo };
    const struct sdfgi_instance_desc desc = { .mesh = e->mesh,
                                              .material = gi_test_material(e->t, a, (float[]){ 1, 1, 1 }),
                                              .transform = { .basis = { 1, 0, 0, 0, 1, 0, 0, 0, 1 } } };
    if (e->room.id)
        REQUIRE_CMP((int)sdfgi_instance_destroy(e->t->gi, e->room), ==, (int)SDFGI_OK);
    REQUIRE_CMP((int)sdfgi_instance_create(e->t->gi, &desc, &e->room), ==, (int)SDFGI_OK);
    e->settings.bounce_feedback = feedback;
    REQUIRE_CMP((int)sdfgi_set_settings(e->t->gi, &e->settings), ==, (int)SDFGI_OK);
}

/* Radiance within the room, which must be finite and no less than Le, over Le / (1 - gain). */
static double endless_look(struct endless *e, double gain)
{
    static const struct gi_test_point places[] = { { { 0, 0, 0 }, { 0, 1, 0 } },
                                                   { { 0.1f, -0.75f, 0.1f }, { 0, 1, 0 } },
                                                   { { 0.75f, 0.1f, -0.3f }, { -1, 0, 0 } },
                                                   { { -0.7f, -0.7f, -0.75f }, { 0, 0, 1 } } };
    enum { PLACES = sizeof places / sizeof places[0] };
    float found[PLACES][3];
    double high = 0;
    gi_test_irradiance(e->t, places, PLACES, found);
    for (int i = 0; i < 3 * PLACES; i++) {
        const double radiance = (double)found[i / 3][i % 3] / PI;
        REQUIRE_TRUE(isfinite(radiance));
        REQUIRE_CMP(radiance, >=, 0.999);
        high = fmax(high, radiance);
    }
    return high * (1 - gain);
}

/* Two updates a time, after which light counts as new: it never settles. */
static void endless_turn(struct endless *e, uint32_t updates)
{
    static struct sdfgi_report report;
    for (uint32_t done = 0; done < updates; done += 2) {
        sdfgi_volume_invalidate(&e->t->gi->volume);
        gi_test_update(e->t, 2);
        sdfgi_get_report(e->t->gi, &report);
        e->idle += report.passes[PASS_LIGHT_BOUNCE].ran && report.passes[PASS_PROBE_BLEND].ran ? 0 : 2;
    }
}

/* Those that the library has recorded. */
static uint64_t endless_updates(const struct endless *e)
{
    static struct sdfgi_report report;
    sdfgi_get_report(e->t->gi, &report);
    return report.update_count;
}

/* Gain 1.99: without the clamp light would double every round. The room keeps its light while its walls and
 * the feedback change. */
static void hard_34_light_stays_bounded(void **state)
{
    static struct endless e;
    const bool full = getenv("SDFGI_TEST_FULL") != NULL;
    const uint32_t turns = full ? 100000 / TURN / PAIRS + 1 : 1;
    endless_start(&e, *state);
    for (int i = 0; i < PAIRS; i++) {
        const double gain = fmin((double)pairs[i].albedo * (double)pairs[i].feedback, SDFGI_MAX_BOUNCE_GAIN);
        endless_furnish(&e, pairs[i].albedo, pairs[i].feedback);
        for (uint32_t turn = 0; turn < turns; turn++) {
            endless_turn(&e, TURN);
            e.worst = fmax(e.worst, endless_look(&e, gain));
        }
        printf("albedo %.2f, feedback %.2f: %.4f of its bound at most so far\n", (double)pairs[i].albedo,
               (double)pairs[i].feedback, e.worst);
        if (i == 0)
            REQUIRE_CMP(light_health(e.t, SDFGI_MESSAGE_BOUNCE_CLAMPED), >, 0ul);
    }
    HARD_CASE_AT_MOST(34, "radiance over Le / (1 - gain), gain at most 0.99", e.worst, 1.025);
    HARD_CASE_AT_LEAST(34, "updates in a row", endless_updates(&e), full ? 100000 : TURN * PAIRS);
    HARD_CASE_AT_MOST(34, "updates that did nothing", e.idle, 0);
}

/* An albedo above 1 means nothing. A gain above 1 comes from `bounce_feedback`. */
static void hard_34_an_albedo_above_1_is_refused(void **state)
{
    const struct gi_test *t = *state;
    struct sdfgi_material_desc desc = { .albedo = { 1, 1, 1 }, .alpha = 1 };
    sdfgi_material material;
    REQUIRE_CMP((int)sdfgi_material_create(t->gi, &desc, &material), ==, (int)SDFGI_OK);
    desc.albedo[1] = 1.2f;
    REQUIRE_CMP((int)sdfgi_material_create(t->gi, &desc, &material), ==, (int)SDFGI_ERROR_INVALID_ARGUMENT);
}

static void hard_34_gain_below_the_clamp_is_not_reported(void **state)
{
    start_furnace(*state, 0.9f, 1);
    gi_test_update(*state, 6);
    REQUIRE_CMP(light_health(*state, SDFGI_MESSAGE_BOUNCE_CLAMPED), ==, 0ul);
}

/* Walls of albedo 1/2 get I / r^2 = pi: they have the radiance 1/2 without bounces, and 1 with all of them
 * (pbrt, analytic scenes). */
static double sphere_error(struct gi_test *t, float cell_m, uint32_t resolution)
{
    const struct sdfgi_settings settings = light_settings(resolution, cell_m);
    gi_test_restart(t, &settings);
    light_add(t, test_mesh_sphere((double[]){ 0, 0, 0 }, 1, 4), 0.5f, 0);
    const struct sdfgi_light_desc lamp = light_point(0, 0, 0, (float)PI);
    light_create(t, &lamp);
    gi_test_converge(t, 200);
    const double found = light_white_at(t, (struct gi_test_point){ { 0, 0, 0 }, { 0, 1, 0 } }) / PI;
    printf("lamp in a sphere of %.0f cells: %.4f of exact\n", 2 / (double)cell_m, found);
    return fabs(found - 1);
}

/* Light is computed above the centre of a cell, a little nearer to the lamp than the wall is: half as much
 * too bright in cells of half the size. */
static void hard_37_a_sphere_that_a_lamp_lights(void **state)
{
    HARD_CASE_AT_MOST(37, "sphere of 40 cells, off by", sphere_error(*state, 0.05f, 64), 0.05);
    if (getenv("SDFGI_TEST_FULL"))
        HARD_CASE_AT_MOST(37, "sphere of 80 cells, off by", sphere_error(*state, 0.025f, 128), 0.025);
}

TEST_GROUP(furnace)
{
    if (!gpu_test_available())
        return GPU_TEST_SKIP;
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(hard_33_35_furnace_of_albedo_half),
        cmocka_unit_test(hard_33_furnace_of_albedo_four_fifths),
        cmocka_unit_test(hard_33_furnace_of_albedo_nineteen_twentieths),
        cmocka_unit_test(hard_34_light_stays_bounded),
        cmocka_unit_test(hard_34_an_albedo_above_1_is_refused),
        cmocka_unit_test(hard_34_gain_below_the_clamp_is_not_reported),
        cmocka_unit_test(hard_37_a_sphere_that_a_lamp_lights),
    };
    return cmocka_run_group_tests(tests, light_open, light_close);
}
