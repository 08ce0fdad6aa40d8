/* SPDX-License-Identifier: MIT
 * sdfgi_prepare makes room for the instances of the scene, so that updates make none: counted by calls of
 * Vulkan. */
#include "counting_vulkan.h"
#include "gi_test.h"
#include "require.h"
#include "test_group.h"

#include <stdlib.h>

enum { MANY = 3000, SIDE = 50 }; /* more than there is room for at first; in rows of so many */

static struct gi_test t;

static struct sdfgi_settings settings(bool enabled)
{
    struct sdfgi_settings s = gi_test_settings();
    s.resolution = 32;
    s.ray_count = 4;
    s.enabled = enabled;
    return s;
}

static int open_context(void **state)
{
    (void)state;
    const struct sdfgi_settings off = settings(false);
    gi_test_open_device(&t);
    struct sdfgi_desc desc = gi_test_desc(&t, &off);
    desc.vulkan.get_instance_proc_addr = counting_vulkan_loader_sharing();
    desc.pipelines_later = true;
    REQUIRE_CMP((int)sdfgi_create(&desc, &t.gi), ==, (int)SDFGI_OK);
    return 0;
}

static int close_context(void **state)
{
    (void)state;
    gi_test_close(&t);
    return 0;
}

/* A floor of boxes that glow. */
static void add_instances(void)
{
    static struct sdfgi_instance_desc descs[MANY];
    static sdfgi_instance handles[MANY];
    struct test_mesh box =
        test_mesh_box((double[]){ 0, -2, 0 }, (double[]){ 0.06, 0.5, 0.06 }, test_rotation_none);
    const sdfgi_mesh mesh = gi_test_mesh(&t, &box);
    test_mesh_destroy(&box);
    const sdfgi_material glow = gi_test_material(&t, (float[]){ 0.5f, 0.5f, 0.5f }, (float[]){ 3, 4, 5 });
    for (int i = 0; i < MANY; i++) {
        const double x = 0.12 * (i % SIDE) - 3, z = 0.12 * (i / SIDE) - 3;
        descs[i] = (struct sdfgi_instance_desc){
            .mesh = mesh, .material = glow, .transform = { { 1, 0, 0, 0, 1, 0, 0, 0, 1 }, { x, 0, z } }
        };
    }
    REQUIRE_CMP((int)sdfgi_instances_create(t.gi, MANY, descs, handles), ==, (int)SDFGI_OK);
}

static struct sdfgi_progress prepare(const struct sdfgi_settings *s, uint32_t max_objects)
{
    struct sdfgi_progress p;
    const struct sdfgi_prepare_desc desc = { .settings = s, .max_objects = max_objects };
    REQUIRE_CMP((int)sdfgi_prepare(t.gi, &desc, &p), ==, (int)SDFGI_OK);
    return p;
}

static void require_updates_that_make_nothing(const struct sdfgi_settings *s)
{
    const struct counting_vulkan before = counting_vulkan_get();
    REQUIRE_CMP((int)sdfgi_set_settings(t.gi, s), ==, (int)SDFGI_OK);
    gi_test_update(&t, 3);
    const struct counting_vulkan after = counting_vulkan_get();
    REQUIRE_CMP(after.pipelines, ==, before.pipelines);
    REQUIRE_CMP(after.memory, ==, before.memory);
    REQUIRE_CMP(after.objects, ==, before.objects);
    const struct gi_test_point above = { { 0, -1.4f, 0 }, { 0, -1, 0 } };
    float light[1][3];
    gi_test_irradiance(&t, &above, 1, light);
    REQUIRE_CMP(light[0][1], >, 0.1f);
}

static void instances_have_room_from_the_first_update_on(void **state)
{
    (void)state;
    const struct sdfgi_settings on = settings(true);
    add_instances();
    const struct sdfgi_progress p = prepare(&on, 0);
    REQUIRE_CMP(p.made, ==, p.total);
    require_updates_that_make_nothing(&on);
}

/* What is complete by then lacks a single buffer. */
static void another_call_makes_room_for_instances_that_came_since(void **state)
{
    (void)state;
    const struct sdfgi_settings on = settings(true);
    struct sdfgi_progress p = prepare(&on, 0);
    const uint32_t total = p.total;
    add_instances();
    const struct counting_vulkan before = counting_vulkan_get();
    p = prepare(&on, 1);
    REQUIRE_TRUE(p.made == total && p.total == total);
    REQUIRE_CMP(counting_vulkan_get().memory, ==, before.memory + 1);
    require_updates_that_make_nothing(&on);
}

static void room_may_be_asked_for_while_volumes_are_being_made(void **state)
{
    (void)state;
    const struct sdfgi_settings on = settings(true);
    const uint32_t total = prepare(&on, 1).total;
    REQUIRE_CMP(prepare(&on, total - 2).made, ==, total - 1);
    add_instances();
    REQUIRE_CMP(prepare(&on, 1).made, ==, total - 1); /* the last one, but room is missing */
    REQUIRE_CMP(prepare(&on, 1).made, ==, total);
    require_updates_that_make_nothing(&on);
}

static void new_volumes_have_room_for_all_that_is_there(void **state)
{
    (void)state;
    struct sdfgi_settings other = settings(true);
    add_instances();
    REQUIRE_CMP((int)sdfgi_set_settings(t.gi, &other), ==, (int)SDFGI_OK);
    gi_test_update(&t, 2);
    other.cascades = 2;
    prepare(&other, 0);
    require_updates_that_make_nothing(&other);
}

#define WITH_CONTEXT(test) cmocka_unit_test_setup_teardown(test, open_context, close_context)

TEST_GROUP(prepare_instances)
{
    if (!gpu_test_available())
        return GPU_TEST_SKIP;
    const struct CMUnitTest tests[] = {
        WITH_CONTEXT(instances_have_room_from_the_first_update_on),
        WITH_CONTEXT(another_call_makes_room_for_instances_that_came_since),
        WITH_CONTEXT(room_may_be_asked_for_while_volumes_are_being_made),
        WITH_CONTEXT(new_volumes_have_room_for_all_that_is_there),
    };
    cmocka_set_test_filter(getenv("SDFGI_TEST_FILTER"));
    return cmocka_run_group_tests_name("api_prepare_instances", tests, NULL, NULL);
}
