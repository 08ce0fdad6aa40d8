/* SPDX-License-Identifier: MIT
 * Light on balls that are hardly larger than cells, on walls at an angle to them, and on the ground below the
 * edge of a bed: it changes along the surface as smoothly as what lights it, whichever light cells answer. */
#include "light_scene.h"
#include "require.h"
#include "test_group.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

enum { BALLS = 4, POINTS = 360, WALL_POINTS = 241, BED_POINTS = 91 };
/* Noise counts on walls: they take half as many again as a cycle has. */
enum { FRAMES = 32, WALL_FRAMES = 48 };

static const double center[3] = { 0.07, -0.04, 0.11 };

/* A black ball between a panel that glows and a dark sky. */
static void build(struct gi_test *t, double radius)
{
    const struct sdfgi_settings settings = light_cell_settings(32, 0.25f);
    gi_test_restart(t, &settings);
    light_add(t, test_mesh_sphere(center, radius, 5), 0, 0);
    light_add_box(t, (double[]){ 1.5, -2, -2 }, (double[]){ 2, 2, 2 }, (float[]){ 0, 0, 0 }, 1);
    light_set_uniform_sky(t, 0.1f);
    gi_test_update(t, FRAMES);
}

/* The largest change of light from point to point, over the range of all. `is_ring`: the first follows the
 * last. */
static double worst_of_range(float (*found)[3], int count, bool is_ring)
{
    double low = 1e30, high = 0, worst = 0;
    for (int i = 0; i < count; i++) {
        const double here = (double)found[i][1];
        low = fmin(low, here);
        high = fmax(high, here);
        if (i + 1 < count || is_ring)
            worst = fmax(worst, fabs((double)found[(i + 1) % count][1] - here));
    }
    REQUIRE_CMP(low, >, 0.0);
    REQUIRE_CMP(high, >, (is_ring ? 3 : 1.2) * low);
    return worst / (high - low);
}

/* Once round the ball in the plane of two axes, a degree at a time. */
static double worst_step(struct gi_test *t, double radius, const double u[static 3], const double v[static 3])
{
    struct gi_test_point points[POINTS];
    float found[POINTS][3];
    for (int i = 0; i < POINTS; i++) {
        const double angle = 2 * PI * i / POINTS;
        for (int k = 0; k < 3; k++) {
            const double normal = cos(angle) * u[k] + sin(angle) * v[k];
            points[i].normal[k] = (float)normal;
            points[i].position[k] = (float)(center[k] + radius * normal);
        }
    }
    gi_test_irradiance(t, points, POINTS, found);
    return worst_of_range(found, POINTS, true);
}

/* Faces of a cube that show on balls made it 0.52 of the range in the mean, and 0.75 at most. */
static void light_on_balls_changes_smoothly(void **state)
{
    static const double radii[BALLS] = { 0.2, 0.3, 0.4, 0.6 };
    const double h = sqrt(0.5);
    double worst = 0, sum = 0;
    for (int i = 0; i < BALLS; i++) {
        build(*state, radii[i]);
        const double level = worst_step(*state, radii[i], (double[]){ 1, 0, 0 }, (double[]){ 0, 0, 1 }),
                     upright = worst_step(*state, radii[i], (double[]){ 1, 0, 0 }, (double[]){ 0, 1, 0 }),
                     slanted = worst_step(*state, radii[i], (double[]){ h, h, 0 }, (double[]){ 0, 0, 1 });
        printf("ball of %.1f cells: steps of %.3f, %.3f and %.3f of the range\n", radii[i] / 0.25, level,
               upright, slanted);
        worst = fmax(worst, fmax(level, fmax(upright, slanted)));
        sum += level + upright + slanted;
    }
    REQUIRE_CMP(worst, <=, 0.3);
    REQUIRE_CMP(sum / (3 * BALLS), <=, 0.14);
}

/* A black wall at an angle, between a panel that glows on one side of it and a dark sky. */
static void build_wall(struct gi_test *t, const double axis[static 3], double degrees,
                       double rotation[static 9])
{
    const struct sdfgi_settings settings = light_cell_settings(32, 0.25f);
    test_rotation(axis, degrees * PI / 180, rotation);
    gi_test_restart(t, &settings);
    light_add(t, test_mesh_box(center, (double[]){ 1.5, 1, 0.3 }, rotation), 0, 0);
    light_add_box(t, (double[]){ 1.8, -2, 1 }, (double[]){ 2.3, 2, 3 }, (float[]){ 0, 0, 0 }, 1);
    light_set_uniform_sky(t, 0.1f);
    gi_test_update(t, WALL_FRAMES);
}

