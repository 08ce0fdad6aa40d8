/* SPDX-License-Identifier: MIT
 * What a scene calls for is all that is worked on: cells of a step, pixels that show something. */
#include "light_scene.h"
#include "require.h"
#include "test_group.h"

#include <stdlib.h>

static struct sdfgi_report report; /* too large for the stack of a test */

static const struct sdfgi_report *report_now(struct gi_test *t)
{
    sdfgi_get_report(t->gi, &report);
    return &report;
}

static uint64_t work_of(enum pass pass)
{
    return report.passes[pass].ran ? report.passes[pass].work : 0;
}

static struct sdfgi_settings small_settings(uint32_t cascades)
{
    struct sdfgi_settings settings = light_settings(32, 0.4f);
    settings.cascades = cascades;
    return settings;
}

static void add_floor(struct gi_test *t)
{
    light_add_box(t, (double[]){ -4, -3, -4 }, (double[]){ 4, -2.1, 4 }, (float[]){ 0.5f, 0.5f, 0.5f }, 0);
}

/* Without geometry and without a sky there is nothing to find out: light has settled as soon as a cycle has
 * come back that changed nothing. */
static void nothing_to_see_is_over_soon(void **state)
{
    struct gi_test *t = *state;
    const struct sdfgi_settings settings = small_settings(2);
    gi_test_restart(t, &settings);
    REQUIRE_CMP(gi_test_converge(t, 60), <=, 6 * sdfgi_settings_cycle_frames(&settings));
    gi_test_update(t, 1);
    REQUIRE_CMP(report_now(t)->command_count, ==, 0u);
}

/* A cascade that moves by a probe voxelises the slab that it enters, and no more. */
static void a_step_works_on_its_slab_alone(void **state)
{
    struct gi_test *t = *state;
    const struct sdfgi_settings settings = small_settings(1);
    gi_test_restart(t, &settings);
    add_floor(t);
    light_set_uniform_sky(t, 1);
    gi_test_converge(t, 120);
    const uint64_t slab = SDFGI_PROBE_SPACING * 32 * 32;
    uint64_t cleared = 0, resolved = 0;
    t->frame.camera_position[0] = 0.4 * (SDFGI_PROBE_SPACING + 2);
    for (int i = 0; i < 20; i++) {
        gi_test_update(t, 1);
        report_now(t);
        cleared += work_of(PASS_REGION_CLEAR);
        resolved += work_of(PASS_VOXEL_RESOLVE);
    }

    REQUIRE_CMP(cleared, ==, slab);
    REQUIRE_CMP(resolved, ==, slab / 8); /* blocks */
}

/* Gathers a picture that shows `depth` everywhere. Returns how many light cells it has read, and whether it
 * shows light. */
static uint32_t cells_seen(struct gi_test *t, float depth, bool *lit)
{
    enum { SIDE = 36 };
    static float depths[SIDE * SIDE], normals[SIDE * SIDE][4];
    static uint16_t found[SIDE * SIDE][4];
    for (int i = 0; i < SIDE * SIDE; i++) {
        depths[i] = depth;
        normals[i][1] = 1;
    }
    struct gpu_test_image images[3] = {
        gi_test_gather_image(t, VK_FORMAT_R32_SFLOAT, 4, SIDE, SIDE, depths),
        gi_test_gather_image(t, VK_FORMAT_R32G32B32A32_SFLOAT, 16, SIDE, SIDE, normals),
        gi_test_gather_image(t, VK_FORMAT_R16G16B16A16_SFLOAT, 8, SIDE, SIDE, NULL),
    };
    const struct sdfgi_gather_desc desc = {
        images[0].view,
        images[1].view,
        images[2].view,
        .width = SIDE,
        .height = SIDE,
        .background_depth = 1,
        /* Depth 0 to 1 is y from -1.8 to -2.4; x and z are within 2 m. */
        .inverse_view_projection = { 2, 0, 0, 0, 0, 0, 2, 0, 0, -0.6f, 0, 0, 0, -1.8f, 0, 1 },
    };
    gi_test_gather(t, &desc);
    gpu_test_image_read(&t->gpu, images[2].image, VK_IMAGE_LAYOUT_GENERAL, VK_IMAGE_ASPECT_COLOR_BIT,
                        images[2].extent, 8, found);
    *lit = false;
    for (int i = 0; i < SIDE * SIDE; i++)
        *lit = *lit || found[i][1] != 0;
    for (int i = 0; i < 3; i++)
        gpu_test_image_destroy(&t->gpu, &images[i]);
    uint32_t *counters = gi_test_read(t, RESOURCE_COUNTERS, NULL);
    const uint32_t seen = counters[SDFGI_COUNTER_CELLS_SEEN];
    free(counters);
    return seen;
}

static void background_calls_for_nothing(void **state)
{
    struct gi_test *t = *state;
    bool lit;
    struct sdfgi_settings settings = small_settings(1);
    settings.surface_light = SDFGI_SURFACE_LIGHT_CELLS;
    gi_test_restart(t, &settings);
    add_floor(t);
    light_set_uniform_sky(t, 1);
    gi_test_update(t, 4);
    REQUIRE_CMP(cells_seen(t, 1, &lit), ==, 0u);
    REQUIRE_TRUE(!lit);
    REQUIRE_CMP(cells_seen(t, 0.5f, &lit), >, 0u);
    REQUIRE_TRUE(lit);
}

TEST_GROUP(least)
{
    if (!gpu_test_available())
        return GPU_TEST_SKIP;
    static struct gi_test t;
    const struct sdfgi_settings settings = small_settings(1);
    gi_test_open(&t, &settings);
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_prestate(nothing_to_see_is_over_soon, &t),
        cmocka_unit_test_prestate(a_step_works_on_its_slab_alone, &t),
        cmocka_unit_test_prestate(background_calls_for_nothing, &t),
    };
    const int failed = cmocka_run_group_tests(tests, NULL, NULL);
    gi_test_close(&t);
    return failed;
}
