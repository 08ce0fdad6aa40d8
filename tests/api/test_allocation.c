/* SPDX-License-Identifier: MIT
 * Running out of memory anywhere is an error, not a crash or a leak: the k-th allocation fails, for k = 1, 2,
 * ... until nothing fails any more. The validation layer counts what is not destroyed. */
#include "failing_vulkan.h"
#include "gi_test.h"
#include "require.h"
#include "test_group.h"

#include <sdfgi/debug.h>
#include <vulkan/vulkan.h>

#include <stdio.h>
#include <stdlib.h>

/* Calls that fail before they record anything. */
static const VkCommandBuffer unused_commands = (VkCommandBuffer)(uintptr_t)1;

/* ---- A host allocator that fails once */

struct counting {
    uint32_t calls, fail_at;
    int64_t live;
};

static void *counting_alloc(void *user, size_t size)
{
    struct counting *c = user;
    if (++c->calls == c->fail_at)
        return NULL;
    void *memory = malloc(size);
    c->live += memory != NULL;
    return memory;
}

static void counting_free(void *user, void *memory)
{
    struct counting *c = user;
    c->live -= memory != NULL;
    free(memory);
}

static uint32_t messages[SDFGI_MESSAGE_COUNT];

static void count_message(void *user, enum sdfgi_log_level level, enum sdfgi_message id, const char *text)
{
    (void)user;
    (void)level;
    (void)text;
    messages[id]++;
}

static uint32_t memory_messages(void)
{
    return messages[SDFGI_MESSAGE_OUT_OF_HOST_MEMORY] + messages[SDFGI_MESSAGE_OUT_OF_DEVICE_MEMORY];
}

static struct sdfgi_settings small_settings(bool enabled)
{
    struct sdfgi_settings s = gi_test_settings();
    s.resolution = 32;
    s.enabled = enabled;
    return s;
}

static struct sdfgi_desc desc_on(const struct gpu_test *gpu, struct counting *counting)
{
    return (struct sdfgi_desc){ .vulkan = { gpu->instance, gpu->physical_device, gpu->device,
                                            gpu->queue_family_index, failing_vulkan_get_instance_proc_addr,
                                            NULL },
                                .log = { count_message, NULL },
                                .allocator = { counting_alloc, counting_free, counting } };
}

/* Adds enough of each kind of object that every pool of the library grows at least once. */
static enum sdfgi_result add_objects(sdfgi *gi, VkBuffer buffer)
{
    enum { COUNT = 70 };
    const struct sdfgi_mesh_desc mesh_desc = {
        .position_buffer = buffer, .vertex_count = 3, .triangle_count = 1, .bounds_max = { 1, 1, 0 }
    };
    const struct sdfgi_material_desc material_desc = { .albedo = { 1, 1, 1 } };
    const struct sdfgi_light_desc light_desc = { .type = SDFGI_LIGHT_POINT, .intensity = { 1, 1, 1 } };
    for (int i = 0; i < COUNT; i++) {
        struct sdfgi_instance_desc instance_desc = { .transform = { { 1, 0, 0, 0, 1, 0, 0, 0, 1 },
                                                                    { 0, 0, 0 } } };
        sdfgi_instance instance;
        sdfgi_light light;
        enum sdfgi_result result = sdfgi_mesh_create(gi, &mesh_desc, &instance_desc.mesh);
        if (result == SDFGI_OK)
            result = sdfgi_material_create(gi, &material_desc, &instance_desc.material);
        if (result == SDFGI_OK)
            result = sdfgi_instance_create(gi, &instance_desc, &instance);
        if (result == SDFGI_OK)
            result = sdfgi_light_create(gi, &light_desc, &light);
        if (result != SDFGI_OK)
            return result;
        if (i % 2) /* a set retired needs memory too, but doing without is no error */
            REQUIRE_CMP((int)sdfgi_mesh_destroy(gi, instance_desc.mesh), ==, (int)SDFGI_OK);
    }
    return SDFGI_OK;
}

