/* SPDX-License-Identifier: MIT
 * Fog against what single scattering gives exactly. */
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

#define PI 3.14159265358979323846

static struct host_device *device;
static float picture[4 * FOG_PIXELS];

/* The exact radiance along a ray, in three channels. */
typedef void (*exact_fn)(const struct fog_scene *scene, const double ray[3], double radiance[3]);

/* The largest relative error of all pixels; darker ones than a hundredth of the brightest count as if they
 * were that bright. */
static double worst_error(const struct fog_scene *scene, exact_fn exact)
{
    static double expected[3 * FOG_PIXELS];
    double brightest = 0, worst = 0;
    for (int i = 0; i < FOG_PIXELS; i++) {
        double ray[3];
        fog_ray(&scene->view, i % FOG_WIDTH, i / FOG_WIDTH, ray);
        exact(scene, ray, expected + 3 * i);
        for (int c = 0; c < 3; c++)
            brightest = fmax(brightest, expected[3 * i + c]);
    }
    for (int i = 0; i < 3 * FOG_PIXELS; i++) {
        const double found = (double)picture[4 * (i / 3) + i % 3];
        worst = fmax(worst, fabs(found - expected[i]) / fmax(expected[i], 0.01 * brightest));
    }
    return worst;
}

static double length_of(const double v[3])
{
    return sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
}

static double phase(double g, double cosine)
{
    return (1 - g * g) / (4 * PI * pow(1 + g * g - 2 * g * cosine, 1.5));
}

/* ---- Sky */

/* An even sky of 2. Up to where the ray ends, an exponential atmosphere takes density / (falloff * slope). */
static void exact_sky(const struct fog_scene *scene, const double ray[3], double radiance[3])
{
    const struct host_fog *fog = &scene->view.fog;
    const double rise = (double)fog->height_falloff * ray[1] / length_of(ray);
    const double depth = (double)fog->density * exp((double)fog->height_falloff * fog->height_m);
    const double through = rise > 0 ? exp(-depth / rise) : 0;
    for (int c = 0; c < 3; c++)
        radiance[c] = 2 * (through + (double)fog->albedo[c] * (1 - through));
}

static void require_sky(const char *name, struct host_fog fog)
{
    struct fog_scene scene = fog_scene_empty(0);
    scene.view.fog = fog;
    scene.view.sky = (struct host_sky){ { 2, 2, 2 }, { 2, 2, 2 }, { 2, 2, 2 } };
    scene.gi = true;
    fog_scene_draw(device, &scene, picture);
    const double worst = worst_error(&scene, exact_sky);
    printf("even sky, %s: off by %.4f\n", name, worst);
    REQUIRE_CMP(worst, <=, 0.01);
}

static void an_even_sky_is_scattered_by_albedo(void **state)
{
    (void)state;
    require_sky("thin", (struct host_fog){ .density = 0.01f, .albedo = { 1, 0.5f, 0 } });
    require_sky("thick", (struct host_fog){ .density = 3, .albedo = { 1, 0.5f, 0 }, .anisotropy = 0.9f });
    require_sky("low", (struct host_fog){ .density = 0.05f,
                                          .albedo = { 1, 0.5f, 0 },
                                          .height_falloff = 0.1f,
                                          .height_m = 5,
                                          .anisotropy = -0.5f });
}

/* ---- Suns */

#define WALL_M    12.0
#define SUN_WATTS 5.0f

/* A black wall across the view. */
static const struct fog_box black_wall[] = {
    { { 0, 0, -WALL_M - 1 }, { 80, 80, 2 }, .color = { 0, 0, 0, 1 } }
};

static void exact_sun(const struct fog_scene *scene, const double ray[3], double radiance[3])
{
    const struct host_fog *fog = &scene->view.fog;
    const float *way = scene->view.sun.direction;
    double cosine = 0, length = 0;
    for (int i = 0; i < 3; i++) {
        cosine -= (double)way[i] * ray[i] / length_of(ray);
        length += (double)way[i] * (double)way[i];
    }
    const double scattered = 1 - exp(-(double)fog->density * WALL_M * length_of(ray));
    for (int c = 0; c < 3; c++)
        radiance[c] = (double)fog->albedo[c] * (double)scene->view.sun.irradiance[c] * scattered *
                      phase((double)fog->anisotropy, cosine / sqrt(length));
}

