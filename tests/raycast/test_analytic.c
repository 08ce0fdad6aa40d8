/* SPDX-License-Identifier: MIT
 * Scenes whose light is known: within 0.5 %. Seeds are fixed, so none of these can fail by chance; the sample
 * counts leave the noise of a mean several times below the tolerance. */
#include "scenes.h"

#include <math.h>

static const double pi = 3.14159265358979323846;
static const double tolerance = 0.005;
static const double from_above[3] = { 0, 2, 0 }, origin[3] = { 0, 0, 0 };

static double furnace(float albedo, uint32_t max_bounces)
{
    struct built_scene s;
    sdfgi_scene_init(&s);
    struct gltf_material *m = scene_add_material(&s, albedo);
    for (int k = 0; k < 3; k++)
        m->emissive[k] = 1;
    scene_add_room(&s, 2);
    struct raycast_view v = view_make((double[]){ 0.3, 0.2, 0.5 }, (double[]){ 1, -1, -2 }, 70);
    v.materials = RAYCAST_MATERIALS_LAMBERT;
    const double mean = trace_mean(&s, &v, 32, 32, 128, max_bounces, RAYCAST_AOV_RADIANCE);
    sdfgi_scene_finish(&s);
    return mean;
}

static void closed_room_sums_all_bounces(void **state)
{
    (void)state;
    assert_ratio(furnace(0.5f, 0), 1 / (1 - 0.5), tolerance);
    assert_ratio(furnace(0.8f, 0), 1 / (1 - 0.8), tolerance);
    /* 64 bounces leave 3.6 % of this one behind. */
    assert_ratio(furnace(0.95f, 2000), 1 / (1 - 0.95), tolerance);
}

static void bounces_end_where_told(void **state)
{
    (void)state;
    assert_ratio(furnace(0.5f, 1), 1.5, tolerance);
    assert_ratio(furnace(0.5f, 2), 1.75, tolerance);
    assert_ratio(furnace(0.95f, 64), (1 - pow(0.95, 65)) / 0.05, tolerance);
}

static void floor_init(struct built_scene *s, float albedo)
{
    sdfgi_scene_init(s);
    scene_add_material(s, albedo);
    scene_add_floor(s, 0, 1000, true);
}

static void sun_on_a_plane(void **state)
{
    (void)state;
    struct built_scene s;
    floor_init(&s, 0.6f);
    struct raycast_view v = view_make(from_above, origin, 40);
    v.materials = RAYCAST_MATERIALS_LAMBERT;
    v.sun = (struct raycast_sun){ .direction = { 1, -2, 0.5f }, .irradiance = { 3, 3, 3 } };
    const double cosine = 2 / sqrt(1 + 4 + 0.25), expected = 0.6 * 3 * cosine / pi;
    assert_ratio(trace_mean(&s, &v, 8, 8, 4, 0, RAYCAST_AOV_RADIANCE), expected, 1e-4);
    assert_ratio(trace_mean(&s, &v, 8, 8, 4, 0, RAYCAST_AOV_DIRECT), expected, 1e-4);
    /* A disc that is all above the horizon gives the same. */
    v.sun.angle_deg = 20;
    assert_ratio(trace_mean(&s, &v, 32, 32, 64, 0, RAYCAST_AOV_DIRECT), expected, tolerance);
    v.sun.angle_deg = 0.53f;
    assert_ratio(trace_mean(&s, &v, 32, 32, 64, 0, RAYCAST_AOV_DIRECT), expected, tolerance);
    sdfgi_scene_finish(&s);
}

static void point_light_over_a_plane(void **state)
{
    (void)state;
    struct built_scene s;
    floor_init(&s, 0.5f);
    struct raycast_light light = { .position = { 0.5, 3, 0 }, .intensity = { 7, 7, 7 } };
    struct raycast_view v = view_make(from_above, origin, 0.01f);
    v.materials = RAYCAST_MATERIALS_LAMBERT;
    v.lights = &light;
    v.light_count = 1;
    const double d2 = 9.25, expected = 7 * 3 / sqrt(d2) / d2;
    assert_ratio(trace_mean(&s, &v, 4, 4, 4, 0, RAYCAST_AOV_RADIANCE), 0.5 * expected / pi, 1e-4);
    assert_ratio(gather_up(&s, &v, 0, 0, 0, 1).direct[0], expected, 1e-4);
    light.radius_m = 0.8f;
    assert_ratio(gather_up(&s, &v, 0, 0, 0, 20000).direct[0], expected, tolerance);
    light.range_m = 3;
    assert_true(gather_up(&s, &v, 0, 0, 0, 16).direct[0] == 0);
    light.range_m = 3.1f;
    assert_ratio(gather_up(&s, &v, 0, 0, 0, 20000).direct[0], expected, tolerance);
    sdfgi_scene_finish(&s);
}

