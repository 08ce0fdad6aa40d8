/* SPDX-License-Identifier: MIT
 * First-bounce light of suns and lamps against form factors and sums over the lit surface. */
#include "hard_case.h"
#include "light_scene.h"
#include "oracle_encode.h"
#include "require.h"
#include "test_group.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const float white[3] = { 1, 1, 1 }, half_white[3] = { 0.5f, 0.5f, 0.5f }, black[3] = { 0, 0, 0 };

/* A lit rectangle in the plane y = height, and light that a point above it gets from it. */
struct floor_patch {
    double low_x, high_x, low_z, high_z, height;
    double albedo;
};

/* Irradiance on a horizontal surface at `point` that faces down, over a floor whose outgoing radiance is
 * given. */
static double irradiance_from_floor(const struct floor_patch *f, const double point[static 3],
                                    double (*radiance)(const double at[static 3], const void *user),
                                    const void *user)
{
    enum { STEPS = 400 };
    const double dx = (f->high_x - f->low_x) / STEPS, dz = (f->high_z - f->low_z) / STEPS,
                 rise = point[1] - f->height;
    double sum = 0;
    for (int i = 0; i < STEPS; i++)
        for (int k = 0; k < STEPS; k++) {
            const double at[3] = { f->low_x + (i + 0.5) * dx, f->height, f->low_z + (k + 0.5) * dz };
            const double x = at[0] - point[0], z = at[2] - point[2], d2 = x * x + rise * rise + z * z;
            sum += radiance(at, user) * rise * rise / (d2 * d2) * dx * dz;
        }
    return sum;
}

static double radiance_constant(const double at[static 3], const void *user)
{
    (void)at;
    return *(const double *)user;
}

struct lamp {
    double position[3], intensity, albedo;
};

/* Of a Lambertian floor under a point light. */
static double radiance_under_lamp(const double at[static 3], const void *user)
{
    const struct lamp *lamp = user;
    const double x = lamp->position[0] - at[0], y = lamp->position[1] - at[1], z = lamp->position[2] - at[2];
    const double d2 = x * x + y * y + z * z;
    return lamp->albedo / PI * lamp->intensity * y / (d2 * sqrt(d2));
}

/* A volume of 16 m: at 32 cells what lies on surfaces is right, and at 64 probes stand in rooms, too. */
static void open_scene(struct gi_test *t, uint32_t resolution)
{
    const struct sdfgi_settings settings = light_quick_settings(resolution, 16.0f / (float)resolution);
    gi_test_open(t, &settings);
}

/* ---- Sun */

/* Outgoing radiance upwards that a light cell holds. */
static double stored_radiance_up(struct gi_test *t, const double position[static 3])
{
    const struct oracle_grid grid = gi_test_grid(t, 0);
    uint32_t cell[3];
    for (int i = 0; i < 3; i++)
        cell[i] = (uint32_t)floor((position[i] - grid.origin[i]) / (4 * grid.step[i]));
    uint32_t *light = gi_test_read(t, RESOURCE_LIGHT, NULL);
    double radiance[3];
    oracle_rgbe_decode(
        light[2 * t->gi->volume.resources->extent.light_cells + gi_test_light_entry(t, 0, cell)], radiance);
    free(light);
    return radiance[1];
}

/* What a host's own shader says of a Lambertian plane under so many suns that shine as one, and so must the
 * light cells above it. */
static void require_sunlit_plane(uint32_t suns)
{
    struct gi_test t;
    open_scene(&t, 32);
    light_add_box(&t, (double[]){ -7, -1, -7 }, (double[]){ 7, -0.05, 7 }, white, 0);
    for (uint32_t i = 0; i < suns; i++) {
        struct sdfgi_light_desc sun = light_sun(-0.48f, -0.8f, 0.36f, 10.0f / (float)suns);
        sun.casts_shadow = i % 2 == 0;
        light_create(&t, &sun);
    }
    gi_test_converge(&t, 80);
    for (int i = 0; i < 3; i++) {
        const double ratio = stored_radiance_up(&t, (double[]){ 1.1 * i, 0.1, -0.7 * i }) / (10 * 0.8 / PI);
        printf("plane under %u suns, point %d: ratio %.4f\n", suns, i, ratio);
        HARD_CASE_AT_MOST(35, "radiance of a sunlit plane, off by", fabs(ratio - 1), 0.01);
    }
    gi_test_close(&t);
}

