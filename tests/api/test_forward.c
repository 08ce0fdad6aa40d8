/* SPDX-License-Identifier: MIT
 * A host draws with the lookup set at any time after creation: without an update ever, before the first one,
 * while GI is on and once it is off. One shader and one pipeline do for all of it. */
#include "forward_pass.h"
#include "gi_test.h"
#include "require.h"
#include "test_group.h"

enum { TEXELS = FORWARD_SIDE * FORWARD_SIDE };

static struct gi_test t;
static struct forward_pass forward;

static struct sdfgi_settings settings(bool enabled)
{
    struct sdfgi_settings s = gi_test_settings();
    s.resolution = 32;
    s.enabled = enabled;
    return s;
}

static void enable(bool enabled)
{
    const struct sdfgi_settings s = settings(enabled);
    REQUIRE_CMP((int)sdfgi_set_settings(t.gi, &s), ==, (int)SDFGI_OK);
}

static int open_host(void **state)
{
    (void)state;
    const struct sdfgi_settings off = settings(false);
    gpu_test_open(&t.gpu, sdfgi_get_requirements);
    struct sdfgi_desc desc = gi_test_desc(&t, &off);
    desc.pipelines_later = true;
    REQUIRE_CMP((int)sdfgi_create(&desc, &t.gi), ==, (int)SDFGI_OK);
    forward_pass_open(&forward, &t.gpu, t.gi);
    return 0;
}

static int close_host(void **state)
{
    (void)state;
    forward_pass_close(&forward, &t.gpu);
    gi_test_close(&t);
    return 0;
}

static void add_lit_floor(void)
{
    struct test_mesh floor =
        test_mesh_box((double[]){ 0, -2, 0 }, (double[]){ 3, 0.5, 3 }, test_rotation_none);
    gi_test_add(&t, &floor, gi_test_material(&t, (float[]){ 0.5f, 0.5f, 0.5f }, (float[]){ 0, 0, 0 }));
    test_mesh_destroy(&floor);
    const struct sdfgi_sky sky = { { 1, 2, 3 }, { 1, 2, 3 }, { 1, 2, 3 } };
    REQUIRE_CMP((int)sdfgi_set_sky(t.gi, &sky), ==, (int)SDFGI_OK);
}

/* The least and the most GI of the picture, beside the host's own light. */
static void require_gi(float least, float most)
{
    static float texels[TEXELS][4];
    const VkDescriptorSet set = sdfgi_get_descriptor_set(t.gi);
    REQUIRE_TRUE(set != VK_NULL_HANDLE);
    forward_pass_draw(&forward, &t.gpu, set, texels);
    for (int i = 0; i < TEXELS; i++) {
        REQUIRE_CMP(texels[i][3], ==, 0.25f);
        for (int k = 0; k < 3; k++) {
            REQUIRE_CMP(texels[i][k], >=, least);
            REQUIRE_CMP(texels[i][k], <=, most);
        }
    }
}

static void a_host_that_never_updates_sees_black_gi(void **state)
{
    (void)state;
    require_gi(0, 0);
    add_lit_floor();
    require_gi(0, 0);
    const struct sdfgi_settings on = settings(true);
    const struct sdfgi_prepare_desc desc = { .settings = &on, .max_objects = 30 };
    REQUIRE_CMP((int)sdfgi_prepare(t.gi, &desc, NULL), ==, (int)SDFGI_OK);
    require_gi(0, 0);
    enable(true);
    require_gi(0, 0);
    enable(false);
    require_gi(0, 0);
}

static void one_pipeline_does_for_on_and_off(void **state)
{
    (void)state;
    const struct sdfgi_settings on = settings(true);
    add_lit_floor();
    for (int round = 0; round < 4; round++) {
        enable(true);
        require_gi(0, 0);
        gi_test_update(&t, 4);
        require_gi(0.5f, 100);
        enable(false);
        require_gi(0, 0);
        gi_test_update(&t, 3);
        require_gi(0, 0);
        if (round == 1) { /* volumes are kept from here on */
            const struct sdfgi_prepare_desc desc = { .settings = &on };
            REQUIRE_CMP((int)sdfgi_prepare(t.gi, &desc, NULL), ==, (int)SDFGI_OK);
        }
    }
}

TEST_GROUP(forward)
{
    if (!gpu_test_available())
        return GPU_TEST_SKIP;
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(a_host_that_never_updates_sees_black_gi, open_host, close_host),
        cmocka_unit_test_setup_teardown(one_pipeline_does_for_on_and_off, open_host, close_host),
    };
    return cmocka_run_group_tests_name("api_forward", tests, NULL, NULL);
}
