/* SPDX-License-Identifier: MIT
 * Device memory of the host's: all of it comes from there, all of it goes back, and the report counts the
 * same bytes. Any request may be refused. */
#include "counting_vulkan.h"
#include "failing_vulkan.h"
#include "gi_test.h"
#include "pool_allocator.h"
#include "require.h"
#include "test_group.h"

#include <stdio.h>

static struct gi_test t;
static struct pool_allocator pool;
static PFN_vkGetInstanceProcAddr loader; /* the library's */

static struct sdfgi_settings small_settings(bool enabled)
{
    struct sdfgi_settings s = gi_test_settings();
    s.resolution = 32;
    s.enabled = enabled;
    return s;
}

static int open_device(void **state)
{
    (void)state;
    gi_test_open_device(&t);
    return 0;
}

static int close_device(void **state)
{
    (void)state;
    gi_test_close(&t);
    return 0;
}

static enum sdfgi_result create(bool enabled)
{
    const struct sdfgi_settings settings = small_settings(enabled);
    struct sdfgi_desc desc = gi_test_desc(&t, &settings);
    desc.vulkan.get_instance_proc_addr = loader;
    desc.device_allocator = pool_allocator_functions(&pool);
    t.gi = NULL;
    return sdfgi_create(&desc, &t.gi);
}

static void enable(bool enabled)
{
    const struct sdfgi_settings settings = small_settings(enabled);
    REQUIRE_CMP((int)sdfgi_set_settings(t.gi, &settings), ==, (int)SDFGI_OK);
}

static void add_room(void)
{
    struct test_mesh room =
        test_mesh_room((double[]){ 0, 0, 0 }, (double[]){ 2, 2, 2 }, 0.5, test_rotation_none);
    gi_test_add(&t, &room, gi_test_material(&t, (float[]){ 0.5f, 0.5f, 0.5f }, (float[]){ 3, 4, 5 }));
    test_mesh_destroy(&room);
}

/* The host's books and the library's. */
static void require_same_bytes(void)
{
    static struct sdfgi_report report;
    sdfgi_get_report(t.gi, &report);
    for (int i = 0; i < SDFGI_MEMORY_CATEGORY_COUNT; i++)
        REQUIRE_CMP(pool_allocator_bytes(&pool, (enum sdfgi_memory_category)i), ==, report.memory.bytes[i]);
}

static sdfgi_view *create_view(bool reflections)
{
    const struct sdfgi_view_desc desc = { .width = 18, .height = 18, .reflections = reflections };
    sdfgi_view *view = NULL;
    REQUIRE_CMP((int)sdfgi_view_create(t.gi, &desc, &view), ==, (int)SDFGI_OK);
    return view;
}

static const struct gi_test_point point = { { 0.3f, -1.9f, 0.2f }, { 0, 1, 0 } };

static float light_of_room(void)
{
    float found[1][3];
    add_room(); /* emits: its first update asks for more */
    gi_test_update(&t, 4);
    gi_test_irradiance(&t, &point, 1, found);
    return found[0][1];
}

/* The same scene with memory of its own. */
static float light_without_the_hook(void)
{
    const struct sdfgi_settings on = small_settings(true);
    struct sdfgi_desc desc = gi_test_desc(&t, &on);
    desc.vulkan.get_instance_proc_addr = counting_vulkan_loader_sharing();
    REQUIRE_CMP((int)sdfgi_create(&desc, &t.gi), ==, (int)SDFGI_OK);
    const float light = light_of_room();
    gi_test_destroy(&t);
    return light;
}

static void all_memory_is_the_hosts_and_goes_back(void **state)
{
    (void)state;
    const float expected = light_without_the_hook();
    const uint32_t before = counting_vulkan_get().memory;
    loader = counting_vulkan_loader_sharing();
    pool_allocator_open(&pool, &t.gpu);
    REQUIRE_CMP((int)create(false), ==, (int)SDFGI_OK);
    REQUIRE_CMP(pool_allocator_live(&pool), ==, 1u); /* of lookups that answer black */
    require_same_bytes();
    enable(true);
    require_same_bytes();
    REQUIRE_CMP(light_of_room(), ==, expected);
    t.gi->volume.resources->extent.light_cells = 5; /* a list that is too short asks for more */
    add_room();
    gi_test_update(&t, 4);
    REQUIRE_CMP(t.gi->volume.resources->extent.light_cells, >, 5u);
    require_same_bytes();
    sdfgi_view *views[2] = { create_view(false), create_view(true) };
    REQUIRE_CMP(pool_allocator_bytes(&pool, SDFGI_MEMORY_VIEWS), >, 0u);
    require_same_bytes();
    sdfgi_view_destroy(t.gi, views[0]);
    gi_test_update(&t, 4);
    require_same_bytes();
    printf("%u requests, %u live in %u blocks\n", pool.calls, pool_allocator_live(&pool), pool.block_count);
    enable(false);
    gi_test_update(&t, 4);
    require_same_bytes();
    REQUIRE_CMP(counting_vulkan_get().memory, ==, before);
    gi_test_destroy(&t);
    pool_allocator_close(&pool);
}

