/* SPDX-License-Identifier: MIT
 * What sdfgi_prepare has made, the switch does not make: counted by calls of Vulkan. */
#include "counting_vulkan.h"
#include "gi_test.h"
#include "require.h"
#include "test_group.h"

#include <pthread.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

static struct gi_test t;

static struct sdfgi_settings settings(bool enabled)
{
    struct sdfgi_settings s = gi_test_settings();
    s.resolution = 32;
    s.ray_count = 64;
    s.frames_to_converge = 4;
    s.enabled = enabled;
    return s;
}

static struct sdfgi_report report(void)
{
    struct sdfgi_report r;
    sdfgi_get_report(t.gi, &r);
    return r;
}

static uint64_t held(void)
{
    return report().memory.total_bytes;
}

static void set(const struct sdfgi_settings *s)
{
    REQUIRE_CMP((int)sdfgi_set_settings(t.gi, s), ==, (int)SDFGI_OK);
}

static void enable(bool enabled)
{
    const struct sdfgi_settings s = settings(enabled);
    set(&s);
}

static void add_box(const double at[3], const double half[3], const float emission[3])
{
    struct test_mesh box = test_mesh_box(at, half, test_rotation_none);
    gi_test_add(&t, &box, gi_test_material(&t, (float[]){ 0.5f, 0.5f, 0.5f }, emission));
    test_mesh_destroy(&box);
}

/* A lamp over a floor. */
static void add_scene(void)
{
    add_box((double[]){ 0, -2, 0 }, (double[]){ 3, 0.5, 3 }, (float[]){ 0, 0, 0 });
    add_box((double[]){ 0, 2, 0 }, (double[]){ 0.5, 0.5, 0.5 }, (float[]){ 3, 4, 5 });
}

static void open_with(PFN_vkGetInstanceProcAddr loader)
{
    const struct sdfgi_settings off = settings(false);
    gi_test_open_device(&t);
    struct sdfgi_desc desc = gi_test_desc(&t, &off);
    desc.vulkan.get_instance_proc_addr = loader;
    desc.pipelines_later = true;
    REQUIRE_CMP((int)sdfgi_create(&desc, &t.gi), ==, (int)SDFGI_OK);
}

/* What cases count is what contexts ask for: the driver makes each pipeline once for all of them. */
static int open_context(void **state)
{
    (void)state;
    open_with(counting_vulkan_loader_sharing());
    return 0;
}

/* Where threads make pipelines, and where it matters how long one takes: the driver makes all. */
static int open_slow_context(void **state)
{
    (void)state;
    open_with(counting_vulkan_loader());
    return 0;
}

static int close_context(void **state)
{
    (void)state;
    gi_test_close(&t);
    return 0;
}

/* All in one call. */
static void prepare(const struct sdfgi_settings *s)
{
    struct sdfgi_progress p;
    const struct sdfgi_prepare_desc desc = { .settings = s };
    REQUIRE_CMP((int)sdfgi_prepare(t.gi, &desc, &p), ==, (int)SDFGI_OK);
    REQUIRE_TRUE(p.total > 0 && p.made == p.total);
}

static void require_nothing_made_since(const struct counting_vulkan *before)
{
    const struct counting_vulkan now = counting_vulkan_get();
    REQUIRE_CMP(now.pipelines, ==, before->pipelines);
    REQUIRE_CMP(now.memory, ==, before->memory);
    REQUIRE_CMP(now.objects, ==, before->objects);
}

static const struct gi_test_point floor_point = { { 1.5f, -1.5f, 0.2f }, { 0, 1, 0 } };

static float light(void)
{
    float found[1][3];
    gi_test_irradiance(&t, &floor_point, 1, found);
    return found[0][1];
}

static float light_of_set(void)
{
    float found[1][3];
    gi_test_lookup(&t, sdfgi_get_descriptor_set(t.gi), NULL, &floor_point, 1, found);
    return found[0][1];
}

/* ---- Before the first switch */