static enum sdfgi_result live_a_whole_life(const struct sdfgi_desc *desc, VkBuffer buffer)
{
    sdfgi *gi = (sdfgi *)messages;
    enum sdfgi_result result = sdfgi_create(desc, &gi);
    if (result != SDFGI_OK) {
        REQUIRE_TRUE(gi == (sdfgi *)messages);
        return result;
    }
    const struct sdfgi_settings on = small_settings(true);
    result = sdfgi_set_settings(gi, &on);
    if (result == SDFGI_OK)
        result = add_objects(gi, buffer);
    sdfgi_destroy(gi);
    return result;
}

static struct gpu_test gpu;
static struct gpu_test_buffer triangle;

static int open_device(void **state)
{
    (void)state;
    gpu_test_open(&gpu, sdfgi_get_requirements);
    const float corners[9] = { 0, 0, 0, 1, 0, 0, 0, 1, 0 };
    triangle = gpu_test_buffer_device(&gpu, sizeof corners, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, corners);
    failing_vulkan_skip_shaders(true);
    return 0;
}

/* Where shaders run. */
static int keep_shaders(void **state)
{
    (void)state;
    failing_vulkan_skip_shaders(false);
    return 0;
}

static int close_device(void **state)
{
    (void)state;
    gpu_test_buffer_destroy(&gpu, &triangle);
    gpu_test_close(&gpu);
    return 0;
}

static void no_host_allocation_is_fatal(void **state)
{
    (void)state;
    uint32_t k = 1, tolerated = 0;
    failing_vulkan_reset(0, VK_SUCCESS);
    for (;; k++) {
        struct counting counting = { .fail_at = k };
        const struct sdfgi_desc desc = desc_on(&gpu, &counting);
        memset(messages, 0, sizeof messages);
        const enum sdfgi_result result = live_a_whole_life(&desc, triangle.buffer);
        REQUIRE_CMP(counting.live, ==, 0);
        if (counting.calls < k) {
            REQUIRE_CMP((int)result, ==, (int)SDFGI_OK);
            break;
        }
        tolerated += result == SDFGI_OK;
        if (result != SDFGI_OK) {
            REQUIRE_CMP((int)result, ==, (int)SDFGI_ERROR_OUT_OF_MEMORY);
            REQUIRE_CMP(messages[SDFGI_MESSAGE_OUT_OF_HOST_MEMORY], ==, 1u);
        }
    }
    printf("%u host allocations, %u of them dispensable\n", k - 1, tolerated);
    REQUIRE_CMP(k, >, 10u);
    REQUIRE_CMP(tolerated, <=, 2u);
}

static void no_vulkan_failure_while_switching_on_is_fatal(void **state)
{
    (void)state;
    static const VkResult failures[] = { VK_ERROR_OUT_OF_HOST_MEMORY, VK_ERROR_OUT_OF_DEVICE_MEMORY };
    struct counting counting = { 0 };
    struct sdfgi_desc desc = desc_on(&gpu, &counting);
    const struct sdfgi_settings off = small_settings(false), on = small_settings(true);
    desc.settings = &off;
    sdfgi *gi;
    failing_vulkan_reset(0, VK_SUCCESS);
    REQUIRE_CMP((int)sdfgi_create(&desc, &gi), ==, (int)SDFGI_OK);
    const int64_t live = counting.live;
    const VkDescriptorSet blank = sdfgi_get_descriptor_set(gi);
    REQUIRE_TRUE(blank != VK_NULL_HANDLE);
    for (int i = 0; i < 2; i++) {
        for (uint32_t k = 1;; k++) {
            memset(messages, 0, sizeof messages);
            failing_vulkan_reset(k, failures[i]);
            const enum sdfgi_result result = sdfgi_set_settings(gi, &on);
            if (failing_vulkan_calls() < k) {
                REQUIRE_CMP((int)result, ==, (int)SDFGI_OK);
                printf("%u Vulkan calls of switching on can fail\n", k - 1);
                REQUIRE_CMP(k, >, 30u);
                break;
            }
            REQUIRE_CMP((int)result, ==, (int)SDFGI_ERROR_OUT_OF_MEMORY);
            REQUIRE_CMP(memory_messages(), ==, 1u);
            REQUIRE_CMP(counting.live, ==, live);
            struct sdfgi_settings in_force;
            sdfgi_get_settings(gi, &in_force);
            REQUIRE_TRUE(!in_force.enabled && !gi->volume.resources && sdfgi_get_descriptor_set(gi) == blank);
        }
        failing_vulkan_reset(0, VK_SUCCESS);
        REQUIRE_CMP((int)sdfgi_set_settings(gi, &off), ==, (int)SDFGI_OK);
        for (int frame = 0; frame < 2; frame++) /* off: nothing is recorded */
            REQUIRE_CMP((int)sdfgi_update(gi, VK_NULL_HANDLE, &(struct sdfgi_frame_desc){ 0 }), ==,
                        (int)SDFGI_OK);
        REQUIRE_CMP(counting.live, ==, live);
    }
    sdfgi_destroy(gi);
    REQUIRE_CMP(counting.live, ==, 0);
}

