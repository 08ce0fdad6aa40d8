/* SPDX-License-Identifier: MIT
 * Views: what a resolve makes of a picture, what it needs for that, and what it leaves out. */
#include "require.h"
#include "test_group.h"
#include "view_stage.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

static struct view_stage stage;

static void a_scene_without_smooth_materials_makes_nothing_for_reflections(void **state)
{
    (void)state;
    view_stage_open(&stage, 0.05f);
    sdfgi_view *view = view_stage_view(&stage);
    const uint64_t before = view_stage_bytes(&stage);
    view_stage_resolve(&stage, view, 0.1f);
    struct sdfgi_view_images images;
    sdfgi_view_get_images(view, &images);
    REQUIRE_TRUE(images.diffuse != VK_NULL_HANDLE && images.reflection == VK_NULL_HANDLE);
    REQUIRE_CMP(view_stage_bytes(&stage), ==, before);
    REQUIRE_CMP(view_stage_dispatches(&stage, PASS_GATHER), ==, 1u);
    for (int pass = PASS_REFLECT_TILES; pass <= PASS_REFLECT_FILTER; pass++) {
        REQUIRE_CMP(view_stage_dispatches(&stage, (enum pass)pass), ==, 0u);
        REQUIRE_TRUE(!stage.t.gi->backend.pipelines.passes[pass][0]);
    }
    view_stage_close(&stage);
}

/* Its pictures are in no layout yet, and no pass may touch them. */
static void a_view_with_pictures_of_reflections_does_without(void **state)
{
    (void)state;
    view_stage_open(&stage, 0.05f);
    sdfgi_view *view = NULL;
    const struct sdfgi_view_desc desc = { .width = VIEW_STAGE_SIDE,
                                          .height = VIEW_STAGE_SIDE,
                                          .reflections = true };
    REQUIRE_CMP((int)sdfgi_view_create(stage.t.gi, &desc, &view), ==, (int)SDFGI_OK);
    view_stage_resolve(&stage, view, 0.1f);
    struct sdfgi_view_images images;
    sdfgi_view_get_images(view, &images);
    REQUIRE_TRUE(images.reflection == VK_NULL_HANDLE);
    view_stage_close(&stage);
}

static void surfaces_of_roughness_1_reflect_irradiance(void **state)
{
    (void)state;
    static float diffuse[VIEW_STAGE_PIXELS][4], reflection[VIEW_STAGE_PIXELS][4];
    view_stage_open(&stage, 1);
    sdfgi_view *view = view_stage_view(&stage);
    view_stage_resolve(&stage, view, 1);
    view_stage_read(&stage, &view->diffuse, diffuse);
    view_stage_read(&stage, &view->reflection, reflection);
    double worst = 0, brightest = 0;
    for (int i = 0; i < VIEW_STAGE_PIXELS; i++)
        for (int k = 0; k < 3; k++) {
            const double want = (double)diffuse[i][k] / 3.14159265;
            worst = fmax(worst, fabs((double)reflection[i][k] - want) / fmax(want, 0.01));
            brightest = fmax(brightest, want);
        }
    printf("roughness 1: off by %.2e at most, brightest %.3f\n", worst, brightest);
    view_stage_close(&stage);
    REQUIRE_CMP(brightest, >, 0.3);
    REQUIRE_CMP(worst, <=, 0.002);
}

static void mirrors_show_the_sky_where_nothing_is_above(void **state)
{
    (void)state;
    static float reflection[VIEW_STAGE_PIXELS][4];
    view_stage_open(&stage, 1);
    sdfgi_view *view = view_stage_view(&stage);
    view_stage_resolve(&stage, view, 0);
    view_stage_read(&stage, &view->reflection, reflection);
    double worst = 0;
    for (int i = 0; i < VIEW_STAGE_PIXELS; i++)
        for (int k = 0; k < 3; k++) {
            const double want = stage.depths[i] < 1 ? (double)view_stage_zenith[k] : 0;
            worst = fmax(worst, fabs((double)reflection[i][k] - want));
        }
    printf("mirror: off by %.2e at most\n", worst);
    view_stage_close(&stage);
    REQUIRE_CMP(worst, <=, 0.002);
}

