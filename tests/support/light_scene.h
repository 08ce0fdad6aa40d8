/* SPDX-License-Identifier: MIT
 * Scenes whose light is known exactly: what their tests share. */
#ifndef TEST_LIGHT_SCENE_H
#define TEST_LIGHT_SCENE_H

#include "gi_test.h"

#define PI 3.14159265358979323846

/* Setup and teardown of a group of tests: their state is a context with light_settings(32, 0.25f). */
int light_open(void **state);
int light_close(void **state);

/* Samples of a probe in a cycle: 250, or 500 with SDFGI_TEST_FULL=1. */
uint32_t light_cycle_samples(void);
/* Settles in few frames: 125 samples in each. */
struct sdfgi_settings light_settings(uint32_t resolution, float cell_m);
/* Likewise with 500 samples in any case: for tests that allow less noise, or compare with records. */
struct sdfgi_settings light_exact_settings(uint32_t resolution, float cell_m);
/* light_settings with 64 rays per surface of a light cell, or 128 with SDFGI_TEST_FULL=1, for light that may
 * be a little noisy. */
struct sdfgi_settings light_quick_settings(uint32_t resolution, float cell_m);

/* light_settings for light cells that gather for themselves, all of them in each frame. */
struct sdfgi_settings light_cell_settings(uint32_t resolution, float cell_m);

sdfgi_instance light_add(struct gi_test *t, struct test_mesh mesh, float albedo, float emission);
/* Of metal. With a smoothness of 0 it counts as diffuse. */
sdfgi_instance light_add_metal(struct gi_test *t, struct test_mesh mesh, float albedo, float smoothness);
/* An axis-aligned box between two corners. */
sdfgi_instance light_add_box(struct gi_test *t, const double low[static 3], const double high[static 3],
                             const float albedo[static 3], float emission);
/* What is v in a world with +Y up, in one with `up`; sdfgi/sky.h, backwards. */
void light_turn(enum sdfgi_up_axis up, const double v[static 3], double out[static 3]);
/* The box that lies in the test's world as one between two corners does in a world with +Y up. */
sdfgi_instance light_add_turned_box(struct gi_test *t, const double a[static 3], const double b[static 3],
                                    const float albedo[static 3]);
/* A ball that emits outwards, of this intensity in all directions. */
void light_add_ball(struct gi_test *t, const double center[static 3], double radius, double watts_per_sr);
/* White lights. `direction` is the way the light travels. */
struct sdfgi_light_desc light_sun(float x, float y, float z, float irradiance);
struct sdfgi_light_desc light_point(double x, double y, double z, float intensity);
sdfgi_light light_create(struct gi_test *t, const struct sdfgi_light_desc *desc);
/* A sky different along every axis and every pair of axes: brighter towards +X, +Y and a direction between -Z
 * and +X; nowhere below 0. */
extern const struct sdfgi_sky_harmonics light_tinted_sky;
void light_set_uniform_sky(struct gi_test *t, float radiance);

/* Irradiance at one point; all channels finite and not negative. */
void light_at(struct gi_test *t, struct gi_test_point point, float irradiance[static 3]);
/* The same where light is white: the green channel. */
double light_white_at(struct gi_test *t, struct gi_test_point point);

/* How often the last report counted a health code. */
uint64_t light_health(struct gi_test *t, enum sdfgi_message code);

#endif
