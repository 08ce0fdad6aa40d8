/* SPDX-License-Identifier: MIT
 * Orthographic cameras against what parallel rays see exactly, and against perspective ones. */
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
#include <string.h>

#define PI     3.14159265358979323846
#define YMAG_M 2.0

static struct host_device *device;
static float picture[4 * FOG_PIXELS];

/* The ray of a pixel. */
struct ray {
    double start[3], direction[3]; /* unit */
};

/* As fog_scene_empty has it, seen by parallel rays. */
static struct fog_scene flat_scene(float density)
{
    struct fog_scene scene = fog_scene_empty(density);
    scene.view.camera.ymag_m = YMAG_M;
    scene.view.camera.zfar_m = 100;
    return scene;
}

/* The camera is somewhere, and looks along (0, y, -1). */
static struct ray ray_of(const struct host_camera *camera, int x, int y)
{
    const double right = ((x + 0.5) / FOG_WIDTH * 2 - 1) * (double)camera->ymag_m * FOG_WIDTH / FOG_HEIGHT,
                 up = (1 - (y + 0.5) / FOG_HEIGHT * 2) * (double)camera->ymag_m;
    const double rise = camera->look_at[1] - camera->position[1], length = sqrt(1 + rise * rise);
    const double *p = camera->position;
    return (struct ray){ { p[0] + right, p[1] + up / length, p[2] + rise * up / length },
                         { 0, rise / length, -1 / length } };
}

/* ---- What is drawn */

static const struct fog_box edge_boxes[] = {
    { { 2.7, 1.7, -0.6 }, { 0.5, 0.5, 0.5 }, .color = { 0.3f, 0.3f, 0.3f, 1 } },
    { { -2.7, -1.7, -0.6 }, { 0.5, 0.5, 0.5 }, .color = { 0.4f, 0.4f, 0.4f, 1 } },
    { { 0, 0, -30 }, { 1, 1, 1 }, .color = { 0.5f, 0.5f, 0.5f, 1 } },
    /* Before the near plane, and behind the far one. */
    { { 0.9, 0.9, -0.1 }, { 0.5, 0.5, 0.1 }, .color = { 0.6f, 0.6f, 0.6f, 1 } },
    { { -0.9, 0.9, -50 }, { 0.5, 0.5, 0.5 }, .color = { 0.7f, 0.7f, 0.7f, 1 } },
};

enum { SEEN_BOXES = 3, EDGE_BOXES = sizeof edge_boxes / sizeof *edge_boxes };

/* The box that a ray along -z meets first, and where; NULL: none. Pixels that an edge crosses may be either.
 */
static const struct fog_box *box_seen(const struct ray *ray, bool *on_edge)
{
    const struct fog_box *found = NULL;
    *on_edge = false;
    for (int i = 0; i < SEEN_BOXES; i++) {
        const double x = fabs(ray->start[0] - edge_boxes[i].center[0]) - edge_boxes[i].size[0] / 2,
                     y = fabs(ray->start[1] - edge_boxes[i].center[1]) - edge_boxes[i].size[1] / 2;
        if (fmax(x, y) < 0)
            found = &edge_boxes[i];
        *on_edge = *on_edge || fabs(fmax(x, y)) < 1e-3;
    }
    return found;
}

static void parallel_rays_see_what_is_between_the_planes(void **state)
{
    (void)state;
    static float depths[4 * FOG_PIXELS];
    struct fog_scene scene = flat_scene(0);
    struct fog_stage stage;
    scene.view.camera.znear_m = 0.3f;
    scene.view.camera.zfar_m = 40;
    scene.boxes = edge_boxes;
    scene.box_count = EDGE_BOXES;
    fog_stage_open(&stage, device, &scene);
    assert_true(host_renderer_read_aov(stage.renderer, HOST_AOV_ALBEDO, picture));
    assert_true(host_renderer_read_aov(stage.renderer, HOST_AOV_DEPTH, depths));
    int seen = 0;
    for (int i = 0; i < FOG_PIXELS; i++) {
        bool on_edge;
        const struct ray ray = ray_of(&scene.view.camera, i % FOG_WIDTH, i / FOG_WIDTH);
        const struct fog_box *box = box_seen(&ray, &on_edge);
        if (on_edge)
            continue;
        seen += box != NULL;
        REQUIRE_NEAR(picture[4 * i], box ? box->color[0] : 0, 1e-6);
        REQUIRE_NEAR(depths[4 * i], box ? -box->center[2] - box->size[2] / 2 : 0, 1e-4);
    }
    REQUIRE_CMP(seen, >, FOG_PIXELS / 20);
    fog_stage_close(&stage);
}