/* Rays make the reflections of the smooth half, and the gather those of the other one. Pictures before had it
 * the other way round. */
static void smooth_and_rough_surfaces_share_a_picture(void **state)
{
    (void)state;
    static float mirror[VIEW_STAGE_PIXELS][4], matt[VIEW_STAGE_PIXELS][4], both[VIEW_STAGE_PIXELS][4];
    view_stage_open(&stage, 1);
    sdfgi_view *views[] = { view_stage_view(&stage),
                            view_stage_view_of(&stage, SDFGI_GATHER_HALF, SDFGI_GATHER_FULL) };
    for (int v = 0; v < 2; v++) {
        view_stage_resolve(&stage, views[v], 0);
        view_stage_read(&stage, &views[v]->reflection, mirror);
        view_stage_resolve(&stage, views[v], 1);
        view_stage_read(&stage, &views[v]->reflection, matt);
        view_stage_resolve_halves(&stage, views[v], 1, 0);
        view_stage_resolve_halves(&stage, views[v], 0, 1);
        view_stage_read(&stage, &views[v]->reflection, both);
        REQUIRE_CMP(memcmp(mirror, matt, sizeof both), !=, 0);
        for (int i = 0; i < VIEW_STAGE_PIXELS; i++)
            REQUIRE_CMP(memcmp(both[i], i % VIEW_STAGE_SIDE < VIEW_STAGE_SIDE / 2 ? mirror[i] : matt[i],
                               sizeof *both),
                        ==, 0);
    }
    view_stage_close(&stage);
}

/* What a resolve records: b barriers, d dispatches, i indirect ones. */
static struct {
    struct gpu_functions below;
    char commands[64];
    size_t count;
} recorded;

static void note(char command)
{
    REQUIRE_CMP(recorded.count, <, sizeof recorded.commands - 1);
    recorded.commands[recorded.count++] = command;
}

static VKAPI_ATTR void VKAPI_CALL barrier(VkCommandBuffer cmd, VkPipelineStageFlags from,
                                          VkPipelineStageFlags to, VkDependencyFlags flags,
                                          uint32_t memory_count, const VkMemoryBarrier *memory,
                                          uint32_t buffer_count, const VkBufferMemoryBarrier *buffers,
                                          uint32_t image_count, const VkImageMemoryBarrier *images)
{
    note('b');
    recorded.below.CmdPipelineBarrier(cmd, from, to, flags, memory_count, memory, buffer_count, buffers,
                                      image_count, images);
}

static VKAPI_ATTR void VKAPI_CALL dispatch(VkCommandBuffer cmd, uint32_t x, uint32_t y, uint32_t z)
{
    note('d');
    recorded.below.CmdDispatch(cmd, x, y, z);
}

static VKAPI_ATTR void VKAPI_CALL dispatch_indirect(VkCommandBuffer cmd, VkBuffer buffer, VkDeviceSize offset)
{
    note('i');
    recorded.below.CmdDispatchIndirect(cmd, buffer, offset);
}

/* Layouts; tiles; rays, and the gather without a barrier between them; both runs of the filter. */
static void rays_do_not_wait_for_the_gather(void **state)
{
    (void)state;
    view_stage_open(&stage, 1);
    sdfgi_view *view = view_stage_view(&stage);
    view_stage_resolve(&stage, view, 0.2f);
    struct gpu_functions *fn = &stage.t.gi->backend.device.fn;
    recorded.below = *fn;
    fn->CmdPipelineBarrier = barrier;
    fn->CmdDispatch = dispatch;
    fn->CmdDispatchIndirect = dispatch_indirect;
    view_stage_resolve(&stage, view, 0.2f);
    *fn = recorded.below;
    REQUIRE_CMP(strcmp(recorded.commands, "bbbdbidbibib"), ==, 0);
    view_stage_close(&stage);
}

/* Normals of a texture lean by 60 degrees: reflected rays would lead into the floor. Right of the wall they
 * see nothing but sky. */
