/* SPDX-License-Identifier: MIT */
#include "light_scene.h"

#include "require.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

const struct sdfgi_sky_harmonics light_tinted_sky = { .coefficients = { { 3.5f, 3, 2.5f },
                                                                        { 0.5f, 0.4f, 0.3f },
                                                                        { -0.3f, 0.1f, 0.2f },
                                                                        { 0.6f, 0.2f, -0.1f },
                                                                        { 0.1f, 0.2f, 0 },
                                                                        { -0.2f, 0.1f, 0.1f },
                                                                        { 0.2f, -0.1f, 0.3f },
                                                                        { 0.3f, 0, -0.2f },
                                                                        { -0.1f, 0.25f, 0.1f } } };

int light_open(void **state)
{
    static struct gi_test t;
    const struct sdfgi_settings settings = light_settings(32, 0.25f);
    gi_test_open(&t, &settings);
    *state = &t;
    return 0;
}

int light_close(void **state)
{
    gi_test_close(*state);
    return 0;
}

uint32_t light_cycle_samples(void)
{
    return getenv("SDFGI_TEST_FULL") ? 500 : 250;
}

struct sdfgi_settings light_settings(uint32_t resolution, float cell_m)
{
    struct sdfgi_settings s = gi_test_settings();
    s.resolution = resolution;
    s.min_cell_size_m = cell_m;
    s.ray_count = 125;
    s.frames_to_converge = light_cycle_samples() / s.ray_count;
    return s;
}

struct sdfgi_settings light_exact_settings(uint32_t resolution, float cell_m)
{
    struct sdfgi_settings s = light_settings(resolution, cell_m);
    s.frames_to_converge = 4;
    return s;
}

struct sdfgi_settings light_quick_settings(uint32_t resolution, float cell_m)
{
    struct sdfgi_settings s = light_settings(resolution, cell_m);
    s.cell_rays = getenv("SDFGI_TEST_FULL") ? 128 : 64;
    return s;
}

struct sdfgi_settings light_cell_settings(uint32_t resolution, float cell_m)
{
    struct sdfgi_settings s = light_settings(resolution, cell_m);
    s.surface_light = SDFGI_SURFACE_LIGHT_CELLS;
    s.cell_rays_per_frame = 1 << 20;
    return s;
}

sdfgi_instance light_add(struct gi_test *t, struct test_mesh mesh, float albedo, float emission)
{
    const float a[3] = { albedo, albedo, albedo }, e[3] = { emission, emission, emission };
    const sdfgi_instance instance = gi_test_add(t, &mesh, gi_test_material(t, a, e));
    test_mesh_destroy(&mesh);
    return instance;
}

sdfgi_instance light_add_metal(struct gi_test *t, struct test_mesh mesh, float albedo, float smoothness)
{
    const struct sdfgi_material_desc desc = { .albedo = { albedo, albedo, albedo },
                                              .smoothness = smoothness,
                                              .metallic = 1 };
    sdfgi_material material;
    REQUIRE_CMP((int)sdfgi_material_create(t->gi, &desc, &material), ==, (int)SDFGI_OK);
    const sdfgi_instance instance = gi_test_add(t, &mesh, material);
    test_mesh_destroy(&mesh);
    return instance;
}

void light_add_ball(struct gi_test *t, const double center[static 3], double radius, double watts_per_sr)
{
    const float emission = (float)(watts_per_sr / (PI * radius * radius));
    const struct sdfgi_material_desc desc = { .alpha = 1, .emission = { emission, emission, emission } };
    sdfgi_material material;
    REQUIRE_CMP((int)sdfgi_material_create(t->gi, &desc, &material), ==, (int)SDFGI_OK);
    struct test_mesh ball = test_mesh_sphere(center, radius, 3);
    gi_test_add(t, &ball, material);
    test_mesh_destroy(&ball);
}

