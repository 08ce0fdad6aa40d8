/* SPDX-License-Identifier: MIT
 * A world with another axis up, or of the other hand, has the light of the same world with +Y up, turned. */
#include "light_scene.h"
#include "require.h"
#include "test_group.h"

#include <sdfgi/sky.h>

#include <math.h>
#include <stdio.h>
#include <string.h>
#include <vulkan/vulkan.h>

enum { UPS = 4 };

static const char *const names[UPS] = { "+Y", "+Z", "-Y", "-Z" };

static struct gi_test t;

static void turned_float(enum sdfgi_up_axis up, const float v[static 3], float out[static 3])
{
    double world[3];
    light_turn(up, (double[3]){ (double)v[0], (double)v[1], (double)v[2] }, world);
    for (int i = 0; i < 3; i++)
        out[i] = (float)world[i];
}

static void open_world(enum sdfgi_up_axis up, const struct sdfgi_settings *settings)
{
    if (!t.gi)
        gi_test_open(&t, settings);
    t.up_axis = up;
    gi_test_restart(&t, settings);
}

static int close_world(void **state)
{
    (void)state;
    if (t.gi)
        gi_test_close(&t);
    return 0;
}

static void look_up(enum sdfgi_up_axis up, const float *viewer, const struct gi_test_point *points,
                    uint32_t count, float (*found)[3])
{
    struct gi_test_point there[8];
    float eye[3];
    REQUIRE_CMP(count, <=, 8u);
    for (uint32_t i = 0; i < count; i++) {
        turned_float(up, points[i].position, there[i].position);
        turned_float(up, points[i].normal, there[i].normal);
    }
    if (viewer)
        turned_float(up, viewer, eye);
    if (viewer)
        gi_test_irradiance_from(&t, eye, there, count, found);
    else
        gi_test_irradiance(&t, there, count, found);
}

/* ---- Skies */

static const struct sdfgi_sky gradient = { { 3, 2, 4 }, { 1, 1.5f, 0.5f }, { 0.2f, 0.1f, 0.3f } };

static void set_skies(void)
{
    struct sdfgi_sky_harmonics harmonics = light_tinted_sky;
    harmonics.rotation_rad = 0.7f;
    REQUIRE_CMP(sdfgi_set_sky(t.gi, &gradient), ==, SDFGI_OK);
    REQUIRE_CMP(sdfgi_set_sky_harmonics(t.gi, &harmonics), ==, SDFGI_OK);
}

/* Beyond the cascades, where lookups give the sky itself. */
static const struct gi_test_point far_points[] = {
    { { 60, 0, 0 }, { 0, 1, 0 } },
    { { 60, 0, 0 }, { 0, -1, 0 } },
    { { 60, 0, 0 }, { 1, 0, 0 } },
    { { 60, 0, 0 }, { -1, 0, 0 } },
    { { 60, 0, 0 }, { 0, 0, 1 } },
    { { 60, 0, 0 }, { 0, 0, -1 } },
    { { 60, 0, 0 }, { 0.6f, 0.64f, 0.48f } },
    { { 60, 0, 0 }, { -0.48f, 0.6f, -0.64f } },
};
enum { FAR_POINTS = sizeof far_points / sizeof *far_points };

static void skies_stand_upright(void **state)
{
    (void)state;
    const struct sdfgi_settings settings = light_settings(32, 0.25f);
    float expected[FAR_POINTS][3], found[FAR_POINTS][3];
    for (int up = 0; up < UPS; up++) {
        open_world((enum sdfgi_up_axis)up, &settings);
        set_skies();
        gi_test_update(&t, 2);
        look_up((enum sdfgi_up_axis)up, NULL, far_points, FAR_POINTS, found);
        if (up == SDFGI_UP_Y)
            memcpy(expected, found, sizeof expected);
        for (int i = 0; i < FAR_POINTS; i++)
            for (int k = 0; k < 3; k++)
                REQUIRE_NEAR(found[i][k], expected[i][k], 1e-5 * (double)expected[i][k]);
    }
    REQUIRE_CMP(expected[0][0], >, 2 * expected[1][0]); /* the zenith is above */
}

