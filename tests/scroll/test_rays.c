/* SPDX-License-Identifier: MIT
 * Rays that are remembered while cascades scroll and geometry changes: those that something new may have
 * changed are forgotten, others stay, and in the end all end where those of a fresh start do. */
#include "light_scene.h"
#include "require.h"
#include "test_group.h"
#include "scroll_scene.h"

#include <stdio.h>
#include <stdlib.h>

static const double home[3] = { 0.3, 0.2, -0.4 };

static struct sdfgi_settings ray_settings(void)
{
    struct sdfgi_settings settings = scroll_settings(32);
    settings.ray_count = 25;
    settings.frames_to_converge = 8;
    return settings;
}

static void open_at(struct gi_test *t, const double position[static 3])
{
    const struct sdfgi_settings settings = ray_settings();
    gi_test_open(t, &settings);
    scroll_world(t, home, 12);
    scroll_stand(t, position);
}

/* Until cascades are complete and every ray of the cycle is remembered. */
static void trace_all(struct gi_test *t)
{
    scroll_settle(t);
    gi_test_update(t, t->gi->volume.state.accumulation.rays_missing);
    REQUIRE_CMP(t->gi->volume.state.accumulation.rays_missing, ==, 0u);
    gi_test_update(t, 1);
    REQUIRE_CMP(t->gi->passes[PASS_PROBE_TRACE].tally.dispatches, ==, 0u);
}

struct comparison {
    uint64_t rays, differ;
};

/* Rays of probes that are alive. */
static struct comparison compare_rays(struct gi_test *walked, struct gi_test *fresh)
{
    uint32_t *a = gi_test_read(walked, RESOURCE_RAYS, NULL), *b = gi_test_read(fresh, RESOURCE_RAYS, NULL),
             *probes = gi_test_read(fresh, RESOURCE_PROBES, NULL);
    const struct extent *e = &fresh->gi->volume.resources->extent;
    struct comparison result = { 0 };
    const uint64_t words = sdfgi_extent_probe_words(e);
    for (uint64_t i = 0; i < e->probes * e->cascades * words; i++) {
        if (probes[i / words] & SDFGI_PROBE_DEAD || i % words >= e->cycle_samples)
            continue;
        REQUIRE_CMP(a[i], !=, SDFGI_RAY_UNKNOWN);
        result.rays++;
        result.differ += a[i] != b[i];
    }
    free(probes);
    free(b);
    free(a);
    return result;
}

/* Where a ray begins within its cascade decides its rounding: one that grazes an edge may end elsewhere. */
static void require_rays_of_a_fresh_start(struct gi_test *t, struct gi_test *fresh, const char *what)
{
    scroll_place_as(fresh, t);
    trace_all(fresh);
    const struct comparison c = compare_rays(t, fresh);
    printf("%s: %llu of %llu rays end elsewhere than those of a fresh start\n", what,
           (unsigned long long)c.differ, (unsigned long long)c.rays);
    REQUIRE_CMP(c.rays, >, 20000u);
    REQUIRE_CMP(c.differ * 10000, <, c.rays);
    gi_test_close(fresh);
}

static void steps_forget_those_rays_that_end_elsewhere(void **state)
{
    (void)state;
    static struct gi_test t, fresh;
    static const double way[][3] = { { 6.3, 0.2, -0.4 }, { 6.3, 0.2, 5.6 }, { 2.3, 3.2, 1.6 } };
    open_at(&t, home);
    trace_all(&t);
    for (int i = 0; i < 3; i++) {
        scroll_stand(&t, way[i]);
        trace_all(&t);
        open_at(&fresh, way[i]);
        require_rays_of_a_fresh_start(&t, &fresh, "after steps");
    }
    gi_test_close(&t);
}

static sdfgi_instance add_box(struct gi_test *t, double x)
{
    return light_add_box(t, (double[]){ x, -1, -1 }, (double[]){ x + 1.5, 1, 1 },
                         (float[]){ 0.5f, 0.5f, 0.5f }, 0);
}

static void edits_forget_those_rays_that_end_elsewhere(void **state)
{
    (void)state;
    static struct gi_test t, fresh;
    open_at(&t, home);
    const sdfgi_instance box = add_box(&t, 1.2);
    trace_all(&t);
    REQUIRE_CMP(sdfgi_instance_destroy(t.gi, box), ==, SDFGI_OK);
    add_box(&t, -3);
    trace_all(&t);
    open_at(&fresh, home);
    add_box(&fresh, -3);
    require_rays_of_a_fresh_start(&t, &fresh, "after a box has gone and another come");
    gi_test_close(&t);
}

/* How many rays are traced until all are remembered. */
static uint64_t traced_after(struct gi_test *t, const double position[static 3])
{
    uint64_t traced = 0;
    scroll_stand(t, position);
    for (uint32_t frame = 0; frame == 0 || t->gi->volume.state.accumulation.rays_missing > 0; frame++) {
        REQUIRE_CMP(frame, <, 200u);
        gi_test_update(t, 1);
        if (t->gi->passes[PASS_PROBE_TRACE].tally.dispatches == 0)
            continue;
        uint32_t *counters = gi_test_read(t, RESOURCE_COUNTERS, NULL);
        traced += counters[SDFGI_COUNTER_RAYS_TRACED];
        free(counters);
    }
    return traced;
}

/* Above a plain a step brings and takes ground alone. */
static void rays_through_new_air_are_remembered(void **state)
{
    (void)state;
    static struct gi_test t;
    const struct sdfgi_settings settings = ray_settings();
    gi_test_open(&t, &settings);
    light_add(&t,
              test_mesh_plane((double[]){ 0, -2.1, 0 }, (double[]){ 0, 0, 80 }, (double[]){ 80, 0, 0 }, 1),
              0.5f, 0);
    trace_all(&t);
    const uint64_t traced = traced_after(&t, (double[]){ 3, 0, 0 });
    const struct extent *e = &t.gi->volume.resources->extent;
    const uint64_t rays = e->probes * e->cascades * e->cycle_samples;
    printf("a step over a plain: %llu of %llu rays traced again\n", (unsigned long long)traced,
           (unsigned long long)rays);
    REQUIRE_CMP(traced, >, rays / e->probes_per_side / 2); /* those of new probes in one cascade at least */
    REQUIRE_CMP(traced * 10, <, rays * 4);
    gi_test_close(&t);
}

TEST_GROUP(rays)
{
    if (!gpu_test_available())
        return GPU_TEST_SKIP;
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(steps_forget_those_rays_that_end_elsewhere),
        cmocka_unit_test(edits_forget_those_rays_that_end_elsewhere),
        cmocka_unit_test(rays_through_new_air_are_remembered),
    };
    return cmocka_run_group_tests_name("scroll_rays", tests, NULL, NULL);
}
