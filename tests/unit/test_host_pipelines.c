/* SPDX-License-Identifier: MIT
 * A start makes no pipeline that it does not need: software drivers take a third of a second for each that
 * has GI's lookup in it. vkCreateGraphicsPipelines is defined here, stands before the loader's, and counts.
 * vkGetQueryPoolResults stands before the loader's as well, and can lose the device. */
#include "files.h"
#include "host_test.h"
#include "unit.h"

#include "host.h"

#include <gltf_scene.h>
#include <stdio.h>
#include <string.h>
#include <vulkan/vulkan.h>

static struct host_device *device;
static int forward_count; /* of pipelines that shade geometry */
static bool lose_device;

VKAPI_ATTR VkResult VKAPI_CALL vkCreateGraphicsPipelines(VkDevice handle, VkPipelineCache cache,
                                                         uint32_t count,
                                                         const VkGraphicsPipelineCreateInfo *info,
                                                         const VkAllocationCallbacks *callbacks,
                                                         VkPipeline *pipeline)
{
    const PFN_vkCreateGraphicsPipelines create =
        (PFN_vkCreateGraphicsPipelines)vkGetDeviceProcAddr(handle, "vkCreateGraphicsPipelines");
    assert_int_equal(count, 1);
    forward_count += info->pVertexInputState->vertexBindingDescriptionCount > 0 &&
                     info->pColorBlendState->attachmentCount > 0 &&
                     !info->pDepthStencilState->depthWriteEnable;
    return create(handle, cache, count, info, callbacks, pipeline);
}

VKAPI_ATTR VkResult VKAPI_CALL vkGetQueryPoolResults(VkDevice handle, VkQueryPool pool, uint32_t first,
                                                     uint32_t count, size_t size, void *data,
                                                     VkDeviceSize stride, VkQueryResultFlags flags)
{
    const PFN_vkGetQueryPoolResults get =
        (PFN_vkGetQueryPoolResults)vkGetDeviceProcAddr(handle, "vkGetQueryPoolResults");
    return lose_device ? VK_ERROR_DEVICE_LOST : get(handle, pool, first, count, size, data, stride, flags);
}

/* A triangle of each of the materials, which are JSON objects separated by commas. */
static struct gltf_scene *scene_of(const char *materials, int count)
{
    char text[2048], primitives[512] = "", error[256];
    for (int i = 0; i < count; i++) {
        const size_t length = strlen(primitives);
        snprintf(primitives + length, sizeof primitives - length,
                 "%s{\"attributes\":{\"POSITION\":0},\"material\":%d}", i > 0 ? "," : "", i);
    }
    snprintf(
        text, sizeof text,
        "{\"asset\":{\"version\":\"2.0\"},\"scene\":0,\"scenes\":[{\"nodes\":[0]}],\"nodes\":[{\"mesh\":0}],"
        "\"materials\":[%s],\"meshes\":[{\"primitives\":[%s]}],"
        "\"buffers\":[{\"byteLength\":36,\"uri\":\"data:application/octet-stream;base64,"
        "AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA\"}],"
        "\"bufferViews\":[{\"buffer\":0,\"byteLength\":36}],"
        "\"accessors\":[{\"bufferView\":0,\"componentType\":5126,\"count\":3,\"type\":\"VEC3\","
        "\"min\":[0,0,0],\"max\":[1,1,0]}]}",
        materials, primitives);
    files_write_text("scene.gltf", text);
    struct gltf_scene *const scene = gltf_scene_load(files_path("scene.gltf"), error, sizeof error);
    remove(files_path("scene.gltf"));
    if (!scene)
        fail_msg("%s", error);
    return scene;
}

struct stage {
    struct gltf_scene *gltf;
    struct host_scene *scene;
    struct host_renderer *renderer;
    struct sdfgi_settings settings;
};

static const struct host_view view = { .camera = { .position = { 0.3, 0.3, 2 },
                                                   .look_at = { 0.3, 0.3, 0 } } };