/* A context that is switched on; nothing fails meanwhile. */
static sdfgi *create_on(struct counting *counting)
{
    struct sdfgi_desc desc = desc_on(&gpu, counting);
    const struct sdfgi_settings on = small_settings(true);
    desc.settings = &on;
    sdfgi *gi;
    failing_vulkan_reset(0, VK_SUCCESS);
    REQUIRE_CMP((int)sdfgi_create(&desc, &gi), ==, (int)SDFGI_OK);
    return gi;
}

/* Records a frame that never runs, as shaders that were skipped leave nothing behind that it could run on.
 * The context counts as active then. */
static void record_first_frame(sdfgi *gi)
{
    const VkCommandBufferAllocateInfo allocate = { .sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO,
                                                   .commandPool = gpu.command_pool,
                                                   .level = VK_COMMAND_BUFFER_LEVEL_PRIMARY,
                                                   .commandBufferCount = 1 };
    const VkCommandBufferBeginInfo begin = { .sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO };
    VkCommandBuffer cmd;
    REQUIRE_CMP((int)vkAllocateCommandBuffers(gpu.device, &allocate, &cmd), ==, (int)VK_SUCCESS);
    REQUIRE_CMP((int)vkBeginCommandBuffer(cmd, &begin), ==, (int)VK_SUCCESS);
    REQUIRE_CMP((int)sdfgi_update(gi, cmd, &(struct sdfgi_frame_desc){ 0 }), ==, (int)SDFGI_OK);
    REQUIRE_CMP((int)vkEndCommandBuffer(cmd), ==, (int)VK_SUCCESS);
    vkFreeCommandBuffers(gpu.device, gpu.command_pool, 1, &cmd);
    REQUIRE_TRUE(sdfgi_is_active(gi));
}

/* A change of resolution that fails leaves the old volumes in force. */
static void a_failed_change_leaves_the_old_settings_in_force(void **state)
{
    (void)state;
    struct counting counting = { 0 };
    sdfgi *gi = create_on(&counting);
    record_first_frame(gi);
    const VkDescriptorSet set = sdfgi_get_descriptor_set(gi);
    const struct sdfgi_settings on = small_settings(true);
    struct sdfgi_settings larger = on, in_force;
    larger.resolution = 64;
    failing_vulkan_reset(9, VK_ERROR_OUT_OF_DEVICE_MEMORY);
    REQUIRE_CMP((int)sdfgi_set_settings(gi, &larger), ==, (int)SDFGI_ERROR_OUT_OF_MEMORY);
    sdfgi_get_settings(gi, &in_force);
    REQUIRE_BYTES(&in_force, &on, sizeof on);
    REQUIRE_TRUE(sdfgi_get_descriptor_set(gi) == set && sdfgi_is_active(gi));
    failing_vulkan_reset(0, VK_SUCCESS);
    REQUIRE_CMP((int)sdfgi_set_settings(gi, &larger), ==, (int)SDFGI_OK);
    sdfgi_destroy(gi);
    REQUIRE_CMP(counting.live, ==, 0);
}