/* ---- Refusals */

/* Every place that asks for memory. */
static enum sdfgi_result live_a_whole_life(void)
{
    const struct sdfgi_settings on = small_settings(true);
    const struct sdfgi_prepare_desc prepare = { .settings = &on };
    const struct sdfgi_view_desc view_desc = { .width = 18, .height = 18, .reflections = true };
    sdfgi_view *view;
    enum sdfgi_result result = create(false);
    if (result == SDFGI_OK)
        result = sdfgi_set_settings(t.gi, &on);
    if (result == SDFGI_OK)
        result = sdfgi_view_create(t.gi, &view_desc, &view);
    if (result == SDFGI_OK) {
        struct sdfgi_settings other = on;
        struct sdfgi_prepare_desc desc = prepare;
        other.cascades = 2;
        desc.settings = &other;
        result = sdfgi_prepare(t.gi, &desc, NULL);
    }
    return result;
}

/* Pipelines take far longer than all else: those made here are empty. */
static void any_refusal_is_an_error_that_leaves_nothing(void **state)
{
    (void)state;
    static const struct {
        VkResult failure;
        enum sdfgi_result result;
        enum sdfgi_message message;
    } kinds[] = {
        { VK_ERROR_OUT_OF_DEVICE_MEMORY, SDFGI_ERROR_OUT_OF_MEMORY, SDFGI_MESSAGE_OUT_OF_DEVICE_MEMORY },
        { VK_ERROR_OUT_OF_HOST_MEMORY, SDFGI_ERROR_OUT_OF_MEMORY, SDFGI_MESSAGE_OUT_OF_HOST_MEMORY },
        { VK_ERROR_FEATURE_NOT_PRESENT, SDFGI_ERROR_UNSUPPORTED, SDFGI_MESSAGE_VULKAN_FAILURE },
    };
    uint32_t k = 0;
    loader = failing_vulkan_get_instance_proc_addr;
    failing_vulkan_reset(0, VK_SUCCESS);
    failing_vulkan_skip_shaders(true);
    t.gpu.messages->quiet = true;
    for (bool failed = true; failed;) {
        pool_allocator_open(&pool, &t.gpu);
        memset(t.messages, 0, sizeof t.messages);
        pool.fail_at = ++k;
        pool.failure = kinds[k % 3].failure;
        const enum sdfgi_result result = live_a_whole_life();
        failed = pool.calls >= k;
        REQUIRE_CMP((int)result, ==, (int)(failed ? kinds[k % 3].result : SDFGI_OK));
        REQUIRE_CMP(t.messages[kinds[k % 3].message], ==, (uint32_t)failed);
        if (t.gi)
            require_same_bytes();
        gi_test_destroy(&t);
        pool_allocator_close(&pool);
    }
    t.gpu.messages->quiet = false;
    printf("%u requests can be refused\n", k - 1);
    REQUIRE_CMP(k, >, 60u);
}

static void what_a_careless_host_gives_is_refused(void **state)
{
    (void)state;
    static const int faults[] = { POOL_NULL, POOL_MISPLACED, POOL_UNMAPPED };
    static const char *const words[] = { "memory is null", "offset", "mapped is null" };
    t.gpu.messages->quiet = true;
    for (int i = 0; i < 3; i++) {
        pool_allocator_open(&pool, &t.gpu);
        pool.fault = faults[i];
        REQUIRE_CMP((int)create(false), ==, (int)SDFGI_ERROR_INVALID_ARGUMENT);
        REQUIRE_TRUE(t.gi == NULL && strstr(t.last_message, words[i]));
        pool_allocator_close(&pool);
    }
    struct sdfgi_desc desc = gi_test_desc(&t, NULL);
    desc.device_allocator = pool_allocator_functions(&pool);
    desc.device_allocator.free = NULL;
    REQUIRE_CMP((int)sdfgi_create(&desc, &t.gi), ==, (int)SDFGI_ERROR_INVALID_ARGUMENT);
    REQUIRE_TRUE(strstr(t.last_message, "device_allocator.free is null"));
    t.gpu.messages->quiet = false;
}

TEST_GROUP(device_memory)
{
    if (!gpu_test_available())
        return GPU_TEST_SKIP;
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(all_memory_is_the_hosts_and_goes_back),
        cmocka_unit_test(any_refusal_is_an_error_that_leaves_nothing),
        cmocka_unit_test(what_a_careless_host_gives_is_refused),
    };
    return cmocka_run_group_tests_name("api_device_memory", tests, open_device, close_device);
}
