/* SPDX-License-Identifier: MIT
 * Rays of a lobe are few in each pixel: reflections of smooth surfaces show no pattern of them. */
#include "gather_picture.h"
#include "require.h"
#include "test_group.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

enum { WIDTH = 96, HEIGHT = 64, FLOOR = 0, SQUARE = 4 };

/* A dark floor that mirrors a lamp 8 m away, seen through a long lens: a pixel is 1/20 of a degree wide. */
static struct picture draw_scene(struct gi_test *t, struct picture_scene *scene)
{
    struct sdfgi_settings settings = gi_test_settings();
    settings.resolution = 64;
    settings.cascades = 2;
    settings.ray_count = 125;
    settings.frames_to_converge = 4;
    gi_test_open(t, &settings);
    picture_scene_add(scene, t,
                      test_mesh_box((double[]){ 0, -1, -4 }, (double[]){ 6, 1, 12 }, test_rotation_none),
                      0.05f, 0);
    picture_scene_add(
        scene, t, test_mesh_box((double[]){ 0, 2.5, -8 }, (double[]){ 0.3, 0.5, 0.3 }, test_rotation_none),
        0.5f, 20);
    const struct sdfgi_material_desc smooth = { .smoothness = 1 };
    sdfgi_material material;
    REQUIRE_CMP((int)sdfgi_material_create(t->gi, &smooth, &material), ==, (int)SDFGI_OK);
    gi_test_update(t, 8);
    const double down = 0.447, ahead = 0.894; /* towards the mirrored lamp */
    const struct picture_camera camera = { .position = { 0, 1.5, 0 },
                                           .right = { 1, 0, 0 },
                                           .up = { 0, ahead, -down },
                                           .forward = { 0, -down, -ahead },
                                           .tan_x = 0.045,
                                           .tan_y = 0.03,
                                           .near_m = 0.05 };
    return picture_draw(scene, &camera, WIDTH, HEIGHT);
}

/* Luminance of what each pixel reflects at a roughness. */
static void reflect(struct gi_test *t, const struct picture *p, float roughness, float light[WIDTH * HEIGHT])
{
    static float rough[WIDTH * HEIGHT];
    static uint16_t texels[WIDTH * HEIGHT][4];
    for (int i = 0; i < WIDTH * HEIGHT; i++)
        rough[i] = roughness;
    struct gpu_test_image images[] = {
        gi_test_gather_image(t, VK_FORMAT_R32_SFLOAT, 4, WIDTH, HEIGHT, p->depth),
        gi_test_gather_image(t, VK_FORMAT_R32G32B32A32_SFLOAT, 16, WIDTH, HEIGHT, p->normals),
        gi_test_gather_image(t, VK_FORMAT_R32_SFLOAT, 4, WIDTH, HEIGHT, rough),
    };
    struct sdfgi_resolve_desc desc = { .depth = images[0].view,
                                       .normal = images[1].view,
                                       .roughness = images[2].view,
                                       .background_depth = p->desc.background_depth };
    memcpy(desc.inverse_view_projection, p->desc.inverse_view_projection,
           sizeof desc.inverse_view_projection);
    const struct sdfgi_view_desc size = { .width = WIDTH, .height = HEIGHT };
    sdfgi_view *view = NULL;
    REQUIRE_CMP((int)sdfgi_view_create(t->gi, &size, &view), ==, (int)SDFGI_OK);
    gi_test_resolve(t, view, &desc);
    gpu_test_image_read(&t->gpu, view->reflection.handle, VK_IMAGE_LAYOUT_GENERAL, VK_IMAGE_ASPECT_COLOR_BIT,
                        (VkExtent3D){ WIDTH, HEIGHT, 1 }, 8, texels);
    for (int i = 0; i < WIDTH * HEIGHT; i++)
        light[i] = gi_test_half(texels[i][1]);
    for (int i = 0; i < 3; i++)
        gpu_test_image_destroy(&t->gpu, &images[i]);
    sdfgi_view_destroy(t->gi, view);
}

/* How much a square of pixels differs from the mean of those on both sides of it, over the brightest. */
static double pattern_of(const struct picture *p, const float light[WIDTH * HEIGHT])
{
    double sum = 0, brightest = 0;
    int count = 0;
    for (int i = 0; i < WIDTH * HEIGHT; i++) {
        const int x = i % WIDTH;
        brightest = fmax(brightest, (double)light[i]);
        if (x < SQUARE || x >= WIDTH - SQUARE || p->objects[i] != FLOOR)
            continue;
        sum += fabs((double)light[i] - 0.5 * ((double)light[i - SQUARE] + (double)light[i + SQUARE]));
        count++;
    }
    REQUIRE_CMP(count, >, WIDTH * HEIGHT / 2);
    REQUIRE_CMP(brightest, >, 1.0);
    return sum / count / brightest;
}

static void squares_of_rays_do_not_show(void **state)
{
    (void)state;
    static struct gi_test t;
    static float light[WIDTH * HEIGHT];
    struct picture_scene scene = { .count = 0 };
    struct picture picture = draw_scene(&t, &scene);
    static const float roughness[] = { 0.08f, 0.12f, 0.2f, 0.3f };
    double worst = 0;
    for (int i = 0; i < 4; i++) {
        reflect(&t, &picture, roughness[i], light);
        const double pattern = pattern_of(&picture, light);
        printf("roughness %.2f: squares differ by %.4f of the brightest in the mean\n", (double)roughness[i],
               pattern);
        worst = fmax(worst, pattern);
    }
    picture_finish(&picture);
    picture_scene_finish(&scene);
    gi_test_close(&t);
    REQUIRE_CMP(worst, <=, 0.02);
}

TEST_GROUP(reflection_noise)
{
    if (!gpu_test_available())
        return GPU_TEST_SKIP;
    const struct CMUnitTest tests[] = { cmocka_unit_test(squares_of_rays_do_not_show) };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
