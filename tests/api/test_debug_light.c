/* SPDX-License-Identifier: MIT
 * Debug views of light, its cells and its probes, in a furnace: a closed room whose walls emit 1 and reflect
 * a half holds a radiance of 2 everywhere. */
#include "debug_pixel.h"
#include "light_scene.h"
#include "require.h"
#include "test_group.h"

#include <math.h>
#include <stdlib.h>

#define ROUNDING 0x1p-10
#define CELL_M   0.25
/* Brightness of a face that faces -x. */
#define SHADE 0.6

static struct gi_test context;
static const double aside[3] = { 0, 0.1, 0.1 };

/* Cells that gather with few rays: a cycle is four visits. */
static struct sdfgi_settings cell_settings(void)
{
    struct sdfgi_settings settings = light_settings(32, (float)CELL_M);
    settings.surface_light = SDFGI_SURFACE_LIGHT_CELLS;
    settings.cell_rays = 64;
    return settings;
}

static void add_room(struct gi_test *t, float emission)
{
    light_add(t, test_mesh_room((double[]){ 0, 0, 0 }, (double[]){ 1.5, 1.5, 1.5 }, 0.5, test_rotation_none),
              0.5f, emission);
}

static int open_furnace(void **state)
{
    const struct sdfgi_settings settings = cell_settings();
    gi_test_open(&context, &settings);
    add_room(&context, 1);
    gi_test_converge(&context, 400);
    *state = &context;
    return 0;
}

static int close_context(void **state)
{
    gi_test_close(*state);
    return 0;
}

static struct debug_color look(struct gi_test *t, enum sdfgi_debug_view view)
{
    return debug_look(t, view, aside, 0);
}

/* E / pi is 2; what leaves without emission is half of it. */
static void light_in_a_furnace_is_grey_of_known_value(void **state)
{
    REQUIRE_COLOR(look(*state, SDFGI_DEBUG_IRRADIANCE), 2.0 / 3, 2.0 / 3, 2.0 / 3, 0.01);
    REQUIRE_COLOR(look(*state, SDFGI_DEBUG_LIGHT), 0.5, 0.5, 0.5, 0.01);
}

/* A probe stands in the origin, with a ball of three quarters of a cell. */
static void probes_are_balls_of_their_irradiance(void **state)
{
    const double off[] = { 0, 0.16, -0.16, 0.2, -0.2 };
    for (int i = 0; i < 5; i++) {
        const struct debug_color c =
            debug_look(*state, SDFGI_DEBUG_PROBES_IRRADIANCE, (double[]){ -1, off[i], 0 }, 0);
        const double expected = fabs(off[i]) < 0.75 * CELL_M ? 2.0 / 3 : 0.1 * SHADE;
        REQUIRE_COLOR(c, expected, expected, expected, 0.01);
    }
}

static void settled_cells_and_probes_are_green_and_grey(void **state)
{
    const double before[3] = { -1, 0, 0 };
    REQUIRE_COLOR(look(*state, SDFGI_DEBUG_CONFIDENCE), 0, SHADE, 0, ROUNDING);
    REQUIRE_COLOR(look(*state, SDFGI_DEBUG_WOKE), 0.25 * SHADE, 0.25 * SHADE, 0.25 * SHADE, ROUNDING);
    /* The middle of a ball faces the camera. */
    REQUIRE_COLOR(debug_look(*state, SDFGI_DEBUG_PROBES_STATE, before, 0), 0.1, 0.8, 0.1, 0.01);
    const struct debug_color leaks = look(*state, SDFGI_DEBUG_LEAKS);
    REQUIRE_COLOR(leaks, 0.25, 0.25, 0.25, 0.03);
}

/* ---- What woke */

/* A lamp that goes on wakes all cells that it can reach; a box makes voxels, and cells beside it. */
static void what_changes_is_coloured_until_it_has_settled(void **state)
{
    struct gi_test *t = *state;
    const struct sdfgi_light_desc lamp = light_point(-1, 0, 0, 1);
    const sdfgi_light light = light_create(t, &lamp);
    gi_test_update(t, 1);
    REQUIRE_COLOR(look(t, SDFGI_DEBUG_WOKE), SHADE, 0.85 * SHADE, 0, ROUNDING);
    REQUIRE_CMP(debug_value_of(look(t, SDFGI_DEBUG_AGE)), <, 0.3);
    REQUIRE_CMP(look(t, SDFGI_DEBUG_CONFIDENCE).rgb[0], >=, 0.9 * SHADE);
    gi_test_converge(t, 400);
    REQUIRE_COLOR(look(t, SDFGI_DEBUG_WOKE), 0.25 * SHADE, 0.25 * SHADE, 0.25 * SHADE, ROUNDING);
    const sdfgi_instance box = light_add_box(t, (double[]){ 0.5, -0.5, -0.5 }, (double[]){ 1, 0.5, 0.5 },
                                             (float[]){ 0.5f, 0.5f, 0.5f }, 1);
    gi_test_update(t, 1);
    REQUIRE_COLOR(look(t, SDFGI_DEBUG_WOKE), SHADE, 0.05 * SHADE, 0.02 * SHADE, ROUNDING);
    gi_test_update(t, 1);
    REQUIRE_COLOR(look(t, SDFGI_DEBUG_WOKE), SHADE, 0.35 * SHADE, 0, ROUNDING);
    REQUIRE_CMP((int)sdfgi_instance_destroy(t->gi, box), ==, (int)SDFGI_OK);
    REQUIRE_CMP((int)sdfgi_light_destroy(t->gi, light), ==, (int)SDFGI_OK);
}