/* The pane in front is farther off from the camera's point than the one behind it. */
static void glass_is_drawn_in_order_of_depth(void **state)
{
    (void)state;
    static const struct fog_box panes[] = {
        { { 6, 0, -2 }, { 12.5, 4, 0.02 }, { 0, 0, 0, 0.5f }, .emission = 1 },
        { { 0, 0, -3 }, { 8, 8, 0.02 }, .color = { 0, 0, 0, 0.5f } },
    };
    struct fog_scene scene = flat_scene(0);
    scene.boxes = panes;
    scene.box_count = 2;
    fog_scene_draw(device, &scene, picture);
    const int right_half = FOG_HEIGHT / 2 * FOG_WIDTH + FOG_WIDTH * 3 / 4;
    /* The pane's back is culled: half of 1, over black. */
    REQUIRE_NEAR(picture[4 * right_half], 0.5, 1e-3);
}

/* ---- Fog */

typedef void (*exact_fn)(const struct fog_scene *scene, const struct ray *ray, double radiance[3]);

/* The largest relative error of all pixels, and how much the exact ones differ. */
static double worst_error(const struct fog_scene *scene, exact_fn exact, double *range)
{
    double worst = 0, least = INFINITY, most = 0;
    for (int i = 0; i < FOG_PIXELS; i++) {
        double expected[3];
        const struct ray ray = ray_of(&scene->view.camera, i % FOG_WIDTH, i / FOG_WIDTH);
        exact(scene, &ray, expected);
        for (int c = 0; c < 3; c++)
            worst = fmax(worst, fabs((double)picture[4 * i + c] - expected[c]) / fmax(expected[c], 1e-3));
        least = fmin(least, expected[0]);
        most = fmax(most, expected[0]);
    }
    *range = most / least;
    return worst;
}

/* An even sky of 2, seen along rays that rise from different heights. */
static void exact_sky(const struct fog_scene *scene, const struct ray *ray, double radiance[3])
{
    const struct host_fog *fog = &scene->view.fog;
    const double falloff = (double)fog->height_falloff,
                 here = (double)fog->density * exp(falloff * (fog->height_m - ray->start[1])),
                 through = exp(-here / (falloff * ray->direction[1]));
    for (int c = 0; c < 3; c++)
        radiance[c] = 2 * (through + (double)fog->albedo[c] * (1 - through));
}

static void fog_thins_out_along_parallel_rays(void **state)
{
    (void)state;
    struct fog_scene scene = flat_scene(0);
    double range;
    scene.view.fog =
        (struct host_fog){ .density = 0.3f, .albedo = { 0.1f, 0.5f, 0 }, .height_falloff = 0.4f };
    scene.view.camera.look_at[1] = 1;
    scene.view.sky = (struct host_sky){ { 2, 2, 2 }, { 2, 2, 2 }, { 2, 2, 2 } };
    scene.gi = true;
    fog_scene_draw(device, &scene, picture);
    const double worst = worst_error(&scene, exact_sky, &range);
    printf("even sky, parallel rays: off by %.4f, values differ by %.2f\n", worst, range);
    REQUIRE_CMP(worst, <=, 0.01);
    REQUIRE_CMP(range, >, 2.0);
}

#define WALL_M    12.0
#define SUN_WATTS 5.0f

/* A black wall across the view. */
static const struct fog_box wall[] = { { { 0, 0, -WALL_M - 1 }, { 80, 80, 2 }, .color = { 0, 0, 0, 1 } } };

static void exact_sun(const struct fog_scene *scene, const struct ray *ray, double radiance[3])
{
    const struct host_fog *fog = &scene->view.fog;
    const double scattered = 1 - exp(-(double)fog->density * WALL_M);
    (void)ray;
    const double g = (double)fog->anisotropy, cosine = -0.6; /* the light comes from behind */
    const double phase = (1 - g * g) / (4 * PI * pow(1 + g * g - 2 * g * cosine, 1.5));
    for (int c = 0; c < 3; c++)
        radiance[c] = (double)fog->albedo[c] * (double)SUN_WATTS * scattered * phase;
}

