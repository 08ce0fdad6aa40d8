/* SPDX-License-Identifier: MIT
 * The screen pass and the lookup in a shader of the host's give the same irradiance. */
#include "gi_test.h"
#include "require.h"
#include "test_group.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

enum { WIDTH = 19, HEIGHT = 13, PIXELS = WIDTH * HEIGHT };

/* Depth and normals of a level floor seen from straight above by an orthographic camera whose near plane is 1
 * m above it: the way to the eye is the normal, as in gi_test_irradiance. Clip x, y in [-1, 1] are metres
 * over 3, depth 0 to 1 is y from -1.9 to -2.1. */
struct screen {
    float depth[PIXELS];
    float normals[PIXELS][4];
    struct gi_test_point points[PIXELS];
};

static void screen_fill(struct screen *s)
{
    for (int i = 0; i < PIXELS; i++) {
        const float u = ((float)(i % WIDTH) + 0.5f) / WIDTH * 2 - 1,
                    v = ((float)(i / WIDTH) + 0.5f) / HEIGHT * 2 - 1;
        /* Inside the wall rounding alone decides what is seen. */
        const bool hole = i % 17 == 3 || fabsf(3 * u + 2) < 0.6f;
        s->depth[i] = hole ? 1.0f : 0.5f;
        s->points[i] = (struct gi_test_point){ { 3 * u, -1.9f - 0.2f * s->depth[i], 3 * v }, { 0, 1, 0 } };
        for (int k = 0; k < 3; k++)
            s->normals[i][k] = s->points[i].normal[k];
        s->normals[i][3] = 0;
    }
}

struct gather {
    struct gi_test *t;
    struct sdfgi_gather_desc desc;
    enum sdfgi_result result;
};

static void gather_record(VkCommandBuffer cmd, uint32_t index, void *user)
{
    (void)index;
    struct gather *g = user;
    g->result = sdfgi_gather(g->t->gi, cmd, &g->desc);
}

static void open_scene(struct gi_test *t)
{
    struct sdfgi_settings settings = gi_test_settings();
    settings.resolution = 32;
    settings.min_cell_size_m = 0.4f;
    gi_test_open(t, &settings);
    struct test_mesh box = test_mesh_box((double[]){ 0, -3, 0 }, (double[]){ 4, 1, 4 }, test_rotation_none);
    struct test_mesh wall =
        test_mesh_box((double[]){ -2, 0, 0 }, (double[]){ 0.4, 2, 3 }, test_rotation_none);
    gi_test_add(t, &box, gi_test_material(t, (float[]){ 0.7f, 0.7f, 0.7f }, (float[]){ 0, 0, 0 }));
    gi_test_add(t, &wall, gi_test_material(t, (float[]){ 0.8f, 0.2f, 0.1f }, (float[]){ 1, 0.5f, 0.2f }));
    test_mesh_destroy(&box);
    test_mesh_destroy(&wall);
    REQUIRE_CMP((int)sdfgi_set_sky(t->gi, &(struct sdfgi_sky){ { 1, 1, 2 }, { 1, 1, 1 }, { 0, 0, 0 } }), ==,
                (int)SDFGI_OK);
    gi_test_update(t, 8);
}

/* Clip (x, y, depth) to (3 x, -1.9 - 0.2 depth, 3 y), column-major. */
static struct sdfgi_gather_desc floor_desc(const struct gpu_test_image *depth,
                                           const struct gpu_test_image *normal,
                                           const struct gpu_test_image *output)
{
    return (struct sdfgi_gather_desc){
        .depth = depth->view,
        .normal = normal->view,
        .output = output->view,
        .width = WIDTH,
        .height = HEIGHT,
        .background_depth = 1,
        .inverse_view_projection = { 3, 0, 0, 0, 0, 0, 3, 0, 0, -2, 0, 0, 0, -1, 0, 1 },
    };
}

static void read_output(struct gi_test *t, const struct gpu_test_image *output, uint16_t (*texels)[4])
{
    gpu_test_image_read(&t->gpu, output->image, VK_IMAGE_LAYOUT_GENERAL, VK_IMAGE_ASPECT_COLOR_BIT,
                        output->extent, 8, texels);
}

/* The largest error of a picture, relative to what the lookup gives; 0 where there is background. */
static double worst_error(const float depth[static PIXELS], float expected[static PIXELS][3],
                          uint16_t found[static PIXELS][4])
{
    double worst = 0;
    for (int i = 0; i < PIXELS; i++)
        for (int k = 0; k < 3; k++) {
            const double want = depth[i] < 1 ? (double)expected[i][k] : 0,
                         have = (double)gi_test_half(found[i][k]);
            worst = fmax(worst, fabs(have - want) / fmax(want, 0.1));
        }
    return worst;
}