/* ---- Probes */

/* Plates a cell apart leave the probe at (2, 0, 0) no place to stand. It shows through them. A lamp that is a
 * hundred times as bright as what was there begins the history of a probe anew. */
static void probes_show_their_state(void **state)
{
    struct gi_test *t = *state;
    const struct sdfgi_settings settings = light_settings(32, (float)CELL_M);
    gi_test_renew(t, &settings);
    for (int i = 0; i < 10; i++) {
        const double x = 0.875 + i * CELL_M;
        light_add_box(t, (double[]){ x, -1.2, -1.2 }, (double[]){ x + 0.05, 1.2, 1.2 },
                      (float[]){ 0.5f, 0.5f, 0.5f }, 0);
    }
    light_set_uniform_sky(t, 0.01f);
    gi_test_update(t, 1);
    const double before[3] = { -1, 0, 0 }, between[3] = { 0.4, 0, 0 };
    REQUIRE_COLOR(debug_look(t, SDFGI_DEBUG_PROBES_STATE, before, 0), 1, 0.85, 0, 0.01);
    const double behind = 0.6 * 0.1 * SHADE;
    REQUIRE_COLOR(debug_look(t, SDFGI_DEBUG_PROBES_STATE, between, 0), 0.4 + behind, 0.4 * 0.05 + behind,
                  0.4 * 0.02 + behind, 0.01);
    REQUIRE_COLOR(debug_look(t, SDFGI_DEBUG_PROBES_IRRADIANCE, between, 0), 0.1 * SHADE, 0.1 * SHADE,
                  0.1 * SHADE, ROUNDING);
    gi_test_update(t, 20);
    REQUIRE_COLOR(debug_look(t, SDFGI_DEBUG_PROBES_STATE, before, 0), 0.1, 0.8, 0.1, 0.01);
    light_set_uniform_sky(t, 1);
    gi_test_update(t, 2);
    REQUIRE_COLOR(debug_look(t, SDFGI_DEBUG_PROBES_STATE, before, 0), 1, 0.35, 0, 0.01);
}

/* A cell over open ground sees the four probes above it. Where nothing occludes, all eight count. */
static void visibility_counts_the_probes_of_a_cage(void **state)
{
    struct gi_test *t = *state;
    const struct sdfgi_settings settings = light_settings(32, (float)CELL_M);
    gi_test_renew(t, &settings);
    light_add_box(t, (double[]){ -3.5, -1.6, -3.5 }, (double[]){ 3.5, -1, 3.5 },
                  (float[]){ 0.5f, 0.5f, 0.5f }, 0);
    gi_test_update(t, 2);
    const double above[3] = { 1, 0, 1 };
    REQUIRE_COLOR(debug_look(t, SDFGI_DEBUG_VISIBILITY, above, 3), 1, 1, 0, ROUNDING);
    struct sdfgi_settings blind = settings;
    blind.use_occlusion = false;
    REQUIRE_CMP((int)sdfgi_set_settings(t->gi, &blind), ==, (int)SDFGI_OK);
    gi_test_update(t, 2);
    REQUIRE_COLOR(debug_look(t, SDFGI_DEBUG_VISIBILITY, above, 3), 0, 1, 0, ROUNDING);
}

/* ---- Leaks, and what is no number */

static void write_words(struct gi_test *t, enum resource resource, void *words, uint64_t size)
{
    gpu_test_buffer_write(&t->gpu, t->gi->volume.resources->buffers[resource].handle, 0, size, words);
    free(words);
}

static void fill_atlas(struct gi_test *t, uint16_t half)
{
    uint64_t size;
    uint16_t *texels = gi_test_read(t, RESOURCE_IRRADIANCE, &size);
    for (uint64_t i = 0; i < size / 2; i++)
        texels[i] = i % 4 < 3 ? half : 0x3c00; /* a gain of 1 */
    write_words(t, RESOURCE_IRRADIANCE, texels, size);
}

