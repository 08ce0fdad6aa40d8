/* SPDX-License-Identifier: MIT
 * Light in the air: what a medium scatters agrees with what surfaces at the same place get. */
#include "gpu_test_compute.h"
#include "light_scene.h"
#include "require.h"
#include "test_group.h"

#include "air_light.comp.h"
#include "air_light_software.comp.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

/* As air_light.comp has it. Radiance; irradiance in W/m^2. */
struct sample {
    float position[4], direction[4];
    float mean[3], known, towards[4];
    float irradiance[4], surface[4], transparent[4];
};

enum { DIRECTIONS = 128 };

static void look_up(struct gi_test *t, struct sample *samples, uint32_t count)
{
    const struct gpu_test_shader shader = GI_TEST_SHADER(t->gi, sdfgi_get_descriptor_set(t->gi), air_light);
    gpu_test_compute(&t->gpu, &shader, count, samples, count * sizeof *samples);
}

/* Spread evenly over the sphere. */
static void set_direction(struct sample *sample, int i)
{
    const double y = 1 - (2 * i + 1.0) / DIRECTIONS, angle = 2.39996323 * i, flat = sqrt(1 - y * y);
    sample->direction[0] = (float)(flat * cos(angle));
    sample->direction[1] = (float)y;
    sample->direction[2] = (float)(flat * sin(angle));
}

/* All directions at one place. */
static void set_around(const float position[static 3], struct sample samples[DIRECTIONS])
{
    memset(samples, 0, DIRECTIONS * sizeof *samples);
    for (int i = 0; i < DIRECTIONS; i++) {
        memcpy(samples[i].position, position, 3 * sizeof(float));
        set_direction(&samples[i], i);
    }
}

/* A room of 3 m whose walls reflect one half and glow with 1. */
static void open_furnace(struct gi_test *t, const struct sdfgi_settings *settings)
{
    gi_test_restart(t, settings);
    light_add(t, test_mesh_room((double[]){ 0, 0, 0 }, (double[]){ 1.5, 1.5, 1.5 }, 0.25, test_rotation_none),
              0.5f, 1);
}

static void a_furnace_is_even_in_the_air(void **state)
{
    struct gi_test *t = *state;
    const struct sdfgi_settings settings = light_settings(32, 0.25f);
    open_furnace(t, &settings);
    gi_test_converge(t, 200);
    static const float places[][3] = { { 0, 0, 0 }, { 1.2f, -0.4f, 0.3f }, { -1.3f, -1.3f, 1.3f } };
    struct sample samples[DIRECTIONS];
    for (int p = 0; p < 3; p++) {
        double worst = 0;
        set_around(places[p], samples);
        look_up(t, samples, DIRECTIONS);
        for (int i = 0; i < DIRECTIONS; i++)
            for (int c = 0; c < 3; c++) {
                worst = fmax(worst, fabs((double)samples[i].mean[c] / 2 - 1));
                worst = fmax(worst, fabs((double)samples[i].towards[c] / 2 - 1));
            }
        printf("furnace, place %d: off by %.4f, known %.3f\n", p, worst, (double)samples[0].known);
        REQUIRE_CMP(worst, <=, 0.02);
        REQUIRE_NEAR(samples[0].known, 1, 1e-6);
    }
}

static void nothing_is_known_within_a_wall(void **state)
{
    struct gi_test *t = *state;
    struct sample sample = { .position = { 1.55f, 0.1f, 0.2f }, .direction = { 0, 1, 0 } };
    look_up(t, &sample, 1);
    REQUIRE_TRUE(sample.known == 0 && sample.mean[1] == 0 && sample.towards[1] == 0);
}