static void sunlit_plane_has_radiance_albedo_e_over_pi(void **state)
{
    (void)state;
    require_sunlit_plane(1);
}

/* More than are lit in one round, with and without shadows. */
static void many_suns_add_up(void **state)
{
    (void)state;
    require_sunlit_plane(70);
}

/* Two plates: a sunlit floor of 14 m and a small black ceiling 3 m above it, whose shadow falls beside the
 * floor. */
static void sunlit_floor_lights_a_ceiling(void **state)
{
    (void)state;
    struct gi_test t;
    open_scene(&t, 32);
    const struct floor_patch floor = { -7, 7, -7, 7, -2, 0.5 };
    light_add_box(&t, (double[]){ -7, -3, -7 }, (double[]){ 7, -2, 7 }, half_white, 0);
    light_add_box(&t, (double[]){ -1, 1, -1 }, (double[]){ 1, 1.5, 1 }, black, 0);
    const struct sdfgi_light_desc sun = light_sun(-0.96f, -0.28f, 0, 10);
    light_create(&t, &sun);
    gi_test_converge(&t, 80);
    const double radiance = 0.5 * 10 * 0.28 / PI;
    const double at[3] = { 0.2, 1, -0.1 };
    const double exact = irradiance_from_floor(&floor, at, radiance_constant, &radiance);
    const double found = light_white_at(&t, (struct gi_test_point){ { 0.2f, 1, -0.1f }, { 0, -1, 0 } });
    printf("sunlit floor, ceiling: E %.4f, exact %.4f, ratio %.4f\n", found, exact, found / exact);
    REQUIRE_NEAR(found / exact, 1, 0.1);
    gi_test_close(&t);
}

/* A probe of each of four cascades of 32 cells where no finer one answers. The last cascade fades towards the
 * sky over its outer probe, so its point is not on a probe but where it still answers alone. */
static const double rings[4][2] = { { 0, 2 }, { 4, 4 }, { 8, 8 }, { 14, 8 } }; /* x, y */
static const struct floor_patch wide_floor = { -31, 31, -31, 31, -0.1, 1 };

static void open_wide_floor(struct gi_test *t)
{
    struct sdfgi_settings settings = light_quick_settings(32, 0.25f);
    settings.cascades = 4;
    settings.normal_bias_cells = 0;
    gi_test_open(t, &settings);
    light_add_box(t, (double[]){ wide_floor.low_x, -4, wide_floor.low_z },
                  (double[]){ wide_floor.high_x, wide_floor.height, wide_floor.high_z }, white, 0);
}

static double light_down_at(struct gi_test *t, const double at[static 2])
{
    return light_white_at(t, (struct gi_test_point){ { (float)at[0], (float)at[1], 0 }, { 0, -1, 0 } });
}

/* One floor through four cascades; the light that it throws back is the same whatever cascade answers. */
static void sun_reaches_every_cascade(void **state)
{
    (void)state;
    struct gi_test t;
    open_wide_floor(&t);
    const struct sdfgi_light_desc sun = light_sun(0, -1, 0, 10);
    light_create(&t, &sun);
    gi_test_converge(&t, 80);
    double ratios[4];
    for (int c = 0; c < 4; c++) {
        const double at[3] = { rings[c][0], rings[c][1], 0 }, radiance = 10 / PI;
        ratios[c] =
            light_down_at(&t, at) / irradiance_from_floor(&wide_floor, at, radiance_constant, &radiance);
        printf("sun in cascade %d: ratio %.4f\n", c, ratios[c]);
    }
    for (int c = 0; c < 4; c++)
        REQUIRE_NEAR(ratios[c], 1, 0.1);
    gi_test_close(&t);
}

