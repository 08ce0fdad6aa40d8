/* SPDX-License-Identifier: MIT
 * Two eyes, each in a half of the picture: what each sees is what a camera in its place sees, from one
 * update.
 */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "fog_scene.h"
#include "host_test.h"
#include "require.h"
#include "test_group.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define EYES_M 0.4f

static struct host_device *device;
static float both[8 * FOG_PIXELS], one[4 * FOG_PIXELS];

static const struct fog_box room[] = {
    { { 0, -1.25, -2 }, { 4, 0.5, 3 }, .color = { 0.8f, 0.8f, 0.8f, 1 } },
    { { -0.6, -0.6, -2 }, { 0.8, 0.8, 0.8 }, .color = { 0.9f, 0.2f, 0.1f, 1 } },
    { { 0.7, 0, -2.4 }, { 0.6, 2, 0.05 }, .color = { 1, 1, 1, 1 }, .metal = true, .smoothness = 1 },
    { { 0.2, 0, -1.5 }, { 0.5, 0.5, 0.02 }, .color = { 0.2f, 0.3f, 0.9f, 0.5f } },
};

static struct fog_scene room_scene(void)
{
    struct fog_scene scene = fog_scene_empty(0.2f);
    scene.view.materials = HOST_MATERIALS_GLTF;
    scene.view.sky = (struct host_sky){ { 1, 1, 1.5f }, { 1, 1, 1 }, { 0.5f, 0.5f, 0.5f } };
    scene.view.sun = (struct host_sun){ true, { 0.5f, -1, -0.3f }, { 5, 5, 5 }, 0 };
    scene.boxes = room;
    scene.box_count = sizeof room / sizeof *room;
    scene.gi = true;
    return scene;
}

/* What all tests look at; the last of them changes its size. */
static struct fog_stage stereo;

static int open_stereo(void **state)
{
    (void)state;
    struct fog_scene scene = room_scene();
    scene.eye_distance_m = EYES_M;
    fog_stage_open(&stereo, device, &scene);
    return 0;
}

static int close_stereo(void **state)
{
    (void)state;
    fog_stage_close(&stereo);
    return 0;
}

/* Mean difference between a half and what a camera sees that stands where that eye is, over the light. */
static double half_differs(struct fog_stage *mono, int eye, enum host_aov aov)
{
    double off = 0, light = 0;
    struct host_camera camera = mono->camera;
    camera.position[0] += (eye - 0.5) * (double)EYES_M;
    camera.look_at[0] += (eye - 0.5) * (double)EYES_M;
    assert_true(host_renderer_frame(mono->renderer, &camera));
    assert_true(host_renderer_read_aov(mono->renderer, aov, one));
    for (int y = 0; y < FOG_HEIGHT; y++)
        for (int x = 0; x < 4 * FOG_WIDTH; x++) {
            const double half = (double)both[(2 * y + eye) * 4 * FOG_WIDTH + x],
                         whole = (double)one[4 * y * FOG_WIDTH + x];
            off += fabs(half - whole);
            light += fabs(whole);
        }
    return off / light;
}

static void require_halves(struct fog_stage *mono, enum host_aov aov, double most)
{
    assert_true(host_renderer_read_aov(stereo.renderer, aov, both));
    const double left = half_differs(mono, 0, aov), right = half_differs(mono, 1, aov);
    printf("%s: left off by %.5f, right by %.5f\n", host_aov_name(aov), left, right);
    REQUIRE_CMP(left, <=, most);
    REQUIRE_CMP(right, <=, most);
}

/* Light is that of other frames, and its cells chose what to gather by what they were seen by. */
static void each_half_is_the_picture_of_an_eye(void **state)
{
    (void)state;
    struct fog_stage mono;
    const struct fog_scene scene = room_scene();
    fog_stage_open(&mono, device, &scene);
    require_halves(&mono, HOST_AOV_DEPTH, 1e-6);
    require_halves(&mono, HOST_AOV_COLOR, 0.02);
    fog_stage_close(&mono);
}

