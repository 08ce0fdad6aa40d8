/* SPDX-License-Identifier: MIT
 * Emitters as lights: lamps over a floor whose light is known, whatever their size and number. */
#include "hard_case.h"
#include "light_scene.h"
#include "require.h"
#include "test_group.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Lamps hang at this height and shine downwards. */
#define HEIGHT 2.02
#define CELL_M 0.2

static struct sdfgi_settings emitter_settings(void)
{
    struct sdfgi_settings s = light_settings(32, (float)CELL_M);
    s.surface_light = SDFGI_SURFACE_LIGHT_CELLS;
    s.cell_rays = getenv("SDFGI_TEST_FULL") ? 256 : 128;
    s.cell_rays_per_frame = 1 << 18;
    s.bounce_feedback = 0;
    return s;
}

static void add_lamp(struct gi_test *t, const double center[static 3], double side, double watts_per_sr)
{
    const double u[3] = { side / 2, 0, 0 }, v[3] = { 0, 0, side / 2 };
    light_add(t, test_mesh_plane(center, u, v, 1), 0, (float)(watts_per_sr / (side * side)));
}

/* A floor whose top is at -0.05. */
static void add_floor(struct gi_test *t, double half)
{
    light_add_box(t, (double[]){ -half, -0.6, -half }, (double[]){ half, -0.05, half },
                  (float[]){ 0.5f, 0.5f, 0.5f }, 0);
}

/* Irradiance on the floor of a square lamp over the origin: a sum over its parts. */
static double lamp_irradiance(double side, double watts_per_sr, const float at[static 3])
{
    enum { PARTS = 16 };
    double sum = 0;
    for (int i = 0; i < PARTS * PARTS; i++) {
        const double x = side * ((i % PARTS + 0.5) / PARTS - 0.5) - (double)at[0],
                     z = side * (((double)(i / PARTS) + 0.5) / PARTS - 0.5) - (double)at[2],
                     h = HEIGHT - (double)at[1], square = x * x + z * z + h * h;
        sum += h * h / (square * square);
    }
    return watts_per_sr * sum / (PARTS * PARTS);
}

/* The same of a ball at half the height, of a radius. */
static double ball_irradiance(double radius, double watts_per_sr, const float at[static 3])
{
    (void)radius;
    const double x = (double)at[0], z = (double)at[2], h = HEIGHT / 2 - (double)at[1],
                 square = x * x + z * z + h * h;
    return watts_per_sr * h / (square * sqrt(square));
}

typedef double irradiance_fn(double size, double watts_per_sr, const float at[static 3]);

/* The same as cells show it: interpolated between four, of which each is the mean of 3 x 3. Right under the
 * lamp that is 3.5 % less. */
static double shown_irradiance(irradiance_fn *irradiance, double size, double watts_per_sr,
                               const float at[static 3])
{
    const double x = floor((double)at[0] / CELL_M - 0.5), z = floor((double)at[2] / CELL_M - 0.5);
    double sum = 0;
    for (int i = 0; i < 4 * 9; i++) {
        const int cell = i / 9, part = i % 9;
        const double right = x + cell % 2, back = z + cell / 2;
        const float place[3] = { (float)((right + part % 3 - 0.5) * CELL_M), at[1],
                                 (float)((back + part / 3 - 0.5) * CELL_M) };
        const double weight = (1 - fabs((double)at[0] / CELL_M - 0.5 - right)) *
                              (1 - fabs((double)at[2] / CELL_M - 0.5 - back));
        sum += weight / 9 * irradiance(size, watts_per_sr, place);
    }
    return sum;
}

enum { POINTS = 5 };
static const struct gi_test_point floor_points[POINTS] = {
    { { 0, -0.05f, 0 }, { 0, 1, 0 } },        { { 0.5f, -0.05f, 0.3f }, { 0, 1, 0 } },
    { { -1.1f, -0.05f, 0.7f }, { 0, 1, 0 } }, { { 1.1f, -0.05f, -1.2f }, { 0, 1, 0 } },
    { { -1.3f, -0.05f, 0.1f }, { 0, 1, 0 } },
};

/* How far light on the floor of such a lamp is off at most. */
static double lamp_error(struct gi_test *t, double side, double watts_per_sr)
{
    float found[POINTS][3];
    double worst = 0;
    gi_test_irradiance(t, floor_points, POINTS, found);
    for (int k = 0; k < POINTS; k++) {
        const double expected =
                         shown_irradiance(lamp_irradiance, side, watts_per_sr, floor_points[k].position),
                     ratio = (double)found[k][1] / expected;
        printf("lamp of %.3f m, point %d: %.3f W/m^2, ratio %.3f\n", side, k, expected, ratio);
        worst = fmax(worst, fabs(ratio - 1));
    }
    return worst;
}

