/* SPDX-License-Identifier: MIT
 * What is shown while sample cycles are not complete: nothing where light stays, all of it soon where light
 * changes (PITFALLS: flicker, change). */
#include "light_scene.h"
#include "require.h"
#include "test_group.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { POINTS = 48 };

struct room {
    struct gi_test t;
    struct gi_test_point points[POINTS];
    float light[POINTS][3];
    sdfgi_light lamp;
};

static const double half = 2.5;

static void place_points(struct gi_test_point points[static POINTS])
{
    for (int i = 0; i < POINTS; i++) {
        const int axis = 1 + i / 24, sign = i / 12 % 2 ? 1 : -1;
        struct gi_test_point point = { 0 };
        point.position[axis] = (float)(sign * half);
        point.normal[axis] = (float)-sign;
        point.position[0] = (float)(2 * (2.0 * (i % 4) / 3 - 1));
        point.position[3 - axis] = (float)(2 * (i / 4 % 3 - 1));
        points[i] = point;
    }
}

/* A box, red and green to the sides, open at the front, with a lamp; 25 rays a frame and 20 frames a cycle,
 * as by default. The cascade holds the box; in suite `full` there is another one around it. */
static struct sdfgi_settings room_settings(void)
{
    struct sdfgi_settings settings = light_settings(32, 0.2f);
    settings.cascades = getenv("SDFGI_TEST_FULL") ? 2 : 1;
    settings.ray_count = 25;
    settings.frames_to_converge = 20;
    return settings;
}

static void room_open(struct room *r, const struct sdfgi_settings *settings,
                      const struct sdfgi_light_desc *lamp)
{
    gi_test_open(&r->t, settings);
    const float red[3] = { 0.63f, 0.065f, 0.05f }, green[3] = { 0.14f, 0.45f, 0.09f },
                white[3] = { 0.73f, 0.71f, 0.68f };
    const double h = half, out = half + 0.3;
    light_add_box(&r->t, (double[]){ -out, -out, -h }, (double[]){ -h, out, h }, red, 0);
    light_add_box(&r->t, (double[]){ h, -out, -h }, (double[]){ out, out, h }, green, 0);
    light_add_box(&r->t, (double[]){ -h, -out, -h }, (double[]){ h, -h, h }, white, 0);
    light_add_box(&r->t, (double[]){ -h, h, -h }, (double[]){ h, out, h }, white, 0);
    light_add_box(&r->t, (double[]){ -out, -out, -out }, (double[]){ out, out, -h }, white, 0);
    place_points(r->points);
    r->lamp = light_create(&r->t, lamp);
    gi_test_converge(&r->t, 2000);
}

static double room_look(struct room *r)
{
    double sum = 0;
    gi_test_irradiance_from(&r->t, (float[]){ 0.1f, 0.2f, -0.1f }, r->points, POINTS, r->light);
    for (int i = 0; i < POINTS; i++)
        sum += (double)r->light[i][1];
    return sum / POINTS;
}

static void room_set_lamp(struct room *r, const struct sdfgi_light_desc *lamp)
{
    REQUIRE_CMP(sdfgi_light_update(r->t.gi, r->lamp, lamp), ==, SDFGI_OK);
}

/* Cycles start over and over; their directions, and so what they find, are the same. */
static void light_that_stays_is_shown_unchanged(void **state)
{
    (void)state;
    static struct room r;
    const struct sdfgi_settings settings = room_settings();
    const struct sdfgi_light_desc lamp = light_point(0.2, 0.7 * half, -0.1, 20);
    room_open(&r, &settings, &lamp);
    room_look(&r);
    double worst = 0;
    for (int frame = 0; frame < 30; frame++) {
        float before[POINTS][3];
        memcpy(before, r.light, sizeof before);
        sdfgi_accumulation_invalidate(&r.t.gi->volume.state.accumulation);
        gi_test_update(&r.t, 1);
        room_look(&r);
        for (int i = 0; i < 3 * POINTS; i++)
            worst = fmax(worst, fabs((double)r.light[i / 3][i % 3] / (double)before[i / 3][i % 3] - 1));
    }
    printf("light that stays changes by at most %.3f %% a frame\n", 100 * worst);
    REQUIRE_CMP(worst, <=, 0.005);
    gi_test_close(&r.t);
}

enum { FRAMES = 40 };

