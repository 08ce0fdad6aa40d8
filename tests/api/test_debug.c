/* SPDX-License-Identifier: MIT
 * sdfgi_debug_draw as a host calls it: names, bad descriptions, the report, cameras. tests/api/
 * test_debug_views.c has the colours. */
#include "debug_pixel.h"
#include "require.h"
#include "test_group.h"

#include <math.h>
#include <stdio.h>

static struct sdfgi_report report; /* too large for the stack of a test */

static void names_round_trip(void **state)
{
    (void)state;
    for (int i = 0; i < SDFGI_DEBUG_VIEW_COUNT; i++) {
        const enum sdfgi_debug_view view = (enum sdfgi_debug_view)i;
        REQUIRE_CMP((int)sdfgi_debug_view_find(sdfgi_debug_view_name(view)), ==, i);
        REQUIRE_CMP(strlen(sdfgi_debug_view_text(view)), >, (size_t)10);
        for (const char *c = sdfgi_debug_view_name(view); *c; c++)
            REQUIRE_TRUE((*c >= 'a' && *c <= 'z') || *c == '_');
    }
    const int outside[] = { -1, SDFGI_DEBUG_VIEW_COUNT };
    for (int i = 0; i < 2; i++) {
        REQUIRE_TRUE(!sdfgi_debug_view_name((enum sdfgi_debug_view)outside[i]));
        REQUIRE_TRUE(!sdfgi_debug_view_text((enum sdfgi_debug_view)outside[i]));
    }
    REQUIRE_CMP((int)sdfgi_debug_view_find("Solid"), ==, (int)SDFGI_DEBUG_VIEW_COUNT);
    REQUIRE_CMP((int)sdfgi_debug_view_find(""), ==, (int)SDFGI_DEBUG_VIEW_COUNT);
}

/* A wall 2 m in front of the origin, along +x. */
static void open_wall(struct gi_test *t)
{
    struct sdfgi_settings settings = gi_test_settings();
    settings.resolution = 32;
    gi_test_open(t, &settings);
    struct test_mesh wall =
        test_mesh_box((double[]){ 2.5, 0, 0 }, (double[]){ 0.5, 3, 3 }, test_rotation_none);
    gi_test_add(t, &wall, gi_test_material(t, (float[]){ 0.8f, 0.2f, 0.1f }, (float[]){ 0, 0, 0 }));
    test_mesh_destroy(&wall);
    gi_test_update(t, 1);
}

/* ---- Bad descriptions */

/* None of the refused calls touches its command buffer. */
static void require_refused(struct gi_test *t, const struct sdfgi_debug_desc *desc, const char *message)
{
    t->messages[SDFGI_MESSAGE_INVALID_ARGUMENT] = 0;
    REQUIRE_CMP((int)sdfgi_debug_draw(t->gi, (VkCommandBuffer)t, desc), ==,
                (int)SDFGI_ERROR_INVALID_ARGUMENT);
    REQUIRE_CMP(t->messages[SDFGI_MESSAGE_INVALID_ARGUMENT], ==, 1u);
    if (!strstr(t->last_message, message))
        require_fail(__FILE__, __LINE__, "\"%s\" does not say \"%s\"", t->last_message, message);
}