/* ---- Lamps */

/* A lamp above each of the points, half again as high, brighter the further out. A surface's light is
 * computed half a cell before it: up to 9 % too much here. */
static void lamps_reach_every_cascade(void **state)
{
    (void)state;
    struct gi_test t;
    struct lamp lamps[4];
    open_wide_floor(&t);
    for (int c = 0; c < 4; c++) {
        const double y = 1.5 * rings[c][1];
        lamps[c] = (struct lamp){ { rings[c][0], y, 0 }, 10 * y * y, 1 };
        const struct sdfgi_light_desc light = light_point(rings[c][0], y, 0, (float)lamps[c].intensity);
        light_create(&t, &light);
    }
    gi_test_converge(&t, 80);
    double ratios[4];
    for (int c = 0; c < 4; c++) {
        const double at[3] = { rings[c][0], rings[c][1], 0 };
        double exact = 0;
        for (int i = 0; i < 4; i++)
            exact += irradiance_from_floor(&wide_floor, at, radiance_under_lamp, &lamps[i]);
        ratios[c] = light_down_at(&t, at) / exact;
        printf("lamp in cascade %d: ratio %.4f of E %.3f\n", c, ratios[c], exact);
    }
    for (int c = 0; c < 4; c++)
        REQUIRE_NEAR(ratios[c], 1, 0.2);
    gi_test_close(&t);
}

/* A white ceiling of 12 m under lamps 4 m and 8 m below it, seen from a probe 7 m below it, without a bias:
 * nothing is interpolated. A surface's light is computed half a cell before it, which makes the nearer lamp 6
 * % too bright. */
static void lamp_follows_the_inverse_square(void **state)
{
    (void)state;
    /* As a floor, upside down. */
    const struct floor_patch ceiling = { -6, 6, -6, 6, 0, 1 };
    static const double distances[2] = { 4, 8 };
    double found[2], exact[2];
    for (int i = 0; i < 2; i++) {
        struct gi_test t;
        struct sdfgi_settings settings = light_quick_settings(64, 0.25f);
        settings.normal_bias_cells = 0;
        gi_test_open(&t, &settings);
        light_add_box(&t, (double[]){ -6, 5, -6 }, (double[]){ 6, 6, 6 }, white, 0);
        const struct lamp lamp = { { 0.4, distances[i], -0.3 }, 100, 1 };
        const struct sdfgi_light_desc light = light_point(0.4, 5 - distances[i], -0.3, 100);
        light_create(&t, &light);
        gi_test_converge(&t, 80);
        exact[i] = irradiance_from_floor(&ceiling, (double[]){ 0, 7, 0 }, radiance_under_lamp, &lamp);
        found[i] = light_white_at(&t, (struct gi_test_point){ { 0, -2, 0 }, { 0, 1, 0 } });
        printf("lamp at %.0f m: E %.4f, exact %.4f, ratio %.4f\n", distances[i], found[i], exact[i],
               found[i] / exact[i]);
        gi_test_close(&t);
    }
    for (int i = 0; i < 2; i++)
        REQUIRE_NEAR(found[i] / exact[i], 1, 0.1);
    REQUIRE_NEAR(found[1] / found[0] / (exact[1] / exact[0]), 1, 0.05);
}

/* Irradiance of a spot light on a level surface at `at`, by the formula of sdfgi.h. */
static double spot_irradiance(const struct sdfgi_light_desc *spot, const double at[static 3])
{
    double offset[3], along = 0, d2 = 0, aim2 = 0;
    for (int i = 0; i < 3; i++) {
        const double aim = (double)spot->direction[i];
        offset[i] = at[i] - spot->position[i];
        d2 += offset[i] * offset[i];
        along += offset[i] * aim;
        aim2 += aim * aim;
    }
    if (spot->range_m > 0 && sqrt(d2) > (double)spot->range_m)
        return 0;
    const double inner = cos((double)spot->inner_angle_rad), outer = cos((double)spot->outer_angle_rad),
                 share = fmin(fmax((along / sqrt(d2 * aim2) - outer) / (inner - outer), 0), 1);
    return (double)spot->intensity[1] * share * share * -offset[1] / (d2 * sqrt(d2));
}