static void a_context_may_be_created_without_pipelines(void **state)
{
    const uint32_t before = counting_vulkan_get().pipelines;
    REQUIRE_CMP(open_context(state), ==, 0);
    REQUIRE_CMP(counting_vulkan_get().pipelines, ==, before);
    enable(true); /* who prepares nothing waits here */
    REQUIRE_CMP(counting_vulkan_get().pipelines, >, before + 20);
    add_scene();
    gi_test_update(&t, 4);
    REQUIRE_CMP(light(), >, 0.01f);
    close_context(state);
}

static uint32_t made(void)
{
    const struct counting_vulkan now = counting_vulkan_get();
    return now.pipelines + now.objects;
}

/* One object in a call: a pipeline, or a buffer with its memory, or a pool. */
static void each_call_makes_as_much_as_its_budget(void **state)
{
    (void)state;
    const struct sdfgi_settings off = settings(false);
    const struct sdfgi_prepare_desc desc = { .settings = &off, .max_objects = 1 };
    struct sdfgi_progress p = { 0, 1 };
    for (uint32_t calls = 1; p.made < p.total; calls++) {
        const uint32_t before = made();
        REQUIRE_CMP((int)sdfgi_prepare(t.gi, &desc, &p), ==, (int)SDFGI_OK);
        REQUIRE_CMP(p.made, ==, calls);
        REQUIRE_CMP(made(), ==, before + 1);
        REQUIRE_TRUE(report().prepared.made == p.made && report().prepared.total == p.total);
    }
    printf("%u objects\n", p.total);
    const struct counting_vulkan before = counting_vulkan_get();
    prepare(&off);
    require_nothing_made_since(&before);
}

static void a_budget_of_time_ends_a_call(void **state)
{
    (void)state;
    const struct sdfgi_settings off = settings(false);
    const struct sdfgi_prepare_desc desc = { .settings = &off, .max_microseconds = 1 };
    struct sdfgi_progress p;
    REQUIRE_CMP((int)sdfgi_prepare(t.gi, &desc, &p), ==, (int)SDFGI_OK);
    REQUIRE_TRUE(p.made == 1 && p.total > 30); /* a pipeline takes longer */
}

static void the_switch_makes_nothing_that_has_been_prepared(void **state)
{
    (void)state;
    const struct sdfgi_settings off = settings(false);
    prepare(&off);
    REQUIRE_TRUE(!sdfgi_is_active(t.gi) && light_of_set() == 0);
    const uint64_t prepared = held();
    add_scene();
    const struct counting_vulkan before = counting_vulkan_get();
    enable(true);
    gi_test_update(&t, 4);
    require_nothing_made_since(&before);
    REQUIRE_CMP(held(), ==, prepared);
    REQUIRE_CMP(light(), >, 0.01f);
}

/* The first picture that is gathered makes a small pool besides. */
static void a_picture_makes_no_pipeline_that_has_been_prepared(void **state)
{
    (void)state;
    const struct sdfgi_settings off = settings(false);
    prepare(&off);
    add_scene();
    enable(true);
    gi_test_update(&t, 2);
    const float depth[9] = { 0.5f }, normals[9][4] = { { 0, 1 } };
    struct gpu_test_image d = gi_test_gather_image(&t, VK_FORMAT_R32_SFLOAT, 4, 3, 3, depth),
                          n = gi_test_gather_image(&t, VK_FORMAT_R32G32B32A32_SFLOAT, 16, 3, 3, normals),
                          o = gi_test_gather_image(&t, VK_FORMAT_R16G16B16A16_SFLOAT, 8, 3, 3, NULL);
    const struct counting_vulkan before = counting_vulkan_get();
    struct sdfgi_gather_desc desc = { .depth = d.view,
                                      .normal = n.view,
                                      .output = o.view,
                                      .width = 3,
                                      .height = 3,
                                      .inverse_view_projection = { 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0,
                                                                   0, 1 } };
    gi_test_gather(&t, &desc);
    desc.resolution = SDFGI_GATHER_HALF;
    gi_test_gather(&t, &desc);
    REQUIRE_CMP(counting_vulkan_get().pipelines, ==, before.pipelines);
    REQUIRE_CMP(counting_vulkan_get().memory, ==, before.memory);
    gpu_test_image_destroy(&t.gpu, &d);
    gpu_test_image_destroy(&t.gpu, &n);
    gpu_test_image_destroy(&t.gpu, &o);
}