static void no_vulkan_failure_while_creating_is_fatal(void **state)
{
    (void)state;
    failing_vulkan_reset(0, VK_SUCCESS);
    for (uint32_t k = 1;; k++) {
        struct counting counting = { 0 };
        struct sdfgi_desc desc = desc_on(&gpu, &counting);
        const struct sdfgi_settings off = small_settings(false);
        desc.settings = &off;
        memset(messages, 0, sizeof messages);
        failing_vulkan_reset(k, VK_ERROR_OUT_OF_DEVICE_MEMORY);
        sdfgi *gi = NULL;
        const enum sdfgi_result result = sdfgi_create(&desc, &gi);
        const bool failed = failing_vulkan_calls() >= k;
        sdfgi_destroy(gi);
        REQUIRE_CMP(counting.live, ==, 0);
        if (!failed) {
            REQUIRE_CMP((int)result, ==, (int)SDFGI_OK);
            printf("%u Vulkan calls of creation can fail\n", k - 1);
            REQUIRE_CMP(k, >, 30u);
            break;
        }
        REQUIRE_TRUE(gi == NULL);
        REQUIRE_CMP((int)result, ==, (int)SDFGI_ERROR_OUT_OF_MEMORY);
        REQUIRE_CMP(memory_messages(), ==, 1u);
    }
}

static void no_vulkan_failure_while_adding_a_mesh_is_fatal(void **state)
{
    (void)state;
    struct counting counting = { 0 };
    const struct sdfgi_desc desc = desc_on(&gpu, &counting);
    sdfgi *gi;
    failing_vulkan_reset(0, VK_SUCCESS);
    REQUIRE_CMP((int)sdfgi_create(&desc, &gi), ==, (int)SDFGI_OK);
    const struct sdfgi_mesh_desc mesh = {
        .position_buffer = triangle.buffer, .vertex_count = 3, .triangle_count = 1, .bounds_max = { 1, 1, 0 }
    };
    for (uint32_t k = 1;; k++) {
        sdfgi_mesh handle = { 77 };
        failing_vulkan_reset(k, VK_ERROR_OUT_OF_DEVICE_MEMORY);
        const enum sdfgi_result result = sdfgi_mesh_create(gi, &mesh, &handle);
        if (failing_vulkan_calls() < k) {
            REQUIRE_CMP((int)result, ==, (int)SDFGI_OK);
            REQUIRE_CMP(k, >, 1u);
            break;
        }
        REQUIRE_CMP((int)result, ==, (int)SDFGI_ERROR_OUT_OF_MEMORY);
        REQUIRE_CMP(handle.id, ==, 77u);
    }
    failing_vulkan_reset(0, VK_SUCCESS);
    sdfgi_destroy(gi);
    REQUIRE_CMP(counting.live, ==, 0);
}

static void record_update(VkCommandBuffer cmd, uint32_t index, void *user)
{
    (void)index;
    REQUIRE_CMP((int)sdfgi_update(user, cmd, &(struct sdfgi_frame_desc){ 0 }), ==, (int)SDFGI_OK);
}

/* Two frames, so that what the first counted has come back. */
static void update_twice(sdfgi *gi)
{
    gpu_test_submit_many(&gpu, 2, record_update, gi);
}

static void add_a_triangle(sdfgi *gi)
{
    const struct sdfgi_mesh_desc mesh = {
        .position_buffer = triangle.buffer, .vertex_count = 3, .triangle_count = 1, .bounds_max = { 1, 1, 0 }
    };
    const struct sdfgi_material_desc material = { .albedo = { 1, 1, 1 } };
    struct sdfgi_instance_desc desc = { .transform = { { 1, 0, 0, 0, 1, 0, 0, 0, 1 }, { 0, 0, 0 } } };
    sdfgi_instance instance;
    REQUIRE_CMP((int)sdfgi_mesh_create(gi, &mesh, &desc.mesh), ==, (int)SDFGI_OK);
    REQUIRE_CMP((int)sdfgi_material_create(gi, &material, &desc.material), ==, (int)SDFGI_OK);
    REQUIRE_CMP((int)sdfgi_instance_create(gi, &desc, &instance), ==, (int)SDFGI_OK);
}