static void bad_descriptions_are_refused(void **state)
{
    (void)state;
    static struct gi_test t;
    open_wall(&t);
    t.gpu.messages->quiet = true;
    struct gpu_test_image output = gi_test_gather_image(&t, VK_FORMAT_R16G16B16A16_SFLOAT, 8, 4, 4, NULL);
    struct sdfgi_debug_desc good = debug_desc(DEBUG_CAMERA_FORWARD, (double[]){ 0, 0, 0 }, 0);
    good.output = output.view;
    good.width = good.height = 4;
    const uint32_t largest = t.gi->backend.device.limits.maxImageDimension2D;
    struct {
        struct sdfgi_debug_desc desc;
        const char *message;
    } bad[13];
    for (int i = 0; i < 13; i++)
        bad[i].desc = good;
    bad[0].desc.output = VK_NULL_HANDLE, bad[0].message = "sdfgi_debug_draw: output is null";
    bad[1].desc.width = 0, bad[1].message = "width is 0";
    bad[2].desc.height = 0, bad[2].message = "height is 0";
    bad[3].desc.inverse_view_projection[7] = NAN, bad[3].message = "inverse_view_projection[7] is";
    memset(bad[4].desc.inverse_view_projection, 0, sizeof good.inverse_view_projection);
    bad[4].message = "inverse_view_projection is 0";
    bad[5].desc.background_depth = 0.5f, bad[5].message = "background_depth is 0.5, must be 0 or 1";
    bad[6].desc.background_depth = NAN, bad[6].message = "background_depth is";
    bad[7].desc.view = SDFGI_DEBUG_VIEW_COUNT, bad[7].message = "must be one of enum sdfgi_debug_view";
    bad[8].desc.exposure = -1, bad[8].message = "exposure is -1";
    bad[9].desc.slice_m = INFINITY, bad[9].message = "slice_m is inf";
    bad[10].desc.width = largest + 1, bad[10].message = "must be at most maxImageDimension2D";
    bad[11].desc.height = UINT32_MAX, bad[11].message = "height is 4294967295";
    bad[12].desc.view = (enum sdfgi_debug_view) - 1, bad[12].message = "view is -1";
    for (int i = 0; i < 13; i++)
        require_refused(&t, &bad[i].desc, bad[i].message);
    REQUIRE_CMP((int)sdfgi_debug_draw(t.gi, VK_NULL_HANDLE, &good), ==, (int)SDFGI_ERROR_INVALID_ARGUMENT);
    sdfgi_get_report(t.gi, &report);
    REQUIRE_TRUE(!report.passes[PASS_DEBUG_VIEW].ran);
    gpu_test_image_destroy(&t.gpu, &output);
    gi_test_close(&t);
}

/* ---- The report */

static void what_nobody_calls_costs_nothing_and_the_report_says_so(void **state)
{
    (void)state;
    static struct gi_test t;
    open_wall(&t);
    const struct sdfgi_pass_report *line = &report.passes[PASS_DEBUG_VIEW];
    sdfgi_get_report(t.gi, &report);
    REQUIRE_TRUE(!line->ran);
    REQUIRE_TRUE(strcmp(line->reason, "the host did not call sdfgi_debug_draw") == 0);
    REQUIRE_TRUE(!t.gi->backend.pipelines.passes[PASS_DEBUG_VIEW][0]);
    REQUIRE_TRUE(!report.passes[PASS_DEBUG_TIER].ran);
    REQUIRE_TRUE(!t.gi->backend.pipelines.passes[PASS_DEBUG_TIER][0]);
    const uint64_t memory = report.memory.total_bytes;
    for (int i = 0; i < 3; i++)
        debug_look(&t, SDFGI_DEBUG_SOLID, (double[]){ 0, 0, 0 }, 0);
    sdfgi_get_report(t.gi, &report);
    REQUIRE_TRUE(line->ran);
    REQUIRE_TRUE(strcmp(line->name, "debug_view") == 0);
    REQUIRE_TRUE(strcmp(line->reason, "the host called sdfgi_debug_draw") == 0);
    REQUIRE_CMP(line->dispatches, ==, 3u);
    REQUIRE_CMP(line->work, ==, (uint64_t)3 * 25);
    REQUIRE_CMP(report.memory.total_bytes, ==, memory);
    gi_test_update(&t, 1);
    sdfgi_get_report(t.gi, &report);
    REQUIRE_TRUE(!line->ran);
    gi_test_close(&t);
}

