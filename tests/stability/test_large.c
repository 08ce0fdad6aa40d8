/* SPDX-License-Identifier: MIT
 * Cascades that are too large to be voxelised at once, and many of them. */
#include "light_scene.h"
#include "require.h"
#include "test_group.h"
#include "test_memory.h"

#include "shaders/shared/scratch.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

static const enum resource volumes[] = { RESOURCE_BITS, RESOURCE_ALBEDO, RESOURCE_EMISSION, RESOURCE_NORMALS,
                                         RESOURCE_DISTANCE };
enum { VOLUMES = sizeof volumes / sizeof *volumes };

struct copies {
    uint8_t *bytes[VOLUMES];
    uint64_t size[VOLUMES];
};

static struct copies read_volumes(struct gi_test *t)
{
    struct copies c;
    for (int i = 0; i < VOLUMES; i++)
        c.bytes[i] = gi_test_read(t, volumes[i], &c.size[i]);
    return c;
}

static void require_equal_and_destroy(struct copies *a, struct copies *b)
{
    for (int i = 0; i < VOLUMES; i++) {
        REQUIRE_CMP(a->size[i], ==, b->size[i]);
        REQUIRE_BYTES(a->bytes[i], b->bytes[i], a->size[i]);
        free(a->bytes[i]);
        free(b->bytes[i]);
    }
}

/* A turned torus through the whole cascade that emits a little, in it a triangle that is skipped. */
static void add_torus(struct gi_test *t, double size)
{
    double turned[9];
    test_rotation((double[]){ 3, 1, 2 }, 0.6, turned);
    struct test_mesh mesh =
        test_mesh_torus((double[]){ 0.3, -0.2, 0.1 }, 0.3 * size, 0.12 * size, turned, 60, 30);
    mesh.indices[3 * 1000] = mesh.vertex_count;
    light_add(t, mesh, 0.5f, 0.125f);
}

/* A rebuild takes the largest parts that there is room for. What is invalidated comes in pieces of a frame's
 * budget, which end elsewhere. */
static void require_parts_do_not_show(uint32_t resolution)
{
    static struct gi_test t;
    struct sdfgi_settings settings = light_settings(resolution, 0.125f);
    settings.max_scroll_cells = resolution * resolution * 40;
    settings.ray_count = settings.frames_to_converge = 1; /* light does not matter */
    gi_test_open(&t, &settings);
    REQUIRE_CMP(sdfgi_scratch_part_cells(sdfgi_log2(resolution)), <, t.gi->volume.resources->extent.cells);
    add_torus(&t, 0.125 * resolution);
    gi_test_update(&t, 3); /* what is counted comes back after two frames */
    REQUIRE_CMP(light_health(&t, SDFGI_MESSAGE_TRIANGLES_SKIPPED), ==, 1);
    struct copies rebuilt = read_volumes(&t);
    REQUIRE_CMP(sdfgi_invalidate_box(t.gi, (double[]){ -99, -99, -99 }, (double[]){ 99, 99, 99 }), ==,
                SDFGI_OK);
    gi_test_update(&t, 1);
    REQUIRE_TRUE(t.gi->volume.state.cascades.at[0].change.cause !=
                 CHANGE_NONE); /* several frames, so other parts */
    for (int i = 0; i < 20 && t.gi->volume.state.cascades.at[0].change.cause != CHANGE_NONE; i++)
        gi_test_update(&t, 1);
    REQUIRE_TRUE(t.gi->volume.state.cascades.at[0].change.cause == CHANGE_NONE);
    struct copies invalidated = read_volumes(&t);
    require_equal_and_destroy(&rebuilt, &invalidated);
    gi_test_close(&t);
}

static void parts_of_128_cells_do_not_show(void **state)
{
    (void)state;
    require_parts_do_not_show(128);
}

static void parts_of_256_cells_do_not_show(void **state)
{
    (void)state;
    require_parts_do_not_show(256);
}

