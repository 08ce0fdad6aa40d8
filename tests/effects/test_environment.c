/* SPDX-License-Identifier: MIT
 * A picture of all directions: it is the background, the right way round, and GI gets its harmonics.
 */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "fog_scene.h"
#include "host_internal.h"
#include "host_test.h"
#include "require.h"
#include "test_group.h"

#include <math.h>
#include <string.h>

enum { MAP_WIDTH = 64, MAP_HEIGHT = 32 };

static struct host_device *device;
static float map[3 * MAP_WIDTH * MAP_HEIGHT];

/* Radiance from a direction: a number for each of the six that it is nearest to. */
static float light_from(const double d[3])
{
    int axis = 0;
    for (int i = 1; i < 3; i++)
        if (fabs(d[i]) > fabs(d[axis]))
            axis = i;
    return (float)(1 + 2 * axis + (d[axis] < 0));
}

/* Rows go down, columns from +Z by -X, -Z and +X. */
static void map_fill(bool uniform)
{
    for (int y = 0; y < MAP_HEIGHT; y++)
        for (int x = 0; x < MAP_WIDTH; x++) {
            const double down = 3.14159265 * (y + 0.5) / MAP_HEIGHT;
            const double around = 6.2831853 * (x + 0.5) / MAP_WIDTH;
            const double d[3] = { -sin(down) * sin(around), cos(down), sin(down) * cos(around) };
            for (int c = 0; c < 3; c++)
                map[3 * (y * MAP_WIDTH + x) + c] = uniform ? 2 : light_from(d) * (float)(c + 1);
        }
}

static struct fog_scene scene_with_map(const struct fog_box *box)
{
    struct fog_scene scene = fog_scene_empty(0);
    scene.boxes = box;
    scene.box_count = 1;
    scene.view.environment = (struct host_environment){ map, MAP_WIDTH, MAP_HEIGHT };
    return scene;
}

static const struct fog_box far_box = { { 0, -500, 0 }, { 1, 1, 1 }, .color = { 0.5f, 0.5f, 0.5f, 1 } };

static void the_background_is_the_map_the_right_way_round(void **state)
{
    (void)state;
    static const double looks[6][3] = { { 1, 0, 0 },  { -1, 0, 0 }, { 0, 1, 0 },
                                        { 0, -1, 0 }, { 0, 0, 1 },  { 0, 0, -1 } };
    static float rgba[4 * FOG_PIXELS];
    map_fill(false);
    for (int i = 0; i < 6; i++) {
        struct fog_scene scene = scene_with_map(&far_box);
        memcpy(scene.view.camera.look_at, looks[i], sizeof looks[i]);
        if (fabs(looks[i][1]) > 0)
            memcpy(scene.view.camera.up, (const float[]){ 0, 0, 1 }, sizeof scene.view.camera.up);
        fog_scene_draw(device, &scene, rgba);
        const float *const middle = rgba + 4 * (FOG_HEIGHT / 2 * FOG_WIDTH + FOG_WIDTH / 2);
        for (int c = 0; c < 3; c++)
            REQUIRE_NEAR(middle[c], (float)((i + 1) * (c + 1)), 0.02);
    }
}

/* sqrt(4 pi) of the radiance in the first, and nothing in the others. */
static void an_even_map_is_an_even_sky(void **state)
{
    (void)state;
    map_fill(true);
    const struct fog_scene scene = scene_with_map(&far_box);
    struct fog_stage stage;
    fog_stage_open(&stage, device, &scene);
    const struct sdfgi_sky_harmonics *const sky = &stage.scene->environment.harmonics;
    for (int c = 0; c < 3; c++) {
        REQUIRE_NEAR(sky->coefficients[0][c], 2 * 3.5449077f, 1e-3);
        for (int i = 1; i < 9; i++)
            REQUIRE_NEAR(sky->coefficients[i][c], 0, 0.02);
    }
    fog_stage_close(&stage);
}

/* Convex and in the open: a white box is as bright as the sky around it. */
static void a_white_box_under_an_even_map_vanishes(void **state)
{
    (void)state;
    static const struct fog_box box = { { 0, 0, -4 }, { 1, 1, 1 }, .color = { 1, 1, 1, 1 } };
    static float rgba[4 * FOG_PIXELS];
    map_fill(true);
    struct fog_scene scene = scene_with_map(&box);
    scene.gi = true;
    fog_scene_draw(device, &scene, rgba);
    const float *const middle = rgba + 4 * (FOG_HEIGHT / 2 * FOG_WIDTH + FOG_WIDTH / 2);
    for (int c = 0; c < 3; c++)
        REQUIRE_NEAR(middle[c], 2, 0.1);
}

TEST_GROUP(environment)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_background_is_the_map_the_right_way_round),
        cmocka_unit_test(an_even_map_is_an_even_sky),
        cmocka_unit_test(a_white_box_under_an_even_map_vanishes),
    };
    device = host_test_open();
    if (!device)
        return HOST_TEST_SKIP;
    return host_test_close(device, cmocka_run_group_tests(tests, NULL, NULL));
}