/* Without memory for a longer list the short one stays, is reported, and frames go on. */
static void no_failure_while_the_light_list_grows_is_fatal(void **state)
{
    (void)state;
    struct counting counting = { 0 };
    sdfgi *gi = create_on(&counting);
    add_a_triangle(gi);
    gi->volume.resources->extent.light_cells = 5;
    update_twice(gi);
    const VkDescriptorSet set = sdfgi_get_descriptor_set(gi);
    uint32_t k = 0;
    do {
        const int64_t live = counting.live;
        memset(messages, 0, sizeof messages);
        gi->volume.feedback.light_cells_refused = 0;
        failing_vulkan_reset(++k, VK_ERROR_OUT_OF_DEVICE_MEMORY);
        update_twice(gi);
        if (failing_vulkan_calls() < k)
            break;
        REQUIRE_CMP(messages[SDFGI_MESSAGE_LIGHT_CELLS_OVERFLOW], ==, 1u);
        REQUIRE_CMP(gi->volume.resources->extent.light_cells, ==, 5u);
        REQUIRE_TRUE(sdfgi_get_descriptor_set(gi) == set);
        REQUIRE_CMP(counting.live, ==, live);
    } while (k < 100);
    printf("%u Vulkan calls of growing the list can fail\n", k - 1);
    REQUIRE_CMP(k, >, 4u);
    REQUIRE_CMP(gi->volume.resources->extent.light_cells, >, 5u);
    REQUIRE_TRUE(sdfgi_get_descriptor_set(gi) != set);
    update_twice(gi);
    sdfgi_destroy(gi);
    REQUIRE_CMP(counting.live, ==, 0);
}

static const VkImageView unused_view = (VkImageView)(uintptr_t)1; /* nothing gets as far as to use it */

static struct sdfgi_gather_desc unused_gather(void)
{
    return (struct sdfgi_gather_desc){ .depth = unused_view,
                                       .normal = unused_view,
                                       .output = unused_view,
                                       .width = 1,
                                       .height = 1,
                                       .inverse_view_projection = { 1 } };
}

static struct sdfgi_debug_desc unused_debug(void)
{
    return (struct sdfgi_debug_desc){
        .output = unused_view, .width = 1, .height = 1, .inverse_view_projection = { 1 }
    };
}

/* Those for sdfgi_gather, sdfgi_debug_draw and textures, which are made when they are asked for. */
static void no_failure_to_make_a_late_pipeline_is_fatal(void **state)
{
    (void)state;
    struct counting counting = { 0 };
    sdfgi *gi = create_on(&counting);
    add_a_triangle(gi);
    update_twice(gi);
    const struct sdfgi_gather_desc gather = unused_gather();
    const struct sdfgi_debug_desc debug = unused_debug();
    const struct sdfgi_material_desc material = { .albedo = { 1, 1, 1 },
                                                  .albedo_texture = { .view = unused_view } };
    for (uint32_t k = 1; k <= 2; k++) { /* its shader module, itself */
        sdfgi_material handle = { 77 };
        memset(messages, 0, sizeof messages);
        failing_vulkan_reset(k, VK_ERROR_OUT_OF_DEVICE_MEMORY);
        REQUIRE_CMP((int)sdfgi_gather(gi, unused_commands, &gather), ==, (int)SDFGI_ERROR_OUT_OF_MEMORY);
        REQUIRE_CMP(failing_vulkan_calls(), ==, k);
        failing_vulkan_reset(k, VK_ERROR_OUT_OF_DEVICE_MEMORY);
        REQUIRE_CMP((int)sdfgi_debug_draw(gi, unused_commands, &debug), ==, (int)SDFGI_ERROR_OUT_OF_MEMORY);
        REQUIRE_CMP(failing_vulkan_calls(), ==, k);
        failing_vulkan_reset(k, VK_ERROR_OUT_OF_DEVICE_MEMORY);
        REQUIRE_CMP((int)sdfgi_material_create(gi, &material, &handle), ==, (int)SDFGI_ERROR_OUT_OF_MEMORY);
        REQUIRE_CMP(failing_vulkan_calls(), ==, k);
        REQUIRE_CMP(handle.id, ==, 77u);
        REQUIRE_CMP(memory_messages(), ==, 3u);
    }
    failing_vulkan_reset(0, VK_SUCCESS);
    sdfgi_destroy(gi);
    REQUIRE_CMP(counting.live, ==, 0);
}