static void a_view_wakes_nothing(void **state)
{
    (void)state;
    static struct gi_test t;
    open_wall(&t);
    gi_test_converge(&t, 100);
    for (int i = 0; i < SDFGI_DEBUG_VIEW_COUNT; i++)
        debug_look(&t, (enum sdfgi_debug_view)i, (double[]){ 0, 0, 0 }, 0);
    gi_test_update(&t, 1);
    sdfgi_get_report(t.gi, &report);
    REQUIRE_CMP(report.command_count, ==, 0u);
    gi_test_close(&t);
}

static void nothing_is_drawn_while_gi_is_off(void **state)
{
    (void)state;
    static struct gi_test t;
    open_wall(&t);
    struct sdfgi_settings off = gi_test_settings();
    off.enabled = false;
    REQUIRE_CMP((int)sdfgi_set_settings(t.gi, &off), ==, (int)SDFGI_OK);
    REQUIRE_CMP((int)sdfgi_debug_draw(t.gi, (VkCommandBuffer)&t, &(struct sdfgi_debug_desc){ 0 }), ==,
                (int)SDFGI_OK);
    gi_test_close(&t);
}

/* ---- What the host has drawn */

static const struct drawn {
    float depth, normal[3], roughness;
    double color[3];
} drawn[] = {
    { 0.5f, { 0, 1, 0 }, 0, { 0, 1, 0 } },
    { 0.5f, { 0, 1, 0 }, 0.4f, { 0, 1, 0 } },
    { 0.5f, { 0, 1, 0 }, 0.6f, { 1, 1, 0 } },         /* rays count by 1/2 */
    { 0.5f, { 0, 1, 0 }, 0.7f, { 1, 10.0 / 32, 0 } }, /* and by 5/32 */
    { 0.5f, { 0, 1, 0 }, 0.8f, { 0.1, 0.3, 1 } },
    { 0.5f, { 0, 1, 0 }, 1, { 0.1, 0.3, 1 } },
    { 0.5f, { 0, 1, 0 }, NAN, { 0.1, 0.3, 1 } },
    { 0.5f, { 0, -2, 0 }, 0, { 0, 0.4, 0 } },
    { 0.5f, { 1, 0, -1 }, 0, { 0, (0.85 + 0.5) / 2, 0 } },
    { 1, { 0, 1, 0 }, 0, { 0.01, 0.015, 0.03 } }, /* background */
};
enum { DRAWN = sizeof drawn / sizeof *drawn };

/* The pixel of a picture that shows this everywhere. */
static struct debug_color tier_of(struct gi_test *t, const struct drawn *d)
{
    float depths[DEBUG_PIXELS], normals[DEBUG_PIXELS][4], roughness[DEBUG_PIXELS];
    for (int i = 0; i < DEBUG_PIXELS; i++) {
        depths[i] = d->depth;
        memcpy(normals[i], d->normal, sizeof d->normal);
        normals[i][3] = 0;
        roughness[i] = d->roughness;
    }
    struct gpu_test_image images[] = {
        gi_test_gather_image(t, VK_FORMAT_R32_SFLOAT, 4, DEBUG_SIDE, DEBUG_SIDE, depths),
        gi_test_gather_image(t, VK_FORMAT_R32G32B32A32_SFLOAT, 16, DEBUG_SIDE, DEBUG_SIDE, normals),
        gi_test_gather_image(t, VK_FORMAT_R32_SFLOAT, 4, DEBUG_SIDE, DEBUG_SIDE, roughness),
    };
    struct sdfgi_debug_desc desc = debug_desc(DEBUG_CAMERA_FORWARD, (double[]){ 0, 0, 0 }, 0);
    desc.view = SDFGI_DEBUG_REFLECTION_TIER;
    desc.depth = images[0].view;
    desc.normal = images[1].view;
    desc.roughness = images[2].view;
    const struct debug_color color = debug_pixel(t, &desc);
    for (int i = 0; i < 3; i++)
        gpu_test_image_destroy(&t->gpu, &images[i]);
    return color;
}