static void stage_open(struct stage *stage, const char *materials, int count, enum host_lookup lookup)
{
    sdfgi_settings_default(&stage->settings);
    stage->settings.cascades = 1;
    stage->settings.resolution = 32;
    forward_count = 0;
    stage->gltf = scene_of(materials, count);
    stage->scene = host_scene_create(device, stage->gltf, &view);
    assert_non_null(stage->scene);
    const struct host_renderer_desc desc = {
        .width = 24, .height = 24, .settings = &stage->settings, .lookups = { lookup, HOST_LOOKUP_FULL }
    };
    stage->renderer = host_renderer_create(device, stage->scene, &desc);
    if (!stage->renderer)
        fail_msg("%s", host_device_error(device));
}

static void stage_close(struct stage *stage)
{
    host_renderer_destroy(stage->renderer);
    host_scene_destroy(stage->scene);
    gltf_scene_destroy(stage->gltf);
}

static void frame(struct stage *stage, bool gi)
{
    stage->settings.enabled = gi;
    assert_true(host_renderer_set_settings(stage->renderer, &stage->settings));
    assert_true(host_renderer_frame(stage->renderer, &view.camera));
}

static void one_material_needs_one_pipeline(void **state)
{
    (void)state;
    struct stage stage;
    stage_open(&stage, "{}", 1, HOST_LOOKUP_FORWARD);
    assert_int_equal(forward_count, 1);
    frame(&stage, false);
    assert_int_equal(forward_count, 1);
    stage_close(&stage);
}

static void each_kind_of_material_adds_one(void **state)
{
    (void)state;
    struct stage stage;
    stage_open(&stage,
               "{},{\"doubleSided\":true},{\"alphaMode\":\"BLEND\"},{\"metallicFactor\":0},"
               "{\"doubleSided\":true,\"alphaMode\":\"BLEND\"}",
               5, HOST_LOOKUP_FORWARD);
    assert_int_equal(forward_count, 4);
    frame(&stage, false);
    assert_int_equal(forward_count, 4);
    stage_close(&stage);
}

static void switching_gi_makes_the_other_pipelines_once(void **state)
{
    (void)state;
    struct stage stage;
    stage_open(&stage, "{},{\"doubleSided\":true}", 2, HOST_LOOKUP_FORWARD);
    for (int round = 0; round < 2; round++) {
        frame(&stage, false);
        assert_int_equal(forward_count, round == 0 ? 2 : 4);
        frame(&stage, true);
        assert_int_equal(forward_count, 4);
    }
    stage_close(&stage);
}

/* Blended surfaces look light up themselves. */
static void gathered_light_needs_as_many_pipelines(void **state)
{
    (void)state;
    struct stage stage;
    stage_open(&stage, "{},{\"alphaMode\":\"BLEND\"}", 2, HOST_LOOKUP_HALF);
    assert_int_equal(forward_count, 2);
    for (int round = 0; round < 2; round++) {
        frame(&stage, true);
        assert_int_equal(forward_count, 4);
        frame(&stage, false);
        assert_int_equal(forward_count, 4);
    }
    stage_close(&stage);
}

static void a_device_lost_while_times_are_read_is_noticed(void **state)
{
    (void)state;
    struct stage stage;
    stage_open(&stage, "{}", 1, HOST_LOOKUP_FORWARD);
    const struct host_until_desc two = { .frames = 2 };
    stage.settings.enabled = false;
    assert_true(host_renderer_set_settings(stage.renderer, &stage.settings));
    assert_true(host_render_until(stage.renderer, &view.camera, &two, NULL));
    lose_device = true;
    assert_false(host_render_until(stage.renderer, &view.camera, &two, NULL));
    lose_device = false;
    assert_non_null(strstr(host_device_error(device), "lost"));
    stage_close(&stage);
}

int main(void)
{
    device = host_test_open();
    if (!device)
        return HOST_TEST_SKIP;
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(one_material_needs_one_pipeline),
        cmocka_unit_test(each_kind_of_material_adds_one),
        cmocka_unit_test(switching_gi_makes_the_other_pipelines_once),
        cmocka_unit_test(gathered_light_needs_as_many_pipelines),
        cmocka_unit_test(a_device_lost_while_times_are_read_is_noticed),
    };
    return host_test_close(device, cmocka_run_group_tests(tests, files_setup, files_teardown));
}
