/* SPDX-License-Identifier: MIT
 * Journeys leave the same bytes behind as when they were recorded: each frame's buffers, irradiance,
 * lookups and report. They tell that a change of the code changed a result, and where first; not which of the
 * two is right. Where a result is meant to change, record anew: SDFGI_TEST_RECORD=1, and say why in the
 * commit. */
#include "journey.h"
#include "journey_book.h"
#include "journey_things.h"
#include "light_scene.h"
#include "require.h"
#include "scroll_scene.h"

#include <vulkan/vulkan.h>

#include <stdio.h>

/* A cycle of 100 samples in 4 frames: journeys see several end. */
static struct sdfgi_settings short_cycles(uint32_t cascades)
{
    struct sdfgi_settings settings = light_exact_settings(32, 0.25f);
    settings.cascades = cascades;
    settings.ray_count = 25;
    settings.surface_light = SDFGI_SURFACE_LIGHT_CELLS;
    settings.cell_rays = 128;
    settings.cell_rays_per_frame = 1 << 15;
    return settings;
}

static void a_scene_built_from_nothing_is_as_recorded(void **state)
{
    (void)state;
    struct journey j;
    struct journey_poster poster;
    struct sdfgi_settings settings = short_cycles(3);
    settings.ray_count = 50;
    journey_open(&j, "build", &settings);
    scroll_world(&j.t, (double[]){ 0, 0, 0 }, 10);
    journey_poster_add(&poster, &j.t);
    journey_screen_open(&j.screen, &j.t);
    double camera[3] = { 0.3, 0.2, -0.4 };
    journey_walk(&j, camera, (double[]){ 0, 0, 0 }, 14);
    journey_poster_destroy(&poster, &j.t);
    journey_close(&j);
}

/* Boxes around what goes and comes lie across x, and where the way is along z alone, across that. */
static void a_walk_along_an_axis_is_as_recorded(void **state)
{
    (void)state;
    struct journey j;
    const struct sdfgi_settings settings = short_cycles(3);
    journey_open(&j, "walk", &settings);
    scroll_world(&j.t, (double[]){ 6, 0, -4 }, 12);
    double camera[3] = { 0.3, 0.2, -0.4 };
    journey_walk(&j, camera, (double[]){ 1.7, 0, 0 }, 8);
    journey_walk(&j, camera, (double[]){ 0, 0, -2.3 }, 5);
    journey_stay(&j, camera, 3);
    journey_close(&j);
}

/* The other way to do each of it: rasteriser, flood, depths around probes, flat cells. */
static void a_walk_with_other_methods_is_as_recorded(void **state)
{
    (void)state;
    struct journey j;
    struct sdfgi_settings settings = short_cycles(2);
    settings.voxelizer = SDFGI_VOXELIZER_RASTER;
    settings.sdf_method = SDFGI_SDF_FLOOD;
    settings.visibility = SDFGI_VISIBILITY_PROBE_DEPTH;
    settings.y_scale = SDFGI_Y_SCALE_50;
    settings.frames_to_update_lights = 2;
    journey_open(&j, "methods", &settings);
    scroll_world(&j.t, (double[]){ 0, 0, 2 }, 8);
    double camera[3] = { 0.1, 0.2, 0.3 };
    journey_walk(&j, camera, (double[]){ 0.2, 0.5, 1.2 }, 6);
    journey_stay(&j, camera, 2);
    journey_close(&j);
}

/* Of 64 cells a side, so that the fine cascade claims more than the budget and has to wait. */
static void a_flight_across_all_axes_is_as_recorded(void **state)
{
    (void)state;
    struct journey j;
    struct sdfgi_settings settings = short_cycles(2);
    settings.resolution = 64;
    settings.min_cell_size_m = 0.2f;
    settings.ray_count = 5;
    settings.frames_to_converge = 5;
    settings.max_scroll_cells = 524288;
    settings.y_scale = SDFGI_Y_SCALE_75;
    journey_open(&j, "flight", &settings);
    scroll_air(&j.t, (double[]){ -4, -2, -4 }, 14);
    double camera[3] = { 9, 4, 7 };
    journey_walk(&j, camera, (double[]){ -4.1, -2.3, -3.2 }, 7);
    journey_walk(&j, camera, (double[]){ 1.1, 2.2, 0.4 }, 2);
    journey_stay(&j, camera, 4);
    journey_close(&j);
}

