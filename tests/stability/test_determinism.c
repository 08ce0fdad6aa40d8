/* SPDX-License-Identifier: MIT
 * The same input gives the same bits: in another context, after switching off and on, and whatever memory
 * held before (HARD_CASES row 58). */
#include "hard_case.h"
#include "light_scene.h"
#include "require.h"
#include "test_group.h"
#include "test_memory.h"

#include <stdio.h>
#include <stdlib.h>

static const enum resource compared[] = { RESOURCE_BITS,     RESOURCE_DISTANCE,    RESOURCE_ALBEDO,
                                          RESOURCE_EMISSION, RESOURCE_NORMALS,     RESOURCE_LIGHT,
                                          RESOURCE_MASKS,    RESOURCE_PROBES,      RESOURCE_PREVIOUS,
                                          RESOURCE_SUMS,     RESOURCE_LIGHT_CELLS, RESOURCE_DIRECT };
enum { COMPARED = sizeof compared / sizeof compared[0] };

/* Everything that lookups and later frames read. */
struct snapshot {
    void *buffers[COMPARED];
    uint64_t sizes[COMPARED];
    float irradiance[64][3];
};

static struct sdfgi_settings two_cascades(void)
{
    struct sdfgi_settings settings = light_settings(32, 0.5f);
    settings.cascades = 2;
    return settings;
}

static void build_scene(struct gi_test *t, uint32_t first_row)
{
    static const float colors[4][3] = {
        { 0.7f, 0.7f, 0.6f }, { 0.8f, 0.1f, 0.1f }, { 0.1f, 0.5f, 0.2f }, { 0.3f, 0.3f, 0.9f }
    };
    static const double boxes[4][2][3] = { { { -4, -3, -4 }, { 4, -2, 4 } },
                                           { { -4, -2, -4 }, { -3, 2, 3 } },
                                           { { 1.1, -2, -1.3 }, { 2.3, -0.7, 0.2 } },
                                           { { -0.5, -1.9, 2.2 }, { 0.9, 0.4, 2.5 } } };
    for (uint32_t i = 0; i < 4; i++) {
        const uint32_t row = (first_row + i) % 4;
        light_add_box(t, boxes[row][0], boxes[row][1], colors[row], row == 3 ? 2 : 0);
    }
    /* Overlapping triangles meet in one block: their sums must not depend on order. */
    const double low[3] = { -3, -1, -3 }, high[3] = { 3, 2, 3 };
    light_add(t, test_mesh_soup(11, 40, low, high, 0.8), 0.4f, 0);
    const struct sdfgi_light_desc sun = light_sun(-0.5f, -0.8f, 0.2f, 5),
                                  lamp = light_point(0.3, 0.5, 0.4, 3);
    light_create(t, &sun);
    light_create(t, &lamp);
    REQUIRE_CMP(
        sdfgi_set_sky(t->gi, &(struct sdfgi_sky){ { 0.5f, 0.7f, 1 }, { 1, 1, 1 }, { 0.2f, 0.2f, 0.1f } }), ==,
        SDFGI_OK);
}

/* What is as long as the list of light cells, with so many bytes an entry in so many planes; what lies behind
 * the last entry of a cascade belongs to nobody. */
static void *take_list(struct gi_test *t, enum resource resource, uint64_t bytes, uint32_t planes,
                       uint64_t *size)
{
    uint8_t *list = gi_test_read(t, resource, size);
    uint32_t *counters = gi_test_read(t, RESOURCE_COUNTERS, NULL);
    const uint64_t room = t->gi->volume.resources->extent.light_cells;
    *size = bytes * planes * room * t->gi->settings.cascades;
    for (uint32_t p = 0; p < planes * t->gi->settings.cascades; p++) {
        const uint64_t count = counters[SDFGI_COUNTER_LIGHT_CELLS + p / planes];
        if (count < room)
            memset(list + bytes * (p * room + count), 0, bytes * (room - count));
    }
    free(counters);
    return list;
}

