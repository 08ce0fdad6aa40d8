/* SPDX-License-Identifier: MIT
 * Updates whose command buffers never run: cancelled ones leave no trace, others are noticed. */
#include "gi_test.h"
#include "require.h"
#include "test_group.h"
#include "view_stage.h"

#include <stdio.h>
#include <stdlib.h>

/* ---- A host that drops command buffers */

static void record(VkCommandBuffer cmd, uint32_t index, void *user)
{
    struct gi_test *t = user;
    (void)index;
    REQUIRE_CMP((int)sdfgi_update(t->gi, cmd, &t->frame), ==, (int)SDFGI_OK);
}

static void drop(struct gi_test *t)
{
    gpu_test_record_and_drop(&t->gpu, record, t);
}

static sdfgi_material grey(struct gi_test *t)
{
    return gi_test_material(t, (float[]){ 0.5f, 0.5f, 0.5f }, (float[]){ 0, 0, 0 });
}

static void add_box(struct gi_test *t, const double center[static 3], const double half[static 3],
                    sdfgi_material material)
{
    struct test_mesh box = test_mesh_box(center, half, test_rotation_none);
    gi_test_add(t, &box, material);
    test_mesh_destroy(&box);
}

static void start_with(struct gi_test *t, uint32_t cascades, enum sdfgi_surface_light surface_light)
{
    struct sdfgi_settings settings = gi_test_settings();
    settings.surface_light = surface_light;
    settings.resolution = 32;
    settings.cascades = cascades;
    settings.ray_count = 25;
    settings.frames_to_converge = 5;
    gi_test_restart(t, &settings);
    for (int k = 0; k < 3; k++)
        t->frame.camera_position[k] = 0;
    const struct sdfgi_sky sky = { { 1, 1, 1 }, { 1, 1, 1 }, { 0 } };
    REQUIRE_CMP((int)sdfgi_set_sky(t->gi, &sky), ==, (int)SDFGI_OK);
    add_box(t, (double[]){ 0, -1.1, 0 }, (double[]){ 20, 0.4, 20 }, grey(t));
}

static void start(struct gi_test *t, uint32_t cascades)
{
    start_with(t, cascades, SDFGI_SURFACE_LIGHT_PROBES);
}

/* ---- What may happen in a frame */

static void nothing(struct gi_test *t)
{
    (void)t;
}

static void walk_on(struct gi_test *t)
{
    t->frame.camera_position[0] += 3;
}

static void add_wall(struct gi_test *t)
{
    add_box(t, (double[]){ 1.6, 0.4, 0 }, (double[]){ 0.3, 1.1, 1.5 }, grey(t));
}

static void add_lamp(struct gi_test *t)
{
    add_box(t, (double[]){ -1.5, 0.6, 0 }, (double[]){ 0.3, 0.3, 0.3 },
            gi_test_material(t, (float[]){ 0.5f, 0.5f, 0.5f }, (float[]){ 3, 2, 1 }));
}

static void add_light(struct gi_test *t)
{
    sdfgi_light light;
    const struct sdfgi_light_desc desc = { .type = SDFGI_LIGHT_POINT,
                                           .position = { 0, 1, 0 },
                                           .range_m = 10,
                                           .intensity = { 5, 5, 5 },
                                           .indirect_energy = 1,
                                           .casts_shadow = true };
    REQUIRE_CMP((int)sdfgi_light_create(t->gi, &desc, &light), ==, (int)SDFGI_OK);
}

/* More surfaces than the light lists have room for: they grow. */
static void add_shelves(struct gi_test *t)
{
    const sdfgi_material material = grey(t);
    for (int i = 0; i < 8; i++)
        add_box(t, (double[]){ 0, 0.1 + 0.5 * i, 0 }, (double[]){ 8, 0.05, 8 }, material);
}

/* In one run: what happens before a frame, and how often that frame and those after it are dropped first. */
static const struct event {
    void (*before)(struct gi_test *t);
    uint32_t frame, frames;
} events[] = {
    { nothing, 0, 3 },   { walk_on, 12, 1 },     { add_wall, 16, 2 },
    { add_lamp, 22, 1 }, { add_shelves, 28, 5 }, { add_light, 40, 1 },
};
enum { EVENTS = sizeof events / sizeof *events, FRAMES = 50 };