static void normals_that_lean_reflect_no_surface_of_their_own(void **state)
{
    (void)state;
    static float reflection[VIEW_STAGE_PIXELS][4];
    stage.lean = 1.732f;
    view_stage_open(&stage, 1);
    sdfgi_view *view = view_stage_view(&stage);
    view_stage_resolve(&stage, view, 0);
    view_stage_read(&stage, &view->reflection, reflection);
    for (int i = 0; i < VIEW_STAGE_PIXELS; i++)
        if (i % VIEW_STAGE_SIDE > VIEW_STAGE_SIDE / 2)
            REQUIRE_CMP(reflection[i][3], >=, 65000.0f);
    view_stage_close(&stage);
}

/* 64 steps from a mirror to a matt surface. */
static void roughness_changes_reflections_without_a_step(void **state)
{
    (void)state;
    static float reflection[VIEW_STAGE_PIXELS][4];
    view_stage_open(&stage, 1);
    sdfgi_view *view = view_stage_view(&stage);
    double before = 0, worst = 0, first = 0;
    for (int step = 0; step <= 64; step++) {
        view_stage_resolve(&stage, view, (float)step / 64);
        view_stage_read(&stage, &view->reflection, reflection);
        const double mean = view_stage_luminance(reflection);
        if (step > 0)
            worst = fmax(worst, fabs(mean - before) / fmax(mean, before));
        first = step == 0 ? mean : first;
        before = mean;
    }
    printf("roughness 0: %.3f, 1: %.3f, largest step %.2f %%\n", first, before, 100 * worst);
    view_stage_close(&stage);
    REQUIRE_CMP(fabs(first - before) / first, >, 0.05);
    REQUIRE_CMP(worst, <=, 0.03);
}

static void views_have_pictures_of_their_own_and_give_them_back(void **state)
{
    (void)state;
    static float a[VIEW_STAGE_PIXELS][4], b[VIEW_STAGE_PIXELS][4];
    view_stage_open(&stage, 1);
    const uint64_t none = view_stage_bytes(&stage);
    sdfgi_view *one = view_stage_view(&stage), *two = view_stage_view(&stage);
    const uint64_t diffuse = view_stage_bytes(&stage);
    view_stage_resolve(&stage, one, 0);
    view_stage_resolve(&stage, two, 1);
    view_stage_read(&stage, &two->reflection, b);
    view_stage_resolve(&stage, two, 0);
    view_stage_read(&stage, &one->reflection, a);
    REQUIRE_CMP(memcmp(a, b, sizeof a), !=, 0);
    view_stage_read(&stage, &two->reflection, b);
    REQUIRE_CMP(memcmp(a, b, sizeof a), ==, 0);
    const uint64_t all = view_stage_bytes(&stage);
    REQUIRE_CMP(diffuse, >=, none + 2 * 8 * VIEW_STAGE_PIXELS);
    REQUIRE_CMP(all, >=, diffuse + 2 * 20 * VIEW_STAGE_PIXELS);
    sdfgi_view_destroy(stage.t.gi, one);
    sdfgi_view_destroy(stage.t.gi, NULL);
    gi_test_update(&stage.t, 4);
    REQUIRE_CMP(view_stage_bytes(&stage), ==, none + (all - none) / 2);
    sdfgi_view_destroy(stage.t.gi, two);
    gi_test_update(&stage.t, 4);
    REQUIRE_CMP(view_stage_bytes(&stage), ==, none);
    view_stage_close(&stage);
}

/* Two eyes, 40 cm apart from a metre above, whose pictures show the same points of the floor. */
static void eyes_share_an_update_and_see_the_same_light(void **state)
{
    (void)state;
    static float pictures[2][VIEW_STAGE_PIXELS][4];
    view_stage_open(&stage, 1);
    const uint32_t gathers = view_stage_dispatches(&stage, PASS_GATHER),
                   traces = view_stage_dispatches(&stage, PASS_PROBE_TRACE);
    double worst = 0, brightest = 0;
    for (int eye = 0; eye < 2; eye++) {
        sdfgi_view *view = view_stage_view(&stage);
        struct sdfgi_resolve_desc desc = view_stage_desc(&stage, VK_NULL_HANDLE);
        desc.inverse_view_projection[8] = eye == 0 ? 0.4f : -0.4f;
        desc.inverse_view_projection[12] = eye == 0 ? -0.2f : 0.2f;
        gi_test_resolve(&stage.t, view, &desc);
        view_stage_read(&stage, &view->diffuse, pictures[eye]);
    }
    REQUIRE_CMP(view_stage_dispatches(&stage, PASS_GATHER), ==, gathers + 2);
    REQUIRE_CMP(view_stage_dispatches(&stage, PASS_PROBE_TRACE), ==, traces);
    for (int i = 0; i < VIEW_STAGE_PIXELS; i++)
        for (int k = 0; k < 3; k++) {
            const double left = (double)pictures[0][i][k], right = (double)pictures[1][i][k];
            worst = fmax(worst, fabs(left - right) / fmax(fmax(left, right), 0.01));
            brightest = fmax(brightest, left);
        }
    printf("eyes: off by %.2e at most, brightest %.3f\n", worst, brightest);
    view_stage_close(&stage);
    REQUIRE_CMP(brightest, >, 0.3);
    REQUIRE_CMP(worst, <=, 0.01);
}

