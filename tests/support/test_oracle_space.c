/* SPDX-License-Identifier: MIT
 * The distance and ray references, against every set bit in turn. */
#include "test_memory.h"
#include "meshes.h"
#include "oracle_edt.h"
#include "oracle_trace.h"
#include "oracle_voxel.h"
#include "require.h"
#include <stdlib.h>

static const struct oracle_grid unit_grid = { { 0, 0, 0 }, { 1, 1, 1 } };

static double distance_by_definition(const struct oracle_bits *bits, const uint32_t cell[static 3],
                                     double y_scale)
{
    double best = INFINITY;
    for (uint32_t z = 0; z < bits->size; z++)
        for (uint32_t y = 0; y < bits->size; y++)
            for (uint32_t x = 0; x < bits->size; x++) {
                if (!oracle_bits_get(bits, x, y, z))
                    continue;
                const double dx = 4 * cell[0] + 2 - (x + 0.5), dz = 4 * cell[2] + 2 - (z + 0.5);
                const double dy = y_scale * (4 * cell[1] + 2 - (y + 0.5));
                best = fmin(best, sqrt(dx * dx + dy * dy + dz * dz) / 4);
            }
    return best;
}

static void require_distances(const struct oracle_bits *bits, double y_scale)
{
    const uint32_t cells = bits->size / 4;
    float *distance = oracle_edt_cells(bits, y_scale);
    for (uint32_t i = 0; i < cells * cells * cells; i++) {
        const uint32_t cell[3] = { i % cells, i / cells % cells, i / cells / cells };
        const double expected = distance_by_definition(bits, cell, y_scale);
        if (isinf(expected))
            REQUIRE_TRUE(isinf(distance[i]));
        else
            REQUIRE_NEAR(distance[i], expected, 1e-6 * expected);
    }
    free(distance);
}

static void distances_equal_the_nearest_of_all_bits(void **state)
{
    (void)state;
    const uint32_t counts[5] = { 0, 1, 3, 60, 3000 };
    const double scales[3] = { 1, 0.75, 0.5 };
    for (int i = 0; i < 15; i++) {
        struct oracle_bits bits = oracle_bits_random(20 + (uint32_t)i, 32, counts[i / 3]);
        require_distances(&bits, scales[i % 3]);
        oracle_bits_destroy(&bits);
    }
}

/* Row 7 of the hard cases: from one corner bit to the far corner of 128 cells is 220.6 cells. */
static void one_corner_bit_is_seen_across_the_whole_cascade(void **state)
{
    (void)state;
    struct oracle_bits bits = oracle_bits_create(512);
    oracle_bits_set(&bits, 0, 0, 0);
    float *distance = oracle_edt_cells(&bits, 1);
    REQUIRE_NEAR(distance[128 * 128 * 128 - 1], sqrt(3) * (127.5 - 0.125), 1e-4);
    REQUIRE_NEAR(distance[0], sqrt(3) * 0.375, 1e-6);
    free(distance);
    oracle_bits_destroy(&bits);
}

/* ---- Rays ---- */

static struct oracle_hit trace_by_definition(const struct oracle_bits *bits, const double origin[static 3],
                                             const double direction[static 3])
{
    struct oracle_hit best = { .distance = INFINITY };
    for (uint32_t i = 0; i < bits->size * bits->size * bits->size; i++) {
        const uint32_t c[3] = { i % bits->size, i / bits->size % bits->size, i / bits->size / bits->size };
        if (!oracle_bits_get(bits, c[0], c[1], c[2]))
            continue;
        double range[2];
        int axis;
        const double high[3] = { c[0] + 1.0, c[1] + 1.0, c[2] + 1.0 };
        if (oracle_trace_box(origin, direction, (double[]){ c[0], c[1], c[2] }, high, range, &axis) &&
            range[0] < best.distance)
            best = (struct oracle_hit){ true, range[0], { c[0], c[1], c[2] }, axis };
    }
    return best;
}

static void rays_hit_the_nearest_of_all_bits(void **state)
{
    (void)state;
    struct test_random random = { 31 };
    struct oracle_bits bits = oracle_bits_random(5, 24, 150);
    uint32_t hits = 0;
    for (uint32_t i = 0; i < 3000; i++) {
        double origin[3], direction[3];
        for (int k = 0; k < 3; k++)
            origin[k] = test_random_real(&random, -6, 30);
        test_random_direction(&random, direction);
        if (i % 5 == 0)
            direction[i % 3] = 0;
        if (i % 7 == 0)
            direction[(i + 1) % 3] = 0;
        const struct oracle_hit fast = oracle_trace(&bits, origin, direction, INFINITY);
        const struct oracle_hit slow = trace_by_definition(&bits, origin, direction);
        REQUIRE_CMP((int)fast.hit, ==, (int)slow.hit);
        if (!slow.hit)
            continue;
        hits++;
        REQUIRE_NEAR(fast.distance, slow.distance, 1e-9);
        for (int k = 0; k < 3; k++)
            REQUIRE_CMP(fast.coord[k], ==, slow.coord[k]);
        REQUIRE_CMP(fast.axis, ==, slow.axis);
        REQUIRE_TRUE(!oracle_trace(&bits, origin, direction, fast.distance - 1e-6).hit);
    }
    REQUIRE_CMP(hits, >, 200);
    oracle_bits_destroy(&bits);
}

static void rays_do_not_leave_a_closed_voxel_surface(void **state)
{
    (void)state;
    struct test_random random = { 77 };
    const double center[3] = { 31.7, 32.4, 32.1 };
    struct test_mesh mesh = test_mesh_bumpy_sphere(center, 22, 0.2, 5);
    struct oracle_bits bits = oracle_bits_create(64);
    oracle_voxel_separating(&bits, &unit_grid, &mesh, 0);
    for (uint32_t i = 0; i < 200000; i++) {
        double direction[3];
        test_random_direction(&random, direction);
        REQUIRE_TRUE(oracle_trace(&bits, center, direction, INFINITY).hit);
    }
    oracle_bits_destroy(&bits);
    test_mesh_destroy(&mesh);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(distances_equal_the_nearest_of_all_bits),
        cmocka_unit_test(one_corner_bit_is_seen_across_the_whole_cascade),
        cmocka_unit_test(rays_hit_the_nearest_of_all_bits),
        cmocka_unit_test(rays_do_not_leave_a_closed_voxel_surface),
    };
    return cmocka_run_group_tests_name("oracle_space", tests, NULL, NULL);
}
