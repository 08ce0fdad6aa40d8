/* SPDX-License-Identifier: MIT
 * The descriptor set that hosts bind is there from the start: while there is no light to show, lookups are
 * black. */
#include "gi_test.h"
#include "require.h"
#include "test_group.h"

#include <vulkan/vulkan.h>

#include <stdio.h>

static struct sdfgi_settings settings(bool enabled)
{
    struct sdfgi_settings s = gi_test_settings();
    s.resolution = 32;
    s.enabled = enabled;
    return s;
}

/* A context that is off, in the middle of a bright room. */
static void open_room(struct gi_test *t)
{
    const struct sdfgi_settings off = settings(false);
    gi_test_open(t, &off);
    struct test_mesh room =
        test_mesh_room((double[]){ 0, 0, 0 }, (double[]){ 2, 2, 2 }, 0.5, test_rotation_none);
    gi_test_add(t, &room, gi_test_material(t, (float[]){ 0.5f, 0.5f, 0.5f }, (float[]){ 3, 4, 5 }));
    test_mesh_destroy(&room);
}

static void enable(struct gi_test *t, bool enabled)
{
    const struct sdfgi_settings s = settings(enabled);
    REQUIRE_CMP((int)sdfgi_set_settings(t->gi, &s), ==, (int)SDFGI_OK);
}

enum { POINTS = 3 };

static const struct gi_test_point points[POINTS] = { { { 0.3f, -1.9f, 0.2f }, { 0, 1, 0 } },
                                                     { { 0, 0, 0 }, { 1, 0, 0 } },
                                                     { { 1e4f, -1e4f, 1e4f }, { 0, 0, 1 } } };

static void require_black(struct gi_test *t, VkDescriptorSet set)
{
    float found[POINTS][3];
    REQUIRE_TRUE(set != VK_NULL_HANDLE);
    gi_test_lookup(t, set, NULL, points, POINTS, found);
    for (int i = 0; i < POINTS; i++)
        for (int k = 0; k < 3; k++)
            REQUIRE_CMP(found[i][k], ==, 0.0f);
}

/* Two frames of light, which is there. */
static void require_light(struct gi_test *t)
{
    float found[POINTS][3];
    gi_test_update(t, 2);
    gi_test_irradiance(t, points, POINTS, found);
    for (int k = 0; k < 3; k++)
        REQUIRE_CMP(found[0][k], >, 0.1f);
}

static uint32_t commands(const struct gi_test *t)
{
    static struct sdfgi_report report;
    sdfgi_get_report(t->gi, &report);
    return report.command_count;
}

/* A frame of a context that is off records nothing: there is nothing that it could record into. */
static void require_idle_frame(struct gi_test *t)
{
    REQUIRE_CMP((int)sdfgi_update(t->gi, VK_NULL_HANDLE, &t->frame), ==, (int)SDFGI_OK);
    REQUIRE_CMP(commands(t), ==, 0u);
}

/* The host makes one pipeline for all of it. */
static void lookups_are_black_until_there_is_light_and_once_it_is_off(void **state)
{
    (void)state;
    static struct gi_test t;
    open_room(&t);
    const VkDescriptorSet blank = sdfgi_get_descriptor_set(t.gi);
    require_black(&t, blank);
    const VkPipeline pipeline = t.gpu.kept.pipeline;
    REQUIRE_CMP(commands(&t), ==, 0u);
    require_idle_frame(&t);
    for (int round = 0; round < 2; round++) {
        enable(&t, true);
        REQUIRE_TRUE(sdfgi_get_descriptor_set(t.gi) == blank && !sdfgi_is_active(t.gi));
        require_black(&t, sdfgi_get_descriptor_set(t.gi));
        REQUIRE_CMP(commands(&t), ==, 0u);
        require_light(&t);
        REQUIRE_TRUE(sdfgi_get_descriptor_set(t.gi) != blank);
        enable(&t, false);
        REQUIRE_TRUE(sdfgi_get_descriptor_set(t.gi) == blank && !sdfgi_is_active(t.gi));
        require_black(&t, sdfgi_get_descriptor_set(t.gi));
        require_idle_frame(&t);
        require_black(&t, sdfgi_get_descriptor_set(t.gi));
    }
    REQUIRE_TRUE(t.gpu.kept.pipeline == pipeline);
    gi_test_close(&t);
}

/* Volumes of another size hold no light yet. */
static void lookups_are_black_after_a_change_that_recreates_everything(void **state)
{
    (void)state;
    static struct gi_test t;
    open_room(&t);
    enable(&t, true);
    require_light(&t);
    struct sdfgi_settings other = settings(true);
    other.cascades = 2;
    REQUIRE_CMP((int)sdfgi_set_settings(t.gi, &other), ==, (int)SDFGI_OK);
    require_black(&t, sdfgi_get_descriptor_set(t.gi));
    require_light(&t);
    gi_test_close(&t);
}

/* A shader stage may have few of them on some devices, and hosts need some of their own. */
static void the_set_of_hosts_has_at_most_8_storage_buffers(void **state)
{
    (void)state;
    uint32_t storage = 0;
    for (int i = 0; i < RESOURCE_COUNT; i++) {
        const struct resource_row *row = sdfgi_resource_row((enum resource)i);
        storage += row->set == RESOURCE_SET_LOOKUP && row->kind == RESOURCE_KIND_STORAGE;
    }
    printf("%u storage buffers\n", storage);
    REQUIRE_CMP(storage, >, 0u);
    REQUIRE_CMP(storage, <=, 8u);
}

static void the_blank_set_holds_at_most_64_kib(void **state)
{
    (void)state;
    static struct gi_test t;
    open_room(&t);
    VkMemoryRequirements needed;
    vkGetBufferMemoryRequirements(t.gpu.device, t.gi->blank.buffer.handle, &needed);
    printf("the blank set holds %llu bytes\n", (unsigned long long)needed.size);
    REQUIRE_CMP(needed.size, >=, t.gi->blank.buffer.size);
    REQUIRE_CMP(needed.size, <=, 65536ul);
    gi_test_close(&t);
}

TEST_GROUP(blank_set)
{
    if (!gpu_test_available())
        return GPU_TEST_SKIP;
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(lookups_are_black_until_there_is_light_and_once_it_is_off),
        cmocka_unit_test(lookups_are_black_after_a_change_that_recreates_everything),
        cmocka_unit_test(the_set_of_hosts_has_at_most_8_storage_buffers),
        cmocka_unit_test(the_blank_set_holds_at_most_64_kib),
    };
    return cmocka_run_group_tests_name("api_blank_set", tests, NULL, NULL);
}
