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

TEST_GROUP(curved)
{
    if (!gpu_test_available())
        return GPU_TEST_SKIP;
    const struct CMUnitTest tests[] = { cmocka_unit_test(light_on_balls_changes_smoothly) };
    return cmocka_run_group_tests(tests, light_open, light_close);
}
