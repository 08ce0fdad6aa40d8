/* SPDX-License-Identifier: MIT
 * The Vulkan calls that test_allocation.c leaves out: those of the raster voxelizer, and those that bring
 * back what frames found out. Which calls of the library make none that can fail. */
#include "failing_vulkan.h"
#include "gi_test.h"
#include "require.h"
#include "test_group.h"

#include <vulkan/vulkan.h>

#include <stdio.h>
#include <stdlib.h>

enum { MEMORY_FAILURES = 2 };

static const VkResult memory_failures[MEMORY_FAILURES] = { VK_ERROR_OUT_OF_HOST_MEMORY,
                                                           VK_ERROR_OUT_OF_DEVICE_MEMORY };

static uint32_t errors, warnings;
static enum sdfgi_message last_warning;

static void count_message(void *user, enum sdfgi_log_level level, enum sdfgi_message id, const char *text)
{
    (void)user;
    (void)text;
    if (level == SDFGI_LOG_WARNING)
        last_warning = id;
    errors += level == SDFGI_LOG_ERROR;
    warnings += level == SDFGI_LOG_WARNING;
}

static struct gi_test t; /* its device */
static struct gpu_test_buffer triangle;

static struct sdfgi_settings small_settings(enum sdfgi_voxelizer voxelizer, bool enabled)
{
    struct sdfgi_settings s = gi_test_settings();
    s.resolution = 32;
    s.voxelizer = voxelizer;
    s.enabled = enabled;
    return s;
}

static sdfgi *create(enum sdfgi_voxelizer voxelizer, bool enabled)
{
    const struct sdfgi_settings settings = small_settings(voxelizer, enabled);
    const struct sdfgi_desc desc = { .vulkan = { t.gpu.instance, t.gpu.physical_device, t.gpu.device,
                                                 t.gpu.queue_family_index,
                                                 failing_vulkan_get_instance_proc_addr, NULL },
                                     .log = { count_message, NULL },
                                     .settings = &settings };
    sdfgi *gi;
    failing_vulkan_reset(0, VK_SUCCESS);
    REQUIRE_CMP((int)sdfgi_create(&desc, &gi), ==, (int)SDFGI_OK);
    errors = warnings = 0;
    return gi;
}

static void add_a_light(sdfgi *gi)
{
    const struct sdfgi_light_desc light = { .type = SDFGI_LIGHT_POINT,
                                            .position = { 0, 0, 1 },
                                            .intensity = { 1, 1, 1 } };
    sdfgi_light unused;
    REQUIRE_CMP((int)sdfgi_light_create(gi, &light, &unused), ==, (int)SDFGI_OK);
}

static void add_a_triangle(sdfgi *gi, float emission)
{
    const struct sdfgi_mesh_desc mesh = {
        .position_buffer = triangle.buffer, .vertex_count = 3, .triangle_count = 1, .bounds_max = { 1, 1, 0 }
    };
    const struct sdfgi_material_desc material = { .albedo = { 0.5f, 0.5f, 0.5f },
                                                  .emission = { emission, emission, emission } };
    struct sdfgi_instance_desc desc = { .transform = { { 1, 0, 0, 0, 1, 0, 0, 0, 1 }, { 0, 0, 0 } } };
    sdfgi_instance instance;
    REQUIRE_CMP((int)sdfgi_mesh_create(gi, &mesh, &desc.mesh), ==, (int)SDFGI_OK);
    REQUIRE_CMP((int)sdfgi_material_create(gi, &material, &desc.material), ==, (int)SDFGI_OK);
    REQUIRE_CMP((int)sdfgi_instance_create(gi, &desc, &instance), ==, (int)SDFGI_OK);
    add_a_light(gi);
}

static void record_update(VkCommandBuffer cmd, uint32_t index, void *user)
{
    (void)index;
    REQUIRE_CMP((int)sdfgi_update(user, cmd, &(struct sdfgi_frame_desc){ 0 }), ==, (int)SDFGI_OK);
}

/* No more at a time than may be in flight. */
static void update(sdfgi *gi, int pairs)
{
    for (int i = 0; i < pairs; i++)
        gpu_test_submit_many(&t.gpu, 2, record_update, gi);
}

