/* SPDX-License-Identifier: MIT
 * Light while the camera moves: what stays keeps its light, what is new is never black, a fixed point hardly
 * notices, and after convergence light is that of a fresh start (HARD_CASES rows 19, 23, 39 and 54). */
#include "hard_case.h"
#include "light_scene.h"
#include "require.h"
#include "test_group.h"
#include "scroll_scene.h"
#include "test_memory.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

static const double home[3] = { 0.3, 0.2, -0.4 };

static struct gi_test_point at(double x, double y, double z, float nx, float ny, float nz)
{
    return (struct gi_test_point){ { (float)x, (float)y, (float)z }, { nx, ny, nz } };
}

/* Two cascades of 32^3 cells of 0.5 m, `rays` of a probe in a frame. */
static struct sdfgi_settings light_walk_settings(uint32_t rays)
{
    struct sdfgi_settings settings = scroll_settings(32);
    settings.min_cell_size_m = 0.5f;
    settings.ray_count = rays;
    settings.frames_to_converge = light_cycle_samples() / rays;
    return settings;
}

/* Points on the ground around a place, a little above it. */
static uint32_t ground_points(const double center[static 3], struct gi_test_point *points)
{
    uint32_t count = 0;
    for (int z = -3; z <= 3; z++)
        for (int x = -3; x <= 3; x++)
            points[count++] = at(center[0] + 0.7 * x, center[1] + 2.5, center[2] + 0.7 * z, 0, 1, 0);
    return count;
}

/* Where rays end, at random and towards emitters, is the same to the bit. */
static void require_same_rays(struct gi_test *a, struct gi_test *b)
{
    uint32_t *rays[2] = { gi_test_read(a, RESOURCE_RAYS, NULL), gi_test_read(b, RESOURCE_RAYS, NULL) },
             *probes = gi_test_read(a, RESOURCE_PROBES, NULL);
    const struct extent *e = &a->gi->volume.resources->extent;
    const uint64_t words = sdfgi_extent_probe_words(e);
    REQUIRE_CMP(words, >, e->cycle_samples);
    for (uint64_t i = 0; i < e->probes * e->cascades; i++)
        if (!(probes[i] & SDFGI_PROBE_DEAD))
            REQUIRE_BYTES(rays[0] + i * words, rays[1] + i * words, words * sizeof(uint32_t));
    free(rays[0]);
    free(rays[1]);
    free(probes);
}

/* Stored light may go round in a circle of its rounding, by 1/1024 of a texel. Where in the circle it settles
 * depends on the way. */
static void hard_20_light_after_a_loop_is_that_of_a_fresh_start(void **state)
{
    (void)state;
    static struct gi_test t, fresh;
    struct sdfgi_settings settings = light_walk_settings(125);
    settings.frames_to_converge = 4; /* of fewer samples the circle is wider on a GPU */
    gi_test_open(&t, &settings);
    scroll_world(&t, home, 14);
    scroll_stand(&t, home);
    gi_test_update(&t, 6);
    const double way[4][3] = { { 4, 1, 0 }, { 6, 0, 5 }, { 1, -1, 7 }, { home[0], home[1], home[2] } };
    for (int i = 0; i < 4; i++) {
        scroll_stand(&t, way[i]);
        scroll_settle(&t);
    }
    gi_test_converge(&t, 400);
    gi_test_open(&fresh, &settings);
    scroll_world(&fresh, home, 14);
    scroll_stand(&fresh, way[3]);
    scroll_place_as(&fresh, &t);
    gi_test_converge(&fresh, 400);
    require_same_rays(&t, &fresh);

    struct gi_test_point points[49];
    float a[49][3], b[49][3];
    const uint32_t count = ground_points(way[3], points);
    gi_test_irradiance(&t, points, count, a);
    gi_test_irradiance(&fresh, points, count, b);
    double worst = 0;
    for (uint32_t i = 0; i < count; i++)
        for (int k = 0; k < 3; k++)
            worst = fmax(worst, fabs((double)a[i][k] / (double)b[i][k] - 1));
    printf("light after a loop differs from a fresh start's by at most %.4f %%\n", 100 * worst);
    HARD_CASE_AT_MOST(20, "light off the start's, relative", worst, 1e-4);
    gi_test_close(&fresh);
    gi_test_close(&t);
}

/* A camera walks past a point, `way` metres a frame; the point's light must not jump while cascades step,
 * appear and go. Over all hand-overs it changes as far as cells of 0.5 m and of 1 m differ. */