/* Squared distance, in sub-voxels, from the centre of a cell to the nearest set bit within reach of it. */
static double nearest_bit(const struct oracle_bits *bits, const uint32_t cell[static 3])
{
    const int reach = 4 * SDFGI_DISTANCE_REACH;
    int low[3], high[3];
    double best = (double)reach * reach;
    for (int i = 0; i < 3; i++) {
        low[i] = (int)fmax(4.0 * cell[i] + 2 - reach, 0);
        high[i] = (int)fmin(4.0 * cell[i] + 2 + reach, bits->size);
    }
    for (int z = low[2]; z < high[2]; z++)
        for (int y = low[1]; y < high[1]; y++)
            for (int x = low[0]; x < high[0]; x++)
                if (oracle_bits_get(bits, (uint32_t)x, (uint32_t)y, (uint32_t)z)) {
                    const double d[3] = { x + 0.5 - 4.0 * cell[0] - 2, y + 0.5 - 4.0 * cell[1] - 2,
                                          z + 0.5 - 4.0 * cell[2] - 2 };
                    best = fmin(best, d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
                }
    return best;
}

static void distances_of_256_cells_are_exact(void **state)
{
    (void)state;
    enum { SAMPLES = 300, N = 256 };
    static struct gi_test t;
    const struct sdfgi_settings settings = light_settings(N, 0.125f);
    gi_test_open(&t, &settings);
    add_torus(&t, 0.125 * N);
    gi_test_update(&t, 1);
    struct oracle_bits bits = gi_test_bits(&t, 0);
    float *stored = gi_test_distances(&t, 0);
    struct test_random random = { 256 };
    uint32_t reached = 0;
    for (int i = 0; i < SAMPLES; i++) {
        uint32_t cell[3];
        double found;
        do { /* half of them near a surface */
            for (int k = 0; k < 3; k++)
                cell[k] = test_random_uint(&random) % N;
            found = (double)stored[cell[0] + N * (cell[1] + N * cell[2])];
        } while (i % 2 == 0 && found >= SDFGI_DISTANCE_REACH);
        const double exact = sqrt(nearest_bit(&bits, cell)) / 4;
        reached += exact < SDFGI_DISTANCE_REACH;
        /* Stored in 1/128 cell, rounded down. */
        if (!(found <= exact + 1e-4 && found >= exact - 1.0 / 128 - 1e-4))
            require_fail(__FILE__, __LINE__, "cell %u %u %u: %g, not %g", cell[0], cell[1], cell[2], found,
                         exact);
    }
    printf("%u of %d samples within reach\n", reached, SAMPLES);
    REQUIRE_CMP(reached, >, SAMPLES / 3);
    free(stored);
    oracle_bits_destroy(&bits);
    gi_test_close(&t);
}

/* Light that needs no geometry is exact, at the eye and far away, whatever the size. */
static void require_sky_is_exact(uint32_t resolution, uint32_t cascades)
{
    static struct gi_test t;
    struct sdfgi_settings settings = light_settings(resolution, 0.125f);
    settings.cascades = cascades;
    settings.ray_count = 25;
    settings.frames_to_converge = 4;
    settings.surface_light = SDFGI_SURFACE_LIGHT_CELLS;
    gi_test_open(&t, &settings);
    light_set_uniform_sky(&t, 1);
    light_add_box(&t, (double[]){ -2, -3, -2 }, (double[]){ 2, -2, 2 }, (float[]){ 0.5f, 0.5f, 0.5f }, 0);
    gi_test_update(&t, 6);
    const float far = 0.4f * 0.125f * (float)resolution * exp2f((float)cascades - 1);
    const struct gi_test_point points[] = { { { 0, 1, 0 }, { 0, 1, 0 } }, { { far, far, 0 }, { 1, 0, 0 } } };
    float found[2][3];
    gi_test_irradiance(&t, points, 2, found);
    printf("%u^3, %u cascades: E / pi %.5f at the eye, %.5f at %.0f m\n", resolution, cascades,
           (double)found[0][0] / PI, (double)found[1][0] / PI, (double)far);
    REQUIRE_NEAR((double)found[0][0] / PI, 1, 0.01); /* the box below shows a little of its own light */
    REQUIRE_NEAR((double)found[1][0] / PI, 1, 1e-3);
    gi_test_close(&t);
}

static void sky_over_256_cells_is_exact(void **state)
{
    (void)state;
    require_sky_is_exact(256, 1);
}

static void sky_over_eight_cascades_is_exact(void **state)
{
    (void)state;
    require_sky_is_exact(128, 8);
}

/* The validation layer tells whether what is bound is within the device's limits, before anything runs. */
static void the_largest_volumes_are_within_limits(void **state)
{
    (void)state;
    static const uint32_t sizes[][2] = { { 256, 1 }, { 128, 8 } };
    for (size_t i = 0; i < sizeof sizes / sizeof *sizes; i++) {
        static struct gi_test t;
        struct sdfgi_settings settings = light_settings(sizes[i][0], 0.125f);
        settings.cascades = sizes[i][1];
        gi_test_open(&t, &settings);
        gi_test_close(&t);
    }
}

TEST_GROUP(large)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(parts_of_128_cells_do_not_show),
        cmocka_unit_test(the_largest_volumes_are_within_limits),
    };
    const struct CMUnitTest full[] = {
        cmocka_unit_test(parts_of_256_cells_do_not_show),
        cmocka_unit_test(distances_of_256_cells_are_exact),
        cmocka_unit_test(sky_over_256_cells_is_exact),
        cmocka_unit_test(sky_over_eight_cascades_is_exact),
    };
    return getenv("SDFGI_TEST_FULL") ? cmocka_run_group_tests(full, NULL, NULL)
                                     : cmocka_run_group_tests(tests, NULL, NULL);
}