static void *take_buffer(struct gi_test *t, enum resource resource, uint64_t *size)
{
    if (resource == RESOURCE_LIGHT_CELLS)
        return take_list(t, resource, 4, 1, size);
    if (resource == RESOURCE_DIRECT)
        return take_list(t, resource, 4, SDFGI_DIRECT_WORDS, size);
    return resource == RESOURCE_LIGHT ? take_list(t, resource, 4, 6, size) : gi_test_read(t, resource, size);
}

static struct snapshot take(struct gi_test *t)
{
    struct snapshot s;
    for (int i = 0; i < COMPARED; i++)
        s.buffers[i] = take_buffer(t, compared[i], &s.sizes[i]);
    struct gi_test_point points[64];
    struct test_random random = { 5 };
    for (int i = 0; i < 64; i++) {
        double normal[3];
        test_random_direction(&random, normal);
        for (int k = 0; k < 3; k++) {
            points[i].position[k] = (float)test_random_real(&random, -9, 9);
            points[i].normal[k] = (float)normal[k];
        }
    }
    gi_test_irradiance(t, points, 64, s.irradiance);
    return s;
}

static uint64_t bytes_differ(const void *a, const void *b, uint64_t size, const char *name)
{
    uint64_t count = 0;
    for (uint64_t i = 0; i < size; i++)
        count += ((const uint8_t *)a)[i] != ((const uint8_t *)b)[i];
    if (count > 0)
        printf("%s: %llu bytes differ\n", name, (unsigned long long)count);
    return count;
}

static void require_same(struct snapshot *a, struct snapshot *b)
{
    uint64_t differ = bytes_differ(a->irradiance, b->irradiance, sizeof a->irradiance, "light");
    for (int i = 0; i < COMPARED; i++) {
        REQUIRE_CMP(a->sizes[i], ==, b->sizes[i]);
        differ +=
            bytes_differ(a->buffers[i], b->buffers[i], a->sizes[i], sdfgi_resource_row(compared[i])->name);
        free(a->buffers[i]);
        free(b->buffers[i]);
    }
    HARD_CASE_AT_MOST(58, "bytes that differ", differ, 0);
}

static struct snapshot run_fresh(uint32_t first_row)
{
    struct gi_test t;
    const struct sdfgi_settings settings = two_cascades();
    gi_test_open(&t, &settings);
    build_scene(&t, first_row);
    gi_test_update(&t, 14);
    REQUIRE_CMP(light_health(&t, SDFGI_MESSAGE_LIGHT_CELLS_OVERFLOW), ==, 0ul);
    struct snapshot s = take(&t);
    gi_test_close(&t);
    return s;
}

static void hard_58_two_contexts_give_the_same_bits(void **state)
{
    (void)state;
    struct snapshot a = run_fresh(0), b = run_fresh(0);
    require_same(&a, &b);
}

static void hard_58_order_of_instances_does_not_matter(void **state)
{
    (void)state;
    struct snapshot a = run_fresh(0), b = run_fresh(2);
    require_same(&a, &b);
}

static struct snapshot run_short_of_room(uint32_t first_row)
{
    struct gi_test t;
    const struct sdfgi_settings settings = two_cascades();
    gi_test_open(&t, &settings);
    t.gi->volume.resources->extent.light_cells = t.gi->volume.resources->extent.light_cells_max = 400;
    build_scene(&t, first_row);
    gi_test_update(&t, 14);
    REQUIRE_CMP(light_health(&t, SDFGI_MESSAGE_LIGHT_CELLS_OVERFLOW), >, 400ul);
    struct snapshot s = take(&t);
    gi_test_close(&t);
    return s;
}

static void hard_58_holds_where_the_light_list_overflows(void **state)
{
    (void)state;
    struct snapshot a = run_short_of_room(0), b = run_short_of_room(2);
    require_same(&a, &b);
}

