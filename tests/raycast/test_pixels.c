/* SPDX-License-Identifier: MIT
 * Pictures whose every pixel is known: at least 99.75 % of the pixels must pass a z-test at 0.01,
 * Sidak-corrected, with the variance that the tracer gives. With the argument "full", larger pictures with
 * more samples, and furnaces within 0.1 %. */
#include "scenes.h"
#include "ztest.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const double pi = 3.14159265358979323846;
static const double alpha = 0.01, accepted_min = 0.9975;

enum { SMALL_WIDTH = 80, FULL_WIDTH = 320, PIXEL_STEPS = 8 };

/* Radiance of the floor y = 0 at x, z. */
typedef double floor_radiance(double x, double z);

static const double camera_position[3] = { 1.5, 2.5, 1.0 }, camera_target[3] = { 1.2, 0, -0.4 };
static const float camera_yfov_deg = 45;

static uint32_t width, height, samples;

struct axes {
    double forward[3], right[3], up[3]; /* right and up reach to the picture's edge */
    bool parallel;                      /* an orthographic camera, of `flat_ymag_m` */
};

static const float flat_ymag_m = 1.2f, flat_znear_m = 0.5f;

static void cross(const double a[3], const double b[3], double out[3])
{
    for (int k = 0; k < 3; k++)
        out[k] = a[(k + 1) % 3] * b[(k + 2) % 3] - a[(k + 2) % 3] * b[(k + 1) % 3];
}

static void scale_to(double v[3], double length)
{
    const double factor = length / sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
    for (int k = 0; k < 3; k++)
        v[k] *= factor;
}

static struct axes camera_axes(bool parallel)
{
    static const double world_up[3] = { 0, 1, 0 };
    const double reach = parallel ? (double)flat_ymag_m : tan(camera_yfov_deg * pi / 360);
    struct axes a = { .parallel = parallel };
    for (int k = 0; k < 3; k++)
        a.forward[k] = camera_target[k] - camera_position[k];
    scale_to(a.forward, 1);
    cross(a.forward, world_up, a.right);
    cross(a.right, a.forward, a.up);
    scale_to(a.right, reach * width / height);
    scale_to(a.up, reach);
    return a;
}

/* The mean of `radiance` over a pixel, which the camera's box filter makes of it. */
static double pixel_mean(const struct axes *a, floor_radiance *radiance, uint32_t x, uint32_t y)
{
    double sum = 0;
    for (int i = 0; i < PIXEL_STEPS * PIXEL_STEPS; i++) {
        const double u = 2 * (x + (i % PIXEL_STEPS + 0.5) / PIXEL_STEPS) / width - 1;
        const double v = 1 - 2 * (y + (i / PIXEL_STEPS + 0.5) / PIXEL_STEPS) / height;
        double start[3], direction[3];
        for (int k = 0; k < 3; k++) {
            const double aside = u * a->right[k] + v * a->up[k];
            start[k] = camera_position[k] + (a->parallel ? aside : 0);
            direction[k] = a->forward[k] + (a->parallel ? 0 : aside);
        }
        const double range = -start[1] / direction[1];
        assert_true(range > 0);
        sum += radiance(start[0] + range * direction[0], start[2] + range * direction[2]);
    }
    return sum / (PIXEL_STEPS * PIXEL_STEPS);
}

struct pictures {
    float *traced, *variance, *expected;
};

static void pictures_make(struct pictures *p, const struct built_scene *s, const struct raycast_view *v,
                          floor_radiance *radiance, uint32_t spp)
{
    const size_t bytes = (size_t)3 * width * height * sizeof(float);
    p->traced = malloc(bytes);
    p->variance = malloc(bytes);
    p->expected = malloc(bytes);
    assert_true(p->traced && p->variance && p->expected);
    struct raycast *rc = tracer_create(s, v, &(struct raycast_settings){ .width = width, .height = height });
    assert_true(raycast_render(rc, &(struct raycast_budget){ .samples = spp }, NULL, NULL, NULL));
    assert_true(raycast_image(rc, RAYCAST_AOV_RADIANCE, p->traced));
    assert_true(raycast_image(rc, RAYCAST_AOV_VARIANCE, p->variance));
    raycast_destroy(rc);
    const struct axes a = camera_axes(v->camera.ymag_m > 0);
    for (uint32_t i = 0; i < width * height; i++)
        for (int k = 0; k < 3; k++)
            p->expected[3 * i + (uint32_t)k] = (float)pixel_mean(&a, radiance, i % width, i / width);
}