/* Within the inner angle, between both angles, outside, and beyond the range. Light is computed above the
 * centres of cells, in the middle of the sub-voxel that the plane sets. */
static void spot_light_on_a_plane_follows_its_formula(void **state)
{
    (void)state;
    static const float range_m[2] = { 0, 3.6f };
    const double level = -1.5 * 0.0625;
    struct gi_test t;
    const struct sdfgi_settings settings = light_quick_settings(32, 0.25f);
    gi_test_open(&t, &settings);
    light_add_box(&t, (double[]){ -3.5, -1, -3.5 }, (double[]){ 3.5, -0.05, 3.5 }, white, 0);
    struct sdfgi_light_desc spot = light_point(-1.6, 3, 0.2, 100);
    spot.type = SDFGI_LIGHT_SPOT;
    memcpy(spot.direction, (float[3]){ 0.5f, -2, 0 }, sizeof spot.direction);
    spot.inner_angle_rad = 0.3f;
    spot.outer_angle_rad = 0.8f;
    const sdfgi_light light = light_create(&t, &spot);
    for (int r = 0; r < 2; r++) {
        spot.range_m = range_m[r];
        REQUIRE_CMP(sdfgi_light_update(t.gi, light, &spot), ==, SDFGI_OK);
        gi_test_converge(&t, 80);
        for (int i = -13; i < 13; i++) {
            const double x = 0.25 * i + 0.125, found = PI * stored_radiance_up(&t, (double[]){ x, 0.1, 0.3 }),
                         exact = spot_irradiance(&spot, (double[]){ x, level, 0.375 });
            REQUIRE_NEAR(found, exact, 0.01 * exact + 0.003);
        }
    }
    gi_test_close(&t);
}

static double far_room_with_lamp(bool casts_shadow)
{
    struct gi_test t;
    open_scene(&t, 64);
    const double center[3] = { 0, 0, 0 }, half[3] = { 5, 2, 3 };
    light_add(&t, test_mesh_two_rooms(center, half, 0.5, test_rotation_none), 0.5f, 0);
    struct sdfgi_light_desc light = light_point(-2.5, 0.1, 0.2, 100);
    light.casts_shadow = casts_shadow;
    light_create(&t, &light);
    gi_test_converge(&t, 120);
    const double found = light_white_at(&t, (struct gi_test_point){ { 2.5f, 0, 0 }, { -1, 0, 0 } });
    gi_test_close(&t);
    return found;
}

static void shadowless_lamp_lights_the_far_side_of_a_wall(void **state)
{
    (void)state;
    const double with = far_room_with_lamp(true), without = far_room_with_lamp(false);
    printf("behind a wall: E %.4f without shadows, %.2e with\n", without, with);
    /* The far room's end wall, 7.5 m away, alone gets 100 / 7.5^2 = 1.8 W/m^2. */
    REQUIRE_CMP(without, >, 0.1);
    REQUIRE_CMP(with, <=, 1e-3 * without);
}

/* HARD_CASES row 48. */
static void hard_48_lamp_inside_a_solid_lights_nothing(void **state)
{
    (void)state;
    struct gi_test t;
    open_scene(&t, 64);
    light_add_box(&t, (double[]){ -7, -3, -7 }, (double[]){ 7, -2, 7 }, white, 0);
    light_add_box(&t, (double[]){ -1, -1, -1 }, (double[]){ 1, 1, 1 }, half_white, 0);
    const struct sdfgi_light_desc light = light_point(0.05, 0.02, -0.03, 1000);
    light_create(&t, &light);
    gi_test_converge(&t, 80);
    const double found = light_white_at(&t, (struct gi_test_point){ { 2.2f, 0, 0.3f }, { 0, -1, 0 } });
    printf("lamp inside a solid: E %.2e\n", found);
    HARD_CASE_AT_MOST(48, "irradiance from a lamp of 1,000 W/sr in a solid", found, 1e-3);
    gi_test_close(&t);
}

