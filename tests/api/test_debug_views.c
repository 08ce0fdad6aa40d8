/* SPDX-License-Identifier: MIT
 * Debug views of surfaces: what they show of a scene of boxes, of which everything is known. */
#include "debug_pixel.h"
#include "light_scene.h"
#include "require.h"
#include "test_group.h"

#include <math.h>

/* Half floats have 11 bits, and a driver may truncate. */
#define ROUNDING 0x1p-10
#define CELL_M   0.25
/* Brightness of faces: +x -x +y -y +z -z. */
static const double shades[6] = { 0.85, 0.6, 1, 0.4, 0.75, 0.5 };
static const double origin[3] = { 0, 0, 0 };

static struct gi_test context;

/* Over (-3, 1.1, 0); it emits upwards alone. */
static void add_panel(struct gi_test *t)
{
    const struct sdfgi_material_desc desc = { .albedo = { 0.5f, 0.5f, 0.5f }, .emission = { 2, 2, 2 } };
    sdfgi_material material;
    REQUIRE_CMP((int)sdfgi_material_create(t->gi, &desc, &material), ==, (int)SDFGI_OK);
    struct test_mesh mesh =
        test_mesh_plane((double[]){ -3, 1.1, 0 }, (double[]){ 0, 0, 0.5 }, (double[]){ 0.5, 0, 0 }, 1);
    gi_test_add(t, &mesh, material);
    test_mesh_destroy(&mesh);
}

/* Cascade 0 reaches to 4 m, and cascade 1 to 8. A red wall 2 m along +x, a blue one 6 m along +z, and a lamp
 * 2 m along -z; the floor is 1.5 m below, where x is below 2.
 */
static int open_boxes(void **state)
{
    struct sdfgi_settings settings = light_settings(32, (float)CELL_M);
    settings.cascades = 2;
    gi_test_open(&context, &settings);
    light_add_box(&context, (double[]){ 2, -1.5, -2 }, (double[]){ 3, 3, 2 }, (float[]){ 0.8f, 0.1f, 0.2f },
                  0);
    light_add_box(&context, (double[]){ -4, -3, 6 }, (double[]){ 4, 3, 7 }, (float[]){ 0.1f, 0.2f, 0.7f }, 0);
    light_add_box(&context, (double[]){ -1, -1, -3 }, (double[]){ 1, 1, -2 }, (float[]){ 0.5f, 0.5f, 0.5f },
                  2);
    light_add_box(&context, (double[]){ -7, -2.5, -7 }, (double[]){ 2, -1.5, 7 },
                  (float[]){ 0.5f, 0.5f, 0.5f }, 0);
    add_panel(&context);
    gi_test_update(&context, 3);
    *state = &context;
    return 0;
}

static int close_boxes(void **state)
{
    gi_test_close(*state);
    return 0;
}

static void solid_bits_are_shaded_by_face_and_beyond_them_is_sky(void **state)
{
    const double from[6][3] = { { 3.9, 0, 0 },   { 0, 0, 0 }, { 0, 0, 0 },
                                { -3, -2.9, 0 }, { 0, 0, 0 }, { 0, 0, 0 } };
    /* The axis along which a camera looks at a face that faces +x -x +y -y +z -z. */
    const int look[6] = { 1, 0, 3, 2, 5, 4 };
    for (int face = 0; face < 6; face++) {
        const struct debug_color c = debug_look(*state, SDFGI_DEBUG_SOLID, from[face], look[face]);
        REQUIRE_COLOR(c, shades[face], shades[face], shades[face], ROUNDING);
    }
    const double between_probes[3] = { 1, 0, 1 };
    for (int view = 0; view < SDFGI_DEBUG_VIEW_COUNT; view++)
        if (view != SDFGI_DEBUG_DISTANCE_SLICE && view != SDFGI_DEBUG_STEPS)
            REQUIRE_COLOR(debug_look(*state, (enum sdfgi_debug_view)view, between_probes, 2), 0.01, 0.015,
                          0.03, ROUNDING);
}

