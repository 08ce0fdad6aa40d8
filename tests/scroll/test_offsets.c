/* SPDX-License-Identifier: MIT
 * A box with a lamp has the same light wherever it lies within a cell (HARD_CASES row 27). */
#include "hard_case.h"
#include "light_scene.h"
#include "require.h"
#include "test_group.h"
#include "scroll_scene.h"
#include "test_memory.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

/* On three of the walls a grid of points. */
enum { MOST_PLACES = 64, GRID = 4, POINTS = 3 * GRID * GRID };

static const double half = 2.5;

static void wall_points(const double center[static 3], struct gi_test_point points[static POINTS])
{
    for (int i = 0; i < POINTS; i++) {
        const int axis = i / (GRID * GRID), place[2] = { i % GRID, i / GRID % GRID };
        points[i] = (struct gi_test_point){ 0 };
        points[i].normal[axis] = 1;
        points[i].position[axis] = (float)(center[axis] - half);
        for (int k = 0; k < 2; k++) {
            const int other = (axis + 1 + k) % 3;
            points[i].position[other] =
                (float)(center[other] + 0.8 * half * (2.0 * place[k] / (GRID - 1) - 1));
        }
    }
}

static void look_at_box(struct gi_test *t, const double center[static 3], double light[static POINTS])
{
    scroll_colored_box(t, center, half);
    gi_test_converge(t, 400);
    struct gi_test_point points[POINTS];
    float found[POINTS][3];
    wall_points(center, points);
    gi_test_irradiance(t, points, POINTS, found);
    for (int i = 0; i < POINTS; i++)
        light[i] = (double)found[i][1];
}

static void hard_27_light_does_not_depend_on_the_place_within_a_cell(void **state)
{
    (void)state;
    static double light[MOST_PLACES][POINTS];
    struct sdfgi_settings settings = light_settings(scroll_resolution(), 6.4f / (float)scroll_resolution());
    settings.cascades = 1;
    if (!scroll_is_full()) /* cycles of one frame settle in fewer frames */
        settings.frames_to_converge = 1;
    static struct gi_test t;
    gi_test_open(&t, &settings);
    const int places = scroll_is_full() ? (int)gpu_test_repeats(&t.gpu, MOST_PLACES) : 3;
    struct test_random random = { 27 };
    double mean[POINTS] = { 0 };
    for (int n = 0; n < places; n++) {
        double center[3];
        for (int k = 0; k < 3; k++)
            center[k] = test_random_real(&random, 0, settings.min_cell_size_m);
        gi_test_restart(&t, &settings);
        look_at_box(&t, center, light[n]);
        for (int i = 0; i < POINTS; i++)
            mean[i] += light[n][i] / places;
    }
    gi_test_close(&t);
    double worst = 0, largest = 0;
    for (int n = 0; n < places; n++) {
        double sum = 0;
        for (int i = 0; i < POINTS; i++) {
            const double error = light[n][i] / mean[i] - 1;
            largest = fmax(largest, fabs(error));
            sum += error * error / POINTS;
        }
        worst = fmax(worst, sqrt(sum));
    }
    printf(
        "%d places within a cell: light differs from the mean by at most %.2f %% rms, %.2f %% at a point\n",
        places, 100 * worst, 100 * largest);
    HARD_CASE_AT_MOST(27, "light off its mean over places, rms", worst, 0.1);
}

TEST_GROUP(offsets)
{
    if (!gpu_test_available())
        return GPU_TEST_SKIP;
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(hard_27_light_does_not_depend_on_the_place_within_a_cell),
    };
    return cmocka_run_group_tests_name("scroll_offsets", tests, NULL, NULL);
}
