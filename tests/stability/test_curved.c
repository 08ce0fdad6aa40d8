/* SPDX-License-Identifier: MIT
 * Light on balls that are hardly larger than cells: it changes along the surface as smoothly as the normal
 * does, whichever light cells answer. */
#include "light_scene.h"
#include "require.h"
#include "test_group.h"

#include <math.h>
#include <stdio.h>

enum { BALLS = 4, POINTS = 360, FRAMES = 60 };

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

/* Once round the ball in the plane of two axes, a degree at a time: the largest change from point to point
 * over the range of all. */
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
    double low = 1e30, high = 0, worst = 0;
    for (int i = 0; i < POINTS; i++) {
        const double here = (double)found[i][1], next = (double)found[(i + 1) % POINTS][1];
        low = fmin(low, here);
        high = fmax(high, here);
        worst = fmax(worst, fabs(next - here));
    }
    REQUIRE_CMP(low, >, 0.0);
    REQUIRE_CMP(high, >, 3 * low);
    return worst / (high - low);
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
    REQUIRE_CMP(worst, <=, 0.35);
    REQUIRE_CMP(sum / (3 * BALLS), <=, 0.15);
}

/* ---- The foot of a ball */

enum { FEET = 6, FOOT_POINTS = 60 };

static const double viewer[3] = { 0.3, 1.4, 3.2 };

/* True if nothing of a ball is between the viewer and a point. */
static bool is_in_sight(const double ball[static 3], double radius, const double point[static 3])
{
    double along = 0, way2 = 0, off2 = 0;
    for (int k = 0; k < 3; k++) {
        along += (ball[k] - point[k]) * (viewer[k] - point[k]);
        way2 += (viewer[k] - point[k]) * (viewer[k] - point[k]);
    }
    for (int k = 0; k < 3; k++) {
        const double off = point[k] + along / way2 * (viewer[k] - point[k]) - ball[k];
        off2 += off * off;
    }
    return along <= 0 || off2 > radius * radius;
}

/* Points of the floor in the gap below a ball that the viewer sees. */
static uint32_t foot_points(const double ball[static 3], double radius, double ground,
                            struct gi_test_point points[static FOOT_POINTS])
{
    uint32_t count = 0;
    for (int i = 0; i < FOOT_POINTS; i++) {
        const double angle = PI * (0.2 + 0.6 * (i % 12) / 11), away = radius * (0.15 + 0.15 * (i / 12)),
                     at[3] = { ball[0] + away * cos(angle), ground, ball[2] + away * sin(angle) };
        if (is_in_sight(ball, radius, at))
            points[count++] =
                (struct gi_test_point){ { (float)at[0], (float)at[1], (float)at[2] }, { 0, 1, 0 } };
    }
    return count;
}

/* A ball is hollow: the light cells in it are black. A lookup of the floor below it has its place in one of
 * them, where the gap is lower than a cell. It goes on from there, towards the viewer. */
static void foot_of_a_ball_is_not_black(void **state)
{
    struct gi_test *t = *state;
    const double radius = 0.45;
    uint32_t seen = 0, black = 0;
    for (int i = 0; i < FEET; i++) {
        const struct sdfgi_settings settings = light_cell_settings(32, 0.2f);
        const double ground = -0.5 - 0.04 * i, ball[3] = { 0.05 * i, ground + radius + 0.02, -0.03 * i };
        struct gi_test_point points[FOOT_POINTS];
        float found[FOOT_POINTS][3];
        gi_test_restart(t, &settings);
        light_add(t, test_mesh_sphere(ball, radius, 4), 0.5f, 0);
        light_add_box(t, (double[]){ -3, ground - 1, -3 }, (double[]){ 3, ground, 3 },
                      (float[]){ 0.5f, 0.5f, 0.5f }, 0);
        light_set_uniform_sky(t, 1);
        gi_test_update(t, 8);
        const uint32_t count = foot_points(ball, radius, ground, points);
        gi_test_irradiance_from(t, (float[]){ (float)viewer[0], (float)viewer[1], (float)viewer[2] }, points,
                                count, found);
        for (uint32_t k = 0; k < count; k++)
            black += (double)found[k][1] < 0.01;
        seen += count;
    }
    printf("foot of a ball: %u of %u points are black\n", black, seen);
    REQUIRE_CMP(seen, >, 100u);
    REQUIRE_CMP(black, ==, 0u);
}

TEST_GROUP(curved)
{
    if (!gpu_test_available())
        return GPU_TEST_SKIP;
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(light_on_balls_changes_smoothly),
        cmocka_unit_test(foot_of_a_ball_is_not_black),
    };
    return cmocka_run_group_tests(tests, light_open, light_close);
}
