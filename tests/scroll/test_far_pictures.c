/* SPDX-License-Identifier: MIT
 * The same scene at the world's origin and far out, through importer, host and library: the same picture. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "far_stage.h"

#include <math.h>

enum { PIXELS = FAR_PIXELS };

static const double at_origin[3], far_out[3] = { 8388608, -1048576, 8388608 };
static struct host_device *device;

/* Of the scene at the origin; the last two with GI. */
static float near_direct[4 * PIXELS], near_albedo[4 * PIXELS], near_color[4 * PIXELS],
    near_irradiance[4 * PIXELS];
static float picture[4 * PIXELS];

static void read_aov(const struct far_stage *stage, enum host_aov aov, float *rgba)
{
    if (!host_renderer_read_aov(stage->renderer, aov, rgba))
        fail_msg("%s", host_device_error(device));
}

static void draw(const double shift[3], enum host_aov aov, bool gi, uint32_t seed)
{
    struct far_stage stage;
    far_stage_open(&stage, device, shift, gi, seed);
    read_aov(&stage, aov, picture);
    far_stage_close(&stage);
}

static int draw_near(void **state)
{
    (void)state;
    struct far_stage stage;
    far_stage_open(&stage, device, at_origin, false, 0);
    read_aov(&stage, HOST_AOV_DIRECT, near_direct);
    read_aov(&stage, HOST_AOV_ALBEDO, near_albedo);
    far_stage_close(&stage);
    far_stage_open(&stage, device, at_origin, true, 0);
    read_aov(&stage, HOST_AOV_COLOR, near_color);
    read_aov(&stage, HOST_AOV_IRRADIANCE, near_irradiance);
    far_stage_close(&stage);
    return 0;
}

/* What the others would not notice, were the pictures empty or the lights without shadows. */
static void the_scene_shows_light_and_shadow(void **state)
{
    (void)state;
    uint32_t covered = 0, dark = 0, bright = 0;
    for (uint32_t i = 0; i < PIXELS; i++) {
        const float *rgb = near_direct + 4 * i, light = rgb[0] + rgb[1] + rgb[2];
        covered += near_albedo[4 * i] > 0;
        dark += near_albedo[4 * i] > 0 && light < 0.2f;
        bright += light > 2.0f;
    }
    assert_true(covered > PIXELS / 2);
    assert_true(dark > PIXELS / 100);
    assert_true(bright > PIXELS / 10);
}

/* Pixels that differ by more than 1e-5 of their brightest channel. */
static uint32_t pixels_that_differ(const float *a, const float *b)
{
    uint32_t count = 0;
    for (uint32_t i = 0; i < PIXELS; i++) {
        const float *p = a + 4 * i, *q = b + 4 * i;
        const float brightest = fmaxf(fmaxf(p[0], p[1]), fmaxf(p[2], 1e-6f));
        bool differs = false;
        for (int c = 0; c < 3; c++)
            differs = differs || !(fabsf(p[c] - q[c]) <= 1e-5f * brightest);
        count += differs;
    }
    return count;
}

static void require_same(const double shift[3], enum host_aov aov, bool gi, const float *near_picture)
{
    draw(shift, aov, gi, 0);
    const uint32_t differ = pixels_that_differ(near_picture, picture);
    if (differ > 0)
        fail_msg("moved by (%g, %g, %g) m, %u of %d pixels of %s differ", shift[0], shift[1], shift[2],
                 differ, PIXELS, host_aov_name(aov));
}

static void direct_light_and_its_shadows_are_the_same(void **state)
{
    (void)state;
    static const double closer[3] = { 1024, 1024, -1024 };
    require_same(closer, HOST_AOV_DIRECT, false, near_direct);
    require_same(far_out, HOST_AOV_DIRECT, false, near_direct);
}

/* Where the numbers of probes and cells, of which 32 bits count, are those at the origin again: the probes'
 * rays are the same there. */
static void the_whole_picture_with_gi_is_the_same(void **state)
{
    (void)state;
    static const double again[3] = { 17179869184, 17179869184, -17179869184 };
    require_same(again, HOST_AOV_COLOR, true, near_color);
}

static double rms_difference(const float *a, const float *b)
{
    double sum = 0;
    for (uint32_t i = 0; i < 4 * PIXELS; i++)
        sum += ((double)a[i] - (double)b[i]) * ((double)a[i] - (double)b[i]);
    return sqrt(sum / PIXELS);
}

static double mean(const float *rgba)
{
    double sum = 0;
    for (uint32_t i = 0; i < 4 * PIXELS; i++)
        sum += i % 4 < 3 ? (double)rgba[i] : 0.0;
    return sum / PIXELS;
}

/* A probe's rays depend on its place in the world, so that elsewhere the light has other noise: of the size
 * that another seed makes, and with the same mean. Measured for shifts of 2^10, 2^20 and 2^23 m: 0.47 to 1.12
 * times the noise, means within 7e-4. */
static void elsewhere_only_the_noise_is_another(void **state)
{
    (void)state;
    draw(at_origin, HOST_AOV_IRRADIANCE, true, 77);
    const double noise = rms_difference(near_irradiance, picture);
    assert_true(noise > 0);
    draw(far_out, HOST_AOV_IRRADIANCE, true, 0);
    const double size = rms_difference(near_irradiance, picture) / noise;
    const double ratio = mean(picture) / mean(near_irradiance);
    if (!(size < 1.5) || !(fabs(ratio - 1) < 2e-3))
        fail_msg("%.3f times the noise of a seed, mean %.5f of that at the origin", size, ratio);
}

int main(void)
{
    const int code = far_place_open(&device);
    if (code)
        return code;
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_scene_shows_light_and_shadow),
        cmocka_unit_test(direct_light_and_its_shadows_are_the_same),
        cmocka_unit_test(the_whole_picture_with_gi_is_the_same),
        cmocka_unit_test(elsewhere_only_the_noise_is_another),
    };
    return far_place_close(device, cmocka_run_group_tests(tests, draw_near, NULL));
}