static void sun_scatters_once_along_each_ray(void **state)
{
    (void)state;
    static const float anisotropies[] = { 0, 0.7f, -0.5f };
    for (int i = 0; i < 3; i++) {
        struct fog_scene scene = fog_scene_empty(i == 0 ? 0.02f : 0.2f);
        scene.view.fog.albedo[1] = 0.5f;
        scene.view.fog.anisotropy = anisotropies[i];
        scene.view.sun = (struct host_sun){ true, { 0.3f, -1, -0.4f }, { SUN_WATTS, SUN_WATTS, 2 }, 0.01f };
        scene.boxes = black_wall;
        scene.box_count = 1;
        fog_scene_draw(device, &scene, picture);
        const double worst = worst_error(&scene, exact_sun);
        printf("sun, anisotropy %.1f: off by %.4f\n", (double)anisotropies[i], worst);
        REQUIRE_CMP(worst, <=, 0.03);
    }
}

/* Black ground under the camera. */
#define EYE_M 1.6
static const struct fog_box black_ground[] = {
    { { 0, -EYE_M - 1, 0 }, { 400, 2, 400 }, .color = { 0, 0, 0, 1 } }
};

static void exact_above_ground(const struct fog_scene *scene, const double ray[3], double radiance[3])
{
    const double length_m = ray[1] < 0 ? EYE_M / -ray[1] * length_of(ray) : 1e9;
    for (int c = 0; c < 3; c++)
        radiance[c] = (double)SUN_WATTS / (4 * PI) * (1 - exp(-(double)scene->view.fog.density * length_m));
}

/* The horizon is at the edge of froxels, and between. */
static void the_dark_below_the_ground_is_not_seen(void **state)
{
    (void)state;
    for (int i = 0; i < 2; i++) {
        struct fog_scene scene = fog_scene_empty(0.05f);
        scene.view.camera.look_at[1] = -0.14 * i;
        scene.view.sun = (struct host_sun){ true, { 0, -1, 0 }, { SUN_WATTS, SUN_WATTS, SUN_WATTS }, 0 };
        scene.boxes = black_ground;
        scene.box_count = 1;
        fog_scene_draw(device, &scene, picture);
        const double worst = worst_error(&scene, exact_above_ground);
        printf("above ground: off by %.4f\n", worst);
        REQUIRE_CMP(worst, <=, 0.03);
    }
}

/* A roof high above all that lies more than 4 m in front of the camera; the sun stands in the zenith. */
#define ROOF_M 4.0
static const struct fog_box roofed[] = {
    { { 0, 0, -WALL_M - 1 }, { 80, 80, 2 }, .color = { 0, 0, 0, 1 } },
    { { 0, 20, -ROOF_M - 15 }, { 80, 1, 30 }, .color = { 0, 0, 0, 1 } },
};

static void exact_shaft(const struct fog_scene *scene, const double ray[3], double radiance[3])
{
    const double lit_m = ROOF_M * length_of(ray);
    for (int c = 0; c < 3; c++)
        radiance[c] = (double)SUN_WATTS / (4 * PI) * (1 - exp(-(double)scene->view.fog.density * lit_m));
}

static void fog_behind_a_blocker_is_dark(void **state)
{
    (void)state;
    struct fog_scene scene = fog_scene_empty(0.2f);
    scene.view.sun = (struct host_sun){ true, { 0, -1, 0 }, { SUN_WATTS, SUN_WATTS, SUN_WATTS }, 0 };
    scene.boxes = roofed;
    scene.box_count = 2;
    fog_scene_draw(device, &scene, picture);
    const double worst = worst_error(&scene, exact_shaft);
    /* The edge falls into a slice of 0.3 m: its fog is 2 % of what is seen of the 4 m, and looked up at eight
     * places. */
    printf("shaft: off by %.4f\n", worst);
    REQUIRE_CMP(worst, <=, 0.02);
    scene.view.camera.position[2] = scene.view.camera.look_at[2] = -ROOF_M - 1;
    scene.view.camera.look_at[2] -= 1;
    fog_scene_draw(device, &scene, picture);
    for (int i = 0; i < FOG_PIXELS; i++)
        REQUIRE_CMP(picture[4 * i], ==, 0.0f);
}

/* ---- Lamps */

static const double lamp_at[3] = { 0.7, 0.4, -3 };

