/* SPDX-License-Identifier: MIT
 * An update sees what was uploaded before it in the same queue: the host makes no barrier. Synchronization
 * validation watches. */
#include "gi_test.h"
#include "require.h"
#include "test_group.h"

#include <vulkan/vulkan.h>

/* A floor, as it is uploaded. */
static const float floor_vertices[6][3] = { { -3, 0.1f, -3 }, { 3, 0.1f, -3 }, { 3, 0.1f, 3 },
                                            { -3, 0.1f, -3 }, { 3, 0.1f, 3 },  { -3, 0.1f, 3 } };

struct upload {
    struct gi_test *t;
    VkBuffer vertices;
};

static void upload_and_update(VkCommandBuffer cmd, uint32_t index, void *user)
{
    (void)index;
    const struct upload *upload = user;
    vkCmdUpdateBuffer(cmd, upload->vertices, 0, sizeof floor_vertices, floor_vertices);
    REQUIRE_CMP((int)sdfgi_update(upload->t->gi, cmd, &upload->t->frame), ==, (int)SDFGI_OK);
}

static uint64_t bits_set(struct gi_test *t)
{
    struct oracle_bits bits = gi_test_bits(t, 0);
    const uint64_t count = oracle_bits_count(&bits);
    oracle_bits_destroy(&bits);
    return count;
}

static void add_floor(struct gi_test *t, VkBuffer vertices)
{
    const struct sdfgi_mesh_desc mesh = { .position_buffer = vertices,
                                          .vertex_count = 6,
                                          .triangle_count = 2,
                                          .bounds_min = { -3, 0, -3 },
                                          .bounds_max = { 3, 0.2f, 3 } };
    struct sdfgi_instance_desc placed = { .transform.basis = { 1, 0, 0, 0, 1, 0, 0, 0, 1 } };
    placed.material = gi_test_material(t, (float[]){ 0.5f, 0.5f, 0.5f }, (float[]){ 0, 0, 0 });
    REQUIRE_CMP((int)sdfgi_mesh_create(t->gi, &mesh, &placed.mesh), ==, (int)SDFGI_OK);
    REQUIRE_CMP((int)sdfgi_instance_create(t->gi, &placed, &(sdfgi_instance){ 0 }), ==, (int)SDFGI_OK);
}

static void an_update_sees_vertices_that_were_uploaded_before_it(void **state)
{
    (void)state;
    static struct gi_test t;
    struct sdfgi_settings settings = gi_test_settings();
    settings.resolution = 32;
    gi_test_open(&t, &settings);
    static const float nothing[6][3];
    struct gpu_test_buffer vertices =
        gpu_test_buffer_device(&t.gpu, sizeof nothing, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, nothing);
    add_floor(&t, vertices.buffer);
    struct upload upload = { &t, vertices.buffer };
    gpu_test_submit(&t.gpu, upload_and_update, &upload);
    /* The floor of 6 x 6 m has 96 x 96 sub-voxels of 6.25 cm. */
    REQUIRE_CMP(bits_set(&t), >=, 96u * 96u);
    t.buffers[t.buffer_count++] = vertices;
    gi_test_close(&t);
}

TEST_GROUP(uploads)
{
    if (!gpu_test_available())
        return GPU_TEST_SKIP;
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(an_update_sees_vertices_that_were_uploaded_before_it),
    };
    return cmocka_run_group_tests_name("api_uploads", tests, NULL, NULL);
}