/* Surfaces lie up to half a sub-voxel behind their front. */
static void distance_is_that_of_the_surface(void **state)
{
    const struct {
        int axis;
        double range_m;
    } rays[] = { { 0, 2 }, { 3, 1.5 }, { 4, 6 }, { 5, 2 } };
    for (size_t i = 0; i < sizeof rays / sizeof *rays; i++) {
        const double value = debug_value_of(debug_look(*state, SDFGI_DEBUG_DISTANCE, origin, rays[i].axis));
        REQUIRE_NEAR(0.1 * pow(10, 4 * value), rays[i].range_m, 0.05 * rays[i].range_m + CELL_M / 4);
    }
}

/* The slice 1 m before the camera lies 1 m from the wall; 2.05 m before it, in the wall's first sub-voxels.
 */
static void the_slice_shows_distances_and_solid_bits(void **state)
{
    struct sdfgi_debug_desc desc = debug_desc(DEBUG_CAMERA_REVERSED, origin, 0);
    desc.view = SDFGI_DEBUG_DISTANCE_SLICE;
    desc.slice_m = 1;
    REQUIRE_NEAR(16 * CELL_M * debug_value_of(debug_pixel(*state, &desc)), 1, CELL_M);
    desc.slice_m = 2.05f;
    REQUIRE_COLOR(debug_pixel(*state, &desc), 1, 1, 1, 0);
    /* A quarter of 32 cells of 0.25 m. */
    desc.slice_m = 0;
    const struct debug_color at_default = debug_pixel(*state, &desc);
    desc.slice_m = 2;
    const struct debug_color at_2_m = debug_pixel(*state, &desc);
    for (int k = 0; k < 3; k++)
        REQUIRE_CMP(at_default.rgb[k], ==, at_2_m.rgb[k]);
    /* Beyond all cascades there is nothing. */
    desc.slice_m = 20;
    REQUIRE_COLOR(debug_pixel(*state, &desc), 0.01, 0.015, 0.03, ROUNDING);
}

static void cascades_have_colours_of_their_own(void **state)
{
    const struct debug_color near = debug_look(*state, SDFGI_DEBUG_CASCADE, origin, 0),
                             far = debug_look(*state, SDFGI_DEBUG_CASCADE, origin, 4);
    REQUIRE_COLOR(near, 0.1 * shades[1], 0.8 * shades[1], 0.1 * shades[1], ROUNDING);
    REQUIRE_COLOR(far, 0.1 * shades[5], 0.3 * shades[5], 1 * shades[5], ROUNDING);
}

static double steps_of(struct gi_test *t, const double eye[static 3], int axis)
{
    return pow(512, debug_value_of(debug_look(t, SDFGI_DEBUG_STEPS, eye, axis)));
}

/* 2 m of air take a few steps, and so does the air beside the floor. A ray within the floor walks from cell
 * to cell, below the sub-voxels that each has: 16 of cascade 0 and 8 of cascade 1. */
static void steps_are_few_in_air_and_many_beside_subvoxels(void **state)
{
    const double grazing[3] = { 0, -1.45, 3 }, below[3] = { 0, -1.65, 3 };
    const double straight = steps_of(*state, origin, 0), beside = steps_of(*state, grazing, 1),
                 within = steps_of(*state, below, 1);
    REQUIRE_CMP(straight, >=, 2.0);
    REQUIRE_CMP(straight, <=, 8.0);
    REQUIRE_CMP(beside, >=, 2.0);
    REQUIRE_CMP(beside, <=, 8.0);
    REQUIRE_CMP(within, >=, 20.0);
    REQUIRE_CMP(within, <=, 48.0);
}

static void albedo_is_that_of_the_material(void **state)
{
    REQUIRE_COLOR(debug_look(*state, SDFGI_DEBUG_ALBEDO, origin, 0), 0.8, 0.1, 0.2, 2 * ROUNDING);
    REQUIRE_COLOR(debug_look(*state, SDFGI_DEBUG_ALBEDO, origin, 4), 0.1, 0.2, 0.7, 2 * ROUNDING);
}