/* By sums of 1 / d^2 over steps of 4 mm. */
static void exact_lamp(const struct fog_scene *scene, const double ray[3], double radiance[3])
{
    const struct host_fog *fog = &scene->view.fog;
    const double step = 4e-3, end = WALL_M * length_of(ray);
    double sum = 0;
    for (double s = 0.5 * step; s < end; s += step) {
        double distance2 = 0, along = 0;
        for (int i = 0; i < 3; i++) {
            const double unit = ray[i] / length_of(ray), offset = lamp_at[i] - s * unit;
            distance2 += offset * offset;
            along += offset * unit;
        }
        sum += step * exp(-(double)fog->density * s) *
               phase((double)fog->anisotropy, along / sqrt(distance2)) / distance2;
    }
    for (int c = 0; c < 3; c++)
        radiance[c] = (double)fog->density * 10 * sum;
}

/* The black wall, and a black box around the lamp. */
static const struct fog_box lamp_boxes[] = {
    { { 0, 0, -WALL_M - 1 }, { 80, 80, 2 }, .color = { 0, 0, 0, 1 } },
    { { 0.7, 0.4, -3 }, { 0.3, 0.3, 0.3 }, .color = { 0, 0, 0, 1 } },
};

static double lamp_light(struct fog_scene *scene, uint32_t boxes)
{
    struct host_light lamp = { .type = HOST_LIGHT_POINT, .intensity = { 10, 10, 10 } };
    double sum = 0;
    memcpy(lamp.position, lamp_at, sizeof lamp_at);
    scene->view.fog.anisotropy = 0.3f;
    scene->view.lights = &lamp;
    scene->view.light_count = 1;
    scene->boxes = lamp_boxes;
    scene->box_count = boxes;
    fog_scene_draw(device, scene, picture);
    for (int i = 0; i < FOG_PIXELS; i++)
        sum += (double)picture[4 * i];
    return sum;
}

static void a_lamp_has_a_halo(void **state)
{
    (void)state;
    struct fog_scene scene = fog_scene_empty(0.05f);
    const double found = lamp_light(&scene, 1);
    double expected = 0;
    for (int i = 0; i < FOG_PIXELS; i++) {
        double ray[3], exact[3];
        fog_ray(&scene.view, i % FOG_WIDTH, i / FOG_WIDTH, ray);
        exact_lamp(&scene, ray, exact);
        expected += exact[0];
    }
    const double boxed = lamp_light(&scene, 2);
    printf("lamp: %.4f of the light of its halo; in a box %.5f\n", found / expected, boxed / expected);
    REQUIRE_NEAR(found / expected, 1, 0.03);
    REQUIRE_CMP(boxed, <=, 0.01 * expected);
}

/* ---- Furnace */

/* A room of 3 m whose walls glow with 1/2 and reflect 1/2 has the radiance 1 everywhere; a pane of white
 * glass in it shows the same. */
#define WALL(x, y, z, sx, sy, sz)                                                                            \
    {                                                                                                        \
        { x, y, z }, { sx, sy, sz }, { 0.5f, 0.5f, 0.5f, 1 }, .emission = 0.5f                               \
    }
static const struct fog_box furnace[] = {
    WALL(1.625, 0, 0, 0.25, 3.5, 3.5),
    WALL(-1.625, 0, 0, 0.25, 3.5, 3.5),
    WALL(0, 1.625, 0, 3.5, 0.25, 3.5),
    WALL(0, -1.625, 0, 3.5, 0.25, 3.5),
    WALL(0, 0, 1.625, 3.5, 3.5, 0.25),
    WALL(0, 0, -1.625, 3.5, 3.5, 0.25),
    { { 0.3, 0.2, -1 }, { 1, 1, 0.02 }, .color = { 1, 1, 1, 0.25f } },
};

static void exact_one(const struct fog_scene *scene, const double ray[3], double radiance[3])
{
    (void)scene;
    (void)ray;
    for (int c = 0; c < 3; c++)
        radiance[c] = 1;
}

enum { PANES = 1, BOXES = sizeof furnace / sizeof *furnace };

static void require_furnace(float density, float anisotropy, uint32_t boxes)
{
    struct fog_scene scene = fog_scene_empty(density);
    scene.boxes = furnace;
    scene.box_count = boxes;
    scene.gi = true;
    scene.frames = 24; /* bounces need more of them than other scenes do */
    scene.view.fog.anisotropy = anisotropy;
    fog_scene_draw(device, &scene, picture);
    const double worst = worst_error(&scene, exact_one);
    printf("furnace, density %.2f: off by %.4f\n", (double)density, worst);
    REQUIRE_CMP(worst, <=, 0.02);
}