/* ---- A room without a roof */

static void add_room(enum sdfgi_up_axis up)
{
    static const float white[3] = { 0.8f, 0.8f, 0.8f }, red[3] = { 0.8f, 0.1f, 0.1f },
                       green[3] = { 0.1f, 0.7f, 0.1f };
    light_add_turned_box(&t, (double[]){ -3, -1.5, -3 }, (double[]){ 3, -1, 3 }, white);
    light_add_turned_box(&t, (double[]){ -3, -1, -3 }, (double[]){ -2.5, 1.5, 3 }, red);
    light_add_turned_box(&t, (double[]){ -2.5, -1, -3 }, (double[]){ 3, 1, -2.5 }, green);
    light_add_turned_box(&t, (double[]){ 0.5, -1, 0.5 }, (double[]){ 1.5, 0, 1.5 }, white);
    struct sdfgi_light_desc lamp = light_point(0, 0, 0, 3);
    light_turn(up, (double[3]){ -1, 0.4, -1 }, lamp.position);
    light_create(&t, &lamp);
    set_skies();
}

/* On every surface, and in the air. */
static const struct gi_test_point room_points[] = {
    { { 0, -1, 0 }, { 0, 1, 0 } },       { { -2, -1, 2 }, { 0, 1, 0 } }, { { -2.5f, 0, 0.4f }, { 1, 0, 0 } },
    { { 0.6f, 0, -2.5f }, { 0, 0, 1 } }, { { 1, 0, 1 }, { 0, 1, 0 } },   { { 1, -0.5f, 0.5f }, { 0, 0, -1 } },
    { { 0, 0.5f, 0 }, { 0, -1, 0 } },
};
/* A little within the ground, seen from far away along it: lookups step out of its sub-voxels upwards. */
static const struct gi_test_point ground_points[] = { { { -0.1f, -1.03f, -0.6f }, { 1, 0, 0 } },
                                                      { { 0.4f, -1.03f, -1.7f }, { 0, 0, 1 } } };
static const float along_ground[3] = { 30, -0.9f, 0.5f };
enum {
    ROOM_POINTS = sizeof room_points / sizeof *room_points,
    GROUND_POINTS = sizeof ground_points / sizeof *ground_points,
    ALL_POINTS = ROOM_POINTS + GROUND_POINTS
};

/* Relative to the brightest channel of a point, the most that light differs. */
static double most_difference(float (*found)[3], float (*expected)[3], const char *name)
{
    double worst = 0;
    for (int i = 0; i < ALL_POINTS; i++) {
        const float *e = expected[i];
        const double brightest = fmax((double)e[0], fmax((double)e[1], (double)e[2]));
        for (int k = 0; k < 3; k++)
            worst = fmax(worst, fabs((double)found[i][k] - (double)e[k]) / brightest);
        printf("%s up, point %d: %.4f %.4f %.4f, with +Y up %.4f %.4f %.4f\n", name, i, (double)found[i][0],
               (double)found[i][1], (double)found[i][2], (double)e[0], (double)e[1], (double)e[2]);
    }
    return worst;
}

/* Rays go other ways in a turned room, and cells see other parts of it: light of one room with another seed
 * differs by as much. */
static void a_turned_room_has_the_same_light(void **state)
{
    (void)state;
    struct sdfgi_settings settings = light_exact_settings(32, 0.25f);
    settings.surface_light = SDFGI_SURFACE_LIGHT_CELLS;
    settings.cell_rays = 128;
    settings.cell_rays_per_frame = 1 << 18;
    float expected[ALL_POINTS][3], found[ALL_POINTS][3];
    for (int up = 0; up < UPS; up++) {
        open_world((enum sdfgi_up_axis)up, &settings);
        add_room((enum sdfgi_up_axis)up);
        gi_test_converge(&t, 400);
        look_up((enum sdfgi_up_axis)up, NULL, room_points, ROOM_POINTS, found);
        look_up((enum sdfgi_up_axis)up, along_ground, ground_points, GROUND_POINTS, found + ROOM_POINTS);
        if (up == SDFGI_UP_Y)
            memcpy(expected, found, sizeof expected);
        REQUIRE_CMP(most_difference(found, expected, names[up]), <=, 0.015);
    }
}