/* Along a level line on the front of the wall, 1 cm at a time. */
static double worst_step_along(struct gi_test *t, const double rotation[static 9])
{
    struct gi_test_point points[WALL_POINTS];
    float found[WALL_POINTS][3];
    for (int i = 0; i < WALL_POINTS; i++) {
        const double across = -1.2 + 0.01 * i;
        for (int k = 0; k < 3; k++) {
            points[i].normal[k] = (float)rotation[6 + k];
            points[i].position[k] =
                (float)(center[k] + across * rotation[k] + 0.1 * rotation[3 + k] + 0.3 * rotation[6 + k]);
        }
    }
    gi_test_irradiance(t, points, WALL_POINTS, found);
    return worst_of_range(found, WALL_POINTS, false);
}

/* With the nearest cells along the normal, and none beyond the edges of a step, it was 0.12 in the mean and
 * 0.42 at most. */
static void light_on_walls_at_an_angle_changes_smoothly(void **state)
{
    static const double degrees[] = { 10, 17, 25, 45, -30 }, axes[][3] = { { 0, 1, 0 }, { 0.6, 0.8, 0 } };
    enum { ANGLES = sizeof degrees / sizeof *degrees, WALLS = 2 * ANGLES };
    double worst = 0, sum = 0;
    for (int i = 0; i < WALLS; i++) {
        double rotation[9];
        build_wall(*state, axes[i / ANGLES], degrees[i % ANGLES], rotation);
        const double step = worst_step_along(*state, rotation);
        printf("wall at %.0f degrees: steps of %.3f of the range\n", degrees[i % ANGLES], step);
        worst = fmax(worst, step);
        sum += step;
    }
    REQUIRE_CMP(worst, <=, 0.25);
    REQUIRE_CMP(sum / WALLS, <=, 0.07);
}

/* A black bed under a bright sky. The board along its front hangs into the cells above the ground. */
static void build_bed(struct gi_test *t, enum sdfgi_up_axis up, double front)
{
    const struct sdfgi_settings settings = light_cell_settings(32, 0.25f);
    static const float black[3] = { 0 };
    t->up_axis = up;
    gi_test_restart(t, &settings);
    light_add_turned_box(t, (double[]){ -3, -1, -3 }, (double[]){ 3, 0, 3 }, black);
    light_add_turned_box(t, (double[]){ -1.6, 0.3, -1.5 }, (double[]){ 1.6, 0.6, front }, black);
    light_add_turned_box(t, (double[]){ -1.6, 0.19, front - 0.07 }, (double[]){ 1.6, 0.6, front }, black);
    light_set_uniform_sky(t, 1);
    gi_test_update(t, FRAMES);
}

/* Along a line on the ground across the front of the bed, 1 cm at a time. */
static double worst_step_below(struct gi_test *t, double x)
{
    struct gi_test_point points[BED_POINTS];
    float found[BED_POINTS][3];
    double normal[3];
    light_turn(t->up_axis, (double[]){ 0, 1, 0 }, normal);
    for (int i = 0; i < BED_POINTS; i++) {
        double at[3];
        light_turn(t->up_axis, (double[]){ x, 0, -0.4 + 0.01 * i }, at);
        for (int k = 0; k < 3; k++) {
            points[i].position[k] = (float)at[k];
            points[i].normal[k] = (float)normal[k];
        }
    }
    gi_test_irradiance(t, points, BED_POINTS, found);
    return worst_of_range(found, BED_POINTS, false);
}

/* Where the board's cell counted by its nearer side alone, light jumped in the middle of the cell, by
 * 0.92 of the range. Now it is 0.037. Without SDFGI_TEST_FULL the fronts take turns. */
static void light_below_the_edge_of_a_bed_changes_smoothly(void **state)
{
    static const enum sdfgi_up_axis ups[] = { SDFGI_UP_Y, SDFGI_UP_Z, SDFGI_UP_MINUS_Y, SDFGI_UP_MINUS_Z };
    static const double fronts[] = { 0.08, 0.24 }, along[] = { -0.6, 0.11 };
    const bool full = getenv("SDFGI_TEST_FULL") != NULL;
    struct gi_test *t = *state;
    for (size_t i = 0; i < 8; i++) {
        const double front = fronts[i % 2];
        if (!full && i % 2 != i / 2 % 2)
            continue;
        build_bed(t, ups[i / 2], front);
        for (size_t k = 0; k < 2; k++) {
            const double step = worst_step_below(t, along[k]);
            printf("board at %.2f m, line at %.2f m: steps of %.3f of the range\n", front, along[k], step);
            REQUIRE_CMP(step, <=, 0.05);
        }
    }
    t->up_axis = SDFGI_UP_Y;
}

TEST_GROUP(curved)
{
    if (!gpu_test_available())
        return GPU_TEST_SKIP;
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(light_on_balls_changes_smoothly),
        cmocka_unit_test(light_on_walls_at_an_angle_changes_smoothly),
        cmocka_unit_test(light_below_the_edge_of_a_bed_changes_smoothly),
    };
    return cmocka_run_group_tests(tests, light_open, light_close);
}