/* Until light rests. */
static void update_until_converged(sdfgi *gi)
{
    enum { MOST_FRAMES = 2000 };
    struct sdfgi_report report = { .converged = false };
    for (int frame = 0; frame < MOST_FRAMES && !report.converged; frame += 2) {
        update(gi, 1);
        sdfgi_get_report(gi, &report);
    }
    REQUIRE_TRUE(report.converged);
}

/* ---- Claims ------------------------------------------------------------------------------------------ */

/* It has a render pass, a framebuffer and a graphics pipeline, and memory to flush. */
static void switching_on_the_raster_voxelizer_may_fail_anywhere(void **state)
{
    (void)state;
    const struct sdfgi_settings on = small_settings(SDFGI_VOXELIZER_RASTER, true);
    failing_vulkan_hide_coherence(true);
    sdfgi *gi = create(SDFGI_VOXELIZER_RASTER, false);
    failing_vulkan_hide_coherence(false);
    for (int i = 0; i < MEMORY_FAILURES; i++) {
        uint32_t k = 1;
        for (;; k++) {
            errors = 0;
            failing_vulkan_reset(k, memory_failures[i]);
            const enum sdfgi_result result = sdfgi_set_settings(gi, &on);
            if (failing_vulkan_calls() < k)
                break;
            REQUIRE_CMP((int)result, ==, (int)SDFGI_ERROR_OUT_OF_MEMORY);
            REQUIRE_CMP(errors, ==, 1u);
            REQUIRE_TRUE(!gi->volume.resources);
        }
        printf("%u Vulkan calls of switching on can fail\n", k - 1);
        REQUIRE_CMP(k, >, 50u);
        failing_vulkan_reset(0, VK_SUCCESS);
        const struct sdfgi_settings off = small_settings(SDFGI_VOXELIZER_RASTER, false);
        REQUIRE_CMP((int)sdfgi_set_settings(gi, &off), ==, (int)SDFGI_OK);
    }
    sdfgi_destroy(gi);
}

/* Times and counters of a frame are lost without harm, whichever they are: light comes to rest all the same.
 */
static void what_a_frame_found_out_can_be_done_without(void **state)
{
    (void)state;
    failing_vulkan_hide_coherence(true);
    sdfgi *gi = create(SDFGI_VOXELIZER_COMPUTE, true);
    failing_vulkan_hide_coherence(false);
    failing_vulkan_readback_fails(true);
    add_a_triangle(gi, 0);
    for (int i = 0; i < MEMORY_FAILURES; i++) {
        for (uint32_t k = 1; k <= 8; k++) { /* two a frame */
            add_a_light(gi);                /* there is something to find out again */
            failing_vulkan_reset(k, memory_failures[i]);
            update(gi, 4);
            REQUIRE_CMP(failing_vulkan_calls(), >=, k);
        }
    }
    REQUIRE_CMP(errors, ==, 0u);
    update_until_converged(gi);
    REQUIRE_CMP(warnings, ==, 0u);
    failing_vulkan_readback_fails(false);
    sdfgi_destroy(gi);
}

/* The last that was missing is not waited for either. */
static void light_rests_even_if_nothing_is_told_of_a_while(void **state)
{
    (void)state;
    failing_vulkan_hide_coherence(true);
    sdfgi *gi = create(SDFGI_VOXELIZER_COMPUTE, true);
    failing_vulkan_hide_coherence(false);
    failing_vulkan_readback_fails(true);
    add_a_triangle(gi, 0);
    for (uint32_t frame = 0; frame < 60; frame++) {
        failing_vulkan_reset(1, VK_ERROR_OUT_OF_HOST_MEMORY);
        gpu_test_submit_many(&t.gpu, 1, record_update, gi);
    }
    update_until_converged(gi);
    REQUIRE_CMP(errors, ==, 0u);
    failing_vulkan_readback_fails(false);
    sdfgi_destroy(gi);
}

/* More instances than a context has room for at first, all of which touch its cascade. */
enum { MANY = 3000 };