static uint32_t dispatches(const struct sdfgi_report *report, const char *pass)
{
    for (uint32_t i = 0; i < report->pass_count; i++)
        if (strcmp(report->passes[i].name, pass) == 0)
            return report->passes[i].dispatches;
    fail_msg("there is no pass %s", pass);
    return 0;
}

static void a_frame_has_one_update_and_two_resolves(void **state)
{
    (void)state;
    static struct sdfgi_report before, after;
    host_renderer_get_report(stereo.renderer, &before);
    assert_true(host_renderer_frame(stereo.renderer, &stereo.camera));
    host_renderer_get_report(stereo.renderer, &after);
    REQUIRE_CMP(after.update_count, ==, before.update_count + 1);
    REQUIRE_CMP(dispatches(&after, "gather"), ==, 2u);
    REQUIRE_CMP(dispatches(&after, "reflect_tiles"), ==, 2u);
    REQUIRE_CMP(dispatches(&after, "probe_blend"), <=, 1u);
}

/* The halves of 2 n - 1 columns share the one in the middle. In suite `full` a column and two as well: for
 * sides that are powers of two software drivers compile once more. */
static void any_width_will_do(void **state)
{
    (void)state;
    const uint32_t widths[] = { 73, 2 * FOG_WIDTH - 1, 1, 2 };
    const int count = getenv("SDFGI_TEST_FULL") ? 4 : 2;
    for (int i = 0; i < count; i++) {
        static uint8_t picture[8 * FOG_PIXELS];
        const struct host_picture_desc desc = { .exposure = 1 };
        memset(both, 0xff, sizeof both); /* NaN */
        assert_true(host_renderer_resize(stereo.renderer, widths[i], FOG_HEIGHT));
        assert_true(host_renderer_frame(stereo.renderer, &stereo.camera));
        assert_true(host_renderer_read_aov(stereo.renderer, HOST_AOV_COLOR, both));
        assert_true(host_renderer_read_picture(stereo.renderer, &desc, picture));
        for (uint32_t k = 0; k < 4 * widths[i] * FOG_HEIGHT; k++)
            REQUIRE_TRUE(isfinite(both[k]) && (k % 4 < 3 || picture[k] == 255));
    }
}

static void debug_views_have_two_halves(void **state)
{
    (void)state;
    const enum sdfgi_debug_view views[] = { SDFGI_DEBUG_ALBEDO, SDFGI_DEBUG_REFLECTION_TIER };
    for (int v = 0; v < 2; v++) {
        assert_true(host_renderer_read_debug(stereo.renderer, views[v], 1, both));
        double differ = 0, sum = 0;
        for (int i = 0; i < 8 * FOG_PIXELS; i += 4) {
            const int column = i / 4 % (2 * FOG_WIDTH);
            if (column >= FOG_WIDTH)
                continue;
            differ += fabs((double)both[i] - (double)both[i + 4 * FOG_WIDTH]);
            sum += (double)both[i];
        }
        printf("%s: halves differ by %.3f\n", sdfgi_debug_view_name(views[v]), differ / sum);
        REQUIRE_CMP(sum, >, 0.0);
        REQUIRE_CMP(differ / sum, >, 0.02);
        REQUIRE_CMP(differ / sum, <, 0.6);
    }
}

TEST_GROUP(eyes)
{
    device = host_test_open();
    if (!device)
        return HOST_TEST_SKIP;
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(each_half_is_the_picture_of_an_eye),
        cmocka_unit_test(a_frame_has_one_update_and_two_resolves),
        cmocka_unit_test(debug_views_have_two_halves),
        cmocka_unit_test(any_width_will_do),
    };
    return host_test_close(device, cmocka_run_group_tests(tests, open_stereo, close_stereo));
}