/* Irradiance of a lamp at heights within the surface's own sub-voxel, the most of them. */
static double lamp_within_surface(struct gi_test *t, sdfgi_light light, struct sdfgi_light_desc lamp,
                                  double level)
{
    double most = 0;
    for (int i = -1; i <= 1; i++) {
        lamp.position[1] = level + 0.03 * i;
        REQUIRE_CMP((int)sdfgi_light_update(t->gi, light, &lamp), ==, (int)SDFGI_OK);
        gi_test_update(t, 2);
        most = fmax(most, PI * stored_radiance_up(t, (double[]){ 0.125, 0.1, 0.125 }));
    }
    return most;
}

/* A lamp that comes down on a plane, above a cell: radiance grows with the inverse square until the lamp is
 * half a cell away, and stays there. Within the surface's own sub-voxel, last of all, it lights nothing. */
static void hard_47_a_lamp_on_a_surface_is_bounded(void **state)
{
    (void)state;
    enum { STEPS = 40 };
    const double level = -1.5 * 0.0625, least_m = 0.125, intensity = 20;
    struct gi_test t;
    const struct sdfgi_settings settings = light_quick_settings(32, 0.25f);
    gi_test_open(&t, &settings);
    light_add_box(&t, (double[]){ -3.5, -1, -3.5 }, (double[]){ 3.5, -0.05, 3.5 }, white, 0);
    struct sdfgi_light_desc lamp = light_point(0.125, 2, 0.125, (float)intensity);
    const sdfgi_light light = light_create(&t, &lamp);
    double before = 0, most = 0, fall = 0, off = 0;
    for (int i = 0; i < STEPS; i++) {
        const double range_m = 2.0 * (STEPS - i) / STEPS;
        lamp.position[1] = level + range_m;
        REQUIRE_CMP((int)sdfgi_light_update(t.gi, light, &lamp), ==, (int)SDFGI_OK);
        gi_test_update(&t, 2);
        const double found = PI * stored_radiance_up(&t, (double[]){ 0.125, 0.1, 0.125 });
        const double exact = intensity / pow(fmax(range_m, least_m), 2);
        most = fmax(most, found * least_m * least_m / intensity);
        off = fmax(off, fabs(found / exact - 1));
        fall = fmax(fall, (before - found) / exact);
        before = found;
    }
    const double within = lamp_within_surface(&t, light, lamp, level);
    printf("lamp on a surface: %.4f of its bound, off by %.4f, falls by %.4f; within it %.2e\n", most, off,
           fall, within);
    HARD_CASE_AT_MOST(47, "irradiance of a lamp of 20 W/sr in the surface's sub-voxel", within, 0);
    HARD_CASE_AT_MOST(47, "irradiance of a lamp at any distance, over that at half a cell", most, 1.01);
    HARD_CASE_AT_MOST(47, "loss of irradiance as a lamp comes nearer", fall, 0.01);
    /* Distances lead to the middle of a sub-voxel, which lies aside: the surface seems to be 1/50 cell lower.
     */
    HARD_CASE_AT_MOST(47, "irradiance of a lamp before a surface, off by", off, 0.06);
    gi_test_close(&t);
}

TEST_GROUP(direct_light)
{
    if (!gpu_test_available())
        return GPU_TEST_SKIP;
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(sunlit_plane_has_radiance_albedo_e_over_pi),
        cmocka_unit_test(many_suns_add_up),
        cmocka_unit_test(sunlit_floor_lights_a_ceiling),
        cmocka_unit_test(sun_reaches_every_cascade),
        cmocka_unit_test(lamps_reach_every_cascade),
        cmocka_unit_test(lamp_follows_the_inverse_square),
        cmocka_unit_test(spot_light_on_a_plane_follows_its_formula),
        cmocka_unit_test(shadowless_lamp_lights_the_far_side_of_a_wall),
        cmocka_unit_test(hard_48_lamp_inside_a_solid_lights_nothing),
        cmocka_unit_test(hard_47_a_lamp_on_a_surface_is_bounded),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