static void walk_past_a_point(const struct sdfgi_settings *settings, double way)
{
    static struct gi_test t;
    gi_test_open(&t, settings);
    scroll_world(&t, home, 16);
    double camera[3] = { -9, 0.2, -0.4 };
    scroll_stand(&t, camera);
    gi_test_converge(&t, 4000);
    const struct gi_test_point point = at(0.3, 2.4, 1.1, 0, 1, 0);
    double before = light_white_at(&t, point), worst = 0, low = before, high = before;
    for (int frame = 0; frame < lround(18 / way); frame++) {
        camera[0] += way;
        scroll_stand(&t, camera);
        gi_test_update(&t, 1);
        const double now = light_white_at(&t, point);
        worst = fmax(worst, fabs(now / before - 1));
        low = fmin(low, now);
        high = fmax(high, now);
        before = now;
    }
    printf("fixed point: at most %.2f %% from frame to frame, %.2f %% over all hand-overs\n", 100 * worst,
           100 * (high / low - 1));
    REQUIRE_CMP(worst, <=, 0.02);
    gi_test_close(&t);
}

static void a_fixed_point_hardly_notices(void **state)
{
    (void)state;
    const struct sdfgi_settings settings = light_walk_settings(25);
    walk_past_a_point(&settings, 0.2);
}

static void a_fixed_point_hardly_notices_by_light_cells(void **state)
{
    (void)state;
    struct sdfgi_settings settings = light_walk_settings(25);
    scroll_use_cells(&settings, 2);
    settings.cell_rays_per_frame = 1 << 22; /* all of them in each frame */
    walk_past_a_point(&settings, scroll_is_full() ? 0.2 : 0.3);
}

/* Light of a sunlit plain on what looks down on it, near the camera and where a coarse cascade answers, over
 * what is exact: where no cascade answered it would be that of a black sky. */
static void look_down(struct gi_test *t, double x, double *low, double *high)
{
    static const double aside[2] = { 0.3, 12 }, height[2] = { 0.8, 2.3 };
    for (int i = 0; i < 2; i++) {
        const struct gi_test_point point = at(x + 0.4, height[i] - 2, aside[i], 0, -1, 0);
        const double e = light_white_at(t, point) / (0.5 * (4 + 0.05 * PI));
        *low = fmin(*low, e);
        *high = fmax(*high, e);
    }
}

/* A cascade's width per frame, for a hundred frames, or 16 by default, in which the coarsest cascade moves by
 * twice its width: light never fails. Probes that
 * have just come to a coarse cascade have sent the rays of one frame: two thirds of the light are there at
 * least, and all of it at rest. Without them it would be black. */
static void hard_23_flying_leaves_nothing_black(void **state)
{
    (void)state;
    static struct gi_test t;
    struct sdfgi_settings settings = scroll_settings(scroll_resolution() / 2);
    settings.min_cell_size_m = 16.0f / (float)scroll_resolution();
    settings.cascades = 4;
    gi_test_open(&t, &settings);
    light_add_box(&t, (double[]){ -600, -3, -600 }, (double[]){ 600, -2, 600 }, (float[]){ 0.5f, 0.5f, 0.5f },
                  0);
    const struct sdfgi_light_desc sun = light_sun(0, -1, 0, 4);
    const struct sdfgi_sky sky = { { 0.05f, 0.05f, 0.05f }, { 0.05f, 0.05f, 0.05f }, { 0, 0, 0 } };
    light_create(&t, &sun);
    REQUIRE_CMP(sdfgi_set_sky(t.gi, &sky), ==, SDFGI_OK);
    double camera[3] = { -400, 0.1, 0.1 };
    scroll_stand(&t, camera);
    gi_test_converge(&t, 400);
    double low = INFINITY, high = 0, still_low = INFINITY, still_high = 0;
    look_down(&t, camera[0], &still_low, &still_high);
    for (int frame = 0; frame < (scroll_is_full() ? 100 : 16); frame++) {
        camera[0] += 8;
        scroll_stand(&t, camera);
        gi_test_update(&t, 1);
        look_down(&t, camera[0], &low, &high);
    }
    printf("over a plain: light of exact between %.4f and %.4f at rest, %.4f and %.4f in flight\n", still_low,
           still_high, low, high);
    HARD_CASE_AT_LEAST(23, "light at rest, of exact, at least", still_low, 0.98);
    HARD_CASE_AT_LEAST(23, "light in flight, of exact, at least", low, 2.0 / 3);
    HARD_CASE_AT_MOST(23, "light in flight, of exact, at most", high, 1.1);
    gi_test_close(&t);
}

/* ---- New probes */

/* Those whose history was reset in this frame: its length, 0, is stored less 2 (probe_common.glsl). */
struct newborn {
    uint32_t count, seeded;
    float low, high; /* brightest texel of those that have a seed */
};

static float brightest_texel(const uint16_t (*texels)[4])
{
    float brightest = 0;
    for (int i = 0; i < SDFGI_IRRADIANCE_COUNT; i++)
        brightest = fmaxf(brightest, gi_test_half(texels[i][0]));
    return brightest;
}