/* All rays meet its light at one angle, and as much fog. */
static void sun_scatters_evenly_over_the_picture(void **state)
{
    (void)state;
    struct fog_scene scene = flat_scene(0.1f);
    double range;
    scene.view.fog.albedo[1] = 0.5f;
    scene.view.fog.anisotropy = 0.6f;
    scene.view.sun = (struct host_sun){ true, { 0, -0.8f, -0.6f }, { SUN_WATTS, SUN_WATTS, SUN_WATTS }, 0 };
    scene.boxes = wall;
    scene.box_count = 1;
    fog_scene_draw(device, &scene, picture);
    const double worst = worst_error(&scene, exact_sun, &range);
    printf("sun, parallel rays: off by %.4f\n", worst);
    REQUIRE_CMP(worst, <=, 0.01);
}

/* ---- Lamps in fog */

static const double lamp_at[3] = { 1.3, 0.4, -3 };

/* By sums of 1 / d^2 over steps of 4 mm. */
static double exact_lamp(const struct fog_scene *scene, const struct ray *ray)
{
    const double step = 4e-3, density = (double)scene->view.fog.density;
    double sum = 0;
    for (double s = 0.5 * step; s < WALL_M; s += step) {
        double distance2 = 0;
        for (int i = 0; i < 3; i++)
            distance2 += pow(lamp_at[i] - ray->start[i] - s * ray->direction[i], 2);
        sum += step * exp(-density * s) / distance2;
    }
    return density * 10 * sum / (4 * PI);
}

static void a_lamp_has_its_halo_where_it_is(void **state)
{
    (void)state;
    struct host_light lamp = { .type = HOST_LIGHT_POINT, .intensity = { 10, 10, 10 } };
    struct fog_scene scene = flat_scene(0.05f);
    double found = 0, expected = 0, off = 0;
    memcpy(lamp.position, lamp_at, sizeof lamp_at);
    scene.view.lights = &lamp;
    scene.view.light_count = 1;
    scene.boxes = wall;
    scene.box_count = 1;
    fog_scene_draw(device, &scene, picture);
    for (int i = 0; i < FOG_PIXELS; i++) {
        const struct ray ray = ray_of(&scene.view.camera, i % FOG_WIDTH, i / FOG_WIDTH);
        const double exact = exact_lamp(&scene, &ray);
        found += (double)picture[4 * i];
        expected += exact;
        off += fabs((double)picture[4 * i] - exact);
    }
    printf("lamp, parallel rays: %.4f of the light, %.4f in a wrong place\n", found / expected,
           off / expected);
    REQUIRE_NEAR(found / expected, 1, 0.03);
    /* Tiles are 0.5 m wide there. In perspective, where they are 0.4 m wide, 0.08 is in a wrong place. */
    REQUIRE_CMP(off / expected, <=, 0.15);
}

/* ---- Reflections */

static const struct fog_box mirror_floor[] = {
    { { 0, -2.5, 0 }, { 60, 1, 60 }, .color = { 1, 1, 1, 1 }, .metal = true, .smoothness = 1 },
};

/* Seen from 45 degrees above, a mirror shows the sky at 45 degrees, in every pixel: not at the angles at
 * which rays from one point would meet it, between 28 and 62 degrees. */
static void require_even_mirror(bool forward)
{
    struct fog_scene scene = flat_scene(0);
    scene.view.materials = HOST_MATERIALS_GLTF;
    scene.view.camera.look_at[1] = -1;
    scene.view.sky = (struct host_sky){ { 3, 3, 3 }, { 0, 0, 0 }, { 1, 1, 1 } };
    scene.boxes = mirror_floor;
    scene.box_count = 1;
    scene.gi = true;
    scene.forward = forward;
    fog_scene_draw(device, &scene, picture);
    double worst = 0;
    for (int i = 0; i < FOG_PIXELS; i++)
        worst = fmax(worst, fabs((double)picture[4 * i] / (3 * sqrt(0.5)) - 1));
    printf("mirror, %s: off by %.4f\n", forward ? "where it is shaded" : "resolved", worst);
    REQUIRE_CMP(worst, <=, 0.02);
}

static void a_mirror_reflects_parallel_rays_in_parallel(void **state)
{
    (void)state;
    require_even_mirror(false);
    require_even_mirror(true);
}

/* ---- The same light */

static const struct fog_box room[] = {
    { { 0, -1.25, -2 }, { 4, 0.5, 3 }, .color = { 0.8f, 0.8f, 0.8f, 1 } },
    { { -0.6, -0.6, -2 }, { 0.8, 0.8, 0.8 }, .color = { 0.9f, 0.2f, 0.1f, 1 } },
    { { 0, 0, -3.25 }, { 4, 3, 0.5 }, .color = { 0.2f, 0.8f, 0.3f, 1 } },
};

