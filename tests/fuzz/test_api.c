/* SPDX-License-Identifier: MIT
 * Whatever a host does, the library ends up as one that was given the last state at once: the same volumes,
 * the same light, the same memory. Steps follow from a seed.
 *
 *   SDFGI_FUZZ_SEED=N     that seed alone
 *   SDFGI_TEST_FULL=1     one seed after another for a minute */
#include "api_world.h"
#include "light_scene.h"
#include "require.h"
#include "scroll_scene.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

enum { STEPS = 150, FIRST_SEED = 30, SEEDS = 2, POINTS = 24, SECONDS = 60 };

static struct gi_test walked, fresh;
static struct api_device walked_device, fresh_device;

/* Where a failure happened. */
static struct {
    uint32_t seed, step;
    const char *what; /* NULL: all is well */
} at;

/* ---- The two contexts ------------------------------------------------------------------------------- */

static void open_device(struct gi_test *t, struct api_device *device)
{
    memset(t, 0, sizeof *t);
    gpu_test_open(&t->gpu, sdfgi_get_requirements);
    api_device_open(device, t);
}

static void close_device(struct gi_test *t, struct api_device *device)
{
    api_device_close(device, t);
    gpu_test_close(&t->gpu);
}

static int open_devices(void **state)
{
    (void)state;
    open_device(&walked, &walked_device);
    open_device(&fresh, &fresh_device);
    return 0;
}

static void print_settings(void)
{
    char text[64];
    struct sdfgi_settings s;
    const struct sdfgi_property_info *info;
    if (!walked.gi)
        return;
    sdfgi_get_settings(walked.gi, &s);
    for (uint32_t i = 0; (info = sdfgi_property_get_info(i)); i++)
        if (!info->derived && sdfgi_settings_format(&s, info->name, text, sizeof text))
            fprintf(stderr, "  %s=%s\n", info->name, text);
}

static int close_devices(void **state)
{
    (void)state;
    if (at.what) {
        fprintf(stderr, "failed with SDFGI_FUZZ_SEED=%u in step %u: %s\n", at.seed, at.step, at.what);
        print_settings();
        return 0; /* contexts of the failed run are still there */
    }
    close_device(&walked, &walked_device);
    close_device(&fresh, &fresh_device);
    return 0;
}

/* ---- Comparisons ------------------------------------------------------------------------------------ */

static uint64_t held(const struct gi_test *t)
{
    static struct sdfgi_report report;
    sdfgi_get_report(t->gi, &report);
    return report.memory.total_bytes;
}

/* Lists that have grown, those of emitters, and what reflections keep stay until the next change of settings.
 */
static void require_same_memory(void)
{
    const struct extent *const a = &walked.gi->volume.resources->extent, *const b = &fresh.gi->volume
                                                                                         .resources->extent;
    if (a->light_cells == b->light_cells && a->emits == b->emits && a->low_light == b->low_light)
        REQUIRE_CMP(held(&walked), ==, held(&fresh));
    else
        REQUIRE_CMP(held(&walked), >, held(&fresh));
}

static void require_same_light(struct test_random *random)
{
    static struct gi_test_point points[POINTS];
    static float a[POINTS][3], b[POINTS][3];
    float most = 0;
    for (int i = 0; i < POINTS; i++) {
        double normal[3];
        test_random_direction(random, normal);
        for (int k = 0; k < 3; k++) {
            points[i].position[k] =
                (float)(walked.frame.camera_position[k] + test_random_real(random, -2, 2));
            points[i].normal[k] = (float)normal[k];
        }
    }
    gi_test_irradiance(&walked, points, POINTS, a);
    gi_test_irradiance(&fresh, points, POINTS, b);
    for (int i = 0; i < POINTS; i++)
        for (int k = 0; k < 3; k++)
            most = fmaxf(most, b[i][k]);
    for (int i = 0; i < POINTS; i++)
        for (int k = 0; k < 3; k++)
            if (!(fabsf(a[i][k] - b[i][k]) <= 0.01f * most))
                require_fail(__FILE__, __LINE__,
                             "light at point %d, channel %d: %g, and in a fresh context %g", i, k,
                             (double)a[i][k], (double)b[i][k]);
}