static void add_many_triangles(sdfgi *gi, sdfgi_instance *last)
{
    static struct sdfgi_instance_desc descs[MANY];
    static sdfgi_instance handles[MANY];
    const struct sdfgi_mesh_desc mesh = {
        .position_buffer = triangle.buffer, .vertex_count = 3, .triangle_count = 1, .bounds_max = { 1, 1, 0 }
    };
    const struct sdfgi_material_desc material = { .albedo = { 0.5f, 0.5f, 0.5f } };
    REQUIRE_CMP((int)sdfgi_mesh_create(gi, &mesh, &descs[0].mesh), ==, (int)SDFGI_OK);
    REQUIRE_CMP((int)sdfgi_material_create(gi, &material, &descs[0].material), ==, (int)SDFGI_OK);
    descs[0].transform = (struct sdfgi_transform){ { 1, 0, 0, 0, 1, 0, 0, 0, 1 }, { 0, 0, 0 } };
    for (int i = 1; i < MANY; i++)
        descs[i] = descs[0];
    REQUIRE_CMP((int)sdfgi_instances_create(gi, MANY, descs, handles), ==, (int)SDFGI_OK);
    *last = handles[MANY - 1];
}

static uint64_t triangles_drawn(const sdfgi *gi)
{
    static struct sdfgi_report report;
    sdfgi_get_report(gi, &report);
    return report.passes[PASS_VOXELIZE].work;
}

/* One error says so, and frames go on without some of them, until there is memory. */
static void room_for_instances_comes_as_soon_as_there_is_memory(void **state)
{
    (void)state;
    const struct sdfgi_transform moved = { { 1, 0, 0, 0, 1, 0, 0, 0, 1 }, { 0.5, 0, 0 } };
    sdfgi *gi = create(SDFGI_VOXELIZER_COMPUTE, true);
    sdfgi_instance last;
    add_many_triangles(gi, &last);
    uint32_t k = 1;
    for (;; k++) {
        errors = 0;
        gi->volume.feedback.instances_refused = 0;
        failing_vulkan_reset(k, VK_ERROR_OUT_OF_DEVICE_MEMORY);
        gpu_test_submit_many(&t.gpu, 1, record_update, gi);
        if (failing_vulkan_calls() < k)
            break;
        if (k == 1)
            REQUIRE_CMP(triangles_drawn(gi), ==, (uint64_t)SDFGI_FIRST_INSTANCES);
        REQUIRE_CMP(errors, ==, 1u);
        REQUIRE_CMP(gi->volume.resources->extent.instances, ==, (uint64_t)SDFGI_FIRST_INSTANCES);
        update(gi, 1);
        REQUIRE_CMP(errors, ==, 1u);
    }
    printf("%u Vulkan calls of making room for instances can fail\n", k - 1);
    REQUIRE_CMP(k, >, 3u);

    /* Once more, with memory that comes back later, when the scene has changed. */
    sdfgi_destroy(gi);
    gi = create(SDFGI_VOXELIZER_COMPUTE, true);
    add_many_triangles(gi, &last);
    failing_vulkan_reset(1, VK_ERROR_OUT_OF_DEVICE_MEMORY);
    update(gi, 2);
    failing_vulkan_reset(0, VK_SUCCESS);
    REQUIRE_CMP((int)sdfgi_instance_set_transform(gi, last, &moved), ==, (int)SDFGI_OK);
    gpu_test_submit_many(&t.gpu, 1, record_update, gi);
    REQUIRE_CMP(triangles_drawn(gi), ==, (uint64_t)MANY);
    sdfgi_destroy(gi);
}

static void a_material_that_cannot_change_stays_as_it_was(void **state)
{
    (void)state;
    const struct sdfgi_material_desc plain = { .albedo = { 1, 1, 1 } },
                                     textured = { .albedo_texture = { .view = (VkImageView)(uintptr_t)1 } };
    sdfgi *gi = create(SDFGI_VOXELIZER_COMPUTE, true);
    sdfgi_material material;
    REQUIRE_CMP((int)sdfgi_material_create(gi, &plain, &material), ==, (int)SDFGI_OK);
    const struct material *kept = sdfgi_pool_get(&gi->scene.materials, material.id);
    for (uint32_t k = 1; k <= 3; k++) { /* a shader module, a pipeline, a sampler */
        errors = 0;
        failing_vulkan_reset(k, VK_ERROR_OUT_OF_DEVICE_MEMORY);
        REQUIRE_CMP((int)sdfgi_material_update(gi, material, &textured), ==, (int)SDFGI_ERROR_OUT_OF_MEMORY);
        REQUIRE_CMP(errors, ==, 1u);
        REQUIRE_TRUE(!kept->set && !kept->desc.albedo_texture.view && kept->desc.albedo[0] > 0);
    }
    failing_vulkan_reset(0, VK_SUCCESS);
    sdfgi_destroy(gi);
}

