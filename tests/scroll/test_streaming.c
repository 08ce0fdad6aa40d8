/* SPDX-License-Identifier: MIT
 * Instances come, move and go while the camera walks: 10,000 operations leave the volumes of a fresh context,
 * and no memory behind. A host that does anything at random leaves none either. */
#include "light_scene.h"

#include "hard_case.h"
#include "random_setting.h"
#include "require.h"
#include "test_group.h"
#include "scroll_scene.h"
#include "test_memory.h"

#include <malloc.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

enum { SLOTS = 24, MESHES = 3, OPERATIONS = 10000 };

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
    const bool full = scroll_is_full();
    struct test_mesh meshes[MESHES] = {
        test_mesh_box(center, half, test_rotation_none), test_mesh_sphere(center, 0.8, full ? 2 : 1),
        test_mesh_torus(center, 0.9, 0.3, test_rotation_none, full ? 16 : 8, full ? 8 : 5)
    };
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
    const uint32_t per_frame = scroll_is_full() ? 100 : 500;
    memset(&w, 0, sizeof w);
    open_world(&w, &walked, &settings);
    scroll_stand(&walked, camera);
    gi_test_update(&walked, 4);
    const uint64_t before = held(&walked);
    for (uint32_t i = 0; i < OPERATIONS; i++) {
        operate(&w, &random, camera);
        scroll_stand(&walked, camera);
        if (i % per_frame == 0) {
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

/* ---- A host at random */

enum { LAMPS = 4, FRAMES_SHORT = 60, FRAMES_FULL = 10000, FRAMES_BETWEEN = 10, FRAMES_OF_SETTINGS = 10 };

struct random_host {
    struct world world;
    struct gi_test *t;
    struct test_random random;
    struct sdfgi_settings base, settings;
    sdfgi_light lamps[LAMPS];
    bool shines[LAMPS];
    double camera[3];
    uint32_t frames; /* that it has updated */
};

static uint32_t below(struct random_host *h, uint32_t count)
{
    return (uint32_t)test_random_real(&h->random, 0, count);
}

static struct sdfgi_light_desc any_light(struct random_host *h)
{
    struct sdfgi_light_desc light = light_sun(0.3f, -0.8f, (float)test_random_real(&h->random, -1, 1), 3);
    light.type = (enum sdfgi_light_type)below(h, 3);
    for (int i = 0; i < 3; i++) {
        light.position[i] = test_random_real(&h->random, -6, 6);
        light.intensity[i] = (float)test_random_real(&h->random, 0, 20);
    }
    light.range_m = below(h, 2) ? 0 : (float)test_random_real(&h->random, 1, 9);
    light.outer_angle_rad = (float)test_random_real(&h->random, 0.1, 1.5);
    light.casts_shadow = below(h, 2);
    return light;
}

static void change_lamp(struct random_host *h)
{
    const uint32_t i = below(h, LAMPS);
    const struct sdfgi_light_desc light = any_light(h);
    const bool goes = h->shines[i] && below(h, 3) == 0;
    enum sdfgi_result result;
    if (!h->shines[i])
        result = sdfgi_light_create(h->t->gi, &light, &h->lamps[i]);
    else
        result = goes ? sdfgi_light_destroy(h->t->gi, h->lamps[i])
                      : sdfgi_light_update(h->t->gi, h->lamps[i], &light);
    REQUIRE_CMP((int)result, ==, (int)SDFGI_OK);
    h->shines[i] = !goes;
}

static void change_sky(struct random_host *h)
{
    struct sdfgi_sky sky;
    for (int i = 0; i < 3; i++) {
        sky.zenith[i] = (float)test_random_real(&h->random, 0, 2);
        sky.horizon[i] = (float)test_random_real(&h->random, 0, 2);
        sky.ground[i] = (float)test_random_real(&h->random, 0, 1);
    }
    REQUIRE_CMP((int)sdfgi_set_sky(h->t->gi, &sky), ==, (int)SDFGI_OK);
}

/* Every property in its turn, but only what costs about as much. */
static void change_setting(struct random_host *h)
{
    char text[RANDOM_SETTING_TEXT];
    struct sdfgi_settings changed = h->settings;
    random_setting_change(&h->random, below(h, random_setting_rows()), &h->base, &changed, text);
    if (random_setting_memory(&changed) > 2 * random_setting_memory(&h->base))
        return;
    h->settings = changed;
    REQUIRE_CMP((int)sdfgi_set_settings(h->t->gi, &h->settings), ==, (int)SDFGI_OK);
}

static void toggle(struct random_host *h)
{
    h->settings.enabled = !h->settings.enabled;
    REQUIRE_CMP((int)sdfgi_set_settings(h->t->gi, &h->settings), ==, (int)SDFGI_OK);
}

static void change_frame(struct random_host *h)
{
    static const float exposures[] = { 0, 1, 0.01f, 1e-6f, 1000 };
    h->t->frame.exposure = exposures[below(h, 5)];
    h->t->frame.seed = below(h, 2);
    h->t->frame.origin[below(h, 3)] = test_random_real(&h->random, -100, 100);
}

static void invalidate(struct random_host *h)
{
    double low[3], high[3];
    for (int i = 0; i < 3; i++) {
        low[i] = test_random_real(&h->random, -9, 9);
        high[i] = low[i] + test_random_real(&h->random, 0, 4);
    }
    REQUIRE_CMP((int)sdfgi_invalidate_box(h->t->gi, low, high), ==, (int)SDFGI_OK);
}

/* Instances and the camera most of the time, settings seldom: those that recreate all leave nothing to test.
 */
static void do_anything(struct random_host *h)
{
    const uint32_t what = below(h, 64);
    if (what < 40)
        operate(&h->world, &h->random, h->camera);
    else if (what < 52)
        change_lamp(h);
    else if (what < 55)
        change_sky(h);
    else if (what < 58)
        change_frame(h);
    else if (what < 60)
        invalidate(h);
    else if (what < 62)
        toggle(h);
    else
        change_setting(h);
}

/* If it takes about as much memory. */
static void try_value(struct random_host *h, const char *name, const char *value)
{
    struct sdfgi_settings settings = h->base;
    char error[200];
    REQUIRE_TRUE(sdfgi_settings_set(&settings, name, value, error, sizeof error));
    if (random_setting_memory(&settings) > 2 * random_setting_memory(&h->base))
        return;
    REQUIRE_CMP((int)sdfgi_set_settings(h->t->gi, &settings), ==, (int)SDFGI_OK);
    gi_test_update(h->t, 4);
}

/* Gives each property that chooses a way of doing things all its values, so that every pipeline is made. */
static void try_every_choice(struct random_host *h)
{
    const struct sdfgi_property_info *info;
    for (uint32_t row = 0; (info = sdfgi_property_get_info(row)); row++) {
        char value[64];
        if (info->type == SDFGI_PROPERTY_BOOL)
            try_value(h, info->name, sdfgi_settings_get(&h->base, info->name) != 0 ? "false" : "true");
        for (const char *at = info->choices; *at; at += strspn(at, ",")) {
            snprintf(value, sizeof value, "%.*s", (int)strcspn(at, ","), at);
            at += strcspn(at, ",");
            try_value(h, info->name, value);
        }
    }
    REQUIRE_CMP((int)sdfgi_set_settings(h->t->gi, &h->base), ==, (int)SDFGI_OK);
}

static void require_finite(struct random_host *h)
{
    static const float places[4][3] = { { 0, -2.15f, 0 }, { 1, 0.5f, -1 }, { -3, -2.15f, 2 }, { 7, 1, -8 } };
    struct gi_test_point points[4] = { 0 };
    float found[4][3];
    for (int i = 0; i < 4; i++) {
        points[i].normal[1] = 1;
        for (int k = 0; k < 3; k++)
            points[i].position[k] = (float)((double)places[i][k] - h->t->frame.origin[k]);
    }
    gi_test_lookup(h->t, sdfgi_get_descriptor_set(h->t->gi), NULL, points, 4, found);
    for (int i = 0; i < 12; i++)
        REQUIRE_TRUE(isfinite(found[i / 3][i % 3]) && found[i / 3][i % 3] >= 0);
}

/* Bytes that the process has allocated and not freed. Resident pages would tell how the allocator lays them
 * out, too, and the suite has it return nothing. */
static double heap_in_use(void)
{
    const struct mallinfo2 heap = mallinfo2();
    return (double)heap.uordblks + (double)heap.hblkhd;
}

/* Back to what it was at first; `held` then tells what the frames before have left. `heap` is what is in use
 * while the context holds nothing on the device. */
static uint64_t held_at_rest(struct random_host *h, double *heap)
{
    h->settings = h->base;
    h->settings.enabled = false;
    REQUIRE_CMP((int)sdfgi_set_settings(h->t->gi, &h->settings), ==, (int)SDFGI_OK);
    gi_test_update(h->t, 4);
    REQUIRE_CMP(held(h->t), ==, 0ul);
    REQUIRE_TRUE(h->t->gi->backend.retired.first == NULL);
    *heap = heap_in_use();
    h->settings = h->base;
    REQUIRE_CMP((int)sdfgi_set_settings(h->t->gi, &h->settings), ==, (int)SDFGI_OK);
    gi_test_update(h->t, 4);
    return held(h->t);
}

static uint32_t message_count(const struct gi_test *t)
{
    uint32_t count = 0;
    for (int i = 0; i < SDFGI_MESSAGE_COUNT; i++)
        count += t->messages[i];
    return count;
}

static void host_open(struct random_host *h, struct gi_test *t)
{
    memset(h, 0, sizeof *h);
    h->t = t;
    h->random.state = 61;
    h->base = scroll_settings(32);
    h->base.min_cell_size_m = 0.5f;
    h->base.ray_count = 25;
    h->base.cell_rays = 16;
    h->base.cell_rays_per_frame = 8192;
    h->settings = h->base;
    open_world(&h->world, t, &h->base);
}

/* What is set would stay for hundreds of frames, and a flood takes 0.3 s a frame on a software driver. */
static void restore_settings(struct random_host *h)
{
    const bool enabled = h->settings.enabled;
    h->settings = h->base;
    h->settings.enabled = enabled;
    REQUIRE_CMP((int)sdfgi_set_settings(h->t->gi, &h->settings), ==, (int)SDFGI_OK);
}

/* Something in every second frame. */
static void host_frame(struct random_host *h)
{
    for (uint32_t left = below(h, 2); left > 0; left--)
        do_anything(h);
    scroll_stand(h->t, h->camera);
    gi_test_update(h->t, 1);
    h->frames++;
}

/* The settled volumes of a host that did anything are those of a fresh context. */
static void require_no_trace(struct random_host *h)
{
    static struct gi_test fresh;
    static struct world same;
    memset(h->t->frame.origin, 0, sizeof h->t->frame.origin);
    h->t->frame.seed = 0;
    gi_test_update(h->t, 2);
    open_world(&same, &fresh, &h->base);
    for (uint32_t i = 0; i < SLOTS; i++) {
        same.slots[i] = h->world.slots[i];
        if (same.slots[i].used)
            create(&same, &same.slots[i]);
    }
    /* Where light cells are depends on no light, and their direct light does: it stays behind. */
    scroll_stand(&fresh, h->camera);
    scroll_place_as(&fresh, h->t);
    scroll_settle(&fresh);
    scroll_settle(h->t);
    scroll_require_equal_but_light(h->t, &fresh, "after a random host");
    gi_test_close(&fresh);
}

static void hard_61_a_host_at_random_leaves_no_trace(void **state)
{
    (void)state;
    static struct gi_test t;
    static struct random_host h;
    const uint32_t frames = scroll_is_full() ? FRAMES_FULL : FRAMES_SHORT;
    double first_heap, halfway_heap = 0, heap;
    host_open(&h, &t);
    if (scroll_is_full())
        try_every_choice(&h);
    const uint64_t before = held_at_rest(&h, &first_heap);
    for (uint32_t i = 0; i < frames; i++) {
        host_frame(&h);
        if (i % FRAMES_BETWEEN == 0)
            require_finite(&h);
        if (i % FRAMES_OF_SETTINGS == 0)
            restore_settings(&h);
        if (i == frames / 2) /* every pool has its size */
            held_at_rest(&h, &halfway_heap);
    }
    const uint64_t after = held_at_rest(&h, &heap);
    printf(
        "%u random frames: %u messages, device memory %llu bytes before and %llu after, heap %.0f, halfway "
        "%.0f and at the end %.0f bytes\n",
        frames, message_count(&t), (unsigned long long)before, (unsigned long long)after, first_heap,
        halfway_heap, heap);
    HARD_CASE_AT_LEAST(61, "random frames", h.frames, scroll_is_full() ? 10000 : FRAMES_SHORT);
    HARD_CASE_AT_MOST(61, "messages", message_count(&t), 0);
    HARD_CASE_AT_MOST(61, "device memory after, over before", (double)after / (double)before, 1);
    HARD_CASE_AT_MOST(61, "heap at the end, over that halfway", heap / halfway_heap, 1.02);
    require_no_trace(&h);
    gi_test_close(&t);
}

/* Something static is deleted before a camera at rest: its shadow and its bounce go, in frames, not in
 * cycles.
 */
static void a_deleted_instance_loses_its_shadow(void **state)
{
    (void)state;
    static struct gi_test t;
    static struct world w;
    struct sdfgi_settings settings = scroll_settings(scroll_is_full() ? 64 : 32);
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

TEST_GROUP(streaming)
{
    if (!gpu_test_available())
        return GPU_TEST_SKIP;
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(ten_thousand_operations_leave_no_trace),
        cmocka_unit_test(hard_61_a_host_at_random_leaves_no_trace),
        cmocka_unit_test(a_deleted_instance_loses_its_shadow),
    };
    return cmocka_run_group_tests_name("scroll_streaming", tests, NULL, NULL);
}