/* ---- Other settings */

static void the_old_picture_goes_on_until_new_volumes_are_prepared(void **state)
{
    (void)state;
    struct sdfgi_settings other = settings(true);
    other.cascades = 2;
    enable(true);
    add_scene();
    gi_test_update(&t, 8);
    const VkDescriptorSet set_before = sdfgi_get_descriptor_set(t.gi);
    const struct sdfgi_prepare_desc desc = { .settings = &other, .max_objects = 4 };
    struct sdfgi_progress p = { 0, 1 };
    while (p.made < p.total) {
        REQUIRE_CMP((int)sdfgi_prepare(t.gi, &desc, &p), ==, (int)SDFGI_OK);
        gi_test_update(&t, 1);
        REQUIRE_TRUE(sdfgi_get_descriptor_set(t.gi) == set_before && sdfgi_is_active(t.gi));
    }
    const struct counting_vulkan before = counting_vulkan_get();
    REQUIRE_CMP(light(), >, 0.01f);
    set(&other);
    gi_test_update(&t, 4);
    require_nothing_made_since(&before);
    REQUIRE_CMP(light(), >, 0.01f);
}

static void other_settings_release_what_was_prepared(void **state)
{
    (void)state;
    struct sdfgi_settings large = settings(false), small = settings(false);
    struct sdfgi_memory estimate;
    const uint64_t before = held();
    large.cascades = 4;
    prepare(&large);
    prepare(&small);
    REQUIRE_CMP((int)sdfgi_estimate_memory(&large, 2, &estimate), ==, (int)SDFGI_OK);
    REQUIRE_CMP(held() - before, <, estimate.total_bytes);
    sdfgi_release_prepared(t.gi);
    REQUIRE_CMP(held(), ==, before);
    REQUIRE_TRUE(report().prepared.total == 0);
    enable(true); /* what was not prepared is made now */
    gi_test_update(&t, 2);
    enable(false);
    gi_test_update(&t, 4);
    REQUIRE_CMP(held(), ==, before);
}

/* ---- What is kept */

static void off_keeps_what_was_prepared_until_it_is_released(void **state)
{
    (void)state;
    const struct sdfgi_settings off = settings(false);
    const uint64_t nothing = held();
    prepare(&off);
    const uint64_t prepared = held();
    add_scene();
    enable(true);
    gi_test_update(&t, 2);
    enable(false);
    gi_test_update(&t, 4);
    REQUIRE_CMP(held(), ==, prepared);
    prepare(&off); /* there it is */
    REQUIRE_CMP(held(), ==, prepared);
    sdfgi_release_prepared(t.gi);
    gi_test_update(&t, 4);
    REQUIRE_CMP(held(), ==, nothing);
}

static void what_was_kept_goes_when_other_settings_are_prepared(void **state)
{
    (void)state;
    struct sdfgi_settings s = settings(false), other = s;
    other.cascades = 2;
    prepare(&other);
    const uint64_t of_other = held();
    sdfgi_release_prepared(t.gi);
    prepare(&s);
    enable(true);
    gi_test_update(&t, 2);
    enable(false);
    prepare(&other);
    REQUIRE_CMP(held(), >, of_other);
    gi_test_update(&t, 4);
    REQUIRE_CMP(held(), ==, of_other);
}