static void add_wall(struct gi_test *t, double x, double side, const float color[static 3])
{
    struct test_mesh mesh =
        test_mesh_plane((double[]){ x, 0.1, 0.1 }, (double[]){ 0, side, 0 }, (double[]){ 0, 0, 1 }, 1);
    gi_test_add(t, &mesh, gi_test_material(t, color, (float[3]){ 0 }));
    test_mesh_destroy(&mesh);
}

/* A wall of a quarter of a cell. */
static void thin_walls_show_the_colour_of_the_side_that_is_seen(void **state)
{
    (void)state;
    struct gi_test t;
    const struct sdfgi_settings settings = light_settings(32, (float)CELL_M);
    gi_test_open(&t, &settings);
    add_wall(&t, 1.03, -1, (float[3]){ 0.8f, 0.1f, 0.2f });
    add_wall(&t, 1.09, 1, (float[3]){ 0.9f, 0.6f, 0.9f });
    gi_test_update(&t, 3);
    REQUIRE_COLOR(debug_look(&t, SDFGI_DEBUG_ALBEDO, origin, 0), 0.8, 0.1, 0.2, 2 * ROUNDING);
    REQUIRE_COLOR(debug_look(&t, SDFGI_DEBUG_ALBEDO, (double[]){ 2, 0, 0 }, 1), 0.9, 0.6, 0.9, 2 * ROUNDING);
    gi_test_close(&t);
}

/* L / (1 + L) for a radiance of 2; emission is stored with 9 bits. */
static void emission_is_shown_at_the_exposure(void **state)
{
    struct gi_test *t = *state;
    struct sdfgi_debug_desc desc = debug_desc(DEBUG_CAMERA_REVERSED, origin, 5);
    desc.view = SDFGI_DEBUG_EMISSION;
    REQUIRE_COLOR(debug_pixel(t, &desc), 2.0 / 3, 2.0 / 3, 2.0 / 3, 0.002);
    desc.exposure = 0.25f;
    REQUIRE_COLOR(debug_pixel(t, &desc), 1.0 / 3, 1.0 / 3, 1.0 / 3, 0.002);
    /* Without an exposure of its own it follows the hint, whatever light is stored with. */
    desc.exposure = 0;
    t->frame.exposure = 0.75f;
    gi_test_update(t, 1);
    REQUIRE_COLOR(debug_pixel(t, &desc), 0.6, 0.6, 0.6, 0.002);
    REQUIRE_COLOR(debug_look(t, SDFGI_DEBUG_EMISSION, origin, 0), 0, 0, 0, 0);
    t->frame.exposure = 1;
    gi_test_update(t, 1);
    REQUIRE_COLOR(debug_look(t, SDFGI_DEBUG_EMISSION, (double[]){ -3, 1.5, 0 }, 3), 2.0 / 3, 2.0 / 3, 2.0 / 3,
                  0.002);
    REQUIRE_COLOR(debug_look(t, SDFGI_DEBUG_EMISSION, (double[]){ -3, 0.5, 0 }, 2), 0, 0, 0, 0);
}

TEST_GROUP(debug_views)
{
    if (!gpu_test_available())
        return GPU_TEST_SKIP;
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(solid_bits_are_shaded_by_face_and_beyond_them_is_sky),
        cmocka_unit_test(distance_is_that_of_the_surface),
        cmocka_unit_test(the_slice_shows_distances_and_solid_bits),
        cmocka_unit_test(cascades_have_colours_of_their_own),
        cmocka_unit_test(steps_are_few_in_air_and_many_beside_subvoxels),
        cmocka_unit_test(albedo_is_that_of_the_material),
        cmocka_unit_test(thin_walls_show_the_colour_of_the_side_that_is_seen),
        cmocka_unit_test(emission_is_shown_at_the_exposure),
    };
    return cmocka_run_group_tests(tests, open_boxes, close_boxes);
}