static void the_mean_of_a_gradient_sky_is_exact(void **state)
{
    struct gi_test *t = *state;
    const struct sdfgi_settings settings = light_settings(32, 0.25f);
    gi_test_restart(t, &settings);
    const struct sdfgi_sky sky = { { 3, 3, 3 }, { 1, 1, 1 }, { 0.2f, 0.2f, 0.2f } };
    REQUIRE_CMP(sdfgi_set_sky(t->gi, &sky), ==, SDFGI_OK);
    gi_test_converge(t, 60);
    struct sample samples[] = { { .position = { 0.4f, 0.2f, -0.3f }, .direction = { 0, 1, 0 } },
                                { .position = { 500, 2, 1 }, .direction = { 0, 1, 0 } } };
    const double exact = 0.5 + 0.25 * 3.2;
    look_up(t, samples, 2);
    for (int i = 0; i < 2; i++) {
        printf("gradient sky, %s: mean %.4f, exact %.4f; known %.3f\n", i ? "far out" : "in the cascade",
               (double)samples[i].mean[1], exact, (double)samples[i].known);
        REQUIRE_NEAR(samples[i].mean[1], exact, 0.01 * exact);
        REQUIRE_NEAR(samples[i].known, 1, 1e-6);
    }
}

/* A black room of 6 m of which one wall, at x = -2.5 m, glows with a radiance of 1. */
static void open_black_room(struct gi_test *t, const struct sdfgi_settings *settings)
{
    const float black[3] = { 0, 0, 0 };
    gi_test_restart(t, settings);
    light_add(t, test_mesh_room((double[]){ 0, 0, 0 }, (double[]){ 3, 3, 3 }, 0.25, test_rotation_none), 0,
              0);
    light_add_box(t, (double[]){ -3, -3, -3 }, (double[]){ -2.5, 3, 3 }, black, 1);
}

/* The share of all directions that the glowing wall fills: a rectangle between the foot of the perpendicular
 * and a corner fills atan(a b / (d sqrt(a^2 + b^2 + d^2))). */
static double exact_mean(const float at[static 3])
{
    const double d = (double)at[0] + 2.5;
    double angle = 0;
    for (int i = 0; i < 4; i++) {
        const double a = 3 + (i & 1 ? -1 : 1) * (double)at[1], b = 3 + (i & 2 ? -1 : 1) * (double)at[2];
        angle += atan(a * b / (d * sqrt(a * a + b * b + d * d)));
    }
    return angle / (4 * PI);
}

static void a_glowing_wall_fills_its_solid_angle(void **state)
{
    struct gi_test *t = *state;
    struct sample samples[] = { { .position = { 0.1f, 0.2f, -0.3f }, .direction = { 1, 0, 0 } },
                                { .position = { -1.2f, 1.1f, 0.9f }, .direction = { 1, 0, 0 } },
                                { .position = { 2.2f, -1, 0.6f }, .direction = { 1, 0, 0 } } };
    const struct sdfgi_settings settings = light_settings(64, 0.125f);
    open_black_room(t, &settings);
    gi_test_converge(t, 300);
    look_up(t, samples, 3);
    for (int i = 0; i < 3; i++) {
        const double exact = exact_mean(samples[i].position), found = (double)samples[i].mean[1];
        printf("place %d: mean %.4f, exact %.4f, ratio %.4f\n", i, found, exact, found / exact);
        REQUIRE_NEAR(found / exact, 1, 0.04);
    }
}

/* Irradiance at a place in the air on the axis that faces a lamp most, over what the lamp makes there. */
static double air_ratio(struct gi_test *t, const float place[static 3], const double lamp[static 3],
                        double watts_per_sr)
{
    struct sample sample = { .position = { place[0], place[1], place[2] } };
    double square = 0, most = 0;
    int axis = 0;
    for (int k = 0; k < 3; k++) {
        const double offset = lamp[k] - (double)place[k];
        square += offset * offset;
        if (fabs(offset) > fabs(most)) {
            most = offset;
            axis = k;
        }
    }
    sample.direction[axis] = most > 0 ? 1 : -1;
    look_up(t, &sample, 1);
    return (double)sample.irradiance[1] * square * sqrt(square) / (watts_per_sr * fabs(most));
}

/* The smallest ball has a sixth of a cell: most probes' rays at random miss it. The places are those of the
 * 27 probes around it, between which light is interpolated. */