/* ---- Cancelled updates */

static uint64_t hash(struct gi_test *t, enum resource resource)
{
    void *bytes = gi_test_read(t, resource, NULL);
    const uint64_t h = gi_test_hash(bytes, gi_test_ordered_bytes(t, resource));
    free(bytes);
    return h;
}

/* Those that depend on nothing but the scene come first. */
static const enum resource kept[] = { RESOURCE_BITS,   RESOURCE_DISTANCE,   RESOURCE_ALBEDO,
                                      RESOURCE_PROBES, RESOURCE_IRRADIANCE, RESOURCE_FRAME };
enum { KEPT = sizeof kept / sizeof *kept, EXACT = 4 };

static void take_hashes(struct gi_test *t, uint64_t hashes[static KEPT])
{
    for (int i = 0; i < KEPT; i++)
        hashes[i] = hash(t, kept[i]);
}

/* Where `drops`, the frames of events are recorded twice, and dropped and cancelled the first time. */
static void run(struct gi_test *t, bool drops, uint64_t hashes[static KEPT])
{
    start(t, 2);
    for (uint32_t i = 0; i < FRAMES; i++) {
        bool dropped = false;
        for (int e = 0; e < EVENTS; e++) {
            if (i == events[e].frame)
                events[e].before(t);
            dropped = dropped || (i >= events[e].frame && i < events[e].frame + events[e].frames);
        }
        if (drops && dropped) {
            drop(t);
            sdfgi_cancel_update(t->gi);
            sdfgi_cancel_update(t->gi); /* there is none left to undo */
        }
        gi_test_update(t, 1);
    }
    take_hashes(t, hashes);
}

static void cancelled_updates_leave_no_trace(void **state)
{
    (void)state;
    static struct gi_test t;
    const struct sdfgi_settings settings = gi_test_settings();
    uint64_t without[KEPT], with[KEPT];
    gi_test_open(&t, &settings);
    run(&t, false, without);
    run(&t, true, with);
    for (int i = 0; i < KEPT; i++)
        if (without[i] != with[i])
            require_fail(__FILE__, __LINE__, "%s differs", sdfgi_resource_row(kept[i])->name);
    REQUIRE_CMP(t.messages[SDFGI_MESSAGE_UPDATE_LOST], ==, 0u);
    gi_test_close(&t);
}

/* ---- Lost updates */

static const struct gi_test_point floor_point = { { 1, -0.7f, 1.5f }, { 0, 1, 0 } };

static double settled_light(struct gi_test *t, uint64_t hashes[static KEPT])
{
    float light[1][3];
    gi_test_converge(t, 400);
    gi_test_irradiance(t, &floor_point, 1, light);
    take_hashes(t, hashes);
    return (double)light[0][1];
}

static uint64_t lost_by_report(const struct gi_test *t)
{
    static struct sdfgi_report report;
    sdfgi_get_report(t->gi, &report);
    for (uint32_t i = 0; i < report.health_count; i++)
        if (report.health[i].code == SDFGI_MESSAGE_UPDATE_LOST)
            return report.health[i].count;
    return 0;
}

static void lost_updates_are_noticed_and_made_good(void **state)
{
    (void)state;
    static void (*const before[])(struct gi_test *) = { nothing, walk_on, add_wall };
    static struct gi_test t;
    const struct sdfgi_settings settings = gi_test_settings();
    uint64_t fresh[KEPT], found[KEPT];
    gi_test_open(&t, &settings);
    start(&t, 1);
    for (uint32_t i = 0; i < 3; i++) {
        before[i](&t);
        drop(&t);
        gi_test_update(&t, 6);
        REQUIRE_CMP(t.messages[SDFGI_MESSAGE_UPDATE_LOST], ==, i + 1);
        REQUIRE_CMP(lost_by_report(&t), ==, (uint64_t)i + 1);
    }
    const double light = settled_light(&t, found);
    start(&t, 1);
    walk_on(&t);
    add_wall(&t);
    const double light_fresh = settled_light(&t, fresh);
    printf("settled light after lost updates: %.5f, of a fresh context %.5f\n", light, light_fresh);
    REQUIRE_CMP(light_fresh, >, 0.5);
    REQUIRE_NEAR(light / light_fresh, 1, 0.01);
    for (int i = 0; i < EXACT; i++)
        REQUIRE_CMP(found[i], ==, fresh[i]);
    gi_test_close(&t);
}

