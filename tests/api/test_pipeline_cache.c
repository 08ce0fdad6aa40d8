/* SPDX-License-Identifier: MIT
 * The host's pipeline cache reaches every pipeline that the library makes: the loader given to the library
 * notes the cache of each call. */
#include "gi_test.h"
#include "layered_vulkan.h"
#include "require.h"
#include "test_group.h"

#include <sdfgi/debug.h>
#include <vulkan/vulkan.h>

#include <string.h>

static struct {
    VkPipelineCache wanted;
    uint32_t compute, graphics; /* calls so far */
    uint32_t others;            /* calls with another cache */
    bool refuse;
} seen;

static VKAPI_ATTR VkResult VKAPI_CALL create_compute(VkDevice device, VkPipelineCache cache, uint32_t count,
                                                     const VkComputePipelineCreateInfo *infos,
                                                     const VkAllocationCallbacks *callbacks, VkPipeline *out)
{
    seen.compute++;
    seen.others += cache != seen.wanted;
    return seen.refuse ? VK_ERROR_OUT_OF_DEVICE_MEMORY
                       : vkCreateComputePipelines(device, cache, count, infos, callbacks, out);
}

static VKAPI_ATTR VkResult VKAPI_CALL create_graphics(VkDevice device, VkPipelineCache cache, uint32_t count,
                                                      const VkGraphicsPipelineCreateInfo *infos,
                                                      const VkAllocationCallbacks *callbacks, VkPipeline *out)
{
    seen.graphics++;
    seen.others += cache != seen.wanted;
    return vkCreateGraphicsPipelines(device, cache, count, infos, callbacks, out);
}

static const struct layered_function watched[] = {
    LAYERED("vkCreateComputePipelines", create_compute),
    LAYERED("vkCreateGraphicsPipelines", create_graphics),
    { NULL, NULL },
};

static struct gpu_test gpu;

static int open_device(void **state)
{
    (void)state;
    gpu_test_open(&gpu, sdfgi_get_requirements);
    return 0;
}

static int close_device(void **state)
{
    (void)state;
    gpu_test_close(&gpu);
    return 0;
}

static void record_update(VkCommandBuffer cmd, uint32_t index, void *user)
{
    (void)index;
    REQUIRE_CMP((int)sdfgi_update(user, cmd, &(struct sdfgi_frame_desc){ 0 }), ==, (int)SDFGI_OK);
}

/* Asks for the pipelines of sdfgi_gather, debug views and textures, which are made when they are wanted. */
static void ask_for_late_pipelines(sdfgi *gi)
{
    const VkImageView view = (VkImageView)(uintptr_t)1; /* refused before anything uses it */
    const struct sdfgi_gather_desc gather = { .depth = view,
                                              .normal = view,
                                              .output = view,
                                              .width = 1,
                                              .height = 1,
                                              .inverse_view_projection = { 1 } };
    const struct sdfgi_debug_desc debug = {
        .output = view, .width = 1, .height = 1, .inverse_view_projection = { 1 }
    };
    const struct sdfgi_material_desc textured = { .albedo_texture = { .view = view } };
    const uint32_t before = seen.compute;
    sdfgi_material material;
    seen.refuse = true;
    sdfgi_gather(gi, (VkCommandBuffer)(uintptr_t)1, &gather);
    REQUIRE_CMP(seen.compute, ==, before + 1);
    sdfgi_debug_draw(gi, (VkCommandBuffer)(uintptr_t)1, &debug);
    REQUIRE_CMP(seen.compute, ==, before + 2);
    sdfgi_material_create(gi, &textured, &material);
    REQUIRE_CMP(seen.compute, ==, before + 3);
}

/* Makes every kind of pipeline that there is. */
static void live_a_whole_life(VkPipelineCache cache)
{
    struct sdfgi_settings settings = gi_test_settings();
    settings.resolution = 32;
    settings.voxelizer = SDFGI_VOXELIZER_RASTER;
    const struct sdfgi_desc desc = { .vulkan = { gpu.instance, gpu.physical_device, gpu.device,
                                                 gpu.queue_family_index, layered_vulkan_loader(watched),
                                                 NULL },
                                     .pipeline_cache = cache };
    memset(&seen, 0, sizeof seen);
    seen.wanted = cache;
    sdfgi *gi;
    REQUIRE_CMP((int)sdfgi_create(&desc, &gi), ==, (int)SDFGI_OK);
    REQUIRE_CMP(seen.compute, >, 10u);
    REQUIRE_CMP((int)sdfgi_set_settings(gi, &settings), ==, (int)SDFGI_OK);
    REQUIRE_CMP(seen.graphics, ==, 2u);
    gpu_test_submit(&gpu, record_update, gi); /* before it there is nothing to gather */
    ask_for_late_pipelines(gi);
    sdfgi_destroy(gi);
}

static void every_pipeline_is_made_with_the_hosts_cache(void **state)
{
    (void)state;
    const VkPipelineCacheCreateInfo info = { .sType = VK_STRUCTURE_TYPE_PIPELINE_CACHE_CREATE_INFO };
    VkPipelineCache cache;
    REQUIRE_CMP((int)vkCreatePipelineCache(gpu.device, &info, NULL, &cache), ==, (int)VK_SUCCESS);
    live_a_whole_life(cache);
    REQUIRE_CMP(seen.others, ==, 0u);
    /* The library only borrows it. */
    size_t size = 0;
    REQUIRE_CMP((int)vkGetPipelineCacheData(gpu.device, cache, &size, NULL), ==, (int)VK_SUCCESS);
    vkDestroyPipelineCache(gpu.device, cache, NULL);
}

static void a_host_without_a_cache_gets_none(void **state)
{
    (void)state;
    live_a_whole_life(VK_NULL_HANDLE);
    REQUIRE_CMP(seen.others, ==, 0u);
}

TEST_GROUP(pipeline_cache)
{
    if (!gpu_test_available())
        return GPU_TEST_SKIP;
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_pipeline_is_made_with_the_hosts_cache),
        cmocka_unit_test(a_host_without_a_cache_gets_none),
    };
    return cmocka_run_group_tests(tests, open_device, close_device);
}
