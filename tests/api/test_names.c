/* SPDX-License-Identifier: MIT
 * What debuggers show: every object that the library makes has a name, which says whose it is. */
#include "failing_vulkan.h"
#include "gi_test.h"
#include "named_vulkan.h"
#include "require.h"
#include "test_group.h"

#include <sdfgi/debug.h>

#include <stdio.h>
#include <string.h>

enum { SIDE = 18 };

/* A context, and pictures for all that it can draw. */
struct stage {
    struct gi_test t;
    struct gpu_test_image texture, depth, normal, output;
    sdfgi_view *view;
};

static struct sdfgi_settings small_settings(enum sdfgi_voxelizer voxelizer)
{
    struct sdfgi_settings s = gi_test_settings();
    s.resolution = 32;
    s.voxelizer = voxelizer;
    return s;
}

static void open_context(struct gi_test *t)
{
    gpu_test_open(&t->gpu, sdfgi_get_requirements);
    failing_vulkan_reset(0, VK_SUCCESS);
    failing_vulkan_skip_shaders(true);
    const struct sdfgi_settings settings = small_settings(SDFGI_VOXELIZER_COMPUTE);
    const struct sdfgi_desc desc = { .vulkan = { t->gpu.instance, t->gpu.physical_device, t->gpu.device,
                                                 t->gpu.queue_family_index,
                                                 named_vulkan_get_instance_proc_addr },
                                     .settings = &settings };
    REQUIRE_CMP((int)sdfgi_create(&desc, &t->gi), ==, (int)SDFGI_OK);
}

static void open_pictures(struct stage *s)
{
    const struct gpu_test_image_desc texture = { .format = VK_FORMAT_R8G8B8A8_UNORM,
                                                 .extent = { SIDE, SIDE, 1 },
                                                 .usage = VK_IMAGE_USAGE_SAMPLED_BIT,
                                                 .layout = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL,
                                                 .texel_size = 4 };
    s->texture = gpu_test_image_create(&s->t.gpu, &texture);
    s->depth = gi_test_gather_image(&s->t, VK_FORMAT_R32_SFLOAT, 4, SIDE, SIDE, NULL);
    s->normal = gi_test_gather_image(&s->t, VK_FORMAT_R32G32B32A32_SFLOAT, 16, SIDE, SIDE, NULL);
    s->output = gi_test_gather_image(&s->t, VK_FORMAT_R16G16B16A16_SFLOAT, 8, SIDE, SIDE, NULL);
}

/* A box with all that a material may have. */
static void add_a_box(struct stage *s)
{
    const struct sdfgi_material_desc desc = { .albedo = { 0.5f, 0.5f, 0.5f },
                                              .emission = { 1, 1, 1 },
                                              .smoothness = 1,
                                              .albedo_texture = { .view = s->texture.view } };
    sdfgi_material material;
    REQUIRE_CMP((int)sdfgi_material_create(s->t.gi, &desc, &material), ==, (int)SDFGI_OK);
    struct test_mesh box = test_mesh_box((double[]){ 0, 0, 0 }, (double[]){ 1, 1, 1 }, test_rotation_none);
    gi_test_add(&s->t, &box, material);
    test_mesh_destroy(&box);
}

static void record_frame(VkCommandBuffer cmd, uint32_t index, void *user)
{
    (void)index;
    struct stage *s = user;
    const struct sdfgi_resolve_desc resolve = {
        .depth = s->depth.view,
        .normal = s->normal.view,
        .roughness = s->normal.view,
        .inverse_view_projection = { [0] = 1, [5] = 1, [10] = 1, [15] = 1 },
        .background_depth = 1
    };
    const struct sdfgi_debug_desc debug = {
        .output = s->output.view,
        .width = SIDE,
        .height = SIDE,
        .inverse_view_projection = { [0] = 1, [5] = 1, [10] = 1, [15] = 1 },
        .background_depth = 1,
        .view = SDFGI_DEBUG_SOLID
    };
    REQUIRE_CMP((int)sdfgi_update(s->t.gi, cmd, &(struct sdfgi_frame_desc){ 0 }), ==, (int)SDFGI_OK);
    REQUIRE_CMP((int)sdfgi_view_resolve(s->t.gi, s->view, cmd, &resolve), ==, (int)SDFGI_OK);
    REQUIRE_CMP((int)sdfgi_debug_draw(s->t.gi, cmd, &debug), ==, (int)SDFGI_OK);
}