static struct newborn find_newborn(struct gi_test *t, uint32_t cascade)
{
    const uint32_t probes = (uint32_t)t->gi->volume.resources->extent.probes;
    const float(*sums)[SDFGI_SUMS_STRIDE][4] = gi_test_read(t, RESOURCE_SUMS, NULL);
    const uint16_t(*previous)[SDFGI_IRRADIANCE_COUNT][4] = gi_test_read(t, RESOURCE_PREVIOUS, NULL);
    struct newborn n = { 0, 0, INFINITY, 0 };
    for (uint32_t i = cascade * probes; i < (cascade + 1) * probes; i++) {
        if (sums[i][SDFGI_IRRADIANCE_COUNT][2] != -2)
            continue;
        n.count++;
        if (gi_test_half(previous[i][0][3]) <= 0)
            continue;
        n.seeded++;
        n.low = fminf(n.low, brightest_texel(previous[i]));
        n.high = fmaxf(n.high, brightest_texel(previous[i]));
    }
    free((void *)sums);
    free((void *)previous);
    return n;
}

/* In the frame that completes a step no rays are sent: what its new probes know is what the next cascade's
 * told them, and the last one's know nothing. */
static void new_probes_start_with_the_next_cascades_light(void **state)
{
    (void)state;
    static struct gi_test t;
    const struct sdfgi_settings settings = light_walk_settings(25);
    gi_test_open(&t, &settings);
    light_add_box(&t, (double[]){ -40, -3, -40 }, (double[]){ 40, -2, 40 }, (float[]){ 0.5f, 0.5f, 0.5f }, 0);
    light_set_uniform_sky(&t, 1);
    double camera[3] = { 0.1, 0.2, 0.3 };
    scroll_stand(&t, camera);
    gi_test_converge(&t, 400);
    struct newborn n[2] = { { 0 }, { 0 } };
    for (int frame = 0; frame < 200 && (n[0].count == 0 || n[1].count == 0); frame++) {
        camera[0] += 0.1;
        scroll_stand(&t, camera);
        gi_test_update(&t, 1);
        for (uint32_t c = 0; c < 2; c++)
            if (n[c].count == 0 && t.gi->frame.situation.light_waits)
                n[c] = find_newborn(&t, c);
    }
    for (uint32_t c = 0; c < 2; c++)
        printf("cascade %u: %u new probes, %u of them with a seed, %.3f to %.3f\n", c, n[c].count,
               n[c].seeded, (double)n[c].low, (double)n[c].high);
    REQUIRE_CMP(n[0].count, >=, 20u);
    REQUIRE_CMP(n[0].seeded, ==, n[0].count);
    REQUIRE_NEAR((double)n[0].low, 1, 0.01);
    REQUIRE_NEAR((double)n[0].high, 1, 0.01);
    REQUIRE_CMP(n[1].count, >=, 20u);
    REQUIRE_CMP(n[1].seeded, ==, 0u);
    gi_test_close(&t);
}

/* Scrolls the only cascade back to a place along x, wherever hysteresis would have it: a camera that stands
 * one cell past the middle of that place draws the cascade there, and no further. */
static void scroll_back_along_x(struct gi_test *t, double camera[static 3], int64_t origin)
{
    const struct cascade *cascade = &t->gi->volume.state.cascades.at[0];
    const int64_t away = cascade->origin[0] - origin, middle = origin + t->gi->settings.resolution / 2;
    if (away == 0)
        return;
    camera[0] = ((double)middle + (away > 0 ? -0.5 : 1.5)) * cascade->cell_size[0];
    scroll_stand(t, camera);
    scroll_settle(t);
    REQUIRE_CMP(cascade->origin[0], ==, origin);
}

/* Light of two rooms, over the first's exact light: a furnace, and one with a lamp. */
struct rooms {
    double furnace, lamp;
};

static struct rooms look_into_rooms(struct gi_test *t)
{
    return (struct rooms){ light_white_at(t, at(0.2, 1.2, 0.1, 0, 1, 0)) / PI / 2,
                           light_white_at(t, at(0.2, -5.8, 0.1, 0, 1, 0)) / PI / 2 };
}

/* Two sealed rooms, one above the other. The furnace emits everywhere. */
static void add_rooms(struct gi_test *t)
{
    const double above[3] = { 0, 3.5, 0 }, below[3] = { 0, -3.5, 0 }, half[3] = { 2.8, 2.4, 2.9 };
    light_add(t, test_mesh_room(above, half, 0.5, test_rotation_none), 0.5f, 1);
    light_add(t, test_mesh_room(below, half, 0.5, test_rotation_none), 0.5f, 0);
    const struct sdfgi_light_desc lamp = light_point(0.4, -3, -0.3, 20);
    light_create(t, &lamp);
}