/* A warning says what it costs; frames go on. What emits later asks for memory again. */
static void lists_of_emitters_can_be_done_without(void **state)
{
    (void)state;
    const struct sdfgi_material_desc glows = { .emission = { 5, 5, 5 } };
    sdfgi *gi = create(SDFGI_VOXELIZER_COMPUTE, true);
    add_a_triangle(gi, 0);
    uint32_t k = 1;
    for (;; k++) {
        sdfgi_material material;
        warnings = 0;
        REQUIRE_CMP((int)sdfgi_material_create(gi, &glows, &material), ==, (int)SDFGI_OK);
        failing_vulkan_reset(k, VK_ERROR_OUT_OF_DEVICE_MEMORY);
        update(gi, 1);
        if (failing_vulkan_calls() < k)
            break;
        failing_vulkan_reset(0, VK_SUCCESS);
        update(gi, 1);
        REQUIRE_CMP(warnings, ==, 1u);
        REQUIRE_CMP((int)last_warning, ==, (int)SDFGI_MESSAGE_NO_EMITTER_LISTS);
        REQUIRE_TRUE(!gi->volume.resources->extent.emits);
        REQUIRE_CMP((int)sdfgi_material_destroy(gi, material), ==, (int)SDFGI_OK);
        update(gi, 1);
    }
    printf("%u Vulkan calls of making lists of emitters can fail\n", k - 1);
    REQUIRE_CMP(k, >, 3u);
    REQUIRE_TRUE(gi->volume.resources->extent.emits);
    REQUIRE_CMP(errors, ==, 0u);
    update(gi, 2);
    sdfgi_destroy(gi);
}

/* To the settings of a context, which stay as they are but for this. */
static void set_rough_lobes(sdfgi *gi, struct sdfgi_settings *settings, bool on)
{
    settings->rough_lobes = on;
    REQUIRE_CMP((int)sdfgi_set_settings(gi, settings), ==, (int)SDFGI_OK);
}

/* Likewise, until they are switched off and on. */
static void rough_lobes_can_be_done_without(void **state)
{
    (void)state;
    sdfgi *gi = create(SDFGI_VOXELIZER_COMPUTE, true);
    struct sdfgi_settings settings = small_settings(SDFGI_VOXELIZER_COMPUTE, true);
    settings.surface_light = SDFGI_SURFACE_LIGHT_CELLS;
    REQUIRE_CMP((int)sdfgi_set_settings(gi, &settings), ==, (int)SDFGI_OK);
    const struct sdfgi_view_desc desc = { .width = 16, .height = 16, .reflections = true };
    sdfgi_view *view;
    REQUIRE_CMP((int)sdfgi_view_create(gi, &desc, &view), ==, (int)SDFGI_OK);
    uint32_t k = 1;
    for (;; k++) {
        warnings = 0;
        set_rough_lobes(gi, &settings, true);
        failing_vulkan_reset(k, VK_ERROR_OUT_OF_DEVICE_MEMORY);
        update(gi, 1);
        if (failing_vulkan_calls() < k)
            break;
        failing_vulkan_reset(0, VK_SUCCESS);
        update(gi, 1);
        REQUIRE_CMP(warnings, ==, 1u);
        REQUIRE_CMP((int)last_warning, ==, (int)SDFGI_MESSAGE_NO_ROUGH_LOBES);
        REQUIRE_TRUE(!gi->volume.state.low_light && !gi->volume.resources->extent.low_light);
        set_rough_lobes(gi, &settings, false);
        update(gi, 1);
    }
    printf("%u Vulkan calls of what rough lobes need can fail\n", k - 1);
    REQUIRE_CMP(k, >, 3u);
    REQUIRE_TRUE(gi->volume.state.low_light && gi->volume.resources->extent.low_light);
    REQUIRE_CMP(errors, ==, 0u);
    update(gi, 2);
    sdfgi_destroy(gi);
}

/* Programs call them where they cannot handle errors. */
static void switching_off_reset_and_cancel_call_nothing_that_can_fail(void **state)
{
    (void)state;
    sdfgi *gi = create(SDFGI_VOXELIZER_RASTER, true);
    const struct sdfgi_settings off = small_settings(SDFGI_VOXELIZER_RASTER, false);
    add_a_triangle(gi, 0);
    update(gi, 1);
    failing_vulkan_reset(1, VK_ERROR_OUT_OF_DEVICE_MEMORY);
    sdfgi_cancel_update(gi);
    sdfgi_reset(gi);
    REQUIRE_CMP((int)sdfgi_set_settings(gi, &off), ==, (int)SDFGI_OK);
    update(gi, 2); /* what was retired is destroyed */
    REQUIRE_CMP(failing_vulkan_calls(), ==, 0u);
    REQUIRE_CMP(errors, ==, 0u);
    failing_vulkan_reset(0, VK_SUCCESS);
    sdfgi_destroy(gi);
}

