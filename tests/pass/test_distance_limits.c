/* SPDX-License-Identifier: MIT
 * Distances where there is nothing, everything, or one sub-voxel in a corner (HARD_CASES rows 5 to 8). */
#include "hard_case.h"
#include "oracle_edt.h"
#include "pass_scene.h"
#include "require.h"
#include "test_group.h"
#include "test_memory.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

/* A grid through the whole cascade, in six directions. */
enum { LOOKUPS_A_SIDE = 6, LOOKUPS = 6 * LOOKUPS_A_SIDE * LOOKUPS_A_SIDE * LOOKUPS_A_SIDE };

static void fill_points(struct gi_test_point points[LOOKUPS])
{
    for (uint32_t i = 0; i < LOOKUPS; i++) {
        const uint32_t at = i / 6, side = i % 6;
        const uint32_t index[3] = { at % LOOKUPS_A_SIDE, at / LOOKUPS_A_SIDE % LOOKUPS_A_SIDE,
                                    at / LOOKUPS_A_SIDE / LOOKUPS_A_SIDE };
        points[i] = (struct gi_test_point){ 0 };
        for (int k = 0; k < 3; k++)
            points[i].position[k] = -6.37f + 2.51f * (float)index[k];
        points[i].normal[side / 2] = side & 1 ? -1 : 1;
    }
}

static float (*look_up(struct gi_test *t))[3]
{
    static struct gi_test_point points[LOOKUPS];
    static float irradiance[LOOKUPS][3];
    fill_points(points);
    gi_test_irradiance(t, points, LOOKUPS, irradiance);
    return irradiance;
}

#define PI 3.14159265358979323846

static void hard_05_an_empty_cascade_is_far_from_everything_and_lit_by_the_sky(void **state)
{
    (void)state;
    const struct sdfgi_settings settings = gi_test_settings();
    const struct sdfgi_sky sky = { { 0.25f, 0.5f, 2 }, { 0.25f, 0.5f, 2 }, { 0.25f, 0.5f, 2 } };
    gi_test_renew(&pass_context, &settings);
    REQUIRE_CMP(sdfgi_set_sky(pass_context.gi, &sky), ==, SDFGI_OK);
    gi_test_converge(&pass_context, 64);
    float *distances = gi_test_distances(&pass_context, 0);
    uint32_t near = 0;
    for (uint32_t i = 0; i < 64 * 64 * 64; i++)
        near += distances[i] != (float)SDFGI_DISTANCE_REACH;
    free(distances);
    HARD_CASE_AT_MOST(5, "cells without the farthest distance", near, 0);
    float(*irradiance)[3] = look_up(&pass_context);
    double worst = 0;
    for (uint32_t i = 0; i < LOOKUPS; i++)
        for (int k = 0; k < 3; k++) {
            const double ratio = (double)irradiance[i][k] / (PI * (double)sky.zenith[k]);
            worst = isfinite(ratio) ? fmax(worst, fabs(ratio - 1)) : INFINITY;
        }
    HARD_CASE_AT_MOST(5, "light off the sky's, relative", worst, 1e-3); /* half floats keep 11 bits */
}

/* Planes whose insets go through the middle of every layer of sub-voxels. */
static struct test_mesh all_layers(double half_extent, uint32_t layers)
{
    struct test_mesh mesh = { 0 };
    for (uint32_t i = 0; i < layers; i++) {
        const double center[3] = { half_extent * ((2.0 * i + 2) / layers - 1), 0, 0 };
        const double edge_u[3] = { 0, 1.1 * half_extent, 0 }, edge_v[3] = { 0, 0, 1.1 * half_extent };
        struct test_mesh plane = test_mesh_plane(center, edge_u, edge_v, 1);
        test_mesh_append(&mesh, &plane);
        test_mesh_destroy(&plane);
    }
    return mesh;
}

