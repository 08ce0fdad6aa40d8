/* SPDX-License-Identifier: MIT
 * Fog costs what it needs where there is fog, and nothing where there is none. Functions of Vulkan that are
 * defined here stand before the loader's and count what the host calls; the library asks the driver for its
 * own.
 */
#define _GNU_SOURCE
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "fog_scene.h"
#include "host_test.h"
#include "require.h"
#include "test_group.h"

#include <dlfcn.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <vulkan/vulkan.h>

static struct host_device *device;

static struct counts {
    int compute_pipelines, dispatches, volumes, images, samplers, set_layouts;
    VkDeviceSize bytes;
} counts;

/* The loader's function. */
#define NEXT(name) ((PFN_##name)(uintptr_t)dlsym(RTLD_NEXT, #name))

VKAPI_ATTR VkResult VKAPI_CALL vkCreateComputePipelines(VkDevice handle, VkPipelineCache cache,
                                                        uint32_t count,
                                                        const VkComputePipelineCreateInfo *info,
                                                        const VkAllocationCallbacks *callbacks,
                                                        VkPipeline *pipelines)
{
    counts.compute_pipelines += (int)count;
    return NEXT(vkCreateComputePipelines)(handle, cache, count, info, callbacks, pipelines);
}

VKAPI_ATTR void VKAPI_CALL vkCmdDispatch(VkCommandBuffer cmd, uint32_t x, uint32_t y, uint32_t z)
{
    counts.dispatches++;
    NEXT(vkCmdDispatch)(cmd, x, y, z);
}

VKAPI_ATTR VkResult VKAPI_CALL vkCreateImage(VkDevice handle, const VkImageCreateInfo *info,
                                             const VkAllocationCallbacks *callbacks, VkImage *image)
{
    counts.images++;
    counts.volumes += info->imageType == VK_IMAGE_TYPE_3D;
    return NEXT(vkCreateImage)(handle, info, callbacks, image);
}

VKAPI_ATTR VkResult VKAPI_CALL vkCreateSampler(VkDevice handle, const VkSamplerCreateInfo *info,
                                               const VkAllocationCallbacks *callbacks, VkSampler *sampler)
{
    counts.samplers++;
    return NEXT(vkCreateSampler)(handle, info, callbacks, sampler);
}

VKAPI_ATTR VkResult VKAPI_CALL vkCreateDescriptorSetLayout(VkDevice handle,
                                                           const VkDescriptorSetLayoutCreateInfo *info,
                                                           const VkAllocationCallbacks *callbacks,
                                                           VkDescriptorSetLayout *layout)
{
    counts.set_layouts++;
    return NEXT(vkCreateDescriptorSetLayout)(handle, info, callbacks, layout);
}

VKAPI_ATTR VkResult VKAPI_CALL vkAllocateMemory(VkDevice handle, const VkMemoryAllocateInfo *info,
                                                const VkAllocationCallbacks *callbacks,
                                                VkDeviceMemory *memory)
{
    counts.bytes += info->allocationSize;
    return NEXT(vkAllocateMemory)(handle, info, callbacks, memory);
}

/* What a start takes, and then a frame. */
struct cost {
    struct counts start, frame;
    struct host_times times;
};

static struct cost cost_of(struct host_fog fog, bool gi)
{
    static float rgba[4 * FOG_PIXELS];
    struct cost cost;
    struct fog_stage stage;
    struct fog_scene scene = fog_scene_empty(0);
    scene.view.sky.zenith[0] = 1;
    scene.view.fog = fog;
    scene.gi = gi;
    counts = (struct counts){ 0 };
    fog_stage_open(&stage, device, &scene);
    cost.start = counts;
    counts = (struct counts){ 0 };
    assert_true(host_renderer_frame(stage.renderer, &stage.camera));
    cost.frame = counts;
    /* Parts of the light are shown without fog. */
    counts = (struct counts){ 0 };
    assert_true(host_renderer_read_aov(stage.renderer, HOST_AOV_DIRECT, rgba));
    REQUIRE_CMP(counts.dispatches, ==, 0);
    host_renderer_get_times(stage.renderer, &cost.times);
    fog_stage_close(&stage);
    return cost;
}