static uint64_t held(const sdfgi *gi)
{
    static struct sdfgi_report report;
    sdfgi_get_report(gi, &report);
    return report.memory.total_bytes;
}

/* Pipelines stay, volumes are begun anew, and the switch works all the same. */
static void preparing_may_fail_anywhere(void **state)
{
    (void)state;
    const struct sdfgi_settings on = small_settings(SDFGI_VOXELIZER_RASTER, true);
    const struct sdfgi_prepare_desc prepare = { .settings = &on };
    const struct sdfgi_desc desc = { .vulkan = { t.gpu.instance, t.gpu.physical_device, t.gpu.device,
                                                 t.gpu.queue_family_index,
                                                 failing_vulkan_get_instance_proc_addr, NULL },
                                     .log = { count_message, NULL },
                                     .pipelines_later = true };
    failing_vulkan_skip_shaders(true);
    for (int i = 0; i < MEMORY_FAILURES; i++) {
        sdfgi *gi;
        uint32_t failed = 0;
        failing_vulkan_reset(0, VK_SUCCESS);
        REQUIRE_CMP((int)sdfgi_create(&desc, &gi), ==, (int)SDFGI_OK);
        for (bool done = false; !done;) {
            struct sdfgi_progress p = { 77, 78 };
            errors = 0;
            failing_vulkan_reset(failed + 1, memory_failures[i]);
            const enum sdfgi_result result = sdfgi_prepare(gi, &prepare, &p);
            done = result == SDFGI_OK;
            failed += !done;
            REQUIRE_CMP((int)result, ==, (int)(done ? SDFGI_OK : SDFGI_ERROR_OUT_OF_MEMORY));
            REQUIRE_CMP(errors, ==, (uint32_t)!done);
            REQUIRE_TRUE(done ? p.made == p.total : held(gi) == 0 && p.made == 77);
        }
        printf("%u calls of preparing failed\n", failed);
        REQUIRE_CMP(failed, >, 90u);
        failing_vulkan_reset(1, memory_failures[i]);
        REQUIRE_CMP((int)sdfgi_set_settings(gi, &on), ==, (int)SDFGI_OK);
        REQUIRE_CMP(failing_vulkan_calls(), ==, 0u);
        failing_vulkan_reset(0, VK_SUCCESS);
        sdfgi_destroy(gi);
    }
    failing_vulkan_skip_shaders(false);
}

static int open_device(void **state)
{
    (void)state;
    gi_test_open_device(&t);
    failing_vulkan_share_pipelines(true);
    const float corners[9] = { 0, 0, 0, 1, 0, 0, 0, 1, 0 };
    triangle = gpu_test_buffer_device(&t.gpu, sizeof corners, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, corners);
    return 0;
}

static int close_device(void **state)
{
    (void)state;
    gpu_test_buffer_destroy(&t.gpu, &triangle);
    failing_vulkan_share_pipelines(false);
    gi_test_close(&t);
    return 0;
}

TEST_GROUP(vulkan_failures)
{
    if (!gpu_test_available())
        return GPU_TEST_SKIP;
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(switching_on_the_raster_voxelizer_may_fail_anywhere),
        cmocka_unit_test(what_a_frame_found_out_can_be_done_without),
        cmocka_unit_test(light_rests_even_if_nothing_is_told_of_a_while),
        cmocka_unit_test(room_for_instances_comes_as_soon_as_there_is_memory),
        cmocka_unit_test(a_material_that_cannot_change_stays_as_it_was),
        cmocka_unit_test(lists_of_emitters_can_be_done_without),
        cmocka_unit_test(rough_lobes_can_be_done_without),
        cmocka_unit_test(switching_off_reset_and_cancel_call_nothing_that_can_fail),
        cmocka_unit_test(preparing_may_fail_anywhere),
    };
    cmocka_set_test_filter(getenv("SDFGI_TEST_FILTER"));
    return cmocka_run_group_tests(tests, open_device, close_device);
}
