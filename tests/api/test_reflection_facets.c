/* SPDX-License-Identifier: MIT
 * What a lobe reflects counts as much as the facets that reflect it: at a small angle a dielectric mirrors
 * what lies far off better than what is above, and metal mirrors both alike. What mirrors the ground that it
 * belongs to is dark. */
#include "gather_picture.h"
#include "light_scene.h"
#include "oracle_gloss.h"
#include "require.h"
#include "test_group.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

enum { WIDTH = 66, HEIGHT = 48, STEPS = 48 };

/* The camera looks down at the floor, through a long lens: neighbours, whose rays the filter shares, see it
 * at the same angle. */
static const double DOWN = 0.4, AHEAD = 0.9165, TAN = 0.05;
/* The 256 directions in which the pixels of a square of squares look are not quite even over the lobe. */
static const double TOLERANCE = 0.04;

/* A level floor, how smooth it is, and the sky above. */
struct floor {
    float roughness, metal;
    double lean; /* of the picture's normals, away from the viewer, in radians */
    struct sdfgi_sky sky;
};

static const struct sdfgi_sky bright_above = { .zenith = { 1, 1, 1 } },
                              even = { .zenith = { 1, 1, 1 }, .horizon = { 1, 1, 1 }, .ground = { 1, 1, 1 } };

static void open_floor(struct gi_test *t, struct picture_scene *scene, const struct floor *floor)
{
    struct sdfgi_settings settings = gi_test_settings();
    settings.resolution = 64;
    settings.reflection_blend = settings.reflection_end = 1; /* rays alone */
    gi_test_open(t, &settings);
    const double centre[3] = { 0, -1, -3 }, half[3] = { 6, 1, 6 };
    picture_scene_show(scene, test_mesh_box(centre, half, test_rotation_none));
    if (floor->metal > 0)
        light_add_metal(t, test_mesh_box(centre, half, test_rotation_none), 0.05f, floor->metal);
    else
        light_add(t, test_mesh_box(centre, half, test_rotation_none), 0.05f, 0);
    const struct sdfgi_material_desc smooth = { .smoothness = 1 };
    sdfgi_material material;
    REQUIRE_CMP((int)sdfgi_material_create(t->gi, &smooth, &material), ==, (int)SDFGI_OK);
    REQUIRE_CMP((int)sdfgi_set_sky(t->gi, &floor->sky), ==, (int)SDFGI_OK);
    gi_test_update(t, 8);
}

static struct picture draw_floor(const struct picture_scene *scene, double lean)
{
    const struct picture_camera camera = { .position = { 0, 1, 0 },
                                           .right = { 1, 0, 0 },
                                           .up = { 0, AHEAD, -DOWN },
                                           .forward = { 0, -DOWN, -AHEAD },
                                           .tan_x = TAN,
                                           .tan_y = TAN * HEIGHT / WIDTH,
                                           .near_m = 0.05 };
    const float normal[3] = { 0, (float)cos(lean), (float)-sin(lean) };
    struct picture picture = picture_draw(scene, &camera, WIDTH, HEIGHT);
    for (int i = 0; i < WIDTH * HEIGHT; i++)
        memcpy(picture.normals[i], normal, sizeof normal);
    return picture;
}

/* ---- The mean over the lobe, by quadrature. Heights are cosines to the normal. */

/* Visible facets of GGX (Dupuy and Benyoub 2023) for a viewer at height `h`. The sky's light is the height of
 * the direction. `means`: of light alone, where facets that face down have that of their neighbours, and of
 * light by what facets reflect and others do not hide. */
static void sky_of_lobe(double h, double alpha, double means[static 2])
{
    const double side = sqrt(1 - h * h), length = hypot(side * alpha, h),
                 view[2] = { side * alpha / length, h / length };
    double light = 0, reflected = 0, share = 0;
    for (int i = 0; i < STEPS * STEPS; i++) {
        const double turn = 2 * 3.14159265358979 * (i % STEPS + 0.5) / STEPS,
                     z = (1 - (i / STEPS + 0.5) / STEPS) * (1 + view[1]) - view[1], r = sqrt(1 - z * z);
        const double facet[3] = { alpha * (r * cos(turn) + view[0]), alpha * r * sin(turn), z + view[1] };
        const double norm = sqrt(facet[0] * facet[0] + facet[1] * facet[1] + facet[2] * facet[2]),
                     cosine = (side * facet[0] + h * facet[2]) / norm,
                     height = 2 * cosine * facet[2] / norm - h,
                     sent = height > 0 ? oracle_fresnel(0.04, cosine) * oracle_smith(h, height, alpha) : 0;
        light += fabs(height);
        reflected += sent * height;
        share += sent;
    }
    means[0] = light / (STEPS * STEPS);
    means[1] = reflected / share;
}

/* The mean over any lobe is 1 then. Quadrature takes longer than the picture. */
static bool is_even(const struct sdfgi_sky *sky)
{
    return memcmp(sky, &even, sizeof *sky) == 0;
}