static void without_density_there_is_no_fog(void **state)
{
    (void)state;
    for (int gi = 0; gi < 2; gi++) {
        const struct cost none = cost_of((struct host_fog){ 0 }, gi),
                          thin = cost_of((struct host_fog){ .albedo = { 1, 1, 1 }, .anisotropy = 0.5f }, gi);
        REQUIRE_CMP(memcmp(&none.start, &thin.start, sizeof none.start), ==, 0);
        REQUIRE_CMP(none.start.compute_pipelines, ==, 1); /* finds the exposure */
        REQUIRE_CMP(none.start.volumes, ==, 0);
        REQUIRE_CMP(none.frame.dispatches, ==, 0);
        REQUIRE_CMP(none.times.fog_ns, ==, 0ul);
    }
}

static void fog_costs_what_it_needs(void **state)
{
    (void)state;
    const struct host_fog fog = { .density = 0.1f, .albedo = { 1, 1, 1 } };
    for (int gi = 0; gi < 2; gi++) {
        const struct cost none = cost_of((struct host_fog){ 0 }, gi), some = cost_of(fog, gi);
        REQUIRE_CMP(some.start.compute_pipelines, ==, none.start.compute_pipelines + 3 + gi);
        REQUIRE_CMP(some.start.volumes, ==, 2);
        REQUIRE_CMP(some.start.bytes, >, none.start.bytes);
        REQUIRE_CMP(some.frame.dispatches, ==, 3 + gi);
        REQUIRE_CMP(some.frame.compute_pipelines + some.frame.images, ==, 0);
    }
}

/* A frame of a stage with light from GI, and how many dispatches of the host's it took. */
static uint32_t draw_one(struct host_fog fog, bool left_out, float rgba[4 * FOG_PIXELS])
{
    struct fog_stage stage;
    struct fog_scene scene = fog_scene_empty(0);
    scene.view.sky.zenith[0] = 1;
    scene.view.fog = fog;
    scene.gi = true;
    fog_stage_open(&stage, device, &scene);
    host_renderer_leave_out(stage.renderer, &(struct host_effects){ .fog = left_out });
    counts = (struct counts){ 0 };
    assert_true(host_renderer_frame(stage.renderer, &stage.camera));
    const uint32_t dispatches = (uint32_t)counts.dispatches;
    assert_true(host_renderer_read_aov(stage.renderer, HOST_AOV_COLOR, rgba));
    fog_stage_close(&stage);
    return dispatches;
}

static void fog_that_is_left_out_is_no_fog(void **state)
{
    (void)state;
    static float none[4 * FOG_PIXELS], some[4 * FOG_PIXELS], left_out[4 * FOG_PIXELS];
    const struct host_fog fog = { .density = 0.1f, .albedo = { 1, 1, 1 } };
    draw_one((struct host_fog){ 0 }, false, none);
    REQUIRE_CMP(draw_one(fog, false, some), >, 0u);
    REQUIRE_CMP(draw_one(fog, true, left_out), ==, 0u);
    REQUIRE_CMP(memcmp(none, some, sizeof none), !=, 0);
    REQUIRE_CMP(memcmp(none, left_out, sizeof none), ==, 0);
}

TEST_GROUP(no_fog)
{
    device = host_test_open();
    if (!device)
        return HOST_TEST_SKIP;
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(without_density_there_is_no_fog),
        cmocka_unit_test(fog_costs_what_it_needs),
        cmocka_unit_test(fog_that_is_left_out_is_no_fog),
    };
    return host_test_close(device, cmocka_run_group_tests(tests, NULL, NULL));
}
