/* SPDX-License-Identifier: MIT
 * What an eye sees from frame to frame while a lamp goes on or off, or flickers: FLIP between neighbouring
 * pictures of indirect light, less that of the change itself. */
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
        test_mesh_room((double[]){ 0, 0, 0 }, (double[]){ HALF_M, HALF_M, HALF_M }, 0.2, test_rotation_none),
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
static float unlit[PIXELS][4], lit[PIXELS][4]; /* by the lamp */

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

/* Frames until no later one lacks a tenth of the change. */
static int frames_to_nine_tenths(void)
{
    int count = 1;
    for (int i = 0; i < FRAMES; i++)
        count = fabs(share_of(i) - 1) > 0.1 ? i + 2 : count;
    return count;
}

static double most_noise(void)
{
    static float was[PIXELS][4], is[PIXELS][4];
    const float exposure = tone_exposure(mean_of(before) > mean_of(after) ? before[0] : after[0], PIXELS);
    double worst = 0;
    for (int i = 0; i < FRAMES; i++) {
        without_noise(share_of(i), is);
        if (i > 0)
            worst = fmax(worst, flip(frames[i - 1], frames[i], exposure) - flip(was, is, exposure));
        memcpy(was, is, sizeof was);
    }
    return worst;
}

static void require_calm(const char *name)
{
    const int nine_tenths = frames_to_nine_tenths();
    const double worst = most_noise();
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
    memcpy(unlit, before, sizeof unlit);
    memcpy(lit, after, sizeof lit);
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

/* ---- A lamp that flickers */

enum { WARM_UP = 140 }; /* more than six epochs */

/* It has another power in each frame, by 30 % more or less. */
static void flicker(struct stage *s, int frame)
{
    static const float powers[] = { 1.12f, 0.7f, 1.3f, 0.93f, 0.81f, 1.19f, 0.95f };
    const struct sdfgi_light_desc lamp =
        light_point(0.9, 0.7, 0.8, 8 * powers[frame % (int)(sizeof powers / sizeof *powers)]);
    REQUIRE_CMP((int)sdfgi_light_update(s->t.gi, s->lamp, &lamp), ==, (int)SDFGI_OK);
    gi_test_update(&s->t, 1);
}

static void a_lamp_that_flickers_brings_no_noise(void **state)
{
    (void)state;
    const struct sdfgi_light_desc lamp = light_point(0.9, 0.7, 0.8, 8);
    memcpy(before, unlit, sizeof before);
    memcpy(after, lit, sizeof after);
    stage.lamp = light_create(&stage.t, &lamp);
    for (int i = 0; i < WARM_UP + FRAMES; i++) {
        flicker(&stage, i);
        if (i >= WARM_UP)
            take(&stage, frames[i - WARM_UP]);
    }
    double share = 0;
    for (int i = 0; i < FRAMES; i++)
        share += share_of(i) / FRAMES;
    const double noise = most_noise();
    printf("flickers: %.4f of its light, noise %.4f at most\n", share, noise);
    REQUIRE_CMP(fabs(share - 1), <=, 0.05);
    REQUIRE_CMP(noise, <=, 0.007);
}

/* In the middle of a time in which cells go on from what they know. */
static void a_lamp_that_flickers_goes_off_at_once(void **state)
{
    (void)state;
    const struct sdfgi_light_desc off = light_point(0.9, 0.7, 0.8, 0);
    memcpy(after, unlit, sizeof after);
    for (int i = 0; i < 9; i++)
        flicker(&stage, i);
    take(&stage, before);
    REQUIRE_CMP((int)sdfgi_light_update(stage.t.gi, stage.lamp, &off), ==, (int)SDFGI_OK);
    for (int i = 0; i < FRAMES; i++) {
        gi_test_update(&stage.t, 1);
        take(&stage, frames[i]);
    }
    const int nine_tenths = frames_to_nine_tenths();
    printf("off: nine tenths after %d frames\n", nine_tenths);
    REQUIRE_CMP(nine_tenths, <=, 10);
}

TEST_GROUP(flicker)
{
    if (!gpu_test_available())
        return GPU_TEST_SKIP;
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_lamp_that_goes_on_brings_no_noise),
        cmocka_unit_test(a_lamp_that_goes_off_leaves_no_noise),
        cmocka_unit_test(a_lamp_that_flickers_brings_no_noise),
        cmocka_unit_test(a_lamp_that_flickers_goes_off_at_once),
    };
    open_room(&stage);
    const int failed = cmocka_run_group_tests_name("flicker", tests, NULL, NULL);
    close_room(&stage);
    return failed;
}
