/* SPDX-License-Identifier: MIT
 * Rooms that a camera enters faster than sample cycles end: their probes are new, and those of coarser
 * cascades stand outside under the sky. What the room settles at is shown from the first frames on. */
#include "light_scene.h"
#include "require.h"
#include "test_group.h"
#include "scroll_scene.h"

#include <math.h>
#include <stdio.h>

enum { POINTS = 48, FRAMES = 12 };

static const double half[3] = { 3, 1.4, 2.5 }, wall = 0.3;
static const float viewer[3] = { 0.1f, 0.2f, -0.1f };

/* `window`: share of the wall at +x that is open along either side. */
static void add_room(struct gi_test *t, double window)
{
    const float a[3] = { 0.7f, 0.7f, 0.7f };
    const double x = half[0], y = half[1], z = half[2], w = wall, u = window * y, v = window * z;
    light_add_box(t, (double[]){ -x - w, -y - w, -z - w }, (double[]){ x + w, -y, z + w }, a, 0);
    light_add_box(t, (double[]){ -x - w, y, -z - w }, (double[]){ x + w, y + w, z + w }, a, 0);
    light_add_box(t, (double[]){ -x - w, -y, -z - w }, (double[]){ x + w, y, -z }, a, 0);
    light_add_box(t, (double[]){ -x - w, -y, z }, (double[]){ x + w, y, z + w }, a, 0);
    light_add_box(t, (double[]){ -x - w, -y, -z }, (double[]){ -x, y, z }, a, 0);
    light_add_box(t, (double[]){ x, -y, -z }, (double[]){ x + w, -u, z }, a, 0);
    light_add_box(t, (double[]){ x, u, -z }, (double[]){ x + w, y, z }, a, 0);
    if (window > 0) {
        light_add_box(t, (double[]){ x, -u, -z }, (double[]){ x + w, u, -v }, a, 0);
        light_add_box(t, (double[]){ x, -u, v }, (double[]){ x + w, u, z }, a, 0);
    }
}

/* On floor, ceiling and the walls at -z and +z. */
static void place_points(struct gi_test_point points[static POINTS])
{
    for (int i = 0; i < POINTS; i++) {
        const int axis = 1 + i / 24, sign = i / 12 % 2 ? 1 : -1;
        struct gi_test_point point = { 0 };
        point.position[axis] = (float)(sign * half[axis]);
        point.normal[axis] = (float)-sign;
        point.position[0] = (float)(2.4 * (2.0 * (i % 4) / 3 - 1));
        point.position[3 - axis] = (float)(half[3 - axis] * 0.8 * (i / 4 % 3 - 1));
        points[i] = point;
    }
}

/* Lookups read all that is complete: what probes hold is looked at, not how borders move. */
static void open_borders(struct gi_test *t)
{
    for (uint32_t c = 0; c < t->gi->settings.cascades; c++)
        for (int i = 0; i < 3; i++) {
            t->gi->volume.state.cascades.at[c].blend_low[i] = -1e6;
            t->gi->volume.state.cascades.at[c].blend_high[i] = 1e6;
        }
}

static double mean_light(struct gi_test *t)
{
    struct gi_test_point points[POINTS];
    float found[POINTS][3];
    double sum = 0;
    place_points(points);
    gi_test_irradiance_from(t, viewer, points, POINTS, found);
    for (int i = 0; i < POINTS; i++) {
        REQUIRE_TRUE(isfinite(found[i][1]));
        sum += (double)found[i][1];
    }
    return sum / POINTS;
}

struct arrival {
    double window, lamp, away_m, speed_m; /* `speed_m` from frame to frame */
    uint32_t rays;
};

