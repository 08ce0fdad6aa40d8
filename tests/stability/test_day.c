/* SPDX-License-Identifier: MIT
 * As a day goes by, sun and sky change a little in each frame. Light follows smoothly, and ends as if they
 * always had stood where they stop. */
#include "light_scene.h"
#include "require.h"
#include "test_group.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* A hall of 4.8 m under a roof with a hatch, through which the sun throws a patch on floor and walls. Cells
 * of 0.2 m. */
#define HALF_M   2.4
#define HEIGHT_M 2.4
#define WALL_M   0.4

enum { SIDE = 8, POINTS = SIDE * SIDE, FRAMES = 85, SETTLE = 80 };

struct day {
    struct gi_test t;
    sdfgi_light sun;
    double angle; /* of the sun from the zenith */
};

static struct sdfgi_light_desc sun_at(double angle)
{
    return light_sun((float)sin(angle), -(float)cos(angle), 0.2f, 20);
}

static void add_wall(struct gi_test *t, double x0, double y0, double z0, double x1, double y1, double z1)
{
    light_add_box(t, (double[]){ x0, y0, z0 }, (double[]){ x1, y1, z1 }, (float[]){ 0.6f, 0.6f, 0.6f }, 0);
}

static void open_hall(struct day *day, double angle)
{
    const double h = HALF_M, o = HALF_M + WALL_M, top = HEIGHT_M;
    struct sdfgi_settings settings = light_settings(32, 0.2f);
    settings.surface_light = SDFGI_SURFACE_LIGHT_CELLS;
    settings.cell_rays = 16 * SDFGI_VISIT_RAYS;
    settings.cell_rays_per_frame = 1 << 20; /* all cells in each frame */
    *day = (struct day){ .angle = angle };
    gi_test_open(&day->t, &settings);
    day->t.frame.exposure = 1;
    add_wall(&day->t, -o, -WALL_M, -o, o, 0, o);
    add_wall(&day->t, -o, 0, -o, -h, top, o);
    add_wall(&day->t, h, 0, -o, o, top, o);
    add_wall(&day->t, -h, 0, -o, h, top, -h);
    add_wall(&day->t, -h, 0, h, h, top, o);
    add_wall(&day->t, -o, top, -o, o, top + WALL_M, -0.6);
    add_wall(&day->t, -o, top, 0.6, o, top + WALL_M, o);
    add_wall(&day->t, -o, top, -0.6, -0.8, top + WALL_M, 0.6);
    add_wall(&day->t, 0.8, top, -0.6, o, top + WALL_M, 0.6);
    const struct sdfgi_light_desc desc = sun_at(angle);
    day->sun = light_create(&day->t, &desc);
}

/* The sun moves on by so many radians in each frame. */
static void go_on(struct day *day, int frames, double step)
{
    for (int i = 0; i < frames; i++) {
        const struct sdfgi_light_desc desc = sun_at(day->angle += step);
        REQUIRE_CMP((int)sdfgi_light_update(day->t.gi, day->sun, &desc), ==, (int)SDFGI_OK);
        gi_test_update(&day->t, 1);
    }
}

/* Irradiance along a wall that the sun does not reach. */
static void look(struct day *day, float (*irradiance)[3])
{
    struct gi_test_point points[POINTS];
    for (int i = 0; i < POINTS; i++) {
        const double step = 1.6 * HALF_M / (SIDE - 1);
        points[i] = (struct gi_test_point){ { (float)(-0.8 * HALF_M + step * (i % SIDE)),
                                              (float)(0.3 + 0.25 * (i / SIDE)), (float)HALF_M },
                                            { 0, 0, -1 } };
    }
    gi_test_irradiance(&day->t, points, POINTS, irradiance);
}

struct difference {
    double mean, rms; /* relative */
};

static struct difference compare(float (*found)[3], float (*exact)[3])
{
    struct difference d = { 0 };
    for (int i = 0; i < POINTS; i++) {
        const double off = (double)found[i][1] / (double)exact[i][1] - 1;
        d.mean += off / POINTS;
        d.rms += off * off / POINTS;
    }
    d.rms = sqrt(d.rms);
    return d;
}

static uint32_t lights_of(const uint32_t *direct, uint64_t room, uint32_t entry)
{
    return direct[2 * room + entry] & SDFGI_LIGHT_ALL;
}

static void require_same_direct_light(struct gi_test *a, struct gi_test *b)
{
    uint32_t *counters = gi_test_read(a, RESOURCE_COUNTERS, NULL),
             *x = gi_test_read(a, RESOURCE_DIRECT, NULL), *y = gi_test_read(b, RESOURCE_DIRECT, NULL);
    const uint64_t room = a->gi->volume.resources->extent.light_cells;
    uint32_t lit = 0, differ = 0;
    for (uint32_t i = 0; i < counters[SDFGI_COUNTER_LIGHT_CELLS]; i++) {
        const struct gi_test_direct p = gi_test_direct_at(x, room, 0, i),
                                    q = gi_test_direct_at(y, room, 0, i);
        lit += q.color != 0;
        differ += memcmp(&p, &q, sizeof p) != 0 || lights_of(x, room, i) != lights_of(y, room, i);
    }
    printf("%u light cells are in the sun, %u otherwise than if it always had stood there\n", lit, differ);
    REQUIRE_CMP(lit, >, 1000u);
    REQUIRE_CMP(differ, ==, 0u);
    free(counters);
    free(x);
    free(y);
}

/* At the beginning of an epoch, when it changes most from frame to frame: by 0.075 when cells began anew in
 * each. */
static void light_follows_a_sun_that_moves_slowly(void **state)
{
    (void)state;
    static struct day day, still;
    static float soon[POINTS][3], next[POINTS][3], late[POINTS][3], exact[POINTS][3];
    const double step = 2.5e-4; /* nine degrees in ten seconds at 60 frames a second */
    open_hall(&day, 0.3);
    gi_test_update(&day.t, 40);
    go_on(&day, FRAMES, step);
    look(&day, soon);
    go_on(&day, 1, step);
    look(&day, next);
    gi_test_update(&day.t, SETTLE);
    look(&day, late);
    open_hall(&still, day.angle);
    gi_test_update(&still.t, SETTLE);
    look(&still, exact);
    const struct difference moving = compare(soon, exact), between = compare(next, soon),
                            stopped = compare(late, exact);
    printf(
        "while the sun moves light is off by %.4f in the mean and %.4f rms, from frame to frame by %.4f rms; "
        "by %.4f and %.4f once it has stopped\n",
        moving.mean, moving.rms, between.rms, stopped.mean, stopped.rms);
    REQUIRE_CMP(moving.rms, <=, 0.05);
    REQUIRE_CMP(between.rms, <=, 0.025);
    REQUIRE_CMP(stopped.rms, <=, 0.006);
    require_same_direct_light(&day.t, &still.t);
    gi_test_close(&still.t);
    gi_test_close(&day.t);
}

TEST_GROUP(day)
{
    if (!gpu_test_available())
        return GPU_TEST_SKIP;
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(light_follows_a_sun_that_moves_slowly),
    };
    return cmocka_run_group_tests_name("day", tests, NULL, NULL);
}