static void a_jump_far_away_and_back_is_as_recorded(void **state)
{
    (void)state;
    struct journey j;
    struct sdfgi_settings settings = short_cycles(2);
    settings.use_occlusion = false;
    journey_open(&j, "teleport", &settings);
    scroll_world(&j.t, (double[]){ 0, 0, 0 }, 8);
    light_add_box(&j.t, (double[]){ -4003, -310, 8001 }, (double[]){ -3999, -302, 8004 },
                  (float[]){ 0.5f, 0.6f, 0.7f }, 2);
    double here[3] = { 0.3, 0.2, -0.4 }, there[3] = { -4000.7, -300.2, 8000.3 };
    journey_walk(&j, here, (double[]){ 0.8, 0, 0.1 }, 6);
    memcpy(j.t.frame.origin, (double[]){ -4000, -300, 8000 }, sizeof j.t.frame.origin);
    journey_walk(&j, there, (double[]){ 0, 0.9, 0 }, 6);
    memset(j.t.frame.origin, 0, sizeof j.t.frame.origin);
    journey_walk(&j, here, (double[]){ 0, 0, 0 }, 6);
    journey_close(&j);
}

static const double edit_step[3] = { 0.6, 0, 0.1 };

static void edit_boxes(struct journey *j, double camera[static 3], sdfgi_material material)
{
    const sdfgi_mesh mesh = journey_box_mesh(&j->t);
    const sdfgi_material lamp =
        gi_test_material(&j->t, (float[]){ 0.2f, 0.2f, 0.1f }, (float[]){ 1, 1, 0.5f });
    struct sdfgi_transform at[3] = { journey_at(1, 0.3, -1, 1.5f), journey_at(2, 1, 0.5, 0.7f),
                                     journey_at(2, -1, 1, 2) };
    const sdfgi_instance box = journey_add(&j->t, mesh, material, &at[0], SDFGI_STATIC),
                         light = journey_add(&j->t, mesh, lamp, &at[1], SDFGI_STATIC);
    journey_add(&j->t, mesh, material, &at[2], SDFGI_EXCLUDED);
    journey_walk(j, camera, edit_step, 3);
    at[0].translation[1] = 1.4;
    at[0].basis[0] = -0.5f; /* mirrored */
    REQUIRE_CMP(sdfgi_instance_set_transform(j->t.gi, box, &at[0]), ==, SDFGI_OK);
    journey_walk(j, camera, edit_step, 2);
    REQUIRE_CMP(sdfgi_instance_destroy(j->t.gi, light), ==, SDFGI_OK);
    REQUIRE_CMP(sdfgi_invalidate_box(j->t.gi, (double[]){ 3, -2, -1 }, (double[]){ 4.5, 1, 2 }), ==,
                SDFGI_OK);
    journey_walk(j, camera, edit_step, 3);
    REQUIRE_CMP(sdfgi_mesh_destroy(j->t.gi, mesh), ==, SDFGI_OK);
}

/* The shelves have more light cells than the list has room for: it grows. */
static void edit_shelves(struct journey *j, double camera[static 3], sdfgi_material material)
{
    const uint64_t size = journey_buffer_size(j, "LIGHT_CELLS");
    const sdfgi_instance shelves = journey_add_shelves(&j->t, camera, material);
    journey_walk(j, camera, edit_step, 5);
    REQUIRE_CMP(journey_buffer_size(j, "LIGHT_CELLS"), >, size);
    REQUIRE_CMP(sdfgi_instance_destroy(j->t.gi, shelves), ==, SDFGI_OK);
    journey_walk(j, camera, edit_step, 4);
}