static void balls_of_all_sizes_light_the_air_with_their_power(void **state)
{
    struct gi_test *t = *state;
    static const double radii[] = { 0.01, 0.1, 0.3 }, at[3] = { 0.34, 0.46, 0.54 };
    enum { PLACES = 27 };
    const struct sdfgi_settings settings = light_exact_settings(64, 0.125f);
    for (int r = 0; r < 3; r++) {
        double mean = 0, squares = 0;
        gi_test_restart(t, &settings);
        light_add_ball(t, at, radii[r], 5);
        gi_test_converge(t, 300);
        for (int i = 0; i < PLACES; i++) {
            const float place[3] = { (float)(i % 3 - 1), (float)(i / 3 % 3 - 1), (float)(i / 9 - 1) };
            const double ratio = air_ratio(t, place, at, 5);
            mean += ratio / PLACES;
            squares += (ratio - 1) * (ratio - 1) / PLACES;
        }
        printf("ball of %.2f m: mean ratio %.3f, root mean square off 1 %.3f\n", radii[r], mean,
               sqrt(squares));
        REQUIRE_NEAR(mean, 1, 0.1);
        REQUIRE_CMP(sqrt(squares), <=, 0.2);
    }
}

/* ---- One point, asked in all ways */

enum { WIDTH = 16, HEIGHT = DIRECTIONS / WIDTH, FRAMES = 32 };

/* Irradiance of opaque surfaces: a picture all of whose pixels show the point, each with the direction of a
 * sample as its normal. Depth 0 is 0.1 m nearer to the eye than the point. */
static void resolve_point(struct gi_test *t, const struct sample samples[DIRECTIONS],
                          double found[DIRECTIONS])
{
    const struct sdfgi_view_desc size = { .width = WIDTH, .height = HEIGHT };
    const float *at = samples[0].position;
    float depths[DIRECTIONS], normals[DIRECTIONS][4];
    uint16_t texels[DIRECTIONS][4];
    sdfgi_view *view = NULL;
    for (int i = 0; i < DIRECTIONS; i++) {
        depths[i] = 0.5f;
        memcpy(normals[i], samples[i].direction, sizeof normals[i]);
    }
    struct gpu_test_image depth = gi_test_gather_image(t, VK_FORMAT_R32_SFLOAT, 4, WIDTH, HEIGHT, depths),
                          normal = gi_test_gather_image(t, VK_FORMAT_R32G32B32A32_SFLOAT, 16, WIDTH, HEIGHT,
                                                        normals);
    struct sdfgi_resolve_desc desc = { .depth = depth.view, .normal = normal.view, .background_depth = 1 };
    memcpy(&desc.inverse_view_projection[8], (float[]){ 0, -0.2f, 0, 0 }, 4 * sizeof(float));
    memcpy(&desc.inverse_view_projection[12], (float[]){ at[0], at[1] + 0.1f, at[2], 1 }, 4 * sizeof(float));
    REQUIRE_CMP((int)sdfgi_view_create(t->gi, &size, &view), ==, (int)SDFGI_OK);
    gi_test_resolve(t, view, &desc);
    gpu_test_image_read(&t->gpu, view->diffuse.handle, VK_IMAGE_LAYOUT_GENERAL, VK_IMAGE_ASPECT_COLOR_BIT,
                        (VkExtent3D){ WIDTH, HEIGHT, 1 }, 8, texels);
    for (int i = 0; i < DIRECTIONS; i++)
        found[i] = (double)gi_test_half(texels[i][1]);
    sdfgi_view_destroy(t->gi, view);
    gpu_test_image_destroy(&t->gpu, &depth);
    gpu_test_image_destroy(&t->gpu, &normal);
}

/* Over the light of the brightest direction, W/m^2. */
struct difference {
    double brightest;
    double fog;         /* between what fog scatters towards a side and the air's irradiance there */
    double transparent; /* between a surface in a picture and one that is shaded where it is drawn */
    double air;         /* between a surface in a picture and the air */
};