/* The camera goes to and fro for a hundred steps of the only cascade, once for both rooms. */
static void walk_hundred_steps(bool cells, struct rooms *before, struct rooms *after)
{
    static struct gi_test t;
    struct sdfgi_settings settings = light_walk_settings(25);
    settings.cascades = 1;
    if (cells)
        scroll_use_cells(&settings, 1);
    if (cells && !scroll_is_full())
        settings.cell_rays_per_frame = 1 << 13; /* they take turns while the camera walks */
    gi_test_open(&t, &settings);
    add_rooms(&t);
    double camera[3] = { 0.1, 0.3, 0.2 };
    scroll_stand(&t, camera);
    gi_test_converge(&t, 4000);
    *before = look_into_rooms(&t);
    const int64_t origin = t.gi->volume.state.cascades.at[0].origin[0];
    for (int i = 0; t.gi->volume.state.scroll.scrolls_begun < 100 && i < 400; i++) {
        camera[0] = i & 1 ? -4.1 : 4.1;
        scroll_stand(&t, camera);
        gi_test_update(&t, 2);
    }
    REQUIRE_CMP(t.gi->volume.state.scroll.scrolls_begun, >=, 100u);
    scroll_back_along_x(&t, camera, origin);
    camera[0] = 0.1;
    scroll_stand(&t, camera);
    gi_test_converge(&t, 4000);
    REQUIRE_CMP(t.gi->volume.state.cascades.at[0].origin[0], ==, origin);
    *after = look_into_rooms(&t);
    gi_test_close(&t);
}

static struct rooms before_steps, after_steps;

static int walk_through_rooms(void **state)
{
    (void)state;
    walk_hundred_steps(false, &before_steps, &after_steps);
    return 0;
}

static void hard_39_a_furnace_does_not_drift(void **state)
{
    (void)state;
    const double before = before_steps.furnace, after = after_steps.furnace;
    printf("furnace: E / pi / 2 is %.4f, after 100 steps %.4f\n", before, after);
    HARD_CASE_AT_MOST(39, "furnace after 100 steps, off what it was by", fabs(after / before - 1), 0.005);
    HARD_CASE_AT_MOST(39, "furnace after 100 steps, off exact by", fabs(after - 1), 0.025);
}

static void hard_39_a_room_with_a_lamp_does_not_drift(void **state)
{
    (void)state;
    const double before = before_steps.lamp, after = after_steps.lamp;
    printf("room with a lamp: E / pi / 2 is %.4f, after 100 steps %.4f\n", before, after);
    HARD_CASE_AT_MOST(39, "room with a lamp after 100 steps, off what it was by", fabs(after / before - 1),
                      0.01);
    REQUIRE_CMP(after, >, 0.1);
}

static void hard_39_light_cells_do_not_drift(void **state)
{
    (void)state;
    struct rooms before, after;
    walk_hundred_steps(true, &before, &after);
    printf("by light cells: furnace %.4f, after 100 steps %.4f; lamp %.4f, after them %.4f\n", before.furnace,
           after.furnace, before.lamp, after.lamp);
    HARD_CASE_AT_MOST(39, "furnace by light cells after 100 steps, off what it was by",
                      fabs(after.furnace / before.furnace - 1), 0.005);
    HARD_CASE_AT_MOST(39, "furnace by light cells after 100 steps, off exact by", fabs(after.furnace - 1),
                      0.025);
    HARD_CASE_AT_MOST(39, "room with a lamp by light cells after 100 steps, off what it was by",
                      fabs(after.lamp / before.lamp - 1), 0.01);
    REQUIRE_CMP(after.lamp, >, 0.1);
}

TEST_GROUP(light)
{
    if (!gpu_test_available())
        return GPU_TEST_SKIP;
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(hard_20_light_after_a_loop_is_that_of_a_fresh_start),
        cmocka_unit_test(a_fixed_point_hardly_notices),
        cmocka_unit_test(a_fixed_point_hardly_notices_by_light_cells),
        cmocka_unit_test(hard_39_light_cells_do_not_drift),
        cmocka_unit_test(hard_23_flying_leaves_nothing_black),
        cmocka_unit_test(new_probes_start_with_the_next_cascades_light),
    };
    const struct CMUnitTest rooms[] = {
        cmocka_unit_test(hard_39_a_furnace_does_not_drift),
        cmocka_unit_test(hard_39_a_room_with_a_lamp_does_not_drift),
    };
    return cmocka_run_group_tests_name("scroll_light", tests, NULL, NULL) +
           cmocka_run_group_tests_name("scroll_light_rooms", rooms, walk_through_rooms, NULL);
}