/* Memory that another scene has used, and that the allocator hands out again, holds garbage. */
static void garbage_in_memory_does_not_matter(void **state)
{
    (void)state;
    struct gi_test t;
    struct sdfgi_settings settings = two_cascades();
    gi_test_open(&t, &settings);
    build_scene(&t, 0);
    for (int round = 0; round < 2; round++) {
        t.frame.camera_position[0] = 7.3 * (round + 1);
        t.frame.seed = 17;
        gi_test_update(&t, 6);
        settings.enabled = false;
        REQUIRE_CMP(sdfgi_set_settings(t.gi, &settings), ==, SDFGI_OK);
        gi_test_update(&t, 4);
        settings.enabled = true;
        REQUIRE_CMP(sdfgi_set_settings(t.gi, &settings), ==, SDFGI_OK);
    }
    t.frame.camera_position[0] = 0;
    t.frame.seed = 0;
    gi_test_update(&t, 14);
    struct snapshot used = take(&t);
    gi_test_close(&t);
    struct snapshot fresh = run_fresh(0);
    require_same(&used, &fresh);
}

/* A camera that leaves and comes back finds the same volumes (light has its own history until it converges).
 */
static void going_away_and_coming_back_restores_the_volumes(void **state)
{
    (void)state;
    struct gi_test t;
    const struct sdfgi_settings settings = two_cascades();
    gi_test_open(&t, &settings);
    build_scene(&t, 0);
    gi_test_update(&t, 2);
    struct snapshot before = take(&t);
    t.frame.camera_position[0] = 40;
    t.frame.camera_position[2] = -25;
    gi_test_update(&t, 2);
    t.frame.camera_position[0] = t.frame.camera_position[2] = 0;
    gi_test_update(&t, 2);
    struct snapshot after = take(&t);
    for (int i = 0; i < COMPARED; i++) {
        const enum resource r = compared[i];
        if (r != RESOURCE_LIGHT && r != RESOURCE_PREVIOUS && r != RESOURCE_SUMS)
            REQUIRE_BYTES(before.buffers[i], after.buffers[i], before.sizes[i]);
        free(before.buffers[i]);
        free(after.buffers[i]);
    }
    gi_test_close(&t);
}

/* The same cycle in 4 frames of 125 rays and in 20 of 25: converged light differs by summing order alone. */
static void frame_slicing_does_not_change_converged_light(void **state)
{
    (void)state;
    static const uint32_t slices[2][2] = { { 125, 4 }, { 25, 20 } };
    float found[2][3];
    for (int i = 0; i < 2; i++) {
        struct gi_test t;
        struct sdfgi_settings settings = light_settings(32, 0.5f);
        settings.ray_count = slices[i][0];
        settings.frames_to_converge = slices[i][1];
        gi_test_open(&t, &settings);
        build_scene(&t, 0);
        gi_test_converge(&t, 400);
        REQUIRE_CMP(light_health(&t, SDFGI_MESSAGE_LIGHT_CELLS_OVERFLOW), ==, 0ul);
        light_at(&t, (struct gi_test_point){ { 0.2f, -1.9f, 0.3f }, { 0, 1, 0 } }, found[i]);
        gi_test_close(&t);
    }
    printf("in 4 frames (%.5f %.5f %.5f), in 20 (%.5f %.5f %.5f)\n", (double)found[0][0], (double)found[0][1],
           (double)found[0][2], (double)found[1][0], (double)found[1][1], (double)found[1][2]);
    /* Both stop when a cycle changes light by less than 1/512. */
    for (int k = 0; k < 3; k++)
        REQUIRE_NEAR((double)found[0][k] / (double)found[1][k], 1, 0.005);
}

TEST_GROUP(determinism)
{
    if (!gpu_test_available())
        return GPU_TEST_SKIP;
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(hard_58_two_contexts_give_the_same_bits),
        cmocka_unit_test(hard_58_order_of_instances_does_not_matter),
        cmocka_unit_test(hard_58_holds_where_the_light_list_overflows),
        cmocka_unit_test(garbage_in_memory_does_not_matter),
        cmocka_unit_test(going_away_and_coming_back_restores_the_volumes),
        cmocka_unit_test(frame_slicing_does_not_change_converged_light),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