static void fill_sums(struct gi_test *t, float value)
{
    uint64_t size;
    float *sums = gi_test_read(t, RESOURCE_SUMS, &size);
    for (uint64_t i = 0; i < size / 4; i += 4)
        sums[i] = value;
    write_words(t, RESOURCE_SUMS, sums, size);
}

/* A dark room: nothing emits and no light is on. */
static void light_in_the_air_that_no_surface_gathers_is_red(void **state)
{
    struct gi_test *t = *state;
    const struct sdfgi_settings settings = cell_settings();
    gi_test_renew(t, &settings);
    add_room(t, 0);
    const struct sdfgi_light_desc sun = light_sun(0, -1, 0, 1);
    light_create(t, &sun); /* outside */
    gi_test_converge(t, 400);
    REQUIRE_COLOR(look(t, SDFGI_DEBUG_LEAKS), 0.25, 0.25, 0.25, 0.01);
    fill_atlas(t, 0x2e66); /* 0.1 */
    REQUIRE_COLOR(look(t, SDFGI_DEBUG_LEAKS), 1, 0.05, 0.02, 0.01);
    const uint16_t bad[] = { 0x7c00, 0x7e00, 0xfc00 }; /* infinity, NaN, -infinity */
    for (int i = 0; i < 3; i++) {
        fill_atlas(t, bad[i]);
        REQUIRE_COLOR(look(t, SDFGI_DEBUG_LEAKS), 1, 0, 1, 0);
    }
    fill_atlas(t, 0);
    fill_sums(t, INFINITY);
    REQUIRE_COLOR(look(t, SDFGI_DEBUG_LEAKS), 1, 0, 1, 0);
    fill_sums(t, 0);
    REQUIRE_COLOR(look(t, SDFGI_DEBUG_LEAKS), 0.25, 0.25, 0.25, 0.01);
}

/* A word of the surfaces at the largest value that they hold. */
static void light_that_was_cut_is_yellow(void **state)
{
    struct gi_test *t = *state;
    uint64_t size;
    uint32_t *words = gi_test_read(t, RESOURCE_SURFACES, &size);
    for (uint64_t i = 0; i < size / 4; i++)
        words[i] = words[i] < SDFGI_SURFACE_UNKNOWN ? SDFGI_SURFACE_UNKNOWN - 1 : words[i];
    write_words(t, RESOURCE_SURFACES, words, size);
    REQUIRE_COLOR(look(t, SDFGI_DEBUG_LEAKS), 1, 0.85, 0, ROUNDING);
    REQUIRE_COLOR(look(t, SDFGI_DEBUG_IRRADIANCE), 1, 1, 1, 0.001);
}

/* ---- Surfaces of which there is nothing to tell */

static void what_is_not_known_is_purple(void **state)
{
    struct gi_test *t = *state;
    const struct sdfgi_settings settings = light_settings(32, (float)CELL_M);
    gi_test_renew(t, &settings);
    light_add_box(t, (double[]){ 1, -1, -1 }, (double[]){ 2, 1, 1 }, (float[]){ 0.5f, 0.5f, 0.5f }, 0);
    gi_test_update(t, 2);
    /* Probes alone answer: cells gather nothing. */
    REQUIRE_COLOR(look(t, SDFGI_DEBUG_CONFIDENCE), 0.25, 0, 0.3, ROUNDING);
    REQUIRE_COLOR(look(t, SDFGI_DEBUG_AGE), 0.25, 0, 0.3, ROUNDING);
    REQUIRE_COLOR(look(t, SDFGI_DEBUG_IRRADIANCE), 0, 0, 0, ROUNDING);
}

TEST_GROUP(debug_light)
{
    if (!gpu_test_available())
        return GPU_TEST_SKIP;
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(light_in_a_furnace_is_grey_of_known_value),
        cmocka_unit_test(probes_are_balls_of_their_irradiance),
        cmocka_unit_test(settled_cells_and_probes_are_green_and_grey),
        cmocka_unit_test(what_changes_is_coloured_until_it_has_settled),
        cmocka_unit_test(probes_show_their_state),
        cmocka_unit_test(visibility_counts_the_probes_of_a_cage),
        cmocka_unit_test(light_in_the_air_that_no_surface_gathers_is_red),
        cmocka_unit_test(light_that_was_cut_is_yellow),
        cmocka_unit_test(what_is_not_known_is_purple),
    };
    return cmocka_run_group_tests(tests, open_furnace, close_context);
}