static void light_goes_on_where_it_was(void **state)
{
    (void)state;
    const struct sdfgi_settings on = settings(true);
    enable(true);
    prepare(&on); /* in force: nothing to make, but to keep */
    add_scene();
    gi_test_converge(&t, 400);
    const float settled = light();
    enable(false);
    REQUIRE_TRUE(!sdfgi_is_active(t.gi) && light_of_set() == 0);
    gi_test_update(&t, 3);
    enable(true);
    REQUIRE_TRUE(!sdfgi_is_active(t.gi) && light_of_set() == 0);
    gi_test_update(&t, 1);
    REQUIRE_TRUE(sdfgi_is_active(t.gi) && report().converged);
    REQUIRE_CMP(report().command_count, ==, 0u);
    REQUIRE_CMP(light(), ==, settled);
}

static void what_changed_while_off_is_there_afterwards(void **state)
{
    (void)state;
    const struct sdfgi_settings on = settings(true);
    enable(true);
    prepare(&on);
    add_scene();
    gi_test_converge(&t, 400);
    REQUIRE_CMP(light(), >, 0.01f);
    enable(false);
    gi_test_update(&t, 2);
    add_box((double[]){ 0, 0, 0 }, (double[]){ 3, 0.5, 3 }, (float[]){ 0, 0, 0 }); /* a roof */
    enable(true);
    gi_test_converge(&t, 400);
    REQUIRE_CMP(light(), <, 0.001f);
}

/* The update that is undone may lie before the switch. */
static void an_update_before_the_switch_can_be_undone(void **state)
{
    (void)state;
    const struct sdfgi_settings on = settings(true);
    enable(true);
    prepare(&on);
    add_scene();
    gi_test_update(&t, 4);
    const uint64_t updates = report().update_count;
    gi_test_update(&t, 1);
    enable(false);
    sdfgi_cancel_update(t.gi);
    REQUIRE_TRUE(!sdfgi_is_active(t.gi) && report().update_count == updates);
    enable(true);
    REQUIRE_TRUE(!sdfgi_is_active(t.gi));
    gi_test_update(&t, 1);
    enable(false);
    gi_test_update(&t, 1);
    sdfgi_cancel_update(t.gi); /* which was of a context that is off */
    REQUIRE_TRUE(report().update_count == updates + 1);
    sdfgi_reset(t.gi);
    enable(true);
    gi_test_update(&t, 4);
    REQUIRE_CMP(light(), >, 0.01f);
    REQUIRE_CMP(t.messages[SDFGI_MESSAGE_UPDATE_LOST], ==, 0u);
}

/* ---- Beside frames */

static struct sdfgi_settings beside;
static atomic_bool beside_done;

static void *prepare_beside(void *user)
{
    (void)user;
    const struct sdfgi_prepare_desc desc = { .settings = &beside, .max_objects = 1 };
    struct sdfgi_progress p = { 0, 1 };
    enum sdfgi_result result = SDFGI_OK;
    while (result == SDFGI_OK && p.made < p.total)
        result = sdfgi_prepare(t.gi, &desc, &p);
    beside_done = true;
    return result == SDFGI_OK ? NULL : &beside;
}

static void prepare_in_a_thread(const struct sdfgi_settings *s, uint32_t *frames)
{
    const struct timespec pause = { .tv_nsec = 1000000 }; /* the thread has the processor meanwhile */
    pthread_t thread;
    void *failed;
    beside = *s;
    beside_done = false;
    REQUIRE_CMP(pthread_create(&thread, NULL, prepare_beside, NULL), ==, 0);
    for (*frames = 0; !beside_done; ++*frames) {
        gi_test_update(&t, 2);
        (void)report();
        nanosleep(&pause, NULL);
    }
    REQUIRE_CMP(pthread_join(thread, &failed), ==, 0);
    REQUIRE_TRUE(failed == NULL);
}

static void frames_go_on_while_another_thread_prepares(void **state)
{
    (void)state;
    uint32_t frames[3];
    struct sdfgi_settings s = settings(true);
    add_scene();
    prepare_in_a_thread(&s, &frames[0]); /* off */
    struct counting_vulkan before = counting_vulkan_get();
    set(&s);
    gi_test_update(&t, 2);
    require_nothing_made_since(&before);
    for (uint32_t i = 1; i < 3; i++) {
        s.cascades = 1 + i;
        prepare_in_a_thread(&s, &frames[i]);
        before = counting_vulkan_get();
        set(&s);
        gi_test_update(&t, 2);
        require_nothing_made_since(&before);
    }
    printf("%u, %u and %u frames meanwhile\n", frames[0], frames[1], frames[2]);
    REQUIRE_CMP(light(), >, 0.01f);
}