/* What the two cameras see of the same places. */
struct lit_picture {
    float light[4 * FOG_PIXELS], depth[4 * FOG_PIXELS];
};

static void read_room(const struct fog_stage *stage, struct lit_picture *out)
{
    assert_true(host_renderer_read_aov(stage->renderer, HOST_AOV_IRRADIANCE, out->light));
    assert_true(host_renderer_read_aov(stage->renderer, HOST_AOV_DEPTH, out->depth));
}

/* One after the other, of the same volumes. */
static void draw_room(const struct host_camera *camera, const struct host_camera *parallel, bool forward,
                      struct lit_picture *deep, struct lit_picture *flat)
{
    struct fog_scene scene = fog_scene_empty(0);
    struct fog_stage stage;
    scene.view.camera = *camera;
    scene.view.sky = (struct host_sky){ { 1, 1, 1 }, { 1, 1, 1 }, { 1, 1, 1 } };
    scene.view.sun = (struct host_sun){ true, { 0.5f, -1, -0.3f }, { 5, 5, 5 }, 0 };
    scene.boxes = room;
    scene.box_count = 3;
    scene.gi = true;
    scene.forward = forward;
    fog_stage_open(&stage, device, &scene);
    read_room(&stage, deep);
    assert_true(host_renderer_frame(stage.renderer, parallel));
    read_room(&stage, flat);
    fog_stage_close(&stage);
}

/* The pixel of a perspective camera in the origin, looking along -z, that shows a place; -1: none. */
static int pixel_of(const struct host_camera *camera, const double at[3], double *depth_m)
{
    const double tan_y = tan((double)camera->yfov_rad / 2), tan_x = tan_y * FOG_WIDTH / FOG_HEIGHT;
    *depth_m = -at[2];
    const double x = (at[0] / (*depth_m * tan_x) + 1) / 2 * FOG_WIDTH,
                 y = (1 - at[1] / (*depth_m * tan_y)) / 2 * FOG_HEIGHT;
    return x >= 0 && y >= 0 && x < FOG_WIDTH && y < FOG_HEIGHT ? (int)y * FOG_WIDTH + (int)x : -1;
}

static void require_same_light(bool forward)
{
    static struct lit_picture flat, deep;
    struct host_camera camera = { .look_at = { 0, 0, -1 }, .up = { 0, 1, 0 }, .yfov_rad = 1.2f };
    struct host_camera parallel = camera;
    parallel.position[1] = 0.6;
    parallel.look_at[1] = 0.3;
    parallel.ymag_m = YMAG_M;
    parallel.zfar_m = 100;
    draw_room(&camera, &parallel, forward, &deep, &flat);
    double off = 0, light = 0;
    int seen = 0;
    for (int i = 0; i < FOG_PIXELS; i++) {
        const struct ray ray = ray_of(&parallel, i % FOG_WIDTH, i / FOG_WIDTH);
        double at[3], depth_m;
        for (int k = 0; k < 3; k++)
            at[k] = ray.start[k] + (double)flat.depth[4 * i] * ray.direction[k];
        const int there = flat.depth[4 * i] > 0 ? pixel_of(&camera, at, &depth_m) : -1;
        if (there < 0 || fabs((double)deep.depth[4 * there] - depth_m) > 0.02 * depth_m)
            continue;
        seen++;
        off += fabs((double)flat.light[4 * i] - (double)deep.light[4 * there]);
        light += (double)deep.light[4 * there];
    }
    printf("irradiance of the same places: off by %.4f over %d pixels\n", off / light, seen);
    REQUIRE_CMP(seen, >, FOG_PIXELS / 3);
    REQUIRE_CMP(off / light, <=, 0.03);
}

static void a_place_has_the_same_light_in_both_projections(void **state)
{
    (void)state;
    require_same_light(false);
    require_same_light(true);
}

TEST_GROUP(orthographic)
{
    device = host_test_open();
    if (!device)
        return HOST_TEST_SKIP;
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(parallel_rays_see_what_is_between_the_planes),
        cmocka_unit_test(glass_is_drawn_in_order_of_depth),
        cmocka_unit_test(fog_thins_out_along_parallel_rays),
        cmocka_unit_test(sun_scatters_evenly_over_the_picture),
        cmocka_unit_test(a_lamp_has_its_halo_where_it_is),
        cmocka_unit_test(a_mirror_reflects_parallel_rays_in_parallel),
        cmocka_unit_test(a_place_has_the_same_light_in_both_projections),
    };
    return host_test_close(device, cmocka_run_group_tests(tests, NULL, NULL));
}