static void edits_along_the_way_are_as_recorded(void **state)
{
    (void)state;
    struct journey j;
    const struct sdfgi_settings settings = short_cycles(2);
    journey_open(&j, "edits", &settings);
    scroll_world(&j.t, (double[]){ 4, 0, 0 }, 10);
    double camera[3] = { 0.3, 0.2, -0.4 };
    journey_walk(&j, camera, edit_step, 3);
    const sdfgi_material red = gi_test_material(&j.t, (float[]){ 0.8f, 0.2f, 0.1f }, (float[]){ 0, 0, 0 });
    edit_boxes(&j, camera, red);
    edit_shelves(&j, camera, red);
    journey_close(&j);
}

static void change_lights(struct journey *j, const double camera[static 3])
{
    struct sdfgi_light_desc desc = light_point(1.2, 1.5, -0.7, 25);
    const sdfgi_light lamp = light_create(&j->t, &desc);
    journey_stay(j, camera, 2);
    desc.position[0] = -1.1;
    desc.intensity[0] = 60;
    desc.casts_shadow = false;
    REQUIRE_CMP(sdfgi_light_update(j->t.gi, lamp, &desc), ==, SDFGI_OK);
    desc = (struct sdfgi_light_desc){ .type = SDFGI_LIGHT_SPOT,
                                      .position = { 0.4, 2, 0.3 },
                                      .direction = { 0.1f, -1, 0.3f },
                                      .intensity = { 20, 40, 30 },
                                      .range_m = 6,
                                      .inner_angle_rad = 0.2f,
                                      .outer_angle_rad = 0.7f,
                                      .indirect_energy = 1.5f,
                                      .casts_shadow = true };
    light_create(&j->t, &desc);
    journey_stay(j, camera, 2);
    REQUIRE_CMP(sdfgi_light_destroy(j->t.gi, lamp), ==, SDFGI_OK);
    journey_stay(j, camera, 2);
}

static void change_sky_and_exposure(struct journey *j, const double camera[static 3])
{
    light_set_uniform_sky(&j->t, 0.3f);
    journey_stay(j, camera, 2);
    j->t.frame.exposure = 600;
    journey_stay(j, camera, 2);
}

/* Sun and sky change a little in each frame; a lamp is switched meanwhile. */
static void pass_the_day(struct journey *j, const double camera[static 3])
{
    struct sdfgi_light_desc sun = light_sun(0.3f, -1, 0.2f, 8);
    const struct sdfgi_light_desc lamp = light_point(0.4, 1, 0.8, 12);
    const sdfgi_light light = light_create(&j->t, &sun);
    journey_stay(j, camera, 1);
    for (int frame = 0; frame < 20; frame++) {
        sun.direction[0] += 0.0004f;
        REQUIRE_CMP(sdfgi_light_update(j->t.gi, light, &sun), ==, SDFGI_OK);
        light_set_uniform_sky(&j->t, 0.3f - 0.0001f * (float)frame);
        if (frame == 12)
            light_create(&j->t, &lamp);
        if (frame % 10 < 8)
            gi_test_update(&j->t, 1);
        else
            journey_stay(j, camera, 1);
    }
}

/* A material brighter than all others changes the unit of emission: everything is made again. */
static void change_materials(struct journey *j, const double camera[static 3])
{
    const sdfgi_material unused =
        gi_test_material(&j->t, (float[]){ 0.3f, 0.3f, 0.9f }, (float[]){ 9, 7, 5 });
    journey_stay(j, camera, 2);
    REQUIRE_CMP(sdfgi_material_destroy(j->t.gi, unused), ==, SDFGI_OK);
    journey_stay(j, camera, 2);
}

static void change_settings(struct journey *j, const double camera[static 3], struct sdfgi_settings *settings)
{
    settings->energy = 1.7f;
    settings->bounce_feedback = 0.5f;
    settings->normal_bias_cells = 0.7f;
    REQUIRE_CMP(sdfgi_set_settings(j->t.gi, settings), ==, SDFGI_OK);
    journey_stay(j, camera, 2);
    settings->read_sky_light = false;
    REQUIRE_CMP(sdfgi_set_settings(j->t.gi, settings), ==, SDFGI_OK);
    journey_stay(j, camera, 2);
}

