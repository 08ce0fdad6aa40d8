/* SPDX-License-Identifier: MIT
 * After any journey the volumes are bit for bit those of a fresh start at the same place (HARD_CASES rows 18
 * to 21 and 25). */
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

/* Light does not matter here: one ray a frame. By default 32 cells of 0.5 m, the fewest that there are; a
 * step of theirs takes several frames, too, unless the camera hurries. */
static struct sdfgi_settings volume_settings(void)
{
    struct sdfgi_settings settings = scroll_settings(scroll_is_full() ? 128 : 32);
    settings.min_cell_size_m = scroll_is_full() ? 0.25f : 0.5f;
    settings.ray_count = 1;
    settings.frames_to_converge = 25;
    return settings;
}

static double world_reach(void)
{
    return scroll_is_full() ? 32 : 16;
}

/* Half the cells of the full size at twice theirs, for what takes long. */
static struct sdfgi_settings coarse_settings(void)
{
    struct sdfgi_settings settings = volume_settings();
    settings.resolution = scroll_is_full() ? 64 : 32;
    settings.min_cell_size_m = 0.5f;
    return settings;
}

typedef void scroll_scene(struct gi_test *t, const double center[static 3], double reach);

static void open_scene(struct gi_test *t, scroll_scene *scene, const struct sdfgi_settings *settings,
                       const double position[static 3])
{
    gi_test_open(t, settings);
    scene(t, home, world_reach());
    scroll_stand(t, position);
    scroll_settle(t);
}

static void open_world(struct gi_test *t, const struct sdfgi_settings *settings,
                       const double position[static 3])
{
    open_scene(t, scroll_world, settings, position);
}

/* A start from nothing where `walked` is. */
static void open_fresh(struct gi_test *fresh, struct gi_test *walked, scroll_scene *scene,
                       const double position[static 3])
{
    gi_test_open(fresh, &walked->gi->settings);
    scene(fresh, home, world_reach());
    scroll_stand(fresh, position);
    scroll_place_as(fresh, walked);
    scroll_settle(fresh);
}

/* Elements that differ from a fresh start's. */
static uint64_t differ_from_fresh(struct gi_test *walked, scroll_scene *scene,
                                  const double position[static 3], const char *what)
{
    static struct gi_test fresh;
    open_fresh(&fresh, walked, scene, position);
    const uint64_t count = scroll_differences(walked, &fresh, what);
    gi_test_close(&fresh);
    return count;
}

static void walk_to(struct gi_test *t, const double position[static 3])
{
    scroll_stand(t, position);
    scroll_settle(t);
}

/* Steps of the first cascade: a probe spacing and a half is past its hysteresis. Returns how many elements
 * differ from a fresh start's, there and back home. */
static uint64_t one_step(struct gi_test *t, double x, double y, double z, const char *what)
{
    const double spacing = 8 * (double)t->gi->settings.min_cell_size_m;
    const double to[3] = { home[0] + 1.5 * spacing * x, home[1] + 1.5 * spacing * y,
                           home[2] + 1.5 * spacing * z };
    const uint64_t begun = t->gi->volume.state.scroll.scrolls_begun;
    walk_to(t, to);
    REQUIRE_CMP(t->gi->volume.state.scroll.scrolls_begun, >, begun);
    const uint64_t there = differ_from_fresh(t, scroll_world, to, what);
    walk_to(t, home);
    return there + differ_from_fresh(t, scroll_world, home, what);
}

static void hard_18_a_step_along_each_axis_equals_a_fresh_start(void **state)
{
    (void)state;
    static struct gi_test t;
    const struct sdfgi_settings settings = volume_settings();
    open_world(&t, &settings, home);
    uint64_t differ = one_step(&t, 1, 0, 0, "+x, then -x");
    differ += one_step(&t, 0, -1, 0, "-y, then +y");
    differ += one_step(&t, 0, 0, 1, "+z, then -z");
    HARD_CASE_AT_MOST(18, "elements that differ from a fresh start's", differ, 0);
    gi_test_close(&t);
}

static void hard_21_all_axes_in_one_frame_equal_a_fresh_start(void **state)
{
    (void)state;
    static struct gi_test t;
    const struct sdfgi_settings settings = volume_settings();
    /* As far as leaves something of the first cascade. */
    const double far = scroll_is_full() ? 3 : 2;
    open_world(&t, &settings, home);
    HARD_CASE_AT_MOST(21, "elements that differ from a fresh start's",
                      one_step(&t, 1 - far, 1, -far, "-x +y -z, far"), 0);
    gi_test_close(&t);
}

static void flat_cells_scroll_too(void **state)
{
    (void)state;
    static struct gi_test t;
    struct sdfgi_settings settings = coarse_settings();
    settings.y_scale = SDFGI_Y_SCALE_50;
    open_world(&t, &settings, home);
    REQUIRE_CMP(one_step(&t, 1, 1, 0, "flat"), ==, 0ul);
    gi_test_close(&t);
}