static void without_a_picture_of_roughness_there_are_no_reflections(void **state)
{
    (void)state;
    view_stage_open(&stage, 1);
    sdfgi_view *view = view_stage_view(&stage);
    struct sdfgi_view_images images;
    view_stage_resolve(&stage, view, 0);
    sdfgi_view_get_images(view, &images);
    REQUIRE_TRUE(images.reflection != VK_NULL_HANDLE);
    view_stage_resolve(&stage, view, -1);
    sdfgi_view_get_images(view, &images);
    REQUIRE_TRUE(images.reflection == VK_NULL_HANDLE);
    view_stage_close(&stage);
}

/* ---- Thresholds */

/* Gives other thresholds to light that has settled: the update that follows does nothing else. */
static void set_thresholds(float blend, float end)
{
    static struct sdfgi_report report;
    struct sdfgi_settings settings;
    sdfgi_get_settings(stage.t.gi, &settings);
    settings.reflection_blend = blend;
    settings.reflection_end = end;
    REQUIRE_CMP((int)sdfgi_set_settings(stage.t.gi, &settings), ==, (int)SDFGI_OK);
    gi_test_update(&stage.t, 1);
    sdfgi_get_report(stage.t.gi, &report);
    REQUIRE_TRUE(report.converged);
    for (uint32_t i = 0; i < report.pass_count; i++)
        REQUIRE_CMP(report.passes[i].dispatches, ==, 0u);
}

/* Share of a picture of roughness 0.6 that is not what irradiance makes of it. */
static double unlike_irradiance(sdfgi_view *view)
{
    static float diffuse[VIEW_STAGE_PIXELS][4], reflection[VIEW_STAGE_PIXELS][4];
    double unlike = 0, sum = 0;
    view_stage_resolve(&stage, view, 0.6f);
    view_stage_read(&stage, &view->diffuse, diffuse);
    view_stage_read(&stage, &view->reflection, reflection);
    for (int i = 0; i < VIEW_STAGE_PIXELS; i++)
        for (int k = 0; k < 3; k++) {
            unlike += fabs((double)reflection[i][k] - (double)diffuse[i][k] / 3.14159265);
            sum += (double)diffuse[i][k] / 3.14159265;
        }
    return unlike / sum;
}

static void thresholds_of_roughness_are_followed_and_wake_no_light(void **state)
{
    (void)state;
    static struct sdfgi_report report;
    struct sdfgi_view_images images;
    view_stage_open(&stage, 1);
    for (int i = 0; i < 400 && !report.converged; i++) {
        gi_test_update(&stage.t, 1);
        sdfgi_get_report(stage.t.gi, &report);
    }
    REQUIRE_TRUE(report.converged);
    sdfgi_view *view = view_stage_view(&stage);
    const double blended = unlike_irradiance(view);
    set_thresholds(1, 1);
    const double rays = unlike_irradiance(view);
    set_thresholds(0.7f, 0.6f); /* the blend would begin beyond its end: there is none */
    const double rough = unlike_irradiance(view);
    set_thresholds(0.7f, 0.61f);
    const double sharp = unlike_irradiance(view);
    printf("unlike irradiance: blended %.4f, rays alone %.4f, rough %.4f\n", blended, rays, rough);
    REQUIRE_NEAR(sharp, rays, 1e-6);
    REQUIRE_CMP(rays, >, 1.2 * blended);
    REQUIRE_CMP(blended, >, 0.01);
    REQUIRE_CMP(rough, <=, 1e-3);
    set_thresholds(0.4f, 0);
    view_stage_resolve(&stage, view, 0);
    sdfgi_view_get_images(view, &images);
    REQUIRE_TRUE(images.reflection == VK_NULL_HANDLE);
    REQUIRE_CMP(view_stage_dispatches(&stage, PASS_REFLECT_TILES), ==, 0u);
    view_stage_close(&stage);
}

