/* SPDX-License-Identifier: MIT
 * Stored distances against a brute-force transform of the same bits (HARD_CASES rows 1 to 4, 8 and 62). */
#include "hard_case.h"
#include "pass_scene.h"
#include "require.h"
#include "test_group.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

/* Distances are stored in steps of N / 32768 cells, rounded down; float square roots add their own rounding.
 */
static double storage_step(const struct gi_test *t)
{
    return t->gi->settings.resolution / 32768.0;
}

static const double rounding = 1e-4;

struct method {
    enum sdfgi_sdf_method id;
    double above; /* cells by which a stored distance may exceed the exact one */
};

/* The search is exact; the target for any method is 0.1 (HARD_CASES, row 1). The flood has no bound: 0.15
 * holds on all scenes of this file, where 0.14 was the most measured. */
static const struct method exact = { SDFGI_SDF_EXACT, 0 }, flood = { SDFGI_SDF_FLOOD, 0.15 };

static void open_mesh(const struct test_mesh *mesh, enum sdfgi_sdf_method method, enum sdfgi_y_scale y_scale)
{
    struct sdfgi_settings settings = gi_test_settings();
    if (method == SDFGI_SDF_FLOOD && !getenv("SDFGI_TEST_FULL")) { /* it is slow on processors */
        settings.resolution /= 2;
        settings.min_cell_size_m *= 2;
    }
    settings.sdf_method = method;
    settings.y_scale = y_scale;
    pass_scene_open(&pass_context, &settings, mesh);
}

/* Cells by which a distance lies above the exact one, at most: never more than the method may, and never a
 * step below. */
static double check_mesh(const char *name, struct test_mesh mesh, struct method method,
                         enum sdfgi_y_scale y_scale)
{
    static const double y_scales[] = { 0.5, 0.75, 1 };
    open_mesh(&mesh, method.id, y_scale);
    const struct pass_distance_error e = pass_distance_error(&pass_context, y_scales[y_scale]);
    printf("%s, %s, y scale %g: distance error max %+.4f mean %+.5f min %+.4f\n", name,
           method.id == SDFGI_SDF_FLOOD ? "flood" : "exact", y_scales[y_scale], e.max, e.mean, e.min);
    REQUIRE_CMP(e.max, <=, method.above + rounding);
    REQUIRE_CMP(e.min, >=, -storage_step(&pass_context) - rounding);
    test_mesh_destroy(&mesh);
    return e.max;
}

/* ---- Scenes */

static const double sphere_center[3] = { 0.11, -0.07, 0.19 };

static struct test_mesh sphere(double radius)
{
    return test_mesh_sphere(sphere_center, radius, 4);
}

static struct test_mesh rooms(double angle)
{
    const double center[3] = { 0.013, 0.021, -0.017 }, half[3] = { 4.3, 2.1, 3.2 }, axis[3] = { 0, 1, 0 };
    double turned[9];
    test_rotation(axis, angle, turned);
    return test_mesh_two_rooms(center, half, 0.03, turned);
}

static struct test_mesh soup(void)
{
    const double low[3] = { -7, -7, -7 }, high[3] = { 7, 7, 7 };
    return test_mesh_soup(7, 600, low, high, 1.5);
}

static struct test_mesh dust(uint32_t count)
{
    const double low[3] = { -7.9, -7.9, -7.9 }, high[3] = { 7.9, 7.9, 7.9 };
    return test_mesh_dust(count, count, low, high, 0.02, 0.1);
}

/* ---- Exact search */

static void hard_01_isolated_bits(void **state)
{
    (void)state;
    static const uint32_t counts[2] = { 100, 10000 };
    for (int i = 0; i < 2; i++)
        HARD_CASE_AT_MOST(1, "distance above the exact one, cells",
                          check_mesh("isolated bits", dust(counts[i]), exact, SDFGI_Y_SCALE_100), rounding);
}

static void hard_02_off_grid_sphere(void **state)
{
    (void)state;
    check_mesh("sphere", sphere(5.04), exact, SDFGI_Y_SCALE_100);
}

/* The cells in its middle are as far from any part of it as from any other: a search cannot leave anything
 * out. */
static void hard_02_from_the_middle_of_a_large_sphere(void **state)
{
    (void)state;
    check_mesh("large sphere", sphere(7), exact, SDFGI_Y_SCALE_100);
}

static void hard_03_thin_walls(void **state)
{
    (void)state;
    for (int i = 0; i < 2; i++)
        HARD_CASE_AT_MOST(3, "distance above the exact one, cells",
                          check_mesh("rooms", rooms(0.4 * i), exact, SDFGI_Y_SCALE_100), rounding);
}

