/* SPDX-License-Identifier: MIT
 * What is blended reflects as what is opaque: a pane that lets nothing through looks like a slab. */
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

static struct host_device *device;
static float pictures[2][4 * FOG_PIXELS];

enum { PANE, BOXES = 4 };

/* A black pane on a black floor before a wall that glows. Behind the viewer stands a mirror, for which there
 * are reflections at all. */
static const struct fog_box boxes[BOXES] = {
    [PANE] = { { 0, -0.605, 0 }, { 7, 0.05, 7 }, .color = { 0, 0, 0, 1 } },
    { { 0, -1.1, 0 }, { 7, 1, 7 }, .color = { 0, 0, 0, 1 } },
    { { 0, 0.4, -3.25 }, { 6, 2, 0.5 }, .color = { 0.2f, 0.2f, 0.2f, 1 }, .emission = 3 },
    { { 0, 0, 3 }, { 0.3, 0.3, 0.3 }, .color = { 1, 1, 1, 1 }, .metal = true, .smoothness = 1 },
};

static void draw(float smoothness, bool metal, float alpha, float *rgba)
{
    struct fog_box with[BOXES];
    memcpy(with, boxes, sizeof with);
    with[PANE].smoothness = smoothness;
    with[PANE].metal = metal;
    if (metal)
        with[PANE].color[0] = with[PANE].color[1] = with[PANE].color[2] = 0.5f;
    with[PANE].color[3] = alpha;
    struct fog_scene scene = fog_scene_empty(0);
    scene.boxes = with;
    scene.box_count = BOXES;
    scene.gi = true;
    scene.frames = 16;
    scene.view.materials = HOST_MATERIALS_GLTF;
    scene.view.camera.look_at[1] = -0.35;
    fog_scene_draw(device, &scene, rgba);
}

static double light_of_pane(const float *rgba)
{
    double sum = 0;
    for (int y = FOG_HEIGHT / 2; y < FOG_HEIGHT * 9 / 10; y++)
        for (int x = FOG_WIDTH / 4; x < FOG_WIDTH * 3 / 4; x++)
            sum += (double)rgba[4 * (y * FOG_WIDTH + x)];
    return sum;
}

static void require_alike(const char *name, float smoothness, bool metal)
{
    draw(smoothness, metal, 1, pictures[0]);
    draw(smoothness, metal, 0.999f, pictures[1]);
    const double opaque = light_of_pane(pictures[0]), blended = light_of_pane(pictures[1]);
    printf("%s of roughness %.1f: blended %.4f of opaque\n", name, 1 - (double)smoothness, blended / opaque);
    REQUIRE_CMP(opaque, >, 0.0);
    REQUIRE_CMP(fabs(blended / opaque - 1), <=, 0.01);
}

static void a_rough_pane_reflects_as_a_slab(void **state)
{
    (void)state;
    require_alike("dielectric", 0.2f, false);
}

static void a_pane_of_rough_metal_reflects_as_a_slab(void **state)
{
    (void)state;
    require_alike("metal", 0.1f, true);
}

TEST_GROUP(glass)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_rough_pane_reflects_as_a_slab),
        cmocka_unit_test(a_pane_of_rough_metal_reflects_as_a_slab),
    };
    device = host_test_open();
    if (!device)
        return HOST_TEST_SKIP;
    return host_test_close(device, cmocka_run_group_tests(tests, NULL, NULL));
}