static void bad_views_are_refused(void **state)
{
    (void)state;
    view_stage_open(&stage, 1);
    static const struct sdfgi_view_desc wrong[] = { { .height = 4 },
                                                    { .width = 4 },
                                                    { .width = 4, .height = UINT32_MAX },
                                                    { 4, 4, .diffuse = (enum sdfgi_gather_resolution)7 },
                                                    { 4, 4, .reflection = (enum sdfgi_gather_resolution)3 } };
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        sdfgi_view *view = (sdfgi_view *)&stage;
        REQUIRE_CMP((int)sdfgi_view_create(stage.t.gi, &wrong[i], &view), ==,
                    (int)SDFGI_ERROR_INVALID_ARGUMENT);
        REQUIRE_TRUE(view == (sdfgi_view *)&stage);
    }
    sdfgi_view *view = view_stage_view(&stage);
    struct sdfgi_resolve_desc desc = view_stage_desc(&stage, VK_NULL_HANDLE);
    desc.depth = VK_NULL_HANDLE;
    REQUIRE_CMP((int)sdfgi_view_resolve(stage.t.gi, view, (VkCommandBuffer)&stage, &desc), ==,
                (int)SDFGI_ERROR_INVALID_ARGUMENT);
    REQUIRE_TRUE(strstr(stage.t.last_message, "depth is null") != NULL);
    desc = view_stage_desc(&stage, VK_NULL_HANDLE);
    desc.scale = NAN;
    REQUIRE_CMP((int)sdfgi_view_resolve(stage.t.gi, view, (VkCommandBuffer)&stage, &desc), ==,
                (int)SDFGI_ERROR_INVALID_ARGUMENT);
    const struct sdfgi_material_desc too_smooth = { .smoothness = 1.5f };
    sdfgi_material material = { 77 };
    REQUIRE_CMP((int)sdfgi_material_create(stage.t.gi, &too_smooth, &material), ==,
                (int)SDFGI_ERROR_INVALID_ARGUMENT);
    REQUIRE_TRUE(strstr(stage.t.last_message, "smoothness") != NULL);
    const struct sdfgi_material_desc bad_metal = { .metallic = -0.01f };
    REQUIRE_CMP((int)sdfgi_material_create(stage.t.gi, &bad_metal, &material), ==,
                (int)SDFGI_ERROR_INVALID_ARGUMENT);
    REQUIRE_TRUE(strstr(stage.t.last_message, "metallic") != NULL);
    view_stage_close(&stage);
}

static int finish(void **state)
{
    (void)state;
    gi_test_close(&stage.t);
    return 0;
}

TEST_GROUP(view)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_scene_without_smooth_materials_makes_nothing_for_reflections),
        cmocka_unit_test(a_view_with_pictures_of_reflections_does_without),
        cmocka_unit_test(surfaces_of_roughness_1_reflect_irradiance),
        cmocka_unit_test(mirrors_show_the_sky_where_nothing_is_above),
        cmocka_unit_test(normals_that_lean_reflect_no_surface_of_their_own),
        cmocka_unit_test(smooth_and_rough_surfaces_share_a_picture),
        cmocka_unit_test(rays_do_not_wait_for_the_gather),
        cmocka_unit_test(roughness_changes_reflections_without_a_step),
        cmocka_unit_test(views_have_pictures_of_their_own_and_give_them_back),
        cmocka_unit_test(eyes_share_an_update_and_see_the_same_light),
        cmocka_unit_test(without_a_picture_of_roughness_there_are_no_reflections),
        cmocka_unit_test(thresholds_of_roughness_are_followed_and_wake_no_light),
        cmocka_unit_test(bad_views_are_refused),
    };
    return cmocka_run_group_tests_name("view", tests, NULL, finish);
}