/* The smallest has a hundredth of a cell. Light is nearly right after 15 frames, in which new cells send more
 * rays than later; the filter still spreads it. */
static void hard_49_lamps_of_all_sizes_give_the_light_of_their_power(void **state)
{
    (void)state;
    static const double sides[] = { 0.002, 0.2, 0.8, 0.05 };
    const size_t count = getenv("SDFGI_TEST_FULL") ? 4 : 3;
    static struct gi_test t;
    const struct sdfgi_settings settings = emitter_settings();
    gi_test_open(&t, &settings);
    for (size_t i = 0; i < count; i++) {
        gi_test_restart(&t, &settings);
        add_floor(&t, 1.8); /* all that the points read */
        add_lamp(&t, (double[]){ 0, HEIGHT, 0 }, sides[i], 20);
        gi_test_update(&t, 15);
        REQUIRE_CMP(lamp_error(&t, sides[i], 20), <=, 0.06);
        gi_test_converge(&t, 400);
        HARD_CASE_AT_MOST(49, "light of lamps of 1/100 cell to 4 cells, off by", lamp_error(&t, sides[i], 20),
                          0.02);
    }
    gi_test_close(&t);
}

/* Below the ball, beside it, and along diagonals. There boxes of its power would show up to 1.7 times the
 * area that they show along axes. */
static void a_ball_shines_alike_in_all_directions(void **state)
{
    (void)state;
    static const double radii[] = { 0.3, 0.08 };
    static const struct gi_test_point at[POINTS] = {
        { { 0, -0.05f, 0 }, { 0, 1, 0 } },       { { 1.05f, -0.05f, 0 }, { 0, 1, 0 } },
        { { 0.8f, -0.05f, 0.8f }, { 0, 1, 0 } }, { { -1.3f, -0.05f, 1.3f }, { 0, 1, 0 } },
        { { 0, -0.05f, -1.5f }, { 0, 1, 0 } },
    };
    static struct gi_test t;
    const struct sdfgi_settings settings = emitter_settings();
    gi_test_open(&t, &settings);
    for (int i = 0; i < (getenv("SDFGI_TEST_FULL") ? 2 : 1); i++) {
        float found[POINTS][3];
        const double r = radii[i], watts_per_sr = 10;
        gi_test_restart(&t, &settings);
        add_floor(&t, 1.8);
        light_add_ball(&t, (double[]){ 0, HEIGHT / 2, 0 }, r, watts_per_sr);
        gi_test_converge(&t, 400);
        gi_test_irradiance(&t, at, POINTS, found);
        for (int k = 0; k < POINTS; k++) {
            const double expected = shown_irradiance(ball_irradiance, r, watts_per_sr, at[k].position),
                         ratio = (double)found[k][1] / expected;
            printf("ball of %.2f m, point %d: %.3f W/m^2, ratio %.3f\n", r, k, expected, ratio);
            REQUIRE_NEAR(ratio, 1, 0.11);
        }
    }
    gi_test_close(&t);
}

/* ---- A lamp that slides */

enum { SLIDE_POINTS = 9 };

/* Light on the floor over that of a lamp at this place, in the mean of nine points. */
static double slide_flux(struct gi_test *t, double side, const double offset[static 3])
{
    struct gi_test_point at[SLIDE_POINTS];
    float found[SLIDE_POINTS][3];
    double sum = 0, expected = 0;
    for (int i = 0; i < SLIDE_POINTS; i++)
        at[i] = (struct gi_test_point){ { 0.5f * (float)(i % 3 - 1), -0.05f, 0.5f * (float)(i / 3 - 1) },
                                        { 0, 1, 0 } };
    gi_test_irradiance(t, at, SLIDE_POINTS, found);
    for (int i = 0; i < SLIDE_POINTS; i++) {
        float beside[3];
        for (int k = 0; k < 3; k++)
            beside[k] = at[i].position[k] - (float)offset[k];
        sum += (double)found[i][1];
        expected += lamp_irradiance(side, 20, beside);
    }
    return sum / expected;
}

/* What slides: a lamp, or a wall without a light of its own that a sun from below makes as bright. */
struct slider {
    double side;
    bool is_wall;
};

