/* SPDX-License-Identifier: MIT
 * Light read at single points, which `sdfgi walk --sample` plots: the same as pictures show, near and far. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "far_stage.h"
#include "test_group.h"

#include <math.h>
#include <string.h>

enum { POINTS = 16 };

static struct host_device *device;

/* Points of the floor, away from walls. */
static void floor_points(const double shift[3], struct host_sample samples[POINTS])
{
    for (int i = 0; i < POINTS; i++)
        samples[i] = (struct host_sample){
            { shift[0] + 2.5 + 0.75 * (i % 4), shift[1], shift[2] + 1.5 + 0.75 * (i / 4) }, { 0, 1, 0 }
        };
}

/* Where a point is in the picture; false if it is outside. */
static bool pixel_of(const struct host_camera *camera, const double point[3], uint32_t *pixel)
{
    double forward[3], to_point[3], right[3], up[3], length = 0;
    for (int i = 0; i < 3; i++) {
        forward[i] = camera->look_at[i] - camera->position[i];
        to_point[i] = point[i] - camera->position[i];
        length += forward[i] * forward[i];
    }
    for (int i = 0; i < 3; i++)
        forward[i] /= sqrt(length);
    const double side = hypot(forward[0], forward[2]);
    right[0] = -forward[2] / side, right[1] = 0, right[2] = forward[0] / side;
    up[0] = right[1] * forward[2] - right[2] * forward[1];
    up[1] = right[2] * forward[0] - right[0] * forward[2];
    up[2] = right[0] * forward[1] - right[1] * forward[0];
    double x = 0, y = 0, z = 0;
    for (int i = 0; i < 3; i++) {
        x += right[i] * to_point[i];
        y += up[i] * to_point[i];
        z += forward[i] * to_point[i];
    }
    const double tangent = tan(0.5 * (double)camera->yfov_rad);
    const double column = (x / (z * tangent * FAR_WIDTH / FAR_HEIGHT) * 0.5 + 0.5) * FAR_WIDTH;
    const double row = (0.5 - y / (z * tangent) * 0.5) * FAR_HEIGHT;
    *pixel = (uint32_t)row * FAR_WIDTH + (uint32_t)column;
    return z > 0 && column >= 0 && column < FAR_WIDTH && row >= 0 && row < FAR_HEIGHT;
}

/* A pixel's middle is up to half a pixel, here 4 cm, off, and its viewer is elsewhere: within 3 %. */
static void a_point_has_the_light_that_the_picture_shows(void **state)
{
    (void)state;
    static const double at_origin[3];
    static float picture[4 * FAR_PIXELS];
    struct host_sample samples[POINTS];
    float light[POINTS][3];
    struct far_stage stage;
    far_stage_open(&stage, device, at_origin, true, 0);
    floor_points(at_origin, samples);
    assert_true(host_renderer_sample(stage.renderer, samples, POINTS, light));
    assert_true(host_renderer_read_aov(stage.renderer, HOST_AOV_IRRADIANCE, picture));
    int compared = 0;
    for (int i = 0; i < POINTS; i++) {
        uint32_t pixel;
        if (!pixel_of(&stage.view.camera, samples[i].position, &pixel))
            continue;
        compared++;
        for (int c = 0; c < 3; c++) {
            const float shown = picture[4 * pixel + c];
            if (!(shown > 0.1f) || !(fabsf(light[i][c] / shown - 1) < 0.03f))
                fail_msg("point %d, channel %d: %g sampled, %g in the picture", i, c, (double)light[i][c],
                         (double)shown);
        }
    }
    assert_true(compared > POINTS / 2);
    far_stage_close(&stage);
}

/* Where the 32 bits that number probes repeat, the light has to be bit for bit the same. */
static void far_out_the_light_is_the_same(void **state)
{
    (void)state;
    static const double shifts[2][3] = { { 0, 0, 0 }, { 17179869184, 17179869184, -17179869184 } };
    struct host_sample samples[POINTS];
    float light[2][POINTS][3];
    for (int i = 0; i < 2; i++) {
        struct far_stage stage;
        far_stage_open(&stage, device, shifts[i], true, 0);
        floor_points(shifts[i], samples);
        assert_true(host_renderer_sample(stage.renderer, samples, POINTS, light[i]));
        far_stage_close(&stage);
    }
    assert_memory_equal(light[0], light[1], sizeof light[0]);
}

static void without_gi_there_is_nothing_to_sample(void **state)
{
    (void)state;
    static const double at_origin[3];
    struct host_sample samples[POINTS];
    float light[POINTS][3];
    struct far_stage stage;
    far_stage_open(&stage, device, at_origin, false, 0);
    floor_points(at_origin, samples);
    assert_false(host_renderer_sample(stage.renderer, samples, POINTS, light));
    assert_non_null(strstr(host_device_error(device), "off"));
    far_stage_close(&stage);
}

TEST_GROUP(samples)
{
    const int code = far_place_open(&device);
    if (code)
        return code;
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_point_has_the_light_that_the_picture_shows),
        cmocka_unit_test(far_out_the_light_is_the_same),
        cmocka_unit_test(without_gi_there_is_nothing_to_sample),
    };
    return far_place_close(device, cmocka_run_group_tests(tests, NULL, NULL));
}