static void spot_light_falls_off_as_measured(void **state)
{
    (void)state;
    struct built_scene s;
    floor_init(&s, 0.5f);
    struct raycast_light light = { .type = RAYCAST_LIGHT_SPOT,
                                   .position = { 0, 2, 0 },
                                   .direction = { 0, -1, 0 },
                                   .intensity = { 5, 5, 5 },
                                   .inner_deg = 15,
                                   .outer_deg = 45 };
    struct raycast_view v = view_make(from_above, origin, 40);
    v.lights = &light;
    v.light_count = 1;
    for (int degrees = 5; degrees < 60; degrees += 10) {
        const double t = degrees * pi / 180, c = cos(t), d = 2 / c;
        const double x = (c - cos(45 * pi / 180)) / (cos(15 * pi / 180) - cos(45 * pi / 180));
        const double falloff = x < 0 ? 0 : x > 1 ? 1 : x * x;
        const double e = gather_up(&s, &v, 2 * tan(t), 0, 0, 1).direct[0];
        if (falloff == 0)
            assert_true(e == 0);
        else
            assert_ratio(e, 5 * falloff * c / (d * d), 1e-3);
    }
    sdfgi_scene_finish(&s);
}

static void white_plane_under_a_uniform_sky(void **state)
{
    (void)state;
    struct built_scene s;
    floor_init(&s, 0.7f);
    struct raycast_view v = view_make(from_above, origin, 40);
    v.materials = RAYCAST_MATERIALS_LAMBERT;
    view_set_sky(&v, 2);
    assert_ratio(trace_mean(&s, &v, 32, 32, 64, 0, RAYCAST_AOV_RADIANCE), 0.7 * 2, tolerance);
    assert_ratio(trace_mean(&s, &v, 32, 32, 64, 0, RAYCAST_AOV_IRRADIANCE), pi * 2, tolerance);
    assert_true(trace_mean(&s, &v, 8, 8, 4, 0, RAYCAST_AOV_DIRECT) == 0);
    assert_ratio(gather_up(&s, &v, 0, 1, 0, 50000).indirect[0], pi * 2, tolerance);
    sdfgi_scene_finish(&s);
}

/* lerp(horizon, zenith, y) over a cosine-weighted hemisphere, whose mean of y is 2/3. */
static void sky_gradient_on_a_plane(void **state)
{
    (void)state;
    struct built_scene s;
    floor_init(&s, 0.7f);
    struct raycast_view v = view_make(from_above, origin, 40);
    view_set_sky(&v, 1);
    for (int k = 0; k < 3; k++) {
        v.sky.zenith[k] = 4;
        v.sky.ground[k] = 100; /* below the plane: must not count */
    }
    assert_ratio(gather_up(&s, &v, 0, 0, 0, 50000).indirect[1], pi * (1 + 3 * 2.0 / 3), tolerance);
    sdfgi_scene_finish(&s);
}

/* One texel of a map of 32 x 16 shines, in the middle of its width: where -Z is. Through the cosine a plane
 * gets L dphi (sin^2 b - sin^2 a) / 2 of it. */