sdfgi_instance light_add_box(struct gi_test *t, const double low[static 3], const double high[static 3],
                             const float albedo[static 3], float emission)
{
    double center[3], half[3];
    for (int i = 0; i < 3; i++) {
        center[i] = (low[i] + high[i]) / 2;
        half[i] = (high[i] - low[i]) / 2;
    }
    struct test_mesh mesh = test_mesh_box(center, half, test_rotation_none);
    const sdfgi_instance instance =
        gi_test_add(t, &mesh, gi_test_material(t, albedo, (float[3]){ emission, emission, emission }));
    test_mesh_destroy(&mesh);
    return instance;
}

void light_turn(enum sdfgi_up_axis up, const double v[static 3], double out[static 3])
{
    const double worlds[][3] = { [SDFGI_UP_Y] = { v[0], v[1], v[2] },
                                 [SDFGI_UP_Z] = { v[0], -v[2], v[1] },
                                 [SDFGI_UP_MINUS_Y] = { v[0], -v[1], -v[2] },
                                 [SDFGI_UP_MINUS_Z] = { v[0], v[2], -v[1] } };
    memcpy(out, worlds[up], sizeof worlds[up]);
}

sdfgi_instance light_add_turned_box(struct gi_test *t, const double a[static 3], const double b[static 3],
                                    const float albedo[static 3])
{
    double low[3], high[3], from[3], to[3];
    light_turn(t->up_axis, a, from);
    light_turn(t->up_axis, b, to);
    for (int i = 0; i < 3; i++) {
        low[i] = fmin(from[i], to[i]);
        high[i] = fmax(from[i], to[i]);
    }
    return light_add_box(t, low, high, albedo, 0);
}

struct sdfgi_light_desc light_sun(float x, float y, float z, float irradiance)
{
    return (struct sdfgi_light_desc){ .type = SDFGI_LIGHT_DIRECTIONAL,
                                      .direction = { x, y, z },
                                      .intensity = { irradiance, irradiance, irradiance },
                                      .indirect_energy = 1,
                                      .casts_shadow = true };
}

struct sdfgi_light_desc light_point(double x, double y, double z, float intensity)
{
    return (struct sdfgi_light_desc){ .type = SDFGI_LIGHT_POINT,
                                      .position = { x, y, z },
                                      .intensity = { intensity, intensity, intensity },
                                      .indirect_energy = 1,
                                      .casts_shadow = true };
}

sdfgi_light light_create(struct gi_test *t, const struct sdfgi_light_desc *desc)
{
    sdfgi_light light;
    REQUIRE_CMP(sdfgi_light_create(t->gi, desc, &light), ==, SDFGI_OK);
    return light;
}

void light_set_uniform_sky(struct gi_test *t, float radiance)
{
    struct sdfgi_sky sky;
    for (int i = 0; i < 3; i++)
        sky.zenith[i] = sky.horizon[i] = sky.ground[i] = radiance;
    REQUIRE_CMP(sdfgi_set_sky(t->gi, &sky), ==, SDFGI_OK);
}

void light_at(struct gi_test *t, struct gi_test_point point, float irradiance[static 3])
{
    float found[1][3];
    gi_test_irradiance(t, &point, 1, found);
    for (int i = 0; i < 3; i++) {
        REQUIRE_TRUE(isfinite(found[0][i]));
        REQUIRE_CMP(found[0][i], >=, 0.0f);
    }
    memcpy(irradiance, found[0], sizeof found[0]);
}

double light_white_at(struct gi_test *t, struct gi_test_point point)
{
    float irradiance[3];
    light_at(t, point, irradiance);
    return (double)irradiance[1];
}

uint64_t light_health(struct gi_test *t, enum sdfgi_message code)
{
    static struct sdfgi_report report;
    sdfgi_get_report(t->gi, &report);
    for (uint32_t i = 0; i < report.health_count; i++)
        if (report.health[i].code == code)
            return report.health[i].count;
    return 0;
}