/* Share of a cascade whose distances were made anew since the newest frame that voxelised. */
static double searched_share(struct gi_test *t)
{
    uint32_t *counters = gi_test_read(t, RESOURCE_COUNTERS, NULL);
    const double n = t->gi->settings.resolution;
    const double share = counters[SDFGI_COUNTER_DISTANCE_CELLS] / (n * n * n);
    free(counters);
    return share;
}

/* Over a plain, air is nearer to the ground below than to that which goes and comes beside it: besides the
 * slab, an eighth, little is searched. */
static void a_step_over_a_plain_searches_little(void **state)
{
    (void)state;
    static struct gi_test t;
    struct sdfgi_settings settings = volume_settings();
    settings.cascades = 1;
    settings.resolution = 64;
    settings.min_cell_size_m = 0.25f;
    gi_test_open(&t, &settings);
    light_add_box(&t, (double[]){ -40, -1.6, -40 }, (double[]){ 40, -1, 40 }, (float[]){ 0.5f, 0.5f, 0.5f },
                  0);
    scroll_stand(&t, home);
    gi_test_update(&t, 1);
    REQUIRE_NEAR(searched_share(&t), 1, 1e-6);
    static const double ways[2][3] = { { 3.2, 0.2, -0.4 }, { 3.2, 0.2, 2.6 } };
    for (int i = 0; i < 2; i++) {
        const uint64_t begun = t.gi->volume.state.scroll.scrolls_begun;
        walk_to(&t, ways[i]);
        REQUIRE_CMP(t.gi->volume.state.scroll.scrolls_begun, ==, begun + 1);
        const double share = searched_share(&t);
        printf("a step along %c: %.1f %% searched\n", i ? 'z' : 'x', 100 * share);
        REQUIRE_CMP(share, >=, 0.125);
        REQUIRE_CMP(share, <, 0.4);
    }
    gi_test_close(&t);
}

/* Steps of one cascade, one a frame, anywhere within a world: nothing adds up, and nothing is left behind. */
static void hard_19_a_long_journey_leaves_no_trace(void **state)
{
    (void)state;
    static struct gi_test t;
    struct sdfgi_settings settings = volume_settings();
    settings.cascades = 1;
    open_scene(&t, scroll_air, &settings, home);
    struct test_random random = { 19 };
    double camera[3] = { home[0], home[1], home[2] };
    const uint32_t scrolls = scroll_is_full() ? gpu_test_repeats(&t.gpu, 1000) : 40;
    uint32_t checked = 0;
    while (t.gi->volume.state.scroll.scrolls_begun < scrolls) {
        for (int i = 0; i < 3; i++) {
            camera[i] += test_random_real(&random, -9, 9) * (i == 1 ? 0.5 : 1);
            camera[i] = fmin(fmax(camera[i], -world_reach()), world_reach());
        }
        scroll_stand(&t, camera);
        gi_test_update(&t, 1);
        if (t.gi->volume.state.scroll.scrolls_begun / (scrolls / 2) > checked) {
            checked++;
            scroll_settle(&t);
            HARD_CASE_AT_MOST(19, "elements that differ from a fresh start's",
                              differ_from_fresh(&t, scroll_air, camera, "journey"), 0);
        }
    }
    REQUIRE_CMP(checked, ==, 2u);
    gi_test_close(&t);
}

/* As far away as can be: nothing is left of where it was. */
static void hard_22_a_teleport_equals_a_fresh_start(void **state)
{
    (void)state;
    static struct gi_test t;
    struct sdfgi_settings settings = volume_settings();
    settings.cascades = 1;
    open_world(&t, &settings, home);
    walk_to(&t, (double[]){ 1e9, -1e7, 10 });
    walk_to(&t, home);
    HARD_CASE_AT_MOST(22, "elements that differ from a fresh start's",
                      differ_from_fresh(&t, scroll_world, home, "there and back"), 0);
    gi_test_close(&t);
}

/* Back where it began, by another way. */
static void hard_20_a_closed_loop_ends_where_it_began(void **state)
{
    (void)state;
    static struct gi_test t, start;
    const struct sdfgi_settings settings = volume_settings();
    open_world(&t, &settings, home);
    open_world(&start, &settings, home);
    static const double way[5][3] = { { 5, 0, 0 }, { 5, 2, 6 }, { -4, 1, 6 }, { -6, -2, -3 }, { 3, 0, -6 } };
    for (int i = 0; i < 5; i++)
        walk_to(&t, way[i]);
    walk_to(&t, home);
    scroll_place_as(&start, &t);
    scroll_settle(&start);
    HARD_CASE_AT_MOST(20, "elements that differ from the start's", scroll_differences(&t, &start, "loop"), 0);
    gi_test_close(&start);
    gi_test_close(&t);
}