static void pictures_finish(struct pictures *p)
{
    free(p->traced);
    free(p->variance);
    free(p->expected);
}

static double accepted(const struct pictures *p)
{
    return ztest_accepted(&(struct ztest_input){ .picture = p->traced,
                                                 .variance = p->variance,
                                                 .expected = p->expected,
                                                 .pixels = (size_t)width * height },
                          alpha);
}

/* The pictures must agree, and no longer do when they are expected `wrong` times as bright: a test that sees
 * nothing would accept that, too. */
static void floor_agrees(const struct built_scene *s, struct raycast_view v, floor_radiance *radiance,
                         uint32_t spp, float wrong)
{
    struct pictures p;
    v.materials = RAYCAST_MATERIALS_LAMBERT;
    pictures_make(&p, s, &v, radiance, spp);
    const double share = accepted(&p);
    for (size_t i = 0; i < (size_t)3 * width * height; i++)
        p.expected[i] *= wrong;
    const double wrong_share = accepted(&p);
    pictures_finish(&p);
    print_message("%.4f of the pixels accepted, %.4f if %g times as bright\n", share, wrong_share,
                  (double)wrong);
    assert_true(share >= accepted_min);
    assert_true(wrong_share < accepted_min);
}

static void floor_init(struct built_scene *s, float albedo)
{
    sdfgi_scene_init(s);
    scene_add_material(s, albedo);
    scene_add_floor(s, 0, 10000, true);
}

/* ---- Lamp, wall and emissive square over a floor ------------------------------------------------------ */

static double under_lamp(double x, double z)
{
    const double d2 = (x - 1) * (x - 1) + 4 + z * z;
    return 0.5 * 7 * 2 / (pi * d2 * sqrt(d2));
}

static void point_light_is_right_in_every_pixel(void **state)
{
    (void)state;
    struct built_scene s;
    floor_init(&s, 0.5f);
    const struct raycast_light light = { .position = { 1, 2, 0 }, .intensity = { 7, 7, 7 } };
    struct raycast_view v = view_make(camera_position, camera_target, camera_yfov_deg);
    v.lights = &light;
    v.light_count = 1;
    floor_agrees(&s, v, under_lamp, samples / 4, 1.01f);
    sdfgi_scene_finish(&s);
}

static void point_light_is_right_seen_by_parallel_rays(void **state)
{
    (void)state;
    struct built_scene s;
    floor_init(&s, 0.5f);
    const struct raycast_light light = { .position = { 1, 2, 0 }, .intensity = { 7, 7, 7 } };
    struct raycast_view v = view_make(camera_position, camera_target, 0);
    v.camera.ymag_m = flat_ymag_m;
    v.camera.znear_m = flat_znear_m;
    v.camera.zfar_m = 100;
    v.lights = &light;
    v.light_count = 1;
    floor_agrees(&s, v, under_lamp, samples / 4, 1.01f);
    sdfgi_scene_finish(&s);
}

/* A floor 1 m under the camera, which looks down: depths count from the camera, whatever its planes, and
 * what lies outside these is not there. */
static void parallel_rays_end_at_the_planes(void **state)
{
    (void)state;
    static const float planes[][3] = { { 0, 2, 1 }, { 0.75f, 1.25f, 1 }, { 0, 0.9f, 0 }, { 1.1f, 2, 0 } };
    struct built_scene s;
    floor_init(&s, 0.5f);
    for (size_t i = 0; i < sizeof planes / sizeof planes[0]; i++) {
        struct raycast_view v = view_make((double[]){ 0.2, 1, 0.3 }, (double[]){ 0.2, 0, 0.3 }, 0);
        v.camera.up[1] = 0;
        v.camera.up[2] = -1;
        v.camera.ymag_m = 1;
        v.camera.znear_m = planes[i][0];
        v.camera.zfar_m = planes[i][1];
        const double depth_m = trace_mean(&s, &v, 8, 8, 1, 1, RAYCAST_AOV_DEPTH);
        assert_true(fabs(depth_m - (double)planes[i][2]) < 1e-5);
    }
    sdfgi_scene_finish(&s);
}

static const double wall_m = 3, wall_x = -3; /* out of sight */

static double before_wall(double x, double z)
{
    (void)z;
    const double d = x - wall_x;
    return 0.9 * 0.5 * (1 + d / sqrt(d * d + wall_m * wall_m));
}