/* A small floor, so that light settles in few frames. Rays find a wall at random: it takes more of them. */
static sdfgi_instance start_slide(struct gi_test *t, const struct slider *slider)
{
    struct sdfgi_settings settings = emitter_settings();
    const double side = slider->side, radiance = 20 / (side * side), albedo = slider->is_wall ? 0.5 : 0;
    settings.cell_rays = slider->is_wall ? 256 : 32;
    gi_test_restart(t, &settings);
    add_floor(t, 1);
    if (slider->is_wall) {
        struct sdfgi_light_desc sun = light_sun(0, 1, 0, (float)(PI * radiance / albedo));
        sun.casts_shadow = false;
        light_create(t, &sun);
    }
    const double u[3] = { side / 2, 0, 0 }, v[3] = { 0, 0, side / 2 };
    return light_add(t, test_mesh_plane((double[]){ 0, HEIGHT, 0 }, u, v, 1), (float)albedo,
                     slider->is_wall ? 0 : (float)radiance);
}

struct slide {
    double off, pop; /* the largest error, and the largest change of a step */
};

/* By a sixteenth of a cell a step. Over two cells, the size of an albedo block, all repeats. */
static struct slide slide_along(struct gi_test *t, const struct slider *slider,
                                const double direction[static 3], int steps)
{
    struct slide slide = { 0, 0 };
    double before = 0;
    const sdfgi_instance instance = start_slide(t, slider);
    for (int i = 0; i <= steps; i++) {
        double offset[3];
        struct sdfgi_transform transform = { .basis = { 1, 0, 0, 0, 1, 0, 0, 0, 1 } };
        for (int k = 0; k < 3; k++)
            transform.translation[k] = offset[k] = direction[k] * CELL_M / 16 * i;
        REQUIRE_CMP((int)sdfgi_instance_set_transform(t->gi, instance, &transform), ==, (int)SDFGI_OK);
        gi_test_converge(t, 400);
        const double flux = slide_flux(t, slider->side, offset);
        slide.off = fmax(slide.off, fabs(flux - 1));
        slide.pop = i > 0 ? fmax(slide.pop, fabs(flux / before - 1)) : 0;
        before = flux;
    }
    printf("%s of %.1f m slides along (%g %g %g): off by %.4f at most, %.4f a step\n",
           slider->is_wall ? "wall" : "lamp", slider->side, direction[0], direction[1], direction[2],
           slide.off, slide.pop);
    return slide;
}

/* Light on the floor is computed above the centres of cells, and a lamp's place is known as well as the box
 * around its sub-voxels. */
static void hard_50_a_lamp_that_slides_keeps_its_light(void **state)
{
    (void)state;
    static const double directions[][3] = { { 1, 0, 0 }, { 0.7, -0.4, 0.6 }, { 0, 1, 0 } };
    const bool full = getenv("SDFGI_TEST_FULL") != NULL;
    static struct gi_test t;
    const struct sdfgi_settings settings = emitter_settings();
    gi_test_open(&t, &settings);
    for (int i = 0; i < (full ? 6 : 2); i++) {
        const struct slider lamp = { .side = (1 + i % 2) * CELL_M };
        const struct slide slide = slide_along(&t, &lamp, directions[i / 2], full ? 32 : 5);
        HARD_CASE_AT_MOST(50, "light of a lamp that slides, off by", slide.off, 0.1);
        HARD_CASE_AT_MOST(50, "light of a lamp that slides, change for a step of 1/16 cell", slide.pop, 0.05);
    }
    gi_test_close(&t);
}

/* In suite `full` alone. Where both edges along an axis pass centres of sub-voxels, 33 of them are set across
 * the wall instead of 32: 1/32 more light. Aslant that comes about along three axes, now and then at once. */
static void hard_50_a_wall_that_slides_keeps_its_light(void **state)
{
    (void)state;
    static const double along[3] = { 1, 0, 0 }, aslant[3] = { 0.7, -0.4, 0.6 };
    static struct gi_test t;
    if (!getenv("SDFGI_TEST_FULL"))
        skip();
    const struct slider wall = { .side = 8 * CELL_M, .is_wall = true };
    const struct sdfgi_settings settings = emitter_settings();
    gi_test_open(&t, &settings);
    const struct slide straight = slide_along(&t, &wall, along, 8),
                       oblique = slide_along(&t, &wall, aslant, 16);
    HARD_CASE_AT_MOST(50, "light of a wall that slides, off by", fmax(straight.off, oblique.off), 0.1);
    HARD_CASE_AT_MOST(50, "light of a wall that slides along an axis, change for a step of 1/16 cell",
                      straight.pop, 0.05);
    HARD_CASE_AT_MOST(50, "light of a wall that slides aslant, change for a step of 1/16 cell", oblique.pop,
                      0.07);
    gi_test_close(&t);
}

