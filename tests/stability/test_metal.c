/* SPDX-License-Identifier: MIT
 * Light that reaches cells by way of metal. */
#include "light_scene.h"
#include "require.h"
#include "test_group.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

/* ---- A mirror doubles what stands before it */

/* All light is there: it makes one bounce, or none. */
enum { POINTS = 6, FRAMES = 32 };

#define MIRROR_ALBEDO 0.9f

enum wall { WALL_BLACK, WALL_MIRROR, WALL_MATT, WALL_ABSENT };

/* A black floor between a wall at x < 0 and a panel that glows at x = 2; without the wall, the panel's image
 * glows at x = -2. */
static void build(struct gi_test *t, enum wall wall)
{
    static const float black[3] = { 0, 0, 0 };
    const struct sdfgi_settings settings = light_cell_settings(32, 0.25f);
    gi_test_restart(t, &settings);
    light_add_box(t, (double[]){ -0.5, -1, -0.5 }, (double[]){ 2, 0, 1 }, black, 0);
    light_add_box(t, (double[]){ 2, 0, -1 }, (double[]){ 2.5, 1, 1 }, black, 1);
    if (wall == WALL_ABSENT)
        light_add_box(t, (double[]){ -2.5, 0, -1 }, (double[]){ -2, 1, 1 }, black, 1);
    else
        light_add_metal(
            t, test_mesh_box((double[]){ -0.25, 0.6, 0 }, (double[]){ 0.25, 0.6, 1 }, test_rotation_none),
            wall == WALL_BLACK ? 0 : MIRROR_ALBEDO, wall == WALL_MIRROR ? 1 : 0);
    gi_test_update(t, FRAMES);
}

/* Irradiance of the floor. */
static void look(struct gi_test *t, float found[static POINTS][3])
{
    struct gi_test_point points[POINTS];
    for (int i = 0; i < POINTS; i++)
        points[i] = (struct gi_test_point){ { 0.3f + 0.25f * (float)i, 0, 0.4f }, { 0, 1, 0 } };
    gi_test_irradiance(t, points, POINTS, found);
}

static void a_mirror_doubles_what_stands_before_it(void **state)
{
    struct gi_test *t = *state;
    float found[4][POINTS][3];
    double worst = 0, matt = 0;
    for (enum wall wall = WALL_BLACK; wall <= WALL_ABSENT; wall++) {
        build(t, wall);
        look(t, found[wall]);
    }
    for (int i = 0; i < POINTS; i++) {
        const double black = (double)found[WALL_BLACK][i][1],
                     image = (double)found[WALL_ABSENT][i][1] - black,
                     expected = black + (double)MIRROR_ALBEDO * image;
        worst = fmax(worst, fabs((double)found[WALL_MIRROR][i][1] - expected) / expected);
        matt = fmax(matt, fabs((double)found[WALL_MATT][i][1] - expected) / expected);
        printf("%.2f m before a mirror: %.4f, of which %.4f without it; expected %.4f\n", 0.3 + 0.25 * i,
               (double)found[WALL_MIRROR][i][1], black, expected);
    }
    printf("a mirror off by %.4f at most, a matt wall by %.4f\n", worst, matt);
    REQUIRE_CMP(worst, <=, 0.02);
    REQUIRE_CMP(matt, >, 0.1);
}

/* ---- Kinds */

/* The kinds of metal that blocks have, a bit each; bit 0 for none. */
static uint32_t kinds_of_blocks(struct gi_test *t)
{
    uint64_t size;
    uint32_t *normals = gi_test_read(t, RESOURCE_NORMALS, &size), kinds = 0;
    for (uint64_t i = 0; i < size / sizeof *normals; i++)
        kinds |= 1u << (normals[i] >> 30);
    free(normals);
    return kinds;
}

/* A box of one kind; of none: a rougher one, and one before which as much matt plaster stands. */
static void roughness_tells_the_kind_of_metal(void **state)
{
    static const struct {
        float smoothness;
        uint32_t kind;
    } rows[] = { { 1, 1 },     { 0.8f, 1 }, { 0.79f, 2 },    { 0.6f, 2 },
                 { 0.59f, 3 }, { 0.4f, 3 }, { 1 - 0.6f, 3 }, { 0.39f, 0 } };
    struct gi_test *t = *state;
    const struct sdfgi_settings settings = light_settings(32, 0.25f);
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++)
        for (int plaster = 0; plaster < 2; plaster++) {
            const double half[3] = { 0.8, 0.7, 0.6 }, center[3] = { 0.1, 0.2, 0.3 };
            gi_test_restart(t, &settings);
            light_add_metal(t, test_mesh_box(center, half, test_rotation_none), 0.9f, rows[i].smoothness);
            if (plaster)
                light_add(t, test_mesh_box(center, half, test_rotation_none), 0.9f, 0);
            gi_test_update(t, 4);
            REQUIRE_CMP(kinds_of_blocks(t), ==, 1u | (plaster ? 1u : 1u << rows[i].kind));
        }
}

/* ---- Sealed metal */

/* A ball of two cells and a half, of mirrors. */
static void a_ball_of_metal_is_dark_inside(void **state)
{
    static const double normals[4][3] = { { 1, 0, 0 }, { 0, -1, 0 }, { 0, 0.6, 0.8 }, { -0.8, 0, -0.6 } };
    struct gi_test *t = *state;
    struct gi_test_point points[4];
    float found[4][3];
    const struct sdfgi_settings settings = light_cell_settings(64, 0.25f);
    gi_test_restart(t, &settings);
    light_add_metal(t, test_mesh_sphere((double[]){ 0.07, -0.04, 0.11 }, 0.625, 4), 1, 1);
    light_set_uniform_sky(t, 1e4f);
    gi_test_update(t, 40);
    for (int i = 0; i < 4; i++)
        for (int k = 0; k < 3; k++) {
            points[i].normal[k] = (float)-normals[i][k];
            points[i].position[k] = (float)(0.6 * normals[i][k] + (double[]){ 0.07, -0.04, 0.11 }[k]);
        }
    gi_test_irradiance(t, points, 4, found);
    for (int i = 0; i < 4; i++)
        REQUIRE_CMP((double)found[i][1], ==, 0.0);
}

TEST_GROUP(metal)
{
    if (!gpu_test_available())
        return GPU_TEST_SKIP;
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_mirror_doubles_what_stands_before_it),
        cmocka_unit_test(roughness_tells_the_kind_of_metal),
        cmocka_unit_test(a_ball_of_metal_is_dark_inside),
    };
    return cmocka_run_group_tests_name("metal", tests, light_open, light_close);
}
