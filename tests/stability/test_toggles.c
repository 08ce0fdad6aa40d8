/* SPDX-License-Identifier: MIT
 * What is switched on and off in every frame: the light in the mean, and what is held. */
#include "light_scene.h"

#include "hard_case.h"
#include "require.h"
#include "test_group.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

static const struct gi_test_point points[] = {
    { { 0.2f, -1.9f, 0.3f }, { 0, 1, 0 } },
    { { 1.9f, -1, 0.4f }, { -1, 0, 0 } },
    { { -0.7f, -1.9f, -1.2f }, { 0, 1, 0 } },
};
enum { POINTS = sizeof points / sizeof *points };

static sdfgi_light open_corner(struct gi_test *t, const struct sdfgi_settings *settings,
                               const struct sdfgi_light_desc *lamp)
{
    gi_test_open(t, settings);
    light_add_box(t, (double[]){ -3, -3, -3 }, (double[]){ 3, -2, 3 }, (float[]){ 0.7f, 0.7f, 0.7f }, 0);
    light_add_box(t, (double[]){ 2, -2, -3 }, (double[]){ 3, 1, 3 }, (float[]){ 0.2f, 0.6f, 0.3f }, 0);
    light_add_box(t, (double[]){ -3, -2, -3 }, (double[]){ 2, 1, -2 }, (float[]){ 0.6f, 0.6f, 0.6f }, 0);
    return light_create(t, lamp);
}

static bool is_full(void)
{
    return getenv("SDFGI_TEST_FULL") != NULL;
}

static double mean_light(struct gi_test *t)
{
    float found[POINTS][3];
    double sum = 0;
    gi_test_irradiance(t, points, POINTS, found);
    for (int i = 0; i < POINTS; i++)
        sum += (double)found[i][1] / POINTS;
    return sum;
}

/* Mean of the light over `frames` under a lamp that is switched in every frame, over its light if it stays
 * on.
 */
static double toggled_part(const struct sdfgi_settings *settings, uint32_t warm, uint32_t frames)
{
    struct gi_test t;
    const struct sdfgi_light_desc on = light_point(0.3, 0.2, 0.1, 20), off = light_point(0.3, 0.2, 0.1, 0);
    const sdfgi_light lamp = open_corner(&t, settings, &on);
    gi_test_converge(&t, 2000);
    const double steady = mean_light(&t);
    double sum = 0;
    for (uint32_t i = 0; i < warm + frames; i++) {
        REQUIRE_CMP(sdfgi_light_update(t.gi, lamp, i % 2 ? &on : &off), ==, SDFGI_OK);
        gi_test_update(&t, 1);
        sum += i >= warm ? mean_light(&t) : 0;
    }
    gi_test_close(&t);
    return sum / frames / steady;
}

static struct sdfgi_settings ring(uint32_t frames, uint32_t rays)
{
    struct sdfgi_settings settings = light_settings(32, 0.25f);
    settings.frames_to_converge = frames;
    settings.ray_count = rays;
    return settings;
}

/* The same figure for all ways in which light is gathered. */
static void require_half(const char *what, const struct sdfgi_settings *settings, uint32_t warm,
                         uint32_t frames)
{
    const double half = 2 * toggled_part(settings, warm, frames);
    printf("%s: %.4f of half\n", what, half);
    HARD_CASE_AT_LEAST(52, "mean of a toggled light over half of it", half, 0.95);
    HARD_CASE_AT_MOST(52, "mean of a toggled light over half of it, at most", half, 1.05);
}

static void hard_52_a_lamp_that_is_toggled_in_each_frame_gives_half_of_its_light(void **state)
{
    (void)state;
    static const uint32_t frames[] = { 4, 3, 5, 20 };
    for (int i = 0; i < (is_full() ? 4 : 1); i++) {
        const struct sdfgi_settings settings = ring(frames[i], frames[i] == 20 ? 25 : 125);
        char what[64];
        snprintf(what, sizeof what, "probes, a ring of %u frames", frames[i]);
        require_half(what, &settings, 3 * frames[i] + 20, 4 * frames[i]);
    }
    struct sdfgi_settings settings = ring(4, 125);
    settings.surface_light = SDFGI_SURFACE_LIGHT_CELLS;
    settings.cell_rays = 64;
    settings.min_cell_size_m = 0.5f;
    require_half("light cells", &settings, 34, 34); /* two epochs each */
}

/* ---- Settings */

static void hand_over(struct gi_test *t, const struct sdfgi_settings *settings)
{
    REQUIRE_CMP((int)sdfgi_set_settings(t->gi, settings), ==, (int)SDFGI_OK);
    gi_test_update(t, 1);
}

static uint64_t held(const struct gi_test *t)
{
    static struct sdfgi_report report;
    sdfgi_get_report(t->gi, &report);
    return report.memory.total_bytes;
}

static uint32_t retired_count(const struct gi_test *t)
{
    uint32_t count = 0;
    for (const struct gpu_retired *item = t->gi->backend.retired.first; item; item = item->next)
        count++;
    return count;
}

/* A key that is held down on the switch, a slider that is dragged: of each kind of setting one. */
static struct sdfgi_settings toggled(const struct sdfgi_settings *base, uint32_t frame)
{
    struct sdfgi_settings s = *base;
    s.enabled = frame % 2;
    if (frame % 6 >= 2)
        s.enabled = true;
    if (frame % 6 == 3)
        s.use_occlusion = false;
    if (frame % 6 == 5)
        s.energy = 2;
    return s;
}

static void hard_52_settings_that_are_toggled_in_each_frame_leave_nothing(void **state)
{
    (void)state;
    const uint32_t frames = is_full() ? 600 : 60;
    struct gi_test t;
    const struct sdfgi_settings settings = ring(4, 125);
    const struct sdfgi_light_desc lamp = light_point(0.3, 0.2, 0.1, 20);
    uint64_t most = 0;
    open_corner(&t, &settings, &lamp);
    gi_test_converge(&t, 400);
    const double light = mean_light(&t);
    const uint64_t before = held(&t);
    for (uint32_t i = 0; i < frames; i++) {
        const struct sdfgi_settings changed = toggled(&settings, i);
        hand_over(&t, &changed);
        most = held(&t) > most ? held(&t) : most;
        /* What a frame replaces waits for the frames in flight: three frames' resources at most. */
        REQUIRE_CMP(retired_count(&t), <=, 3u);
    }
    hand_over(&t, &settings);
    gi_test_converge(&t, 400);
    printf("%llu bytes before, %llu at most, %llu after\n", (unsigned long long)before,
           (unsigned long long)most, (unsigned long long)held(&t));
    HARD_CASE_AT_MOST(52, "bytes held after settings were toggled, over those before",
                      (double)held(&t) / (double)before, 1);
    HARD_CASE_AT_MOST(52, "light after settings were toggled, relative difference",
                      fabs(mean_light(&t) / light - 1), 0.005);
    gi_test_close(&t);
}

TEST_GROUP(toggles)
{
    if (!gpu_test_available())
        return GPU_TEST_SKIP;
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(hard_52_a_lamp_that_is_toggled_in_each_frame_gives_half_of_its_light),
        cmocka_unit_test(hard_52_settings_that_are_toggled_in_each_frame_leave_nothing),
    };
    return cmocka_run_group_tests_name("stability_toggles", tests, NULL, NULL);
}