static void one_texel_of_an_environment_shines_from_its_direction(void **state)
{
    (void)state;
    enum { WIDTH = 32, HEIGHT = 16, ROW = 4 };
    static float map[3 * WIDTH * HEIGHT];
    struct built_scene s;
    floor_init(&s, 0.7f);
    for (int k = 0; k < 3; k++)
        map[3 * (ROW * WIDTH + WIDTH / 2) + k] = 50;
    const double a = pi * ROW / HEIGHT, b = pi * (ROW + 1) / HEIGHT;
    const double share = 2 * pi / WIDTH * (sin(b) * sin(b) - sin(a) * sin(a)) / 2;
    struct raycast_view v = view_make(from_above, origin, 40);
    v.environment = (struct raycast_environment){ map, WIDTH, HEIGHT };
    assert_ratio(gather_up(&s, &v, 0, 0, 0, 50000).indirect[1], 50 * share, tolerance);
    /* The texel right of the middle: a little to +X of -Z, halfway up. */
    const double down = pi * (ROW + 0.5) / HEIGHT, around = pi / WIDTH;
    v = view_make(from_above, (double[]){ sin(down) * sin(around), 2 + cos(down), -sin(down) * cos(around) },
                  1);
    v.environment = (struct raycast_environment){ map, WIDTH, HEIGHT };
    assert_ratio(trace_mean(&s, &v, 8, 8, 1, 0, RAYCAST_AOV_RADIANCE), 50, tolerance);
    sdfgi_scene_finish(&s);
}

static void an_even_environment_is_a_uniform_sky(void **state)
{
    (void)state;
    static float map[3 * 8 * 4];
    struct built_scene s;
    floor_init(&s, 0.7f);
    for (int i = 0; i < 3 * 8 * 4; i++)
        map[i] = i < 3 * 8 * 2 ? 2 : 100; /* below the plane: must not count */
    struct raycast_view v = view_make(from_above, origin, 40);
    v.environment = (struct raycast_environment){ map, 8, 4 };
    assert_ratio(gather_up(&s, &v, 0, 0, 0, 200000).indirect[0], pi * 2, tolerance);
    sdfgi_scene_finish(&s);
}

static void right_angle_with_a_black_wall_halves_the_sky(void **state)
{
    (void)state;
    struct built_scene s;
    floor_init(&s, 1);
    scene_add_material(&s, 0);
    scene_add_quad(&s, (float[]){ 0, 0, -1000 }, (float[]){ 0, 0, 2000 }, (float[]){ 0, 1000, 0 });
    struct raycast_view v = view_make((double[]){ 2, 2, 0 }, (double[]){ 0.01, 0, 0 }, 0.05f);
    v.materials = RAYCAST_MATERIALS_LAMBERT;
    view_set_sky(&v, 1);
    assert_ratio(gather_up(&s, &v, 0.01, 0, 0, 100000).indirect[2], pi / 2, tolerance);
    assert_ratio(trace_mean(&s, &v, 16, 16, 512, 0, RAYCAST_AOV_RADIANCE), 0.5, tolerance);
    sdfgi_scene_finish(&s);
}

/* A point under the middle of a level square: the form factor of four quarters, each seen from its corner. */
static void emissive_square_matches_its_form_factor(void **state)
{
    (void)state;
    struct built_scene s;
    floor_init(&s, 0);
    struct gltf_material *m = scene_add_material(&s, 0);
    for (int k = 0; k < 3; k++)
        m->emissive[k] = 6;
    scene_add_floor(&s, 1.5f, 0.5f, false);
    const struct raycast_view v = view_make(from_above, origin, 40);
    const double x = 0.5 / 1.5, root = sqrt(1 + x * x);
    const double form_factor = 4 / pi * (x / root) * atan(x / root);
    assert_ratio(gather_up(&s, &v, 0, 0, 0, 50000).indirect[0], pi * 6 * form_factor, tolerance);
    sdfgi_scene_finish(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(closed_room_sums_all_bounces),
        cmocka_unit_test(bounces_end_where_told),
        cmocka_unit_test(sun_on_a_plane),
        cmocka_unit_test(point_light_over_a_plane),
        cmocka_unit_test(spot_light_falls_off_as_measured),
        cmocka_unit_test(white_plane_under_a_uniform_sky),
        cmocka_unit_test(sky_gradient_on_a_plane),
        cmocka_unit_test(one_texel_of_an_environment_shines_from_its_direction),
        cmocka_unit_test(an_even_environment_is_a_uniform_sky),
        cmocka_unit_test(right_angle_with_a_black_wall_halves_the_sky),
        cmocka_unit_test(emissive_square_matches_its_form_factor),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