/* A lamp with a lampshade: a box without a bottom, so that none of its light goes sideways or up. A second
 * floor above it and the floor outside the cone stay black. */
static void nothing_comes_through_a_lampshade(void **state)
{
    (void)state;
    struct gi_test t;
    struct sdfgi_settings settings = emitter_settings();
    settings.cell_rays = 64;
    const float white[3] = { 0.5f, 0.5f, 0.5f };
    gi_test_open(&t, &settings);
    add_floor(&t, 3);
    add_lamp(&t, (double[]){ 0, HEIGHT, 0 }, 0.2, 20);
    for (int side = 0; side < 4; side++) {
        const double at = side % 2 ? -0.5 : 0.4, other = at + 0.1;
        light_add_box(&t, (double[]){ side < 2 ? at : -0.5, 1.25, side < 2 ? -0.5 : at },
                      (double[]){ side < 2 ? other : 0.5, 2.2, side < 2 ? 0.5 : other }, white, 0);
    }
    light_add_box(&t, (double[]){ -0.5, 2.1, -0.5 }, (double[]){ 0.5, 2.3, 0.5 }, white, 0);
    gi_test_converge(&t, 400);
    static const struct gi_test_point dark[] = {
        { { 2.5f, -0.05f, 0.1f }, { 0, 1, 0 } },
        { { 0.1f, 2.3f, 0.1f }, { 0, 1, 0 } },
        { { 0.5f, 1.7f, 0.1f }, { 1, 0, 0 } },
    };
    float found[3][3];
    gi_test_irradiance(&t, dark, 3, found);
    for (int i = 0; i < 3; i++)
        REQUIRE_CMP(found[i][1], ==, 0.0f);
    const double below = light_white_at(&t, floor_points[0]);
    REQUIRE_NEAR(below / shown_irradiance(lamp_irradiance, 0.2, 20, floor_points[0].position), 1, 0.06);
    gi_test_close(&t);
}

/* The number of emitters that cascade 0 lists. */
static uint32_t listed(struct gi_test *t)
{
    uint32_t *words = gi_test_read(t, RESOURCE_EMITTERS, NULL);
    const uint32_t count = words[0];
    free(words);
    return count;
}

/* Twice as many lamps as a list takes, of equal power: those that it leaves out light what random rays find,
 * so that nothing is lost, and nothing counts twice. The ceiling of lamps is so dense that its light is even
 * in the middle of the floor: pi L times the form factor of the square. */
static void more_lamps_than_a_list_takes_lose_nothing(void **state)
{
    (void)state;
    enum { SIDE = 24 }; /* lamps along a side, each in an albedo block of its own at a spacing of 0.4 m */
    struct gi_test t;
    struct sdfgi_settings settings = emitter_settings();
    settings.min_cell_size_m = 0.1f;
    settings.resolution = 64;
    settings.cell_rays = 32;
    gi_test_open(&t, &settings);
    light_add_box(&t, (double[]){ -0.7, -1.5, -0.7 }, (double[]){ 0.7, -0.975, 0.7 },
                  (float[]){ 0.5f, 0.5f, 0.5f }, 0);
    struct test_mesh lamps = { 0 };
    for (int i = 0; i < SIDE * SIDE; i++) {
        const double center[3] = { 0.2 * (i % SIDE) - 0.2 * SIDE / 2 + 0.1, 1.0125,
                                   0.2 * (double)(i / SIDE) - 0.2 * SIDE / 2 + 0.1 };
        const double u[3] = { 0.05, 0, 0 }, v[3] = { 0, 0, 0.05 };
        struct test_mesh lamp = test_mesh_plane(center, u, v, 1);
        test_mesh_append(&lamps, &lamp);
        test_mesh_destroy(&lamp);
    }
    light_add(&t, lamps, 0, 4);
    gi_test_converge(&t, 600);
    REQUIRE_CMP(listed(&t), <=, (uint32_t)SDFGI_MAX_EMITTERS);
    REQUIRE_CMP(listed(&t), >, (uint32_t)SDFGI_MAX_EMITTERS / 2);
    double expected = 0;
    for (int i = 0; i < SIDE * SIDE; i++) {
        const double x = 0.2 * (i % SIDE) - 0.2 * SIDE / 2 + 0.1,
                     z = 0.2 * (double)(i / SIDE) - 0.2 * SIDE / 2 + 0.1, h = 1.0125 + 0.975,
                     square = x * x + z * z + h * h;
        expected += 4 * 0.01 * h * h / (square * square);
    }
    double mean = 0;
    for (int i = 0; i < 9; i++) {
        const struct gi_test_point point = {
            { 0.3f * (float)(i % 3 - 1), -0.975f, 0.3f * (float)(i / 3 - 1) }, { 0, 1, 0 }
        };
        mean += light_white_at(&t, point) / 9;
    }
    printf("%u lamps of %d listed: mean %.3f, expected at the centre %.3f\n", listed(&t), SIDE * SIDE, mean,
           expected);
    REQUIRE_NEAR(mean / expected, 1, 0.06);
    gi_test_close(&t);
}