static void tiers_of_reflections_follow_roughness(void **state)
{
    (void)state;
    static struct gi_test t;
    open_wall(&t);
    struct sdfgi_settings settings = t.gi->settings;
    settings.reflection_blend = 0.4f;
    settings.reflection_end = 0.8f;
    REQUIRE_CMP((int)sdfgi_set_settings(t.gi, &settings), ==, (int)SDFGI_OK);
    gi_test_update(&t, 1);
    for (int i = 0; i < DRAWN; i++) {
        const double *want = drawn[i].color;
        const struct debug_color found = tier_of(&t, &drawn[i]);
        REQUIRE_COLOR(found, want[0], want[1], want[2], 0.002);
    }
    sdfgi_get_report(t.gi, &report);
    REQUIRE_CMP(report.passes[PASS_DEBUG_TIER].dispatches, ==, (uint32_t)DRAWN);
    REQUIRE_CMP(report.passes[PASS_DEBUG_TIER].work, ==, (uint64_t)DRAWN * DEBUG_PIXELS);
    REQUIRE_TRUE(!report.passes[PASS_DEBUG_VIEW].ran);
    REQUIRE_TRUE(!t.gi->backend.pipelines.passes[PASS_DEBUG_VIEW][0]);
    /* Without pictures there is nothing to tell of the wall. */
    const struct debug_color unknown = debug_look(&t, SDFGI_DEBUG_REFLECTION_TIER, (double[]){ 0, 0, 0 }, 0);
    REQUIRE_COLOR(unknown, 0.25, 0, 0.3, 0.002);
    gi_test_close(&t);
}

/* ---- Cameras */

/* From within the cascade, from its border, and from far outside of it. */
static void all_kinds_of_cameras_see_the_same(void **state)
{
    (void)state;
    static struct gi_test t;
    open_wall(&t);
    const double eyes[][3] = { { 0, 0, 0 }, { -3.9, 0.1, 0.1 }, { -300, 0.1, 0.1 } };
    for (int i = 0; i < 3; i++)
        for (int c = 0; c < DEBUG_CAMERA_COUNT; c++) {
            struct sdfgi_debug_desc desc = debug_desc((enum debug_camera)c, eyes[i], 0);
            desc.view = SDFGI_DEBUG_ALBEDO;
            REQUIRE_COLOR(debug_pixel(&t, &desc), 0.8, 0.2, 0.1, 0.002);
            desc = debug_desc((enum debug_camera)c, eyes[i], 1);
            desc.view = SDFGI_DEBUG_ALBEDO;
            REQUIRE_COLOR(debug_pixel(&t, &desc), 0.01, 0.015, 0.03, 0.001);
        }
    gi_test_close(&t);
}

/* A matrix that leads nowhere shows the sky, and ends. */
static void a_matrix_without_directions_shows_the_sky(void **state)
{
    (void)state;
    static struct gi_test t;
    open_wall(&t);
    struct sdfgi_debug_desc desc = debug_desc(DEBUG_CAMERA_FORWARD, (double[]){ 0, 0, 0 }, 0);
    memset(&desc.inverse_view_projection[8], 0, 4 * sizeof(float));
    for (int i = 0; i < SDFGI_DEBUG_VIEW_COUNT; i++) {
        desc.view = (enum sdfgi_debug_view)i;
        REQUIRE_COLOR(debug_pixel(&t, &desc), 0.01, 0.015, 0.03, 0.001);
    }
    gi_test_close(&t);
}

TEST_GROUP(debug)
{
    if (!gpu_test_available())
        return GPU_TEST_SKIP;
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(names_round_trip),
        cmocka_unit_test(bad_descriptions_are_refused),
        cmocka_unit_test(what_nobody_calls_costs_nothing_and_the_report_says_so),
        cmocka_unit_test(a_view_wakes_nothing),
        cmocka_unit_test(nothing_is_drawn_while_gi_is_off),
        cmocka_unit_test(tiers_of_reflections_follow_roughness),
        cmocka_unit_test(all_kinds_of_cameras_see_the_same),
        cmocka_unit_test(a_matrix_without_directions_shows_the_sky),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