static void hard_06_a_full_cascade_has_no_light_cells(void **state)
{
    (void)state;
    struct sdfgi_settings settings = gi_test_settings();
    settings.resolution = 32;
    struct test_mesh mesh = all_layers(4, 128);
    pass_scene_open(&pass_context, &settings, &mesh);
    gi_test_update(&pass_context, 5);
    struct oracle_bits bits = gi_test_bits(&pass_context, 0);
    REQUIRE_CMP(oracle_bits_count(&bits), ==, 128 * 128 * 128);
    oracle_bits_destroy(&bits);
    const struct pass_distance_error e = pass_distance_error(&pass_context, 1);
    REQUIRE_CMP(e.max, <=, 0);
    REQUIRE_CMP(e.min, >=, -32 / 32768.0 - 1e-6);
    uint32_t *counters = gi_test_read(&pass_context, RESOURCE_COUNTERS, NULL);
    HARD_CASE_AT_MOST(6, "light cells", counters[SDFGI_COUNTER_LIGHT_CELLS], 0);
    free(counters);
    uint32_t *groups = gi_test_read(&pass_context, RESOURCE_INDIRECT, NULL);
    HARD_CASE_AT_MOST(6, "groups of work", groups[0], 0);
    free(groups);
    float(*irradiance)[3] = look_up(&pass_context);
    for (uint32_t i = 0; i < LOOKUPS; i++)
        for (int k = 0; k < 3; k++)
            REQUIRE_NEAR(irradiance[i][k], 0, 0);
    test_mesh_destroy(&mesh);
}

/* The invalidated cells of MASKS are cleared all the same, and counters at the end of GATHERED. */
static const enum resource written_by_groups[] = { RESOURCE_LIGHT,  RESOURCE_LIGHT_CELLS, RESOURCE_RAYS,
                                                   RESOURCE_DIRECT, RESOURCE_SURFACES,    RESOURCE_GATHERED };
enum { WRITTEN = sizeof written_by_groups / sizeof *written_by_groups, CANARY = 0xa5 };

static void write_canaries(struct gi_test *t)
{
    for (int i = 0; i < WRITTEN; i++) {
        const struct gpu_buffer *buffer = &t->gi->volume.resources->buffers[written_by_groups[i]];
        uint8_t *data = test_array_alloc(buffer->size, 1);
        memset(data, CANARY, buffer->size);
        gpu_test_buffer_write(&t->gpu, buffer->handle, 0, buffer->size, data);
        free(data);
    }
}

static uint64_t canaries_lost(struct gi_test *t)
{
    uint64_t lost = 0;
    for (int i = 0; i < WRITTEN; i++) {
        uint64_t size;
        uint8_t *data = gi_test_read(t, written_by_groups[i], &size);
        if (written_by_groups[i] == RESOURCE_GATHERED)
            size = sdfgi_gather_counters_offset(&t->gi->volume.resources->extent);
        for (uint64_t k = 0; k < size; k++)
            lost += data[k] != CANARY;
        free(data);
    }
    return lost;
}

/* Passes over light cells and rays of which there are none: their commands are recorded, and do nothing. */
static void hard_59_work_of_no_group_writes_nothing(void **state)
{
    (void)state;
    static struct sdfgi_report report;
    struct sdfgi_settings settings = gi_test_settings();
    settings.resolution = 32;
    settings.surface_light = SDFGI_SURFACE_LIGHT_CELLS;
    struct test_mesh mesh = all_layers(4, 128);
    pass_scene_open(&pass_context, &settings, &mesh);
    test_mesh_destroy(&mesh);
    gi_test_update(&pass_context, 1);
    write_canaries(&pass_context);
    const struct sdfgi_light_desc lamp = { .type = SDFGI_LIGHT_DIRECTIONAL,
                                           .direction = { 0, -1, 0 },
                                           .intensity = { 1, 1, 1 } };
    sdfgi_light light;
    REQUIRE_CMP(sdfgi_light_create(pass_context.gi, &lamp, &light), ==, SDFGI_OK);
    const double low[3] = { -1, -1, -1 }, high[3] = { 1, 1, 1 };
    REQUIRE_CMP(sdfgi_invalidate_box(pass_context.gi, low, high), ==, SDFGI_OK); /* lists what is dirty */
    bool direct = false, traced = false, gathered = false;
    for (int frame = 0; frame < 4; frame++) {
        gi_test_update(&pass_context, 1);
        sdfgi_get_report(pass_context.gi, &report);
        direct = direct || report.passes[PASS_LIGHT_DIRECT].ran;
        traced = traced || report.passes[PASS_PROBE_TRACE].ran;
        gathered = gathered || report.passes[PASS_CELL_GATHER].ran;
    }
    REQUIRE_TRUE(direct && traced && gathered);
    HARD_CASE_AT_MOST(59, "bytes written by no group", canaries_lost(&pass_context), 0);
}

