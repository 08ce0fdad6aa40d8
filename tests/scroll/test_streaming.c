/* SPDX-License-Identifier: MIT
 * Instances come, move and go while the camera walks: 10,000 operations leave the volumes of a fresh context,
 * and no memory behind. */
#include "light_scene.h"
#include "require.h"
#include "scroll_scene.h"
#include "test_memory.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

enum { SLOTS = 24, MESHES = 3, OPERATIONS = 10000, PER_FRAME = 100 };

struct slot {
    bool used;
    uint32_t mesh;
    struct sdfgi_transform transform;
    sdfgi_instance instance;
};

struct world {
    struct gi_test *t;
    sdfgi_mesh meshes[MESHES];
    sdfgi_material materials[MESHES];
    struct slot slots[SLOTS];
};

static void open_world(struct world *w, struct gi_test *t, const struct sdfgi_settings *settings)
{
    const double center[3] = { 0, 0, 0 }, half[3] = { 0.9, 0.35, 0.6 };
    struct test_mesh meshes[MESHES] = { test_mesh_box(center, half, test_rotation_none),
                                        test_mesh_sphere(center, 0.8, 2),
                                        test_mesh_torus(center, 0.9, 0.3, test_rotation_none, 16, 8) };
    static const float albedo[MESHES][3] = { { 0.8f, 0.3f, 0.1f },
                                             { 0.2f, 0.6f, 0.7f },
                                             { 0.5f, 0.5f, 0.5f } };
    static const float emission[MESHES][3] = { { 0, 0, 0 }, { 1, 0.5f, 0.25f }, { 0, 0, 0 } };
    w->t = t;
    gi_test_open(t, settings);
    for (uint32_t i = 0; i < MESHES; i++) {
        w->meshes[i] = gi_test_mesh(t, &meshes[i]);
        w->materials[i] = gi_test_material(t, albedo[i], emission[i]);
        test_mesh_destroy(&meshes[i]);
    }
    light_add_box(t, (double[]){ -30, -3, -30 }, (double[]){ 30, -2.2, 30 }, (float[]){ 0.4f, 0.5f, 0.3f },
                  0);
    const struct sdfgi_light_desc sun = light_sun(0.3f, -0.9f, 0.1f, 4);
    light_create(t, &sun);
    light_set_uniform_sky(t, 1);
}

static void create(struct world *w, struct slot *slot)
{
    const struct sdfgi_instance_desc desc = { .mesh = w->meshes[slot->mesh],
                                              .material = w->materials[slot->mesh],
                                              .transform = slot->transform };
    REQUIRE_CMP(sdfgi_instance_create(w->t->gi, &desc, &slot->instance), ==, SDFGI_OK);
    slot->used = true;
}

static struct sdfgi_transform anywhere(struct test_random *random)
{
    double rotation[9], axis[3];
    test_random_direction(random, axis);
    test_rotation(axis, test_random_real(random, 0, 6), rotation);
    struct sdfgi_transform transform;
    const double size = test_random_real(random, 0.3, 1.6);
    for (int i = 0; i < 9; i++)
        transform.basis[i] = (float)(rotation[i] * size);
    for (int i = 0; i < 3; i++)
        transform.translation[i] = test_random_real(random, -8, 8) * (i == 1 ? 0.3 : 1);
    return transform;
}

static void operate(struct world *w, struct test_random *random, double camera[static 3])
{
    struct slot *slot = &w->slots[test_random_uint(random) % SLOTS];
    if (test_random_uint(random) % 8 == 0) {
        for (int i = 0; i < 3; i++)
            camera[i] = fmin(fmax(camera[i] + test_random_real(random, -0.6, 0.6), -6), 6);
        return;
    }
    if (!slot->used) {
        slot->mesh = test_random_uint(random) % MESHES;
        slot->transform = anywhere(random);
        create(w, slot);
    } else if (test_random_uint(random) % 3 == 0) {
        REQUIRE_CMP(sdfgi_instance_destroy(w->t->gi, slot->instance), ==, SDFGI_OK);
        slot->used = false;
    } else {
        slot->transform = anywhere(random);
        REQUIRE_CMP(sdfgi_instance_set_transform(w->t->gi, slot->instance, &slot->transform), ==, SDFGI_OK);
    }
}