/* Sums over the pixels of the floor: what is shown, and the two means. */
struct sums {
    double shown, even, by_facets;
    int pixels;
};

static struct sums sum_floor(const struct picture *p, uint16_t (*texels)[4], const struct floor *floor)
{
    const double alpha = (double)floor->roughness * (double)floor->roughness;
    struct sums sums = { 0 };
    for (int i = 0; i < WIDTH * HEIGHT; i++) {
        const double u = ((i % WIDTH + 0.5) / WIDTH * 2 - 1) * TAN,
                     v = ((i / WIDTH + 0.5) / HEIGHT * 2 - 1) * TAN * HEIGHT / WIDTH;
        double means[2] = { 1, 1 };
        if (p->objects[i] != 0)
            continue;
        if (!is_even(&floor->sky))
            sky_of_lobe((DOWN + AHEAD * v) / sqrt(1 + u * u + v * v), alpha, means);
        sums.pixels++;
        sums.shown += (double)gi_test_half(texels[i][1]);
        sums.even += means[0];
        sums.by_facets += means[1];
    }
    REQUIRE_CMP(sums.pixels, >, WIDTH * HEIGHT / 2);
    return sums;
}

static struct sums reflect_sky(const struct floor *floor)
{
    static struct gi_test t;
    static float rough[WIDTH * HEIGHT];
    static uint16_t texels[WIDTH * HEIGHT][4];
    struct picture_scene scene = { .count = 0 };
    open_floor(&t, &scene, floor);
    struct picture picture = draw_floor(&scene, floor->lean);
    for (int i = 0; i < WIDTH * HEIGHT; i++)
        rough[i] = floor->roughness;
    picture_reflect(&t, &picture, rough, texels);
    const struct sums sums = sum_floor(&picture, texels, floor);
    picture_finish(&picture);
    picture_scene_finish(&scene);
    gi_test_close(&t);
    printf(
        "%s of roughness %.2f, leaning by %.2f: %.4f, or %.4f of the mean of the lobe, %.4f of that by what "
        "facets reflect\n",
        floor->metal > 0 ? "metal" : "dielectric", (double)floor->roughness, floor->lean,
        sums.shown / sums.pixels, sums.shown / sums.even, sums.shown / sums.by_facets);
    return sums;
}

static void dielectrics_reflect_by_the_angle_of_facets(void **state)
{
    (void)state;
    const struct floor floor = { .roughness = 0.38f, .sky = bright_above };
    const struct sums sums = reflect_sky(&floor);
    REQUIRE_CMP(sums.by_facets / sums.even, <, 0.9);
    REQUIRE_NEAR(sums.shown / sums.by_facets, 1, TOLERANCE);
}

static void metal_reflects_at_all_angles_alike(void **state)
{
    (void)state;
    const struct floor floor = { .roughness = 0.38f, .metal = 1, .sky = bright_above };
    const struct sums sums = reflect_sky(&floor);
    REQUIRE_NEAR(sums.shown / sums.even, 1, TOLERANCE);
}

/* Facets count differently, and all of them together as much as the host multiplies by. */
static void dielectrics_reflect_an_even_sky_as_it_is(void **state)
{
    static const float roughness[] = { 0.1f, 0.2f, 0.4f, 0.5f, 0.58f };
    (void)state;
    for (size_t i = 0; i < sizeof roughness / sizeof *roughness; i++) {
        const struct floor floor = { .roughness = roughness[i], .sky = even };
        const struct sums sums = reflect_sky(&floor);
        REQUIRE_NEAR(sums.shown / sums.pixels, 1, 0.05);
    }
}

/* A normal of a texture may lean so far that what it mirrors is the ground itself. Hosts multiply by nearly 1
 * there, and what is shown must not be the sky. */
static void facets_that_lean_away_from_the_viewer_do_not_shine(void **state)
{
    (void)state;
    const struct floor slight = { .roughness = 0.05f, .lean = 0.15, .sky = even };
    const struct sums shines = reflect_sky(&slight);
    REQUIRE_NEAR(shines.shown / shines.pixels, 1, 0.05);
    for (int metal = 0; metal < 2; metal++) {
        const struct floor far = { .roughness = 0.05f, .metal = (float)metal, .lean = 0.4, .sky = even };
        const struct sums dark = reflect_sky(&far);
        REQUIRE_CMP(dark.shown / dark.pixels, <, 0.02);
    }
}

TEST_GROUP(reflection_facets)
{
    if (!gpu_test_available())
        return GPU_TEST_SKIP;
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(dielectrics_reflect_by_the_angle_of_facets),
        cmocka_unit_test(metal_reflects_at_all_angles_alike),
        cmocka_unit_test(dielectrics_reflect_an_even_sky_as_it_is),
        cmocka_unit_test(facets_that_lean_away_from_the_viewer_do_not_shine),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