/* ---- Hands */

/* Light above a lamp that shines up, in a world whose z points the other way if it is of the left hand. */
static double light_above(bool mirrored, bool left_handed)
{
    const struct sdfgi_settings settings = light_exact_settings(32, 0.25f);
    open_world(SDFGI_UP_Y, &settings);
    t.left_handed = left_handed;
    gi_test_restart(&t, &settings);
    t.left_handed = false;
    struct test_mesh lamp =
        test_mesh_plane((double[]){ 0, -1, 0.25 }, (double[]){ 0, 0, 1 }, (double[]){ 1.5, 0, 0 }, 1);
    if (mirrored)
        test_mesh_transform(&lamp, (double[9]){ 1, 0, 0, 0, 1, 0, 0, 0, -1 }, (double[3]){ 0 });
    const struct sdfgi_material_desc shining = { .emission = { 1, 1, 1 } };
    sdfgi_material material;
    REQUIRE_CMP((int)sdfgi_material_create(t.gi, &shining, &material), ==, (int)SDFGI_OK);
    gi_test_add(&t, &lamp, material);
    test_mesh_destroy(&lamp);
    gi_test_converge(&t, 200);
    return light_white_at(&t, (struct gi_test_point){ { 0, 0.5f, 0 }, { 0, -1, 0 } });
}

static void fronts_of_left_handed_worlds_are_before_them(void **state)
{
    (void)state;
    const double right = light_above(false, false), left = light_above(true, true);
    printf("above the lamp: %.4f, in a left-handed world %.4f\n", right, left);
    REQUIRE_CMP(right, >, 0.5);
    REQUIRE_NEAR(left, right, 0.02 * right);
    REQUIRE_NEAR(light_above(true, false), 0, 0.02 * right);
    REQUIRE_NEAR(light_above(false, true), 0, 0.02 * right);
}

/* ---- What is refused */

static void cells_are_flat_along_y_alone(void **state)
{
    (void)state;
    struct sdfgi_settings settings = light_settings(32, 0.25f), flat = settings;
    flat.y_scale = SDFGI_Y_SCALE_75;
    for (int up = 0; up < UPS; up++) {
        open_world((enum sdfgi_up_axis)up, &settings);
        const bool along_y = up == SDFGI_UP_Y || up == SDFGI_UP_MINUS_Y;
        REQUIRE_CMP((int)sdfgi_set_settings(t.gi, &flat), ==,
                    along_y ? (int)SDFGI_OK : (int)SDFGI_ERROR_INVALID_ARGUMENT);
        if (!along_y)
            REQUIRE_TRUE(strstr(t.last_message, "sdfgi_y_scale is 75%") != NULL);
    }
}

static void other_axes_are_refused(void **state)
{
    (void)state;
    const struct sdfgi_settings settings = light_settings(32, 0.25f);
    open_world(SDFGI_UP_Y, &settings);
    sdfgi *none = NULL;
    const struct sdfgi_desc desc = {
        .vulkan = { t.gpu.instance, t.gpu.physical_device, t.gpu.device, t.gpu.queue_family_index,
                    vkGetInstanceProcAddr, NULL },
        .up_axis = (enum sdfgi_up_axis)4,
    };
    REQUIRE_CMP((int)sdfgi_create(&desc, &none), ==, (int)SDFGI_ERROR_INVALID_ARGUMENT);
    REQUIRE_TRUE(none == NULL);
}

TEST_GROUP(up_axis)
{
    if (!gpu_test_available())
        return GPU_TEST_SKIP;
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(skies_stand_upright),
        cmocka_unit_test(a_turned_room_has_the_same_light),
        cmocka_unit_test(fronts_of_left_handed_worlds_are_before_them),
        cmocka_unit_test(cells_are_flat_along_y_alone),
        cmocka_unit_test(other_axes_are_refused),
    };
    return cmocka_run_group_tests_name("up_axis", tests, NULL, close_world);
}
