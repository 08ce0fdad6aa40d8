/* SPDX-License-Identifier: MIT
 * Points on walls while the camera walks past and the answer passes from one cascade to the next (HARD_CASES
 * row 54): a furnace reads the same in all of them, also while one takes a step; a box with coloured walls
 * does not jump in the blend, nor while the border moves. */
#include "hard_case.h"
#include "light_scene.h"
#include "require.h"
#include "test_group.h"
#include "scroll_scene.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

/* On each of the six walls of a room a grid of points, the outermost 5 cm from an edge: inside the sub-voxels
 * of the neighbouring wall in all cascades but the first. */
enum { GRID = 6, POINTS = 6 * GRID * GRID };

struct walk {
    struct gi_test t;
    uint32_t resolution;
    double camera[3];
    struct gi_test_point points[POINTS];
    uint32_t count;
    float before[POINTS][3];
    double worst_step; /* relative change from one step to the next */
    double low[POINTS], high[POINTS];
};

static void walk_add_wall(struct walk *w, const double center[static 3], double half, int axis, int sign)
{
    for (int i = 0; i < GRID * GRID; i++) {
        const int place[2] = { i % GRID, i / GRID };
        struct gi_test_point point = { 0 };
        point.position[axis] = (float)(center[axis] + sign * half);
        point.normal[axis] = (float)-sign;
        for (int k = 0; k < 2; k++) {
            const int other = (axis + 1 + k) % 3;
            point.position[other] =
                (float)(center[other] + (half - 0.05) * (2.0 * place[k] / (GRID - 1) - 1));
        }
        w->points[w->count++] = point;
    }
}

/* Light at all points as the camera sees it; E / pi of the green channel is kept apart. */
static void walk_look(struct walk *w, bool first)
{
    float found[POINTS][3];
    const float viewer[3] = { (float)w->camera[0], (float)w->camera[1], (float)w->camera[2] };
    gi_test_irradiance_from(&w->t, viewer, w->points, w->count, found);
    for (uint32_t i = 0; i < w->count; i++) {
        const double light = (double)found[i][1] / PI;
        REQUIRE_TRUE(isfinite(light) && light > 0);
        w->low[i] = first ? light : fmin(w->low[i], light);
        w->high[i] = first ? light : fmax(w->high[i], light);
        for (int k = 0; k < 3 && !first; k++)
            w->worst_step = fmax(w->worst_step, fabs((double)found[i][k] / (double)w->before[i][k] - 1));
    }
    memcpy(w->before, found, sizeof found);
}

static void walk_start(struct walk *w)
{
    scroll_stand(&w->t, w->camera);
    gi_test_converge(&w->t, w->resolution > 64 ? 4000 : 400);
    w->worst_step = 0;
    walk_look(w, true);
}

static void walk_steps(struct walk *w, int count, double step_m)
{
    for (int i = 0; i < count; i++) {
        w->camera[0] += step_m;
        scroll_stand(&w->t, w->camera);
        gi_test_update(&w->t, 1);
        walk_look(w, false);
    }
}

/* The largest change of a point over the whole walk. */
static double walk_range(const struct walk *w)
{
    double range = 0;
    for (uint32_t i = 0; i < w->count; i++)
        range = fmax(range, w->high[i] / w->low[i] - 1);
    return range;
}

/* Three cascades, of which the first is 6.4 m wide. On a software driver, at most `software_most` cells. */
static void walk_open(struct walk *w, bool cells, uint32_t software_most)
{
    memset(w, 0, sizeof *w);
    gi_test_open_device(&w->t);
    const uint32_t most = gpu_test_is_software(&w->t.gpu) ? software_most : 128;
    w->resolution = scroll_resolution() < most ? scroll_resolution() : most;
    struct sdfgi_settings settings = light_settings(w->resolution, 6.4f / (float)w->resolution);
    settings.cascades = 3;
    if (!scroll_is_full()) { /* noise is the same from step to step: few rays settle sooner */
        settings.ray_count = 32;
        settings.frames_to_converge = 1;
    }
    if (cells)
        scroll_use_cells(&settings, 1);
    gi_test_restart(&w->t, &settings);
}

static void furnace_walk(double half, double wall, double z, uint32_t software_most)
{
    static struct walk w;
    walk_open(&w, false, software_most);
    const double center[3] = { 0.13, 0.27, z };
    light_add(&w.t, test_mesh_room(center, (double[]){ half, half, half }, wall, test_rotation_none), 0.5f,
              0.5f);
    for (int axis = 0; axis < 3; axis++)
        for (int sign = -1; sign <= 1; sign += 2)
            walk_add_wall(&w, center, half, axis, sign);
    memcpy(w.camera, (double[]){ -1.6, 0.4, -0.3 }, sizeof w.camera);
    walk_start(&w);
    /* At 6 m/s a frame is half a cell of the defaults long: never more than one here. */
    const double way = fmin(0.1, w.t.gi->settings.min_cell_size_m);
    walk_steps(&w, (int)(3.4 / way + 0.5), way);
    walk_steps(&w, 20, 0.001);
    printf("furnace of %.1f m, walls of %.2f m: at most %.2f %% a step, %.2f %% over the walk\n", 2 * half,
           wall, 100 * w.worst_step, 100 * walk_range(&w));
    REQUIRE_CMP(w.t.gi->volume.state.scroll.scrolls_begun, >=, 1ul);
    HARD_CASE_AT_MOST(54, "furnace, change of a step", w.worst_step, 0.005);
    HARD_CASE_AT_MOST(54, "furnace, change over the walk", walk_range(&w), 0.005);
    for (uint32_t i = 0; i < w.count; i++)
        REQUIRE_NEAR(w.low[i], 1, 0.005);
    gi_test_close(&w.t);
}