static double brightest(const struct screen *s, float expected[static PIXELS][3])
{
    double most = 0;
    for (int i = 0; i < PIXELS; i++)
        for (int k = 0; k < 3; k++)
            most = fmax(most, s->depth[i] < 1 ? (double)expected[i][k] : 0);
    return most;
}

/* Half floats have 11 bits, and a driver may truncate. */
#define ROUNDING 0x1p-10

static void gather_equals_the_lookup_in_a_shader(void **state)
{
    (void)state;
    struct gi_test t;
    static struct screen s;
    static float expected[PIXELS][3];
    static uint16_t found[PIXELS][4];
    open_scene(&t);
    screen_fill(&s);
    gi_test_irradiance(&t, s.points, PIXELS, expected);
    struct gpu_test_image depth = gi_test_gather_image(&t, VK_FORMAT_R32_SFLOAT, 4, WIDTH, HEIGHT, s.depth);
    struct gpu_test_image normal =
        gi_test_gather_image(&t, VK_FORMAT_R32G32B32A32_SFLOAT, 16, WIDTH, HEIGHT, s.normals);
    struct gpu_test_image output =
        gi_test_gather_image(&t, VK_FORMAT_R16G16B16A16_SFLOAT, 8, WIDTH, HEIGHT, NULL);
    struct gather g = { .t = &t, .desc = floor_desc(&depth, &normal, &output) };
    gpu_test_submit(&t.gpu, gather_record, &g);
    REQUIRE_CMP((int)g.result, ==, (int)SDFGI_OK);
    read_output(&t, &output, found);
    const double worst = worst_error(s.depth, expected, found), light = brightest(&s, expected);
    printf("gather: off by %.2e at most, brightest %.3f\n", worst, light);
    gpu_test_image_destroy(&t.gpu, &depth);
    gpu_test_image_destroy(&t.gpu, &normal);
    gpu_test_image_destroy(&t.gpu, &output);
    gi_test_close(&t);
    REQUIRE_CMP(light, >, 1.0);
    REQUIRE_CMP(worst, <=, ROUNDING);
}

/* ---- Many pictures in a frame */

enum { PICTURES = 20 };

/* Pictures that can be told apart: each has background at a pixel of its own. */
struct pictures {
    struct gi_test *t;
    float depth[PICTURES][PIXELS];
    struct gpu_test_image depths[PICTURES], outputs[PICTURES], normal;
    uint32_t turn; /* which depths go to which output */
};

static uint32_t depth_of(const struct pictures *p, uint32_t output)
{
    return (output + 7 * p->turn) % PICTURES;
}

static void pictures_open(struct pictures *p, struct gi_test *t, const struct screen *s)
{
    p->t = t;
    p->turn = 0;
    p->normal = gi_test_gather_image(t, VK_FORMAT_R32G32B32A32_SFLOAT, 16, WIDTH, HEIGHT, s->normals);
    for (uint32_t i = 0; i < PICTURES; i++) {
        memcpy(p->depth[i], s->depth, sizeof s->depth);
        uint32_t pixel = 6 * i;
        while (s->depth[pixel] >= 1)
            pixel++;
        p->depth[i][pixel] = 1;
        p->depths[i] = gi_test_gather_image(t, VK_FORMAT_R32_SFLOAT, 4, WIDTH, HEIGHT, p->depth[i]);
        p->outputs[i] = gi_test_gather_image(t, VK_FORMAT_R16G16B16A16_SFLOAT, 8, WIDTH, HEIGHT, NULL);
    }
}

static void pictures_close(struct pictures *p)
{
    for (uint32_t i = 0; i < PICTURES; i++) {
        gpu_test_image_destroy(&p->t->gpu, &p->depths[i]);
        gpu_test_image_destroy(&p->t->gpu, &p->outputs[i]);
    }
    gpu_test_image_destroy(&p->t->gpu, &p->normal);
}

static void record_pictures(VkCommandBuffer cmd, uint32_t index, void *user)
{
    (void)index;
    struct pictures *p = user;
    REQUIRE_CMP((int)sdfgi_update(p->t->gi, cmd, &p->t->frame), ==, (int)SDFGI_OK);
    for (uint32_t i = 0; i < PICTURES; i++) {
        const struct sdfgi_gather_desc desc =
            floor_desc(&p->depths[depth_of(p, i)], &p->normal, &p->outputs[i]);
        REQUIRE_CMP((int)sdfgi_gather(p->t->gi, cmd, &desc), ==, (int)SDFGI_OK);
    }
}

