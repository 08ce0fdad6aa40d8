/* SPDX-License-Identifier: MIT
 * What an eye sees from frame to frame while a lamp goes on or off: FLIP between neighbouring pictures of
 * indirect light, less that of the change itself. */
#include "light_scene.h"
#include "picture_flip.h"
#include "require.h"
#include "test_group.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { SIDE = 96, PIXELS = SIDE * SIDE, FRAMES = 20, SETTLE = 32 };

/* A room of 3.2 m with a pillar, which two lamps light. One of them changes. */
#define HALF_M  1.6
#define FLOOR_M 1.5f /* what is looked at, less than half a side */

struct stage {
    struct gi_test t;
    struct gpu_test_image depth, normal, output;
    sdfgi_light lamp;
};

static struct stage stage;

static void open_room(struct stage *s)
{
    static float depths[PIXELS], normals[PIXELS][4];
    struct sdfgi_settings settings = light_settings(32, 0.2f);
    settings.surface_light = SDFGI_SURFACE_LIGHT_CELLS;
    settings.cell_rays = 16 * SDFGI_VISIT_RAYS; /* a complete cycle within SETTLE frames */
    gi_test_open(&s->t, &settings);
    light_add(
        &s->t,
        test_mesh_room((double[]){ 0, 0, 0 }, (double[]){ HALF_M, HALF_M, HALF_M }, 0.3, test_rotation_none),
        0.5f, 0);
    light_add_box(&s->t, (double[]){ -0.2, -HALF_M, -0.8 }, (double[]){ 0.5, 0.6, -0.2 },
                  (float[]){ 0.7f, 0.2f, 0.1f }, 0);
    const struct sdfgi_light_desc dim = light_point(-1.2, 1, 1.2, 2);
    light_create(&s->t, &dim);
    for (int i = 0; i < PIXELS; i++) {
        depths[i] = 0.5f;
        normals[i][1] = 1;
    }
    s->depth = gi_test_gather_image(&s->t, VK_FORMAT_R32_SFLOAT, 4, SIDE, SIDE, depths);
    s->normal = gi_test_gather_image(&s->t, VK_FORMAT_R32G32B32A32_SFLOAT, 16, SIDE, SIDE, normals);
    s->output = gi_test_gather_image(&s->t, VK_FORMAT_R16G16B16A16_SFLOAT, 8, SIDE, SIDE, NULL);
    gi_test_update(&s->t, SETTLE);
}

static void close_room(struct stage *s)
{
    gpu_test_image_destroy(&s->t.gpu, &s->depth);
    gpu_test_image_destroy(&s->t.gpu, &s->normal);
    gpu_test_image_destroy(&s->t.gpu, &s->output);
    gi_test_close(&s->t);
}

/* ---- Pictures */

/* Irradiance of the floor, seen from above. */
static void take(struct stage *s, float picture[PIXELS][4])
{
    static uint16_t texels[PIXELS][4];
    const struct sdfgi_gather_desc desc = {
        s->depth.view,
        s->normal.view,
        s->output.view,
        .width = SIDE,
        .height = SIDE,
        .background_depth = 1,
        /* Depth 0 to 1 is y from 0.1 m above the floor to as much below. */
        .inverse_view_projection = { FLOOR_M, 0, 0, 0, 0, 0, FLOOR_M, 0, 0, -0.2f, 0, 0, 0,
                                     0.1f - (float)HALF_M, 0, 1 },
    };
    gi_test_gather(&s->t, &desc);
    gpu_test_image_read(&s->t.gpu, s->output.image, VK_IMAGE_LAYOUT_GENERAL, VK_IMAGE_ASPECT_COLOR_BIT,
                        s->output.extent, 8, texels);
    for (int i = 0; i < 4 * PIXELS; i++)
        picture[i / 4][i % 4] = gi_test_half(texels[i / 4][i % 4]);
}

static double mean_of(float picture[PIXELS][4])
{
    double sum = 0;
    for (int i = 0; i < PIXELS; i++)
        sum += (double)tone_luminance(picture[i]);
    return sum / PIXELS;
}

static double flip(float a[PIXELS][4], float b[PIXELS][4], float exposure)
{
    return picture_flip(a[0], b[0], SIDE, SIDE, exposure);
}

/* ---- Changes */

static float before[PIXELS][4], after[PIXELS][4], frames[FRAMES][PIXELS][4];

/* Share of the change that frame i has, in the mean. */
static double share_of(int i)
{
    const double a = mean_of(before), b = mean_of(after);
    return (mean_of(frames[i]) - a) / (b - a);
}

/* The picture between those before and after that has a share of the change. */
static void without_noise(double share, float picture[PIXELS][4])
{
    for (int k = 0; k < 4 * PIXELS; k++) {
        const float a = before[k / 4][k % 4], b = after[k / 4][k % 4];
        picture[k / 4][k % 4] = a + (float)share * (b - a);
    }
}

static void require_calm(const char *name)
{
    static float was[PIXELS][4], is[PIXELS][4];
    const float exposure = tone_exposure(mean_of(before) > mean_of(after) ? before[0] : after[0], PIXELS);
    double worst = 0;
    int nine_tenths = 1; /* frames until no later one lacks a tenth */
    for (int i = 0; i < FRAMES; i++) {
        const double share = share_of(i);
        without_noise(share, is);
        if (i > 0)
            worst = fmax(worst, flip(frames[i - 1], frames[i], exposure) - flip(was, is, exposure));
        if (fabs(share - 1) > 0.1)
            nine_tenths = i + 2;
        memcpy(was, is, sizeof was);
    }
    printf("%s: nine tenths after %d frames, noise %.4f at most\n", name, nine_tenths, worst);
    REQUIRE_CMP(nine_tenths, <=, 10);
    REQUIRE_CMP(worst, <=, 0.02);
}

static void follow(struct stage *s)
{
    for (int i = 0; i < FRAMES; i++) {
        gi_test_update(&s->t, 1);
        take(s, frames[i]);
    }
    gi_test_update(&s->t, SETTLE - FRAMES);
    take(s, after);
}

static void a_lamp_that_goes_on_brings_no_noise(void **state)
{
    (void)state;
    take(&stage, before);
    const struct sdfgi_light_desc lamp = light_point(0.9, 0.7, 0.8, 8);
    stage.lamp = light_create(&stage.t, &lamp);
    follow(&stage);
    require_calm("on");
}

static void a_lamp_that_goes_off_leaves_no_noise(void **state)
{
    (void)state;
    take(&stage, before);
    REQUIRE_CMP((int)sdfgi_light_destroy(stage.t.gi, stage.lamp), ==, (int)SDFGI_OK);
    follow(&stage);
    require_calm("off");
}

TEST_GROUP(flicker)
{
    if (!gpu_test_available())
        return GPU_TEST_SKIP;
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_lamp_that_goes_on_brings_no_noise),
        cmocka_unit_test(a_lamp_that_goes_off_leaves_no_noise),
    };
    open_room(&stage);
    const int failed = cmocka_run_group_tests_name("flicker", tests, NULL, NULL);
    close_room(&stage);
    return failed;
}