/* Where nothing emits there is no list: neither memory nor work. */
static void nothing_is_there_where_nothing_emits(void **state)
{
    (void)state;
    struct gi_test t;
    static struct sdfgi_report report;
    const struct sdfgi_settings settings = emitter_settings();
    uint64_t before, size;
    gi_test_open(&t, &settings);
    add_floor(&t, 3);
    light_set_uniform_sky(&t, 1);
    gi_test_update(&t, 1);
    sdfgi_get_report(t.gi, &report);
    before = report.memory.total_bytes;
    REQUIRE_TRUE(!report.passes[PASS_EMITTER_MARK].ran && !report.passes[PASS_EMITTER_LIST].ran);
    free(gi_test_read(&t, RESOURCE_EMITTERS, &size));
    REQUIRE_CMP(size, ==, 4ul);

    add_lamp(&t, (double[]){ 0, HEIGHT, 0 }, 0.2, 20);
    gi_test_update(&t, 1);
    sdfgi_get_report(t.gi, &report);
    REQUIRE_TRUE(report.passes[PASS_EMITTER_MARK].ran && report.passes[PASS_EMITTER_LIST].ran);
    REQUIRE_CMP(report.memory.total_bytes, >, before);
    REQUIRE_CMP(listed(&t), ==, 4u);
    gi_test_close(&t);
}

/* The list is that of a fresh start, to the bit, after the camera has moved there. No light is looked at. */
static void lists_do_not_depend_on_the_way(void **state)
{
    (void)state;
    static struct gi_test t;
    struct sdfgi_settings settings = emitter_settings();
    uint32_t *words[2];
    settings.cell_rays_per_frame = 1 << 12;
    gi_test_open(&t, &settings);
    for (int moves = 0; moves < 2; moves++) {
        gi_test_restart(&t, &settings);
        add_floor(&t, 3);
        for (int i = 0; i < 12; i++)
            add_lamp(&t, (double[]){ 0.7 * i - 4, 1 + 0.1 * i, 0.3 * (i % 3) }, 0.1 + 0.02 * i, 3);
        t.frame.camera_position[0] = moves ? 0 : 2;
        gi_test_update(&t, 1);
        for (int step = 1; moves && step <= 8; step++) {
            t.frame.camera_position[0] = 0.25 * step;
            gi_test_update(&t, 6);
        }
        words[moves] = gi_test_read(&t, RESOURCE_EMITTERS, NULL);
    }
    REQUIRE_CMP(words[0][0], >, 4u);
    REQUIRE_CMP(words[0][0], ==, words[1][0]);
    REQUIRE_BYTES(words[0] + 8, words[1] + 8, words[0][0] * SDFGI_EMITTER_WORDS * sizeof(uint32_t));
    free(words[0]);
    free(words[1]);
    gi_test_close(&t);
}

TEST_GROUP(emitters)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(hard_49_lamps_of_all_sizes_give_the_light_of_their_power),
        cmocka_unit_test(a_ball_shines_alike_in_all_directions),
        cmocka_unit_test(hard_50_a_lamp_that_slides_keeps_its_light),
        cmocka_unit_test(hard_50_a_wall_that_slides_keeps_its_light),
        cmocka_unit_test(nothing_comes_through_a_lampshade),
        cmocka_unit_test(more_lamps_than_a_list_takes_lose_nothing),
        cmocka_unit_test(nothing_is_there_where_nothing_emits),
        cmocka_unit_test(lists_do_not_depend_on_the_way),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