/* Off, and on again with another sample cycle and without feedback: light settles, and the frames after that
 * do nothing. */
static void settle(struct journey *j, const double camera[static 3], struct sdfgi_settings *settings)
{
    settings->enabled = false;
    REQUIRE_CMP(sdfgi_set_settings(j->t.gi, settings), ==, SDFGI_OK);
    journey_stay(j, camera, 1);
    settings->enabled = true;
    settings->visibility = SDFGI_VISIBILITY_PROBE_DEPTH;
    settings->surface_light = SDFGI_SURFACE_LIGHT_PROBES;
    settings->frames_to_converge = 1;
    settings->bounce_feedback = 0;
    REQUIRE_CMP(sdfgi_set_settings(j->t.gi, settings), ==, SDFGI_OK);
    journey_stay(j, camera, 7);
    static struct sdfgi_report report;
    sdfgi_get_report(j->t.gi, &report);
    REQUIRE_TRUE(report.converged);
}

static void changes_of_light_and_sky_are_as_recorded(void **state)
{
    (void)state;
    struct journey j;
    struct sdfgi_settings settings = short_cycles(2);
    journey_open(&j, "light", &settings);
    scroll_world(&j.t, (double[]){ 0, 0, 0 }, 8);
    const double camera[3] = { 0.3, 0.2, -0.4 };
    journey_stay(&j, camera, 3);
    change_lights(&j, camera);
    change_sky_and_exposure(&j, camera);
    pass_the_day(&j, camera);
    change_settings(&j, camera, &settings);
    change_materials(&j, camera);
    settle(&j, camera, &settings);
    journey_close(&j);
}

enum { JOURNEYS = 7 };

static void every_pass_ran_in_some_journey(void **state)
{
    (void)state;
    if (journey_count() < JOURNEYS)
        skip();
    if (journey_passes_missing()[0])
        require_fail(__FILE__, __LINE__, "passes that ran in no journey:%s", journey_passes_missing());
}

/* Name and versions of the device that tests run on. The name of lavapipe's tells its vector width, and with
 * it the instructions that it compiles to. */
static void print_device(char *text, size_t size)
{
    struct gpu_test gpu;
    gpu_test_open(&gpu, NULL);
    VkPhysicalDeviceDriverProperties driver = {
        .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_DRIVER_PROPERTIES,
    };
    VkPhysicalDeviceProperties2 properties = {
        .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2,
        .pNext = &driver,
    };
    vkGetPhysicalDeviceProperties2(gpu.physical_device, &properties);
    snprintf(text, size, "%s, %s %s, version %u", gpu.properties.deviceName, driver.driverName,
             driver.driverInfo, gpu.properties.driverVersion);
    gpu_test_close(&gpu);
}

int main(int count, char **arguments)
{
    char device[1024];
    if (!gpu_test_available())
        return GPU_TEST_SKIP;
    if (count != 2) {
        fprintf(stderr, "usage: %s FILE\n", arguments[0]);
        return 1;
    }
    print_device(device, sizeof device);
    if (!journey_book_open(arguments[1], device))
        return GPU_TEST_SKIP;
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_scene_built_from_nothing_is_as_recorded),
        cmocka_unit_test(a_walk_along_an_axis_is_as_recorded),
        cmocka_unit_test(a_walk_with_other_methods_is_as_recorded),
        cmocka_unit_test(a_flight_across_all_axes_is_as_recorded),
        cmocka_unit_test(a_jump_far_away_and_back_is_as_recorded),
        cmocka_unit_test(edits_along_the_way_are_as_recorded),
        cmocka_unit_test(changes_of_light_and_sky_are_as_recorded),
        cmocka_unit_test(every_pass_ran_in_some_journey),
    };
    const int failed = cmocka_run_group_tests(tests, NULL, NULL);
    return journey_book_close(failed == 0) ? failed : 1;
}