static void hard_04_triangle_soup(void **state)
{
    (void)state;
    HARD_CASE_AT_MOST(4, "distance above the exact one, cells",
                      check_mesh("600 triangles", soup(), exact, SDFGI_Y_SCALE_100), rounding);
}

static void hard_62_flat_cells_measure_true_lengths(void **state)
{
    (void)state;
    HARD_CASE_AT_MOST(62, "distance above the exact one, cells",
                      check_mesh("sphere", sphere(5.04), exact, SDFGI_Y_SCALE_75), rounding);
    HARD_CASE_AT_MOST(62, "distance above the exact one, cells",
                      check_mesh("turned rooms", rooms(0.4), exact, SDFGI_Y_SCALE_50), rounding);
}

/* ---- Against a formula */

/* Stored distances less those of a sphere, in cells, where it is in reach. */
struct formula_error {
    double worst, mean;
    uint32_t cells;
};

static struct formula_error formula_error(double radius_m)
{
    const struct oracle_grid grid = gi_test_grid(&pass_context, 0);
    const uint32_t n = pass_context.gi->settings.resolution;
    const double cell = 4 * grid.step[0];
    float *stored = gi_test_distances(&pass_context, 0);
    struct formula_error e = { 0 };
    for (uint32_t i = 0; i < n * n * n; i++) {
        const uint32_t at[3] = { i % n, i / n % n, i / n / n };
        double square = 0;
        for (int k = 0; k < 3; k++) {
            const double off = grid.origin[k] + (at[k] + 0.5) * cell - sphere_center[k];
            square += off * off;
        }
        const double formula = fabs(sqrt(square) - radius_m) / cell;
        if (formula > SDFGI_DISTANCE_REACH - 0.317)
            continue;
        e.worst = fmax(e.worst, fabs((double)stored[i] - formula));
        e.mean += (double)stored[i] - formula;
        e.cells++;
    }
    free(stored);
    e.mean /= e.cells;
    return e;
}

/* A radius of 20.16 cells, or 40.3 of 128^3. Half a sub-voxel's diagonal is 0.217 cell, and a method may add
 * 0.1. */
static void hard_02_distances_follow_the_formula_of_a_sphere(void **state)
{
    (void)state;
    struct sdfgi_settings settings = gi_test_settings();
    settings.resolution = getenv("SDFGI_TEST_FULL") ? 128 : 64;
    const double radius = 5.04 * settings.resolution / 64;
    struct test_mesh mesh = sphere(radius);
    pass_scene_open(&pass_context, &settings, &mesh);
    const struct formula_error e = formula_error(radius);
    printf("sphere: %u cells, %.4f off at most, %+.4f in the mean\n", e.cells, e.worst, e.mean);
    HARD_CASE_AT_MOST(2, "off the formula, cells", e.worst, 0.217 + 0.1);
    HARD_CASE_AT_MOST(2, "off the formula in the mean, cells", fabs(e.mean), 0.05);
    test_mesh_destroy(&mesh);
}

/* ---- Flood */

static void flood_stays_within_its_envelope(void **state)
{
    (void)state;
    check_mesh("10000 bits", dust(10000), flood, SDFGI_Y_SCALE_100);
    check_mesh("1000 bits", dust(1000), flood, SDFGI_Y_SCALE_100);
    check_mesh("sphere", sphere(5.04), flood, SDFGI_Y_SCALE_100);
    check_mesh("turned rooms", rooms(0.4), flood, SDFGI_Y_SCALE_100);
    check_mesh("600 triangles", soup(), flood, SDFGI_Y_SCALE_100);
    check_mesh("sphere", sphere(5.04), flood, SDFGI_Y_SCALE_50);
}

TEST_GROUP(voxel_distance)
{
    if (!gpu_test_available())
        return GPU_TEST_SKIP;
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(hard_01_isolated_bits),
        cmocka_unit_test(hard_02_off_grid_sphere),
        cmocka_unit_test(hard_02_from_the_middle_of_a_large_sphere),
        cmocka_unit_test(hard_02_distances_follow_the_formula_of_a_sphere),
        cmocka_unit_test(hard_03_thin_walls),
        cmocka_unit_test(hard_04_triangle_soup),
        cmocka_unit_test(hard_62_flat_cells_measure_true_lengths),
        cmocka_unit_test(flood_stays_within_its_envelope),
    };
    return cmocka_run_group_tests_name("voxel_distance", tests, NULL, pass_context_close);
}