/* ---- Depths around probes, where lookups read those */

static struct sdfgi_settings depth_settings(enum sdfgi_y_scale y_scale)
{
    struct sdfgi_settings settings = coarse_settings();
    settings.visibility = SDFGI_VISIBILITY_PROBE_DEPTH;
    settings.y_scale = y_scale;
    return settings;
}

static void depths_scroll_too(void **state)
{
    (void)state;
    static struct gi_test t;
    const int last = scroll_is_full() ? SDFGI_Y_SCALE_100 : SDFGI_Y_SCALE_50;
    for (int scale = SDFGI_Y_SCALE_50; scale <= last; scale += 2) {
        const struct sdfgi_settings settings = depth_settings((enum sdfgi_y_scale)scale);
        open_world(&t, &settings, home);
        if (scroll_is_full()) {
            REQUIRE_CMP(one_step(&t, 1, 0, 0, "depths, +x"), ==, 0ul);
            REQUIRE_CMP(one_step(&t, 0, -1, 0, "depths, -y"), ==, 0ul);
        }
        REQUIRE_CMP(one_step(&t, 1, 1, -1, "depths, all axes"), ==, 0ul);
        gi_test_close(&t);
    }
}

enum { POISON = 0x5a5a5a5a, DEPTHS = SDFGI_OCCLUSION_STRIDE * SDFGI_OCCLUSION_STRIDE };

/* Depths are overwritten behind the library's back: after a step it has made those again that look into what
 * is new, and no others. */
static void only_depths_that_look_into_news_are_made_again(void **state)
{
    (void)state;
    static struct gi_test t, fresh;
    const struct sdfgi_settings settings = depth_settings(SDFGI_Y_SCALE_100);
    open_world(&t, &settings, home);
    const struct gpu_buffer *buffer = &t.gi->volume.resources->buffers[RESOURCE_OCCLUSION];
    uint32_t *depths = test_array_alloc(buffer->size, 1);
    for (uint64_t i = 0; i < buffer->size / 4; i++)
        depths[i] = POISON;
    gpu_test_buffer_write(&t.gpu, buffer->handle, 0, buffer->size, depths);
    free(depths);
    const double to[3] = { home[0] + 12 * (double)settings.min_cell_size_m, home[1], home[2] };
    walk_to(&t, to);
    open_fresh(&fresh, &t, scroll_world, to);
    uint32_t *again = gi_test_read(&t, RESOURCE_OCCLUSION, NULL),
             *expected = gi_test_read(&fresh, RESOURCE_OCCLUSION, NULL),
             *states = gi_test_read(&t, RESOURCE_PROBES, NULL);
    uint32_t probes = 0, whole = 0, texels = 0;
    for (uint64_t probe = 0; probe < t.gi->volume.resources->extent.probes;
         probe++) { /* of the first cascade */
        if (states[probe] & SDFGI_PROBE_DEAD)
            continue;
        uint32_t made = 0;
        for (uint64_t i = probe * DEPTHS; i < (probe + 1) * DEPTHS; i++) {
            made += again[i] != POISON;
            if (again[i] != POISON)
                REQUIRE_CMP(again[i], ==, expected[i]);
        }
        probes++;
        whole += made == DEPTHS;
        texels += made < DEPTHS ? made : 0;
    }
    printf("depths made again: all of %u probes of %u, %.0f %% of the others\n", whole, probes,
           100.0 * texels / (double)DEPTHS / (probes - whole));
    REQUIRE_CMP(whole, >, 0u); /* those that are new */
    REQUIRE_CMP(texels, >, 0u);
    REQUIRE_CMP(texels, <, (probes - whole) * DEPTHS * 3 / 4);
    free(again);
    free(expected);
    free(states);
    gi_test_close(&fresh);
    gi_test_close(&t);
}

TEST_GROUP(volumes)
{
    if (!gpu_test_available())
        return GPU_TEST_SKIP;
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(depths_scroll_too),
        cmocka_unit_test(only_depths_that_look_into_news_are_made_again),
        cmocka_unit_test(hard_18_a_step_along_each_axis_equals_a_fresh_start),
        cmocka_unit_test(hard_21_all_axes_in_one_frame_equal_a_fresh_start),
        cmocka_unit_test(hard_19_a_long_journey_leaves_no_trace),
        cmocka_unit_test(hard_20_a_closed_loop_ends_where_it_began),
        cmocka_unit_test(hard_22_a_teleport_equals_a_fresh_start),
        cmocka_unit_test(flat_cells_scroll_too),
        cmocka_unit_test(a_step_over_a_plain_searches_little),
    };
    return cmocka_run_group_tests_name("scroll_volumes", tests, NULL, NULL);
}