/* Who does not wait makes the same pipelines at the same time. */
static void a_switch_that_does_not_wait_works_too(void **state)
{
    (void)state;
    pthread_t thread;
    void *failed;
    beside = settings(true);
    add_scene();
    REQUIRE_CMP(pthread_create(&thread, NULL, prepare_beside, NULL), ==, 0);
    for (int i = 0; i < 6; i++) {
        enable(i % 2 == 0);
        gi_test_update(&t, 1);
    }
    REQUIRE_CMP(pthread_join(thread, &failed), ==, 0);
    REQUIRE_TRUE(failed == NULL);
    enable(true);
    gi_test_update(&t, 4);
    REQUIRE_CMP(light(), >, 0.01f);
}

static void what_makes_no_sense_is_refused(void **state)
{
    (void)state;
    struct sdfgi_settings bad = settings(true);
    struct sdfgi_progress p = { 7, 8 };
    struct sdfgi_prepare_desc desc = { .settings = &bad };
    bad.cascades = 77;
    t.gpu.messages->quiet = true;
    REQUIRE_CMP((int)sdfgi_prepare(t.gi, &desc, &p), ==, (int)SDFGI_ERROR_INVALID_ARGUMENT);
    REQUIRE_CMP(t.messages[SDFGI_MESSAGE_INVALID_SETTING], ==, 1u);
    bad = settings(true);
    desc.parts = 1u << 20;
    REQUIRE_CMP((int)sdfgi_prepare(t.gi, &desc, &p), ==, (int)SDFGI_ERROR_INVALID_ARGUMENT);
    REQUIRE_CMP(t.messages[SDFGI_MESSAGE_INVALID_ARGUMENT], ==, 1u);
    t.gpu.messages->quiet = false;
    REQUIRE_TRUE(p.made == 7 && p.total == 8 && report().prepared.total == 0);
}

#define WITH_CONTEXT(test)      cmocka_unit_test_setup_teardown(test, open_context, close_context)
#define WITH_SLOW_CONTEXT(test) cmocka_unit_test_setup_teardown(test, open_slow_context, close_context)

TEST_GROUP(prepare)
{
    if (!gpu_test_available())
        return GPU_TEST_SKIP;
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_context_may_be_created_without_pipelines),
        WITH_CONTEXT(each_call_makes_as_much_as_its_budget),
        WITH_SLOW_CONTEXT(a_budget_of_time_ends_a_call),
        WITH_CONTEXT(the_switch_makes_nothing_that_has_been_prepared),
        WITH_CONTEXT(a_picture_makes_no_pipeline_that_has_been_prepared),
        WITH_CONTEXT(the_old_picture_goes_on_until_new_volumes_are_prepared),
        WITH_CONTEXT(other_settings_release_what_was_prepared),
        WITH_CONTEXT(off_keeps_what_was_prepared_until_it_is_released),
        WITH_CONTEXT(what_was_kept_goes_when_other_settings_are_prepared),
        WITH_CONTEXT(light_goes_on_where_it_was),
        WITH_CONTEXT(what_changed_while_off_is_there_afterwards),
        WITH_CONTEXT(an_update_before_the_switch_can_be_undone),
        WITH_SLOW_CONTEXT(frames_go_on_while_another_thread_prepares),
        WITH_SLOW_CONTEXT(a_switch_that_does_not_wait_works_too),
        WITH_CONTEXT(what_makes_no_sense_is_refused),
    };
    cmocka_set_test_filter(getenv("SDFGI_TEST_FILTER"));
    return cmocka_run_group_tests_name("api_prepare", tests, NULL, NULL);
}