/* Nothing runs: without shaders nobody writes how much indirect work there is. */
static void draw_with(struct stage *s, enum sdfgi_voxelizer voxelizer)
{
    const struct sdfgi_settings settings = small_settings(voxelizer);
    REQUIRE_CMP((int)sdfgi_set_settings(s->t.gi, &settings), ==, (int)SDFGI_OK);
    gpu_test_record_and_drop(&s->t.gpu, record_frame, s);
}

static void close_all(struct stage *s)
{
    struct gpu_test_image *const images[] = { &s->texture, &s->depth, &s->normal, &s->output };
    for (size_t i = 0; i < sizeof images / sizeof *images; i++)
        gpu_test_image_destroy(&s->t.gpu, images[i]);
    gi_test_close(&s->t);
}

static uint32_t count_of(VkObjectType type)
{
    uint32_t count = 0;
    for (uint32_t i = 0; i < named_vulkan.count; i++)
        count += named_vulkan.objects[i].type == type;
    return count;
}

/* So that the list is known to be of everything. */
static void require_every_kind(void)
{
    static const VkObjectType kinds[] = {
        VK_OBJECT_TYPE_BUFFER,        VK_OBJECT_TYPE_DESCRIPTOR_POOL, VK_OBJECT_TYPE_DESCRIPTOR_SET,
        VK_OBJECT_TYPE_DEVICE_MEMORY, VK_OBJECT_TYPE_FRAMEBUFFER,     VK_OBJECT_TYPE_DESCRIPTOR_SET_LAYOUT,
        VK_OBJECT_TYPE_IMAGE,         VK_OBJECT_TYPE_IMAGE_VIEW,      VK_OBJECT_TYPE_PIPELINE,
        VK_OBJECT_TYPE_QUERY_POOL,    VK_OBJECT_TYPE_PIPELINE_LAYOUT, VK_OBJECT_TYPE_RENDER_PASS,
        VK_OBJECT_TYPE_SAMPLER,       VK_OBJECT_TYPE_SHADER_MODULE
    };
    for (size_t i = 0; i < sizeof kinds / sizeof *kinds; i++) {
        printf("%u objects of VkObjectType %d\n", count_of(kinds[i]), (int)kinds[i]);
        REQUIRE_CMP(count_of(kinds[i]), >, 0u);
    }
    REQUIRE_CMP(named_vulkan.count, <, (uint32_t)NAMED_VULKAN_MOST);
    REQUIRE_CMP((int)strlen(named_vulkan.unwatched), ==, 0);
}

static void every_object_has_a_name_of_the_library(void **state)
{
    (void)state;
    static struct stage s;
    open_context(&s.t);
    open_pictures(&s);
    add_a_box(&s);
    const struct sdfgi_view_desc view = { .width = SIDE, .height = SIDE };
    REQUIRE_CMP((int)sdfgi_view_create(s.t.gi, &view, &s.view), ==, (int)SDFGI_OK);
    draw_with(&s, SDFGI_VOXELIZER_COMPUTE);
    draw_with(&s, SDFGI_VOXELIZER_RASTER);
    close_all(&s);
    require_every_kind();
    uint32_t nameless = 0;
    for (uint32_t i = 0; i < named_vulkan.count; i++) {
        const struct named_vulkan_object *object = &named_vulkan.objects[i];
        if (strncmp(object->name, "sdfgi ", 6) == 0)
            continue;
        printf("object %u of VkObjectType %d has the name \"%s\"\n", i, (int)object->type, object->name);
        nameless++;
    }
    REQUIRE_CMP(nameless, ==, 0u);
    REQUIRE_CMP(named_vulkan.strays, ==, 0u);
}

TEST_GROUP(names)
{
    if (!gpu_test_available())
        return GPU_TEST_SKIP;
    const struct CMUnitTest tests[] = { cmocka_unit_test(every_object_has_a_name_of_the_library) };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