static void a_furnace_with_fog_stays_white(void **state)
{
    (void)state;
    require_furnace(3, -0.4f, BOXES - PANES);
}

static void glass_in_fog_stays_white(void **state)
{
    (void)state;
    require_furnace(0.5f, 0.4f, BOXES);
}

/* Under an even sky of 1 all that is white shows 1: a mirror, metal of three roughnesses, and glass before
 * them, in fog and without. */
static const struct fog_box white_things[] = {
    { { -1, 0.1, -3 }, { 0.7, 0.7, 0.7 }, .color = { 1, 1, 1, 1 }, .metal = true, .smoothness = 1 },
    { { 0, -0.1, -3.2 }, { 0.7, 0.7, 0.7 }, .color = { 1, 1, 1, 1 }, .metal = true, .smoothness = 0.65f },
    { { 0.9, 0, -3 }, { 0.7, 0.7, 0.7 }, .color = { 1, 1, 1, 1 }, .metal = true, .smoothness = 0.2f },
    { { 0.3, 0.9, -3.4 }, { 0.7, 0.7, 0.7 }, .color = { 1, 1, 1, 1 }, .metal = true, .smoothness = 0.9f },
    { { 0, 0.3, -1.6 }, { 1.6, 0.7, 0.02 }, .color = { 1, 1, 1, 0.25f }, .smoothness = 0.9f },
};

static void metal_and_glass_in_fog_stay_white(void **state)
{
    (void)state;
    for (int fog = 0; fog < 2; fog++) {
        struct fog_scene scene = fog_scene_empty(fog ? 0.1f : 0);
        scene.boxes = white_things;
        scene.box_count = sizeof white_things / sizeof *white_things;
        scene.gi = true;
        scene.view.materials = HOST_MATERIALS_GLTF;
        scene.view.sky = (struct host_sky){ { 1, 1, 1 }, { 1, 1, 1 }, { 1, 1, 1 } };
        fog_scene_draw(device, &scene, picture);
        const double worst = worst_error(&scene, exact_one);
        printf("metal and glass, %s: off by %.4f\n", fog ? "in fog" : "no fog", worst);
        REQUIRE_CMP(worst, <=, 0.02);
    }
}

/* ---- Frames */

static void fog_is_the_same_in_every_frame(void **state)
{
    (void)state;
    static float again[4 * FOG_PIXELS];
    struct fog_stage stage;
    struct host_times times;
    struct fog_scene scene = fog_scene_empty(0.1f);
    scene.view.sun = (struct host_sun){ true, { 0.2f, -1, 0.3f }, { 4, 4, 4 }, 0 };
    scene.boxes = roofed;
    scene.box_count = 2;
    scene.gi = true;
    fog_stage_open(&stage, device, &scene);
    fog_stage_read(&stage, picture);
    assert_true(host_renderer_frame(stage.renderer, &stage.camera));
    fog_stage_read(&stage, again);
    REQUIRE_CMP(memcmp(picture, again, sizeof picture), ==, 0);
    host_renderer_get_times(stage.renderer, &times);
    REQUIRE_CMP(times.fog_ns, >, 0ul);
    REQUIRE_CMP(times.fog_ns, <, times.frame_ns);
    fog_stage_close(&stage);
}

/* GI that is switched on later lights the fog as well, and another size has froxels of its own. */
static void fog_follows_what_changes(void **state)
{
    (void)state;
    struct fog_stage stage;
    struct sdfgi_settings settings;
    struct fog_scene scene = fog_scene_empty(0.1f);
    scene.view.sky = (struct host_sky){ { 2, 2, 2 }, { 2, 2, 2 }, { 2, 2, 2 } };
    fog_stage_open(&stage, device, &scene);
    fog_stage_read(&stage, picture);
    REQUIRE_NEAR(picture[0], 0, 1e-3);
    host_renderer_get_settings(stage.renderer, &settings);
    settings.enabled = true;
    assert_true(host_renderer_set_settings(stage.renderer, &settings));
    assert_true(host_renderer_resize(stage.renderer, 39, 31)); /* no whole tiles of froxels */
    assert_true(host_renderer_frame(stage.renderer, &stage.camera));
    fog_stage_read(&stage, picture);
    REQUIRE_NEAR(picture[0], 2, 0.02);
    assert_true(host_renderer_resize(stage.renderer, FOG_WIDTH, FOG_HEIGHT));
    assert_true(host_renderer_frame_without_gi(stage.renderer, &stage.camera));
    assert_true(host_renderer_frame(stage.renderer, &stage.camera));
    fog_stage_read(&stage, picture);
    REQUIRE_NEAR(picture[4 * FOG_PIXELS - 4], 2, 0.02);
    fog_stage_close(&stage);
}