/* What a picture needs is made with its first gather: a pool, and a set for each of two frames in flight. */
static void no_failure_to_make_a_view_is_fatal(void **state)
{
    (void)state;
    struct counting counting = { 0 };
    sdfgi *gi = create_on(&counting);
    record_first_frame(gi);
    const struct sdfgi_gather_desc gather = unused_gather();
    const int64_t live = counting.live;
    REQUIRE_CMP((int)sdfgi_pipelines_require(&gi->backend, PASS_GATHER, 0), ==, (int)VK_SUCCESS);
    for (uint32_t k = 1; k <= 3; k++) {
        memset(messages, 0, sizeof messages);
        failing_vulkan_reset(k, VK_ERROR_OUT_OF_DEVICE_MEMORY);
        REQUIRE_CMP((int)sdfgi_gather(gi, unused_commands, &gather), ==, (int)SDFGI_ERROR_OUT_OF_MEMORY);
        REQUIRE_CMP(failing_vulkan_calls(), ==, k);
        REQUIRE_CMP(memory_messages(), ==, 1u);
        REQUIRE_CMP(counting.live, ==, live);
    }
    counting.fail_at = counting.calls + 1;
    failing_vulkan_reset(0, VK_SUCCESS);
    REQUIRE_CMP((int)sdfgi_gather(gi, unused_commands, &gather), ==, (int)SDFGI_ERROR_OUT_OF_MEMORY);
    REQUIRE_CMP(counting.live, ==, live);
    sdfgi_destroy(gi);
    REQUIRE_CMP(counting.live, ==, 0);
}

static void a_device_lost_while_times_are_read_is_noticed(void **state)
{
    (void)state;
    const struct sdfgi_frame_desc frame = { 0 };
    struct counting counting = { 0 };
    sdfgi *gi = create_on(&counting);
    add_a_triangle(gi);
    update_twice(gi);
    memset(messages, 0, sizeof messages);
    failing_vulkan_readback_fails(true);
    failing_vulkan_reset(1, VK_ERROR_DEVICE_LOST);
    REQUIRE_CMP((int)sdfgi_update(gi, unused_commands, &frame), ==, (int)SDFGI_ERROR_DEVICE_LOST);
    failing_vulkan_readback_fails(false);
    REQUIRE_CMP(messages[SDFGI_MESSAGE_DEVICE_LOST], ==, 1u);
    REQUIRE_CMP((int)sdfgi_update(gi, unused_commands, &frame), ==, (int)SDFGI_ERROR_DEVICE_LOST);
    sdfgi_destroy(gi);
    REQUIRE_CMP(counting.live, ==, 0);
}

TEST_GROUP(allocation)
{
    if (!gpu_test_available())
        return GPU_TEST_SKIP;
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(no_host_allocation_is_fatal),
        cmocka_unit_test(no_vulkan_failure_while_switching_on_is_fatal),
        cmocka_unit_test(a_failed_change_leaves_the_old_settings_in_force),
        cmocka_unit_test(no_vulkan_failure_while_creating_is_fatal),
        cmocka_unit_test(no_vulkan_failure_while_adding_a_mesh_is_fatal),
        cmocka_unit_test_setup(no_failure_while_the_light_list_grows_is_fatal, keep_shaders),
        cmocka_unit_test_setup(no_failure_to_make_a_late_pipeline_is_fatal, keep_shaders),
        cmocka_unit_test(no_failure_to_make_a_view_is_fatal),
        cmocka_unit_test(a_device_lost_while_times_are_read_is_noticed),
    };
    return cmocka_run_group_tests(tests, open_device, close_device);
}