/* Flies into the room from outside and stops. Light from the frame of arrival on, over what it settles at. */
static void arrive(const struct arrival *a, double ratio[static FRAMES])
{
    static struct gi_test t;
    struct sdfgi_settings settings = light_settings(32, 0.2f);
    settings.cascades = 4;
    settings.ray_count = a->rays;
    settings.frames_to_converge = light_cycle_samples() / a->rays;
    gi_test_open(&t, &settings);
    add_room(&t, a->window);
    light_add_box(&t, (double[]){ -400, -4.4, -400 }, (double[]){ 400, -half[1] - wall, 400 },
                  (float[]){ 0.4f, 0.4f, 0.4f }, 0);
    light_set_uniform_sky(&t, 1);
    const struct sdfgi_light_desc sun = light_sun(-0.5f, -0.8f, 0.2f, 5),
                                  lamp = light_point(0.3, 0.6 * half[1], 0.2, (float)a->lamp);
    light_create(&t, &sun);
    if (a->lamp > 0)
        light_create(&t, &lamp);
    double camera[3] = { viewer[0], viewer[1], viewer[2] - a->away_m };
    scroll_stand(&t, camera);
    gi_test_converge(&t, 400);
    for (int i = 1; i < (int)lround(a->away_m / a->speed_m) + FRAMES; i++) {
        camera[2] = fmin(camera[2] + a->speed_m, viewer[2]);
        scroll_stand(&t, camera);
        open_borders(&t);
        gi_test_update(&t, 1);
        const int frame = i - (int)lround(a->away_m / a->speed_m);
        if (frame >= 0)
            ratio[frame] = mean_light(&t);
    }
    gi_test_converge(&t, 400);
    const double settled = mean_light(&t);
    for (int i = 0; i < FRAMES; i++)
        ratio[i] /= settled;
    printf("window %.1f, lamp %.0f W/sr, %.1f m a frame: %.4f W/m^2; on arrival %.2f of it, then %.2f %.2f, "
           "%.2f in the end\n",
           a->window, a->lamp, a->speed_m, settled, ratio[0], ratio[1], ratio[2], ratio[FRAMES - 1]);
    gi_test_close(&t);
}

/* Half a metre a frame is 30 m/s. Outside it is five times as bright. */
static void a_room_with_a_window_is_not_lit_by_the_sky(void **state)
{
    (void)state;
    double ratio[FRAMES];
    arrive(&(struct arrival){ .window = 0.4, .away_m = 15, .speed_m = 0.5, .rays = 25 }, ratio);
    for (int i = 0; i < FRAMES; i++) {
        REQUIRE_CMP(ratio[i], >=, 0.65);
        REQUIRE_CMP(ratio[i], <=, 1.2);
    }
    REQUIRE_CMP(ratio[FRAMES - 1], >=, 0.85);
}

/* So fast that the finest cascade keeps nothing: what the room holds is found out within one frame. */
static void a_dark_room_is_dark_in_the_first_frame(void **state)
{
    (void)state;
    double ratio[FRAMES];
    arrive(&(struct arrival){ .away_m = 60, .speed_m = 5, .rays = 125 }, ratio);
    for (int i = 1; i < FRAMES; i++)
        REQUIRE_CMP(ratio[i], <=, 1.2);
}

static void a_room_with_a_lamp_fills_with_light(void **state)
{
    (void)state;
    double ratio[FRAMES];
    arrive(&(struct arrival){ .lamp = 5, .away_m = 60, .speed_m = 5, .rays = 125 }, ratio);
    REQUIRE_CMP(ratio[1], >=, 0.25);
    REQUIRE_CMP(ratio[FRAMES - 1], >=, 0.7);
    for (int i = 2; i < FRAMES; i++) {
        REQUIRE_CMP(ratio[i], >=, 0.99 * ratio[i - 1]);
        REQUIRE_CMP(ratio[i], <=, 1.02);
    }
}

TEST_GROUP(rooms)
{
    if (!gpu_test_available())
        return GPU_TEST_SKIP;
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_room_with_a_window_is_not_lit_by_the_sky),
        cmocka_unit_test(a_dark_room_is_dark_in_the_first_frame),
        cmocka_unit_test(a_room_with_a_lamp_fills_with_light),
    };
    return cmocka_run_group_tests_name("scroll_rooms", tests, NULL, NULL);
}
