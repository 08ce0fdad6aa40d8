/* SPDX-License-Identifier: MIT
 * A list of light cells that was too short ends as one that had room from the start. */
#include "light_scene.h"
#include "require.h"
#include "test_group.h"

#include <stdio.h>
#include <stdlib.h>

enum { POINTS = 3 };

struct outcome {
    uint32_t *list, *direct, *counters;
    uint64_t room;
    float irradiance[POINTS][3];
};

static struct sdfgi_settings two_cascades(void)
{
    struct sdfgi_settings settings = light_settings(32, 0.4f);
    settings.cascades = 2;
    return settings;
}

static void build_scene(struct gi_test *t)
{
    const double center[3] = { 0, 0, 0 }, half[3] = { 3, 2.4, 3 };
    light_add(t, test_mesh_room(center, half, 1, test_rotation_none), 0.6f, 0);
    light_add_box(t, (double[]){ 0.5, -2.4, 0.3 }, (double[]){ 1.7, -0.8, 1.6 },
                  (float[]){ 0.8f, 0.2f, 0.1f }, 0);
    const struct sdfgi_light_desc lamp = light_point(-0.4, 0.9, -0.2, 10);
    light_create(t, &lamp);
}

static void lower_room(struct gi_test *t, uint64_t room)
{
    t->gi->volume.resources->extent.light_cells = room;
}

static struct outcome take(struct gi_test *t)
{
    static const struct gi_test_point points[POINTS] = { { { 0.2f, -2.3f, -0.9f }, { 0, 1, 0 } },
                                                         { { -2.8f, 0.1f, 0.4f }, { 1, 0, 0 } },
                                                         { { 0.3f, 2.2f, 0.8f }, { 0, -1, 0 } } };
    struct outcome o = { .list = gi_test_read(t, RESOURCE_LIGHT_CELLS, NULL),
                         .direct = gi_test_read(t, RESOURCE_DIRECT, NULL),
                         .counters = gi_test_read(t, RESOURCE_COUNTERS, NULL),
                         .room = t->gi->volume.resources->extent.light_cells };
    gi_test_irradiance(t, points, POINTS, o.irradiance);
    return o;
}

static void destroy(struct outcome *o)
{
    free(o->list);
    free(o->direct);
    free(o->counters);
}

/* Places, masks and direct light are the same bits; what bounced is the same to where convergence stops. */
static void require_same(const struct outcome *a, const struct outcome *b)
{
    for (uint32_t c = 0; c < 2; c++) {
        const uint32_t count = a->counters[SDFGI_COUNTER_LIGHT_CELLS + c];
        REQUIRE_CMP(count, ==, b->counters[SDFGI_COUNTER_LIGHT_CELLS + c]);
        REQUIRE_CMP(count, <=, a->room);
        REQUIRE_CMP(count, <=, b->room);
        REQUIRE_BYTES(a->list + c * a->room, b->list + c * b->room, 4ul * count);
        for (uint32_t i = 0; i < count; i++) {
            const struct gi_test_direct x = gi_test_direct_at(a->direct, a->room, c, i),
                                        y = gi_test_direct_at(b->direct, b->room, c, i);
            REQUIRE_BYTES(&x, &y, sizeof x);
        }
    }
    for (int i = 0; i < POINTS; i++)
        for (int k = 0; k < 3; k++) {
            REQUIRE_CMP(b->irradiance[i][k], >, 0.05f);
            REQUIRE_NEAR((double)a->irradiance[i][k] / (double)b->irradiance[i][k], 1, 0.005);
        }
}

static struct outcome run_with_room(void)
{
    struct gi_test t;
    const struct sdfgi_settings settings = two_cascades();
    gi_test_open(&t, &settings);
    build_scene(&t);
    gi_test_converge(&t, 200);
    REQUIRE_CMP(light_health(&t, SDFGI_MESSAGE_LIGHT_CELLS_OVERFLOW), ==, 0ul);
    struct outcome o = take(&t);
    REQUIRE_CMP(o.room, ==, 23 * 32 * 32ul / 4);
    gi_test_close(&t);
    return o;
}