/* How far the answers at a point differ: in all directions, or towards `facing` alone. */
static struct difference differences_at(struct gi_test *t, const float position[static 3],
                                        const float *facing)
{
    struct sample samples[DIRECTIONS];
    double opaque[DIRECTIONS];
    struct difference d = { 0 };
    set_around(position, samples);
    for (int i = 0; i < DIRECTIONS && facing; i++)
        memcpy(samples[i].direction, facing, 3 * sizeof(float));
    look_up(t, samples, DIRECTIONS);
    resolve_point(t, samples, opaque);
    for (int i = 0; i < DIRECTIONS; i++) {
        const double air = (double)samples[i].irradiance[1];
        d.brightest = fmax(d.brightest, opaque[i]);
        d.fog = fmax(d.fog, fabs((double)samples[i].towards[1] * PI - air));
        d.transparent = fmax(d.transparent, fabs((double)samples[i].surface[1] - opaque[i]));
        d.transparent = fmax(d.transparent, fabs((double)samples[i].transparent[1] - opaque[i]));
        d.air = fmax(d.air, fabs(air - opaque[i]));
    }
    d.fog /= d.brightest;
    d.transparent /= d.brightest;
    d.air /= d.brightest;
    printf("(%.2f, %.2f, %.2f)%s: fog off by %.6f, transparent by %.4f, air by %.4f; E %.3f\n",
           (double)position[0], (double)position[1], (double)position[2], facing ? " facing one way" : "",
           d.fog, d.transparent, d.air, d.brightest);
    return d;
}

static void require_same(const struct difference *d)
{
    REQUIRE_CMP(d->fog, <=, 1e-3);
    REQUIRE_CMP(d->transparent, <=, 0.01);
    REQUIRE_CMP(d->air, <=, 0.01);
}

static struct sdfgi_settings with_cells(void)
{
    struct sdfgi_settings settings = light_quick_settings(32, 0.25f);
    settings.surface_light = SDFGI_SURFACE_LIGHT_CELLS;
    return settings;
}

/* In the middle of the room there are no light cells: probes answer for surfaces, too. On a wall its light
 * cells answer, which have rays of their own, and fog right before it asks probes: in uneven light they
 * differ. */
static void opaque_transparent_and_fog_get_the_same(void **state)
{
    struct gi_test *t = *state;
    static const float places[][3] = { { 0.1f, 0.2f, -0.3f }, { -1.2f, 1.1f, 0.9f }, { 1.4f, -1, 0.6f } },
                       on_floor[] = { 0.3f, -2.99f, 0.3f }, up[] = { 0, 1, 0 };
    const struct sdfgi_settings settings = with_cells();
    open_black_room(t, &settings);
    gi_test_update(t, FRAMES);
    for (int p = 0; p < 3; p++) {
        const struct difference d = differences_at(t, places[p], NULL);
        require_same(&d);
    }
    const struct difference floor = differences_at(t, on_floor, up);
    REQUIRE_CMP(floor.fog, <=, 1e-3);
    REQUIRE_CMP(floor.transparent, <=, 0.01);
}

/* Where light is even, fog before a wall knows as much as the wall. */
static void they_get_the_same_on_walls_of_a_furnace(void **state)
{
    struct gi_test *t = *state;
    static const float on_walls[][3] = { { 1.49f, -0.4f, 0.3f }, { -1.3f, -1.49f, 1.4f } },
                       off_walls[][3] = { { -1, 0, 0 }, { 0, 1, 0 } };
    const struct sdfgi_settings settings = with_cells();
    open_furnace(t, &settings);
    gi_test_update(t, FRAMES);
    for (int i = 0; i < 2; i++) {
        const struct difference d = differences_at(t, on_walls[i], off_walls[i]);
        require_same(&d);
        REQUIRE_NEAR(d.brightest / (2 * PI), 1, 0.01);
    }
}

TEST_GROUP(air)
{
    if (!gpu_test_available())
        return GPU_TEST_SKIP;
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_furnace_is_even_in_the_air),
        cmocka_unit_test(nothing_is_known_within_a_wall),
        cmocka_unit_test(the_mean_of_a_gradient_sky_is_exact),
        cmocka_unit_test(a_glowing_wall_fills_its_solid_angle),
        cmocka_unit_test(balls_of_all_sizes_light_the_air_with_their_power),
        cmocka_unit_test(opaque_transparent_and_fog_get_the_same),
        cmocka_unit_test(they_get_the_same_on_walls_of_a_furnace),
    };
    return cmocka_run_group_tests(tests, light_open, light_close);
}