/* Probes stand so close to one wall that the next cascade's cells there are occupied; at 128^3 they do so in
 * the room below. */
static void hard_54_a_furnace_reads_the_same_in_all_cascades(void **state)
{
    (void)state;
    furnace_walk(2.5, 0.3, -0.71, 64);
}

static void hard_54_thin_walls_too(void **state)
{
    (void)state;
    furnace_walk(2.5, 0.1, -0.41, 64);
    if (scroll_is_full()) /* light that swung for ever */
        furnace_walk(2.5, 0.1, -0.71, 128);
}

/* A box of 5 m with a lamp, from settled light. */
static void walk_in_colored_box(struct walk *w, const double camera[static 3])
{
    const double center[3] = { 0, 0, 0 }, half = 2.5;
    scroll_colored_box(&w->t, center, half);
    for (int axis = 0; axis < 3; axis++)
        for (int sign = -1; sign <= 1; sign += 2)
            if (axis != 2 || sign < 0)
                walk_add_wall(w, center, half, axis, sign);
    memcpy(w->camera, camera, sizeof w->camera);
    walk_start(w);
}

/* While no cascade takes a step: the blend alone. */
static void walk_in_the_blend(bool cells)
{
    static struct walk w;
    /* From here the wall at -2.5 m is in the blend, whose width is that of a probe's spacing. */
    /* Light cells of 5 cm take it half an hour, those of 10 cm ten seconds: it has them in suite `full`. */
    const uint32_t most = scroll_is_full() ? 64 : 32;
    walk_open(&w, cells, cells ? most : 128);
    walk_in_colored_box(&w, (double[]){ w.resolution > 64 ? 0.55 : 0.15, 0.4, 1.3 });
    walk_steps(&w, 20, 0.001);
    const double mm = w.worst_step, way = 0.05 * w.t.gi->settings.min_cell_size_m;
    walk_steps(&w, 40, way);
    printf("coloured box: at most %.2f %% a step of 1 mm, %.2f %% of %.1f mm; %.1f %% over the walk\n",
           100 * mm, 100 * w.worst_step, 1000 * way, 100 * walk_range(&w));
    REQUIRE_CMP(w.t.gi->volume.state.scroll.scrolls_begun, ==, 0ul);
    HARD_CASE_AT_MOST(54, "coloured box, change of a step in the blend", w.worst_step, 0.02);
    gi_test_close(&w.t);
}

static void hard_54_a_colored_box_does_not_jump_in_the_blend(void **state)
{
    (void)state;
    walk_in_the_blend(false);
}

static void hard_54_nor_does_it_by_light_cells(void **state)
{
    (void)state;
    walk_in_the_blend(true);
}

/* The largest change while the border moves after a step, first with a camera that walks on, then with one
 * that rests, once light has settled: that of the border alone. */
static double walk_behind_border(struct walk *w, double step_m)
{
    w->worst_step = 0;
    for (int i = 0; i < 30; i++) {
        const bool settled = w->t.gi->volume.state.accumulation.phase == LIGHTING_CONVERGED;
        walk_steps(w, 1, step_m);
        w->worst_step = settled ? w->worst_step : 0;
        struct sdfgi_report report;
        sdfgi_get_report(w->t.gi, &report);
        REQUIRE_TRUE(!report.converged && report.converged_fraction < 1);
        REQUIRE_TRUE(!settled || !sdfgi_work_has(&w->t.gi->frame.work, PASS_PROBE_TRACE));
    }
    return w->worst_step;
}

/* What sample cycles find while they are not complete is no more to be seen than how the border moves. */
static void hard_54_a_colored_box_does_not_jump_while_cascades_step(void **state)
{
    (void)state;
    static struct walk w;
    walk_open(&w, false, 128);
    walk_in_colored_box(&w, (double[]){ 0.79, 0.4, 1.3 });
    const double way = 0.05 * w.t.gi->settings.min_cell_size_m;
    for (int i = 0; w.t.gi->volume.state.scroll.scrolls_begun == 0 && i < 200; i++)
        walk_steps(&w, 1, way);
    walk_steps(&w, 20, way);
    const double step = w.worst_step, walking = walk_behind_border(&w, way),
                 resting = walk_behind_border(&w, 0);
    printf("coloured box: at most %.2f %% a frame while a cascade steps; by its border alone %.2f %% with a "
           "camera that "
           "walks, %.2f %% with one that rests\n",
           100 * step, 100 * walking, 100 * resting);
    REQUIRE_CMP(w.t.gi->volume.state.scroll.scrolls_begun, >=, 1ul);
    HARD_CASE_AT_MOST(54, "coloured box, change of a frame while a cascade steps", step, 0.02);
    HARD_CASE_AT_MOST(54, "coloured box, change of a frame while the border moves", walking, 0.02);
    REQUIRE_CMP(resting, <=, 0.01);
    gi_test_close(&w.t);
}

TEST_GROUP(handover)
{
    if (!gpu_test_available())
        return GPU_TEST_SKIP;
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(hard_54_thin_walls_too),
        cmocka_unit_test(hard_54_a_colored_box_does_not_jump_in_the_blend),
        cmocka_unit_test(hard_54_nor_does_it_by_light_cells),
    };
    const struct CMUnitTest slow[] = {
        cmocka_unit_test(hard_54_a_furnace_reads_the_same_in_all_cascades),
        cmocka_unit_test(hard_54_a_colored_box_does_not_jump_while_cascades_step),
    };
    int failed = cmocka_run_group_tests_name("scroll_handover", tests, NULL, NULL);
    if (scroll_is_full())
        failed += cmocka_run_group_tests_name("scroll_handover_slow", slow, NULL, NULL);
    return failed;
}