/* Overflow shows in the report, then goes with no host's doing: two frames in flight later the list has room.
 */
static void a_list_that_is_too_short_grows(void **state)
{
    (void)state;
    struct gi_test t;
    static struct sdfgi_report report;
    const struct sdfgi_settings settings = two_cascades();
    gi_test_open(&t, &settings);
    build_scene(&t);
    lower_room(&t, 100);
    gi_test_update(&t, 1);
    const VkDescriptorSet set = sdfgi_get_descriptor_set(t.gi);
    gi_test_update(&t, 1);
    REQUIRE_TRUE(sdfgi_get_descriptor_set(t.gi) == set);
    gi_test_update(&t, 1);
    REQUIRE_TRUE(sdfgi_get_descriptor_set(t.gi) != set);
    sdfgi_get_report(t.gi, &report);
    REQUIRE_TRUE(report.passes[PASS_LIGHT_LIST].ran && report.passes[PASS_LIGHT_DIRECT].ran &&
                 report.passes[PASS_CELL_MASK].ran);
    REQUIRE_TRUE(!report.passes[PASS_VOXELIZE].ran && !report.passes[PASS_DISTANCE_EXACT].ran);
    const uint32_t frames = 3 + gi_test_converge(&t, 200);
    REQUIRE_CMP(light_health(&t, SDFGI_MESSAGE_LIGHT_CELLS_OVERFLOW), ==, 0ul);
    REQUIRE_CMP(t.messages[SDFGI_MESSAGE_LIGHT_CELLS_OVERFLOW], ==, 0u);
    REQUIRE_TRUE(t.gi->backend.retired.first == NULL);

    struct outcome grown = take(&t), roomy = run_with_room();
    const uint32_t *n = &grown.counters[SDFGI_COUNTER_LIGHT_CELLS];
    const uint32_t most = n[0] > n[1] ? n[0] : n[1];
    printf("%u and %u light cells, room for %llu, settled after %u frames\n", n[0], n[1],
           (unsigned long long)grown.room, frames);
    REQUIRE_CMP(grown.room, ==, most + most / 8ul);
    require_same(&grown, &roomy);

    /* The report tells what is allocated: everything but the list is as estimated. */
    struct sdfgi_memory estimate;
    REQUIRE_CMP(sdfgi_estimate_memory(&settings, 2, &estimate), ==, SDFGI_OK);
    sdfgi_get_report(t.gi, &report);
    REQUIRE_CMP(report.memory.bytes[SDFGI_MEMORY_LISTS] + 2 * 64 * roomy.room, ==,
                estimate.bytes[SDFGI_MEMORY_LISTS] + 2 * 64 * grown.room);
    destroy(&grown);
    destroy(&roomy);
    gi_test_close(&t);
}

/* Light had settled in what little it reached: a list that grows sets it going again. */
static void a_settled_scene_goes_on_when_its_list_grows(void **state)
{
    (void)state;
    struct gi_test t;
    const struct sdfgi_settings settings = two_cascades();
    gi_test_open(&t, &settings);
    build_scene(&t);
    const uint64_t most = t.gi->volume.resources->extent.light_cells_max;
    lower_room(&t, 300);
    t.gi->volume.resources->extent.light_cells_max = 300;
    gi_test_converge(&t, 200);
    REQUIRE_CMP(light_health(&t, SDFGI_MESSAGE_LIGHT_CELLS_OVERFLOW), >, 0ul);
    t.gi->volume.resources->extent.light_cells_max = most;
    t.gi->volume.feedback.light_cells_refused = 0;
    gi_test_converge(&t, 200);
    REQUIRE_CMP(light_health(&t, SDFGI_MESSAGE_LIGHT_CELLS_OVERFLOW), ==, 0ul);
    struct outcome grown = take(&t), roomy = run_with_room();
    require_same(&grown, &roomy);
    destroy(&grown);
    destroy(&roomy);
    gi_test_close(&t);
}

TEST_GROUP(list_growth)
{
    if (!gpu_test_available())
        return GPU_TEST_SKIP;
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_list_that_is_too_short_grows),
        cmocka_unit_test(a_settled_scene_goes_on_when_its_list_grows),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