/* The light that is shown in each frame after a lamp is switched. */
static void watch(struct room *r, const struct sdfgi_light_desc *lamp, double shown[static FRAMES])
{
    room_set_lamp(r, lamp);
    for (int i = 0; i < FRAMES; i++) {
        gi_test_update(&r->t, 1);
        shown[i] = room_look(r);
    }
}

/* Frames until nine tenths of a change are shown. */
static int frames_to_follow(const double shown[static FRAMES], double before, double after)
{
    int frames = 0;
    while (frames < FRAMES && fabs(shown[frames] - after) > 0.1 * fabs(after - before))
        frames++;
    for (int i = 0; i < FRAMES; i++)
        REQUIRE_CMP(fabs(shown[i] - after), <=, 1.02 * fabs(after - before));
    return frames + 1;
}

static void switch_a_lamp(const struct sdfgi_settings *settings, int most_on, int most_off)
{
    static struct room r;
    const struct sdfgi_light_desc dim = light_point(0.2, 0.7 * half, -0.1, 2),
                                  bright = light_point(0.2, 0.7 * half, -0.1, 40);
    room_open(&r, settings, &dim);
    double switched_on[FRAMES], switched_off[FRAMES];
    const double dark = room_look(&r);
    watch(&r, &bright, switched_on);
    gi_test_converge(&r.t, 2000);
    const double lit = room_look(&r);
    watch(&r, &dim, switched_off);
    const int on = frames_to_follow(switched_on, dark, lit), off = frames_to_follow(switched_off, lit, dark);
    printf("nine tenths are shown %d frames after a lamp is switched on, %d after it is switched off\n", on,
           off);
    REQUIRE_CMP(on, <=, most_on);
    REQUIRE_CMP(off, <=, most_off);
    gi_test_close(&r.t);
}

static void a_lamp_that_is_switched_shows_within_few_frames(void **state)
{
    (void)state;
    const struct sdfgi_settings settings = room_settings();
    switch_a_lamp(&settings, 14, 20);
}

/* A gather cycle has more visits than frames are given: the light that is shown is that of a part of one. In
 * suite `full` it has those of the defaults, and cells are smaller. */
static void light_cells_show_a_lamp_that_is_switched_within_ten_frames(void **state)
{
    (void)state;
    struct sdfgi_settings settings = room_settings();
    settings.surface_light = SDFGI_SURFACE_LIGHT_CELLS;
    if (!getenv("SDFGI_TEST_FULL")) {
        settings.cell_rays = 12 * SDFGI_VISIT_RAYS;
        settings.min_cell_size_m = 0.4f;
    }
    switch_a_lamp(&settings, 10, 10);
}

/* Second differences tell noise from the way light goes. 2 mm a frame is 0.12 m/s. */
static void light_follows_a_slow_lamp_without_noise(void **state)
{
    (void)state;
    static struct room r;
    const struct sdfgi_settings settings = room_settings();
    struct sdfgi_light_desc lamp = light_point(1.5, 0, 0, 20);
    room_open(&r, &settings, &lamp);
    float before[2][POINTS][3];
    double noise = 0;
    int count = 0;
    for (int frame = 0; frame < 80; frame++) {
        const double angle = 0.002 / 1.5 * frame;
        lamp = light_point(1.5 * cos(angle), 0, 1.5 * sin(angle), 20);
        room_set_lamp(&r, &lamp);
        gi_test_update(&r.t, 1);
        room_look(&r);
        for (int i = 0; i < POINTS && frame >= 40; i++, count++) {
            const double e = (double)r.light[i][1],
                         second = e - 2 * (double)before[0][i][1] + (double)before[1][i][1];
            noise += second * second / (e * e);
        }
        memcpy(before[1], before[0], sizeof before[0]);
        memcpy(before[0], r.light, sizeof before[0]);
    }
    noise = sqrt(noise / count);
    printf("second differences under a lamp that moves 2 mm a frame: %.3f %% rms\n", 100 * noise);
    REQUIRE_CMP(noise, <=, 0.005);
    gi_test_close(&r.t);
}

TEST_GROUP(change)
{
    if (!gpu_test_available())
        return GPU_TEST_SKIP;
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(light_that_stays_is_shown_unchanged),
        cmocka_unit_test(a_lamp_that_is_switched_shows_within_few_frames),
        cmocka_unit_test(light_cells_show_a_lamp_that_is_switched_within_ten_frames),
        cmocka_unit_test(light_follows_a_slow_lamp_without_noise),
    };
    return cmocka_run_group_tests_name("stability_change", tests, NULL, NULL);
}