/* A square whose inset crosses the centre of one sub-voxel and touches no other. */
static struct test_mesh speck_in_corner(int corner, double half_extent, double sub)
{
    double center[3];
    for (int k = 0; k < 3; k++)
        center[k] = (corner >> k & 1 ? 1 : -1) * (half_extent - sub / 2);
    center[2] += sub / 2;
    return test_mesh_plane(center, (double[]){ 0.4 * sub, 0, 0 }, (double[]){ 0, 0.4 * sub, 0 }, 1);
}

static void require_corner_distances(uint32_t resolution, int corner)
{
    struct sdfgi_settings settings = gi_test_settings();
    settings.resolution = resolution;
    const double cell = (double)settings.min_cell_size_m, half = resolution / 2 * cell;
    struct test_mesh mesh = speck_in_corner(corner, half, cell / 4);
    pass_scene_open(&pass_context, &settings, &mesh);
    struct oracle_bits bits = gi_test_bits(&pass_context, 0);
    REQUIRE_CMP(oracle_bits_count(&bits), ==, 1);
    oracle_bits_destroy(&bits);
    const double step = resolution / 32768.0;
    float *distances = gi_test_distances(&pass_context, 0);
    const uint32_t n = resolution, x = corner & 1 ? 0 : n - 1, y = corner & 2 ? 0 : n - 1,
                   z = corner & 4 ? 0 : n - 1;
    HARD_CASE_AT_LEAST(7, "the far corner's distance, cells", distances[x + n * (y + n * z)],
                       SDFGI_DISTANCE_REACH);
    free(distances);
    /* Everywhere rounded down, by no more than a step: never a cell further from the surface than it is. */
    const struct pass_distance_error e = pass_distance_error(&pass_context, 1);
    HARD_CASE_AT_MOST(8, "stored above the exact one, cells", e.max, 1e-5);
    HARD_CASE_AT_MOST(7, "off the exact distance, storage steps", -e.min / step, 1 + 1e-5 / step);
    test_mesh_destroy(&mesh);
}

static void hard_07_a_bit_in_any_corner_is_measured_as_far_as_distances_reach(void **state)
{
    (void)state;
    const bool full = getenv("SDFGI_TEST_FULL") != NULL;
    for (int corner = 0; corner < 8; corner++)
        require_corner_distances(full ? 64 : 32, corner);
    require_corner_distances(full ? 32 : 64, 5);
    if (full)
        require_corner_distances(128, 2);
}

TEST_GROUP(distance_limits)
{
    if (!gpu_test_available())
        return GPU_TEST_SKIP;
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(hard_05_an_empty_cascade_is_far_from_everything_and_lit_by_the_sky),
        cmocka_unit_test(hard_06_a_full_cascade_has_no_light_cells),
        cmocka_unit_test(hard_59_work_of_no_group_writes_nothing),
        cmocka_unit_test(hard_07_a_bit_in_any_corner_is_measured_as_far_as_distances_reach),
    };
    return cmocka_run_group_tests_name("distance_limits", tests, NULL, pass_context_close);
}