static uint64_t held(const struct gi_test *t)
{
    static struct sdfgi_report report;
    sdfgi_get_report(t->gi, &report);
    return report.memory.total_bytes;
}

static void ten_thousand_operations_leave_no_trace(void **state)
{
    (void)state;
    static struct gi_test walked, fresh;
    static struct world w, same;
    const struct sdfgi_settings settings = scroll_settings(32);
    struct test_random random = { 77 };
    double camera[3] = { 0, 0, 0 };
    memset(&w, 0, sizeof w);
    open_world(&w, &walked, &settings);
    scroll_stand(&walked, camera);
    gi_test_update(&walked, 4);
    const uint64_t before = held(&walked);
    for (uint32_t i = 0; i < OPERATIONS; i++) {
        operate(&w, &random, camera);
        scroll_stand(&walked, camera);
        if (i % PER_FRAME == 0) {
            gi_test_update(&walked, 1);
            REQUIRE_CMP(walked.gi->frame.scroll.cells, <=, (uint64_t)settings.max_scroll_cells);
        }
    }
    scroll_settle(&walked);
    printf("%u steps, memory %llu bytes before and %llu after\n",
           (unsigned)walked.gi->volume.state.scroll.scrolls_begun, (unsigned long long)before,
           (unsigned long long)held(&walked));
    REQUIRE_CMP(held(&walked), ==, before);
    REQUIRE_CMP(walked.gi->volume.state.scroll.scrolls_begun, >, 5u);

    open_world(&same, &fresh, &settings);
    for (uint32_t i = 0; i < SLOTS; i++) {
        same.slots[i] = w.slots[i];
        if (same.slots[i].used)
            create(&same, &same.slots[i]);
    }
    scroll_stand(&fresh, camera);
    scroll_place_as(&fresh, &walked);
    scroll_settle(&fresh);
    scroll_require_equal(&walked, &fresh, "after 10,000 operations");
    gi_test_close(&fresh);
    gi_test_close(&walked);
}

/* Something static is deleted before a camera at rest: its shadow and its bounce go, in frames, not in
 * cycles.
 */
static void a_deleted_instance_loses_its_shadow(void **state)
{
    (void)state;
    static struct gi_test t;
    static struct world w;
    struct sdfgi_settings settings = scroll_settings(64);
    memset(&w, 0, sizeof w);
    open_world(&w, &t, &settings);
    scroll_stand(&t, (double[]){ 0, 0, 0 });
    w.slots[0] = (struct slot){ .mesh = 0, .transform = { { 3, 0, 0, 0, 1, 0, 0, 0, 3 }, { 0, -1, 0 } } };
    gi_test_converge(&t, 300);
    const struct gi_test_point below = { { 0.2f, -2.15f, 0.1f }, { 0, 1, 0 } };
    const double open = light_white_at(&t, below);
    create(&w, &w.slots[0]);
    gi_test_converge(&t, 300);
    const double shaded = light_white_at(&t, below);
    REQUIRE_CMP(sdfgi_instance_destroy(t.gi, w.slots[0].instance), ==, SDFGI_OK);
    const uint32_t frames = gi_test_converge(&t, 300);
    const double again = light_white_at(&t, below);
    printf("under an open sky %.4f, under a slab %.4f, slab deleted %.4f after %u frames\n", open, shaded,
           again, frames);
    REQUIRE_CMP(shaded, <, 0.6 * open);
    REQUIRE_CMP(shaded, >, 0.01 * open);
    REQUIRE_NEAR(again / open, 1, 0.005);
    gi_test_close(&t);
}

int main(void)
{
    if (!gpu_test_available())
        return GPU_TEST_SKIP;
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(ten_thousand_operations_leave_no_trace),
        cmocka_unit_test(a_deleted_instance_loses_its_shadow),
    };
    return cmocka_run_group_tests_name("scroll_streaming", tests, NULL, NULL);
}