/* Off, everything is given back; on again, there is as much as for a context that knows nothing. */
static void require_memory_back(struct api_world *w)
{
    struct sdfgi_memory expected;
    struct sdfgi_settings s = w->scene.settings;
    s.enabled = false;
    REQUIRE_CMP((int)sdfgi_set_settings(walked.gi, &s), ==, (int)SDFGI_OK);
    gi_test_update(&walked, 4);
    REQUIRE_CMP(held(&walked), ==, 0u);
    s.enabled = true;
    REQUIRE_CMP((int)sdfgi_set_settings(walked.gi, &s), ==, (int)SDFGI_OK);
    REQUIRE_CMP((int)sdfgi_estimate_memory(&s, 2, &expected), ==, (int)SDFGI_OK);
    REQUIRE_CMP(held(&walked), ==, expected.total_bytes);
}

static void compare(struct api_world *w)
{
    at.what = "settling";
    scroll_settle(&walked);
    at.what = "the same scene in a fresh context";
    api_context_open(&fresh, &w->scene.settings);
    fresh.frame = walked.frame;
    api_scene_build(&fresh, &fresh_device, &w->scene, &walked);
    scroll_place_as(&fresh, &walked);
    scroll_settle(&fresh);
    at.what = "comparing volumes";
    scroll_require_equal(&walked, &fresh, "after all steps");
    at.what = "comparing memory";
    sdfgi_release_prepared(walked.gi);
    gi_test_update(&walked, 4); /* until no frame in flight holds what was replaced */
    gi_test_update(&fresh, 4);
    require_same_memory();
    at.what = "comparing light";
    gi_test_converge(&walked, 1000);
    gi_test_converge(&fresh, 1000);
    require_same_light(&w->random);
    at.what = "giving memory back";
    require_memory_back(w);
    api_context_close(&walked);
    api_context_close(&fresh);
}

/* ---- The run ---------------------------------------------------------------------------------------- */

static void switch_on(struct api_world *w)
{
    at.what = "switching on";
    w->scene.settings.enabled = true;
    REQUIRE_CMP((int)sdfgi_set_settings(walked.gi, &w->scene.settings), ==, (int)SDFGI_OK);
    walked.frame.exposure = 1; /* if the next frame is the first of all */
}

/* Before the last change the light settles: what is not announced then shows as light that stays. */
static void run(uint32_t seed)
{
    static struct api_world w;
    w = (struct api_world){ .t = &walked, .device = &walked_device, .random = { seed } };
    at.seed = seed;
    at.what = "opening";
    w.scene.settings = api_settings(&w.random);
    api_context_open(&walked, &w.scene.settings);
    for (at.step = 0; at.step < STEPS; at.step++)
        at.what = api_step(&w);
    api_views_close(&w);
    switch_on(&w);
    gi_test_converge(&walked, 1000);
    at.what = api_change(&w, seed % API_CHANGES);
    switch_on(&w);
    compare(&w);
    at.what = NULL;
    REQUIRE_CMP(w.refused, >, 0u);
}

static void any_order_of_calls_leads_to_the_same_state(void **state)
{
    (void)state;
    const char *const only = getenv("SDFGI_FUZZ_SEED");
    if (only) {
        run((uint32_t)strtoul(only, NULL, 10));
        return;
    }
    const time_t end = time(NULL) + SECONDS;
    uint32_t count = 0;
    for (; count < SEEDS || (scroll_is_full() && time(NULL) < end); count++)
        run(FIRST_SEED + count);
    printf("%u seeds of %d steps\n", count, STEPS);
}

int main(void)
{
    if (!gpu_test_available())
        return GPU_TEST_SKIP;
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(any_order_of_calls_leads_to_the_same_state, open_devices,
                                        close_devices),
    };
    return cmocka_run_group_tests_name("fuzz_api", tests, NULL, NULL);
}