static void require_pictures(struct pictures *p, float expected[static PIXELS][3])
{
    static uint16_t found[PIXELS][4];
    static struct sdfgi_report report;
    for (uint32_t i = 0; i < PICTURES; i++) {
        read_output(p->t, &p->outputs[i], found);
        REQUIRE_CMP(worst_error(p->depth[depth_of(p, i)], expected, found), <=, ROUNDING);
    }
    sdfgi_get_report(p->t->gi, &report);
    REQUIRE_CMP(report.passes[PASS_GATHER].dispatches, ==, (uint32_t)PICTURES);
    REQUIRE_CMP(report.passes[PASS_GATHER].work, ==, (uint64_t)PICTURES * PIXELS);
}

/* Any number; the next frame has them again, from other images. */
static void twenty_gathers_in_a_frame_give_twenty_pictures_twice(void **state)
{
    (void)state;
    static struct gi_test t;
    static struct screen s;
    static struct pictures p;
    static float expected[PIXELS][3];
    open_scene(&t);
    screen_fill(&s);
    pictures_open(&p, &t, &s);
    for (p.turn = 0; p.turn < 2; p.turn++) {
        gpu_test_submit(&t.gpu, record_pictures, &p);
        gi_test_irradiance(&t, s.points, PIXELS, expected);
        REQUIRE_CMP(brightest(&s, expected), >, 1.0);
        require_pictures(&p, expected);
    }
    uint32_t views = 0;
    for (const struct sdfgi_view *view = t.gi->views.of_gathers; view; view = view->next)
        views++;
    REQUIRE_CMP(views, ==, (uint32_t)PICTURES);
    pictures_close(&p);
    gi_test_close(&t);
}

/* None of the refused calls touches its command buffer. */
static void require_refused(struct gi_test *t, const struct sdfgi_gather_desc *desc)
{
    t->messages[SDFGI_MESSAGE_INVALID_ARGUMENT] = 0;
    REQUIRE_CMP((int)sdfgi_gather(t->gi, (VkCommandBuffer)t, desc), ==, (int)SDFGI_ERROR_INVALID_ARGUMENT);
    REQUIRE_CMP(t->messages[SDFGI_MESSAGE_INVALID_ARGUMENT], ==, 1u);
}

static void gather_refuses_bad_descriptors(void **state)
{
    (void)state;
    struct gi_test t;
    open_scene(&t);
    t.gpu.messages->quiet = true;
    struct gpu_test_image depth = gi_test_gather_image(&t, VK_FORMAT_R32_SFLOAT, 4, WIDTH, HEIGHT, NULL);
    struct gpu_test_image output =
        gi_test_gather_image(&t, VK_FORMAT_R16G16B16A16_SFLOAT, 8, WIDTH, HEIGHT, NULL);
    const struct sdfgi_gather_desc good = { .depth = depth.view,
                                            .normal = depth.view,
                                            .output = output.view,
                                            .width = WIDTH,
                                            .height = HEIGHT,
                                            .inverse_view_projection = { 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0,
                                                                         0, 0, 0, 1 } };
    struct sdfgi_gather_desc bad[12];
    for (int i = 0; i < 12; i++)
        bad[i] = good;
    bad[0].depth = VK_NULL_HANDLE;
    bad[1].normal = VK_NULL_HANDLE;
    bad[2].output = VK_NULL_HANDLE;
    bad[3].width = 0;
    bad[4].height = 0;
    bad[5].inverse_view_projection[7] = NAN;
    bad[6].resolution = (enum sdfgi_gather_resolution)(SDFGI_GATHER_QUARTER + 1);
    bad[7].width = UINT32_MAX;
    bad[8].height = t.gi->backend.device.limits.maxImageDimension2D + 1;
    bad[9].width = UINT32_MAX;
    bad[9].resolution = SDFGI_GATHER_QUARTER;
    bad[10].scale = -1;
    bad[11].scale = INFINITY;
    for (int i = 0; i < 12; i++)
        require_refused(&t, &bad[i]);
    REQUIRE_CMP((int)sdfgi_gather(t.gi, VK_NULL_HANDLE, &good), ==, (int)SDFGI_ERROR_INVALID_ARGUMENT);
    t.gi->backend.device.limits.maxComputeWorkGroupCount[1] = 1;
    require_refused(&t, &good);
    gpu_test_image_destroy(&t.gpu, &depth);
    gpu_test_image_destroy(&t.gpu, &output);
    gi_test_close(&t);
}

TEST_GROUP(gather)
{
    if (!gpu_test_available())
        return GPU_TEST_SKIP;
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(gather_equals_the_lookup_in_a_shader),
        cmocka_unit_test(twenty_gathers_in_a_frame_give_twenty_pictures_twice),
        cmocka_unit_test(gather_refuses_bad_descriptors),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