static void black_wall_is_right_in_every_pixel(void **state)
{
    (void)state;
    struct built_scene s;
    floor_init(&s, 0.9f);
    scene_add_material(&s, 0);
    scene_add_quad(&s, (float[]){ (float)wall_x, 0, 9000 }, (float[]){ 0, 0, -18000 },
                   (float[]){ 0, (float)wall_m, 0 });
    struct raycast_view v = view_make(camera_position, camera_target, camera_yfov_deg);
    view_set_sky(&v, 1);
    floor_agrees(&s, v, before_wall, 2 * samples, 1.1f);
    sdfgi_scene_finish(&s);
}

/* The form factor of a rectangle with one corner right above a level point (Siegel and Howell, "Thermal
 * Radiation Heat Transfer", configuration factor 11), signed by the quadrant its other corner lies in. */
static double corner_factor(double a, double b, double h)
{
    const double x = fabs(a) / h, y = fabs(b) / h, rx = sqrt(1 + x * x), ry = sqrt(1 + y * y);
    const double f = (x / rx * atan(y / rx) + y / ry * atan(x / ry)) / (2 * pi);
    return (a < 0) != (b < 0) ? -f : f;
}

static const double square_half_m = 0.8, square_y_m = 3; /* above the camera */

static double under_square(double x, double z)
{
    double f = 0;
    for (int i = 0; i < 4; i++) {
        const double a = (i & 1 ? square_half_m : -square_half_m) - x,
                     b = (i & 2 ? square_half_m : -square_half_m) - z;
        f += ((i & 1) != 0) == ((i & 2) != 0) ? corner_factor(a, b, square_y_m)
                                              : -corner_factor(a, b, square_y_m);
    }
    return 0.6 * 5 * f;
}

static void emissive_square_is_right_in_every_pixel(void **state)
{
    (void)state;
    struct built_scene s;
    floor_init(&s, 0.6f);
    struct gltf_material *m = scene_add_material(&s, 0);
    for (int k = 0; k < 3; k++)
        m->emissive[k] = 5;
    scene_add_floor(&s, (float)square_y_m, (float)square_half_m, false);
    struct raycast_view v = view_make(camera_position, camera_target, camera_yfov_deg);
    floor_agrees(&s, v, under_square, samples, 1.05f);
    sdfgi_scene_finish(&s);
}

/* ---- The test itself, and what takes longer ----------------------------------------------------------- */

static void limit_is_the_normal_quantile(void **state)
{
    (void)state;
    /* Tables: 1.959964 for 5 % in one test; 1 - 0.95^(1/10) = 0.51162 % for ten of them. */
    assert_true(fabs(ztest_limit(0.05, 1) - 1.959964) < 1e-5);
    assert_true(fabs(erfc(ztest_limit(0.05, 10) / sqrt(2)) - 0.0051162) < 1e-7);
    assert_true(ztest_limit(0.01, 57600) > ztest_limit(0.01, 100));
}

static void furnaces_within_a_thousandth(void **state)
{
    (void)state;
    static const float albedos[] = { 0.5f, 0.8f, 0.95f };
    for (size_t i = 0; i < sizeof albedos / sizeof albedos[0]; i++) {
        struct built_scene s;
        sdfgi_scene_init(&s);
        struct gltf_material *m = scene_add_material(&s, albedos[i]);
        for (int k = 0; k < 3; k++)
            m->emissive[k] = 1 - albedos[i];
        scene_add_room(&s, 2);
        struct raycast_view v = view_make((double[]){ 0.3, 0.2, 0.5 }, (double[]){ 1, -1, -2 }, 70);
        v.materials = RAYCAST_MATERIALS_LAMBERT;
        assert_ratio(trace_mean(&s, &v, 160, 90, 256, 2000, RAYCAST_AOV_RADIANCE), 1, 0.001);
        sdfgi_scene_finish(&s);
    }
}

int main(int argc, char **argv)
{
    const bool full = argc > 1 && strcmp(argv[1], "full") == 0;
    width = full ? FULL_WIDTH : SMALL_WIDTH;
    height = width * 9 / 16;
    samples = full ? 512 : 128;
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(limit_is_the_normal_quantile),
        cmocka_unit_test(point_light_is_right_in_every_pixel),
        cmocka_unit_test(point_light_is_right_seen_by_parallel_rays),
        cmocka_unit_test(parallel_rays_end_at_the_planes),
        cmocka_unit_test(black_wall_is_right_in_every_pixel),
        cmocka_unit_test(emissive_square_is_right_in_every_pixel),
        cmocka_unit_test(furnaces_within_a_thousandth), /* the last one: only in full */
    };
    const size_t count = sizeof tests / sizeof tests[0] - (full ? 0 : 1);
    return _cmocka_run_group_tests("pixels", tests, count, NULL, NULL);
}