/* ---- Resets */

/* All but what holds nothing between frames, and the bounds of what the last scroll or edit changed: a start
 * has none. */
static void take_all_hashes(struct gi_test *t, uint64_t hashes[static RESOURCE_COUNT])
{
    for (int i = 0; i < RESOURCE_COUNT; i++)
        hashes[i] = i == RESOURCE_BOUNDS ? 0 : hash(t, (enum resource)i);
}

static void compare_reset_and_start(struct gi_test *t, enum sdfgi_surface_light surface_light)
{
    uint64_t fresh[RESOURCE_COUNT], found[RESOURCE_COUNT];
    start_with(t, 1, surface_light);
    add_lamp(t);
    gi_test_update(t, 8);
    take_all_hashes(t, fresh);
    const uint64_t bytes = t->gi->backend.held.total_bytes;
    walk_on(t);
    gi_test_update(t, 8);
    t->frame.camera_position[0] = 0;
    sdfgi_reset(t->gi);
    REQUIRE_TRUE(!sdfgi_is_active(t->gi));
    gi_test_update(t, 8);
    take_all_hashes(t, found);
    for (int i = 0; i < RESOURCE_COUNT; i++)
        if (fresh[i] != found[i])
            require_fail(__FILE__, __LINE__, "%s differs", sdfgi_resource_row((enum resource)i)->name);
    REQUIRE_CMP(t->gi->backend.held.total_bytes, ==, bytes);
}

static void a_reset_is_a_fresh_start_in_the_same_memory(void **state)
{
    (void)state;
    static struct gi_test t;
    const struct sdfgi_settings settings = gi_test_settings();
    gi_test_open(&t, &settings);
    compare_reset_and_start(&t, SDFGI_SURFACE_LIGHT_PROBES);
    compare_reset_and_start(&t, SDFGI_SURFACE_LIGHT_CELLS);
    gi_test_close(&t);
}

/* ---- Pictures */

static struct view_stage stage;

struct resolve {
    sdfgi_view *view;
    struct sdfgi_resolve_desc desc;
};

static void record_resolve(VkCommandBuffer cmd, uint32_t index, void *user)
{
    (void)index;
    const struct resolve *r = user;
    REQUIRE_CMP((int)sdfgi_update(stage.t.gi, cmd, &stage.t.frame), ==, (int)SDFGI_OK);
    REQUIRE_CMP((int)sdfgi_view_resolve(stage.t.gi, r->view, cmd, &r->desc), ==, (int)SDFGI_OK);
}

/* The swapchain was out of date when the first picture was to be shown. Validation knows that the view's
 * pictures are in no layout yet. */
static void a_first_resolve_that_never_ran_leaves_no_trace(void **state)
{
    (void)state;
    static float shown[2][VIEW_STAGE_PIXELS][4];
    view_stage_open(&stage, 1);
    struct resolve r = { view_stage_view(&stage), view_stage_desc(&stage, stage.depth.view) };
    gpu_test_record_and_drop(&stage.t.gpu, record_resolve, &r);
    sdfgi_cancel_update(stage.t.gi);
    for (int i = 0; i < 2; i++) {
        view_stage_resolve(&stage, r.view, 0.2f);
        view_stage_read(&stage, &r.view->reflection, shown[i]);
        sdfgi_view_destroy(stage.t.gi, r.view);
        r.view = view_stage_view(&stage);
    }
    REQUIRE_TRUE(memcmp(shown[0], shown[1], sizeof shown[0]) == 0);
    view_stage_close(&stage);
    gi_test_close(&stage.t);
}

TEST_GROUP(lost_update)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(cancelled_updates_leave_no_trace),
        cmocka_unit_test(lost_updates_are_noticed_and_made_good),
        cmocka_unit_test(a_reset_is_a_fresh_start_in_the_same_memory),
        cmocka_unit_test(a_first_resolve_that_never_ran_leaves_no_trace),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