/* ---- A moving camera */

enum { SLATS = 12 };

/* Slats of 0.5 m with gaps as wide, under a slanting sun, in front of a black wall: all that is seen are
 * shafts in the fog. The view is narrow, so that froxels are about as wide as in a picture of 1,000 pixels.
 */
static void open_slats(struct fog_stage *stage)
{
    static struct fog_box boxes[SLATS + 1];
    struct fog_scene scene = fog_scene_empty(0.1f);
    boxes[SLATS] = black_wall[0];
    for (int i = 0; i < SLATS; i++)
        boxes[i] = (struct fog_box){ { i - SLATS / 2, 3, -6 }, { 0.5, 0.1, 12 }, .color = { 0, 0, 0, 1 } };
    scene.view.camera.yfov_rad = 0.2618f;
    scene.view.sun = (struct host_sun){ true, { 0.4f, -1, -0.2f }, { SUN_WATTS, SUN_WATTS, SUN_WATTS }, 0 };
    scene.boxes = boxes;
    scene.box_count = SLATS + 1;
    fog_stage_open(stage, device, &scene);
}

/* What pixels do while the camera moves evenly: the change of their change from frame to frame, over the
 * light. */
static void require_calm(struct fog_stage *stage, int axis, double step_m)
{
    static float frames[3][4 * FOG_PIXELS];
    const struct host_camera start = stage->camera;
    double sum = 0, worst = 0, light = 0;
    for (int i = 0; i < 3; i++) {
        stage->camera.position[axis] = start.position[axis] - i * step_m;
        stage->camera.look_at[axis] = start.look_at[axis] - i * step_m;
        assert_true(host_renderer_frame(stage->renderer, &stage->camera));
        fog_stage_read(stage, frames[i]);
    }
    for (int i = 0; i < 4 * FOG_PIXELS; i += 4) {
        const double change = fabs((double)frames[0][i] - 2 * (double)frames[1][i] + (double)frames[2][i]);
        worst = fmax(worst, change);
        sum += change;
        light += (double)frames[1][i];
    }
    printf("along %c: %.4f of the light, %.4f at worst\n", "xyz"[axis], sum / light,
           worst * FOG_PIXELS / light);
    REQUIRE_CMP(sum / light, <=, 0.02);
    REQUIRE_CMP(worst * FOG_PIXELS / light, <=, 0.1);
    stage->camera = start;
}

/* Steps of a walk at 60 frames a second. With one look at the shadow map per froxel, shafts jump by 0.17. */
static void nothing_crawls(void **state)
{
    (void)state;
    struct fog_stage stage;
    open_slats(&stage);
    require_calm(&stage, 0, 0.015);
    require_calm(&stage, 2, 0.015);
    fog_stage_close(&stage);
}

TEST_GROUP(fog)
{
    device = host_test_open();
    if (!device)
        return HOST_TEST_SKIP;
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(an_even_sky_is_scattered_by_albedo),
        cmocka_unit_test(sun_scatters_once_along_each_ray),
        cmocka_unit_test(the_dark_below_the_ground_is_not_seen),
        cmocka_unit_test(fog_behind_a_blocker_is_dark),
        cmocka_unit_test(a_lamp_has_a_halo),
        cmocka_unit_test(a_furnace_with_fog_stays_white),
        cmocka_unit_test(glass_in_fog_stays_white),
        cmocka_unit_test(metal_and_glass_in_fog_stay_white),
        cmocka_unit_test(fog_is_the_same_in_every_frame),
        cmocka_unit_test(fog_follows_what_changes),
        cmocka_unit_test(nothing_crawls),
    };
    return host_test_close(device, cmocka_run_group_tests(tests, NULL, NULL));
}
