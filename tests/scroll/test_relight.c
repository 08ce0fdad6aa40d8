/* SPDX-License-Identifier: MIT
 * Direct light while cascades scroll: cells that stay keep theirs, new ones are lit in the frame that
 * completes, those that stay are lit again within a budget, probes wait for no more than such a frame, and in
 * the end all is as after a fresh start. */
#include "light_scene.h"
#include "require.h"
#include "test_group.h"
#include "scroll_scene.h"
#include "test_memory.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const double home[3] = { 0.3, 0.2, -0.4 };

/* Probes do not matter here: one ray a frame. */
static struct sdfgi_settings relight_settings(uint32_t resolution, uint32_t cascades)
{
    struct sdfgi_settings settings = scroll_settings(resolution);
    settings.min_cell_size_m = 16.0f / (float)resolution;
    settings.cascades = cascades;
    settings.ray_count = 1;
    settings.frames_to_converge = 25;
    return settings;
}

/* `room` light cells a cascade, or as many as there are (0). */
static void open_at(struct gi_test *t, const struct sdfgi_settings *settings, const double position[static 3],
                    uint64_t room)
{
    gi_test_open(t, settings);
    if (room > 0)
        t->gi->volume.resources->extent.light_cells = t->gi->volume.resources->extent.light_cells_max = room;
    scroll_world(t, home, 16);
    /* Enters with a step of two metres along x, and throws its shadow four metres back. */
    light_add_box(t, (double[]){ 8.3, 4, -1.5 }, (double[]){ 9.7, 5.5, 1.5 }, (float[]){ 0.5f, 0.5f, 0.5f },
                  0);
    scroll_stand(t, position);
}

static void open_fresh(struct gi_test *fresh, const struct gi_test *walked, const double position[static 3],
                       uint64_t room)
{
    open_at(fresh, &walked->gi->settings, position, room);
    scroll_place_as(fresh, walked);
    scroll_settle(fresh);
}

struct entry {
    uint32_t place;
    struct gi_test_direct direct;
};

static struct entry *read_list(struct gi_test *t, uint32_t *count)
{
    uint32_t *counters = gi_test_read(t, RESOURCE_COUNTERS, NULL);
    *count = counters[SDFGI_COUNTER_LIGHT_CELLS];
    free(counters);
    const uint64_t room = t->gi->volume.resources->extent.light_cells;
    uint32_t *places = gi_test_read(t, RESOURCE_LIGHT_CELLS, NULL),
             *direct = gi_test_read(t, RESOURCE_DIRECT, NULL);
    struct entry *list = test_array_alloc(*count, sizeof *list);
    for (uint32_t i = 0; i < *count; i++)
        list[i] = (struct entry){ places[i], gi_test_direct_at(direct, room, 0, i) };
    free(places);
    free(direct);
    return list;
}

static bool is_lit(const struct entry *e)
{
    return e->direct.color != 0;
}

static bool same_direct(const struct entry *a, const struct entry *b)
{
    return memcmp(&a->direct, &b->direct, sizeof a->direct) == 0;
}

/* Steps of 8 cells touch cells up to 16 from either end; further in, nothing is renewed. */
static bool stays(const struct gi_test *t, const struct entry *e)
{
    const uint32_t n = t->gi->settings.resolution;
    const uint32_t x = (e->place - (uint32_t)t->gi->volume.state.params.cascades[0].wrap.x) & (n - 1);
    return x >= 16 && x < n - 16;
}

/* One step along x, up to the frame that completes it; nothing is lit again meanwhile. */
static void step_until_complete(struct gi_test *t, const double to[static 3])
{
    t->gi->volume.state.relight.budget = 0;
    scroll_stand(t, to);
    for (uint32_t frames = 0; frames < 100; frames++) {
        gi_test_update(t, 1);
        if (sdfgi_cascade_completes(&t->gi->frame.next.cascades.at[0]))
            return;
    }
    require_fail(__FILE__, __LINE__, "no step is complete after 100 frames");
}

static void cells_that_stay_keep_direct_light_and_new_ones_get_theirs_at_once(void **state)
{
    (void)state;
    static struct gi_test t, fresh;
    const struct sdfgi_settings settings = relight_settings(64, 1);
    const double to[3] = { home[0] + 3, home[1], home[2] };
    open_at(&t, &settings, home, 0);
    scroll_settle(&t);
    uint32_t old_count, count, fresh_count;
    struct entry *old = read_list(&t, &old_count);
    step_until_complete(&t, to);
    struct entry *list = read_list(&t, &count);
    open_fresh(&fresh, &t, to, 0);
    struct entry *wanted = read_list(&fresh, &fresh_count);
    REQUIRE_CMP(count, ==, fresh_count);

    struct entry **before = test_array_alloc(64 * 64 * 64, sizeof *before);
    memset(before, 0, 64 * 64 * 64 * sizeof *before);
    for (uint32_t i = 0; i < old_count; i++)
        before[old[i].place & 0xffffff] = &old[i];
    uint32_t kept = 0, kept_lit = 0, fresh_lit = 0, shadows_moved = 0;
    for (uint32_t i = 0; i < count; i++) {
        REQUIRE_CMP(list[i].place, ==, wanted[i].place);
        if (stays(&t, &list[i])) {
            const struct entry *was = before[list[i].place & 0xffffff];
            REQUIRE_TRUE(was && same_direct(&list[i], was));
            kept++;
            kept_lit += is_lit(was);
            shadows_moved += !same_direct(was, &wanted[i]);
        } else {
            REQUIRE_TRUE(same_direct(&list[i], &wanted[i]));
            fresh_lit += is_lit(&wanted[i]);
        }
    }
    printf("%u of %u cells stay, %u of them lit; %u others lit at once; other shadows on %u that stay\n",
           kept, count, kept_lit, fresh_lit, shadows_moved);
    REQUIRE_CMP(kept_lit, >, 500u);
    REQUIRE_CMP(fresh_lit, >, 500u);
    REQUIRE_CMP(shadows_moved, >, 0u);

    t.gi->volume.state.relight.budget = 300;
    REQUIRE_CMP(scroll_settle(&t), <=, (count + 299) / 300 + 5);
    scroll_require_equal(&t, &fresh, "lit again");
    free(before);
    free(wanted);
    free(list);
    free(old);
    gi_test_close(&fresh);
    gi_test_close(&t);
}

/* Cells that this frame lit as new, by the counts that the library knew when it recorded it. */
static uint64_t renewed_work(const struct gi_test *t)
{
    uint64_t cells = 0;
    for (uint32_t c = 0; c < t->gi->settings.cascades; c++)
        if (sdfgi_cascade_completes(&t->gi->frame.next.cascades.at[c]))
            cells += t->gi->volume.feedback.counters[SDFGI_COUNTER_LIGHT_DIRTY + c];
    return cells;
}

/* Probes wait where a step leaves a frame enough to do. */
static bool sent_rays(const struct gi_test *t)
{
    return t->gi->passes[PASS_PROBE_SUM].tally.dispatches > 0;
}

/* So small a budget that steps come while cells still wait for light. */
static void a_walk_lights_cells_again_within_the_budget(void **state)
{
    (void)state;
    enum { BUDGET = 128 };
    static struct gi_test t, fresh;
    const struct sdfgi_settings settings = relight_settings(32, 2);
    double camera[3] = { home[0], home[1], home[2] };
    open_at(&t, &settings, camera, 0);
    scroll_settle(&t);
    t.gi->volume.state.relight.budget = BUDGET;
    uint32_t busy = 0, completed_on_the_way = 0, waited = 0, since_waited = 3;
    for (uint32_t frame = 0; frame < 60; frame++) {
        const bool waiting = sdfgi_relight_is_due(&t.gi->volume.state.relight);
        camera[0] += 0.3;
        scroll_stand(&t, camera);
        gi_test_update(&t, 1);
        const uint64_t again = t.gi->passes[PASS_LIGHT_DIRECT].tally.units - renewed_work(&t);
        REQUIRE_CMP(again, <=, (uint64_t)BUDGET);
        REQUIRE_TRUE(sent_rays(&t) || sdfgi_cascades_complete(&t.gi->frame.next.cascades));
        REQUIRE_TRUE(sent_rays(&t) || since_waited >= 3);
        waited += !sent_rays(&t);
        since_waited = sent_rays(&t) ? since_waited + 1 : 0;
        busy += again == BUDGET;
        completed_on_the_way += waiting && sdfgi_cascades_complete(&t.gi->frame.next.cascades);
    }
    printf("%u of 60 frames lit as many cells as they may, %u completed a step meanwhile, %u sent no rays\n",
           busy, completed_on_the_way, waited);
    REQUIRE_CMP(waited, >=, 2u);
    REQUIRE_CMP(busy, >, 30u);
    REQUIRE_CMP(completed_on_the_way, >=, 2u);
    scroll_settle(&t);
    open_fresh(&fresh, &t, camera, 0);
    scroll_require_equal(&t, &fresh, "after a walk");
    gi_test_close(&fresh);
    gi_test_close(&t);
}

/* Something changes in every frame: cells that stay are lit again all the same, in all cascades. */
static void changes_in_every_frame_keep_nobody_waiting(void **state)
{
    (void)state;
    static struct gi_test t;
    const struct sdfgi_settings settings = relight_settings(32, 2);
    open_at(&t, &settings, home, 0);
    const sdfgi_instance box =
        light_add_box(&t, (double[]){ 0, 0, 0 }, (double[]){ 1, 1, 1 }, (float[]){ 0.5f, 0.5f, 0.5f }, 0);
    scroll_settle(&t);
    t.gi->volume.state.relight.budget = 2000;
    uint32_t turns[2] = { 0 }, completed = 0;
    struct sdfgi_transform transform = { { 1, 0, 0, 0, 1, 0, 0, 0, 1 }, { 0, 0, 0 } };
    for (uint32_t frame = 0; frame < 32; frame++) {
        transform.translation[0] = 0.02 * frame;
        REQUIRE_CMP(sdfgi_instance_set_transform(t.gi, box, &transform), ==, SDFGI_OK);
        uint32_t before[2];
        for (uint32_t c = 0; c < 2; c++)
            before[c] = t.gi->volume.state.relight.at[c].next;
        gi_test_update(&t, 1);
        REQUIRE_TRUE(sent_rays(&t));
        completed += sdfgi_cascades_complete(&t.gi->frame.next.cascades);
        for (uint32_t c = 0; c < 2; c++)
            turns[c] += t.gi->volume.state.relight.at[c].next < before[c];
    }
    printf("%u frames completed a change, lists lit again %u and %u times\n", completed, turns[0], turns[1]);
    REQUIRE_CMP(completed, >, 24u);
    REQUIRE_TRUE(turns[0] > 0 && turns[1] > 0);
    gi_test_close(&t);
}

static sdfgi_instance add_box(struct gi_test *t, double x, double y, double z, double size)
{
    const double low[3] = { x, y, z }, high[3] = { x + size, y + 1, z + size };
    return light_add_box(t, low, high, (float[]){ 0.5f, 0.5f, 0.5f }, 0);
}

/* Cells at the same place among the first `end` of `list` that have other direct light than in `before`. */
static uint32_t lit_otherwise(const struct entry *list, uint32_t end, const struct entry *before,
                              uint32_t count)
{
    uint32_t others = 0;
    for (uint32_t i = 0; i < end; i++)
        for (uint32_t k = 0; k < count; k++)
            others += before[k].place == list[i].place && !same_direct(&before[k], &list[i]);
    return others;
}

/* A roof goes while cells under it have been lit again for another reason: they are lit once more. */
static void a_change_while_cells_are_lit_again_starts_that_over(void **state)
{
    (void)state;
    static struct gi_test t, fresh;
    const struct sdfgi_settings settings = relight_settings(32, 1);
    open_at(&t, &settings, home, 0);
    const sdfgi_instance roof = add_box(&t, -2, 5, -3, 5);
    scroll_settle(&t);
    t.gi->volume.state.relight.budget = 250;
    add_box(&t, -7, 5, -7, 1);
    uint32_t count, end;
    do
        gi_test_update(&t, 1);
    while (t.gi->volume.state.cascades.at[0].change.cause != CHANGE_NONE ||
           t.gi->volume.state.relight.at[0].next < 1500);
    struct entry *before = read_list(&t, &count);
    REQUIRE_CMP(sdfgi_instance_destroy(t.gi, roof), ==, SDFGI_OK);
    scroll_settle(&t);
    struct entry *list = read_list(&t, &end);
    const uint32_t others = lit_otherwise(list, 1500, before, count);
    printf("%u of the first 1500 of %u cells lit otherwise without the roof\n", others, end);
    REQUIRE_CMP(others, >, 20u);

    open_at(&fresh, &settings, home, 0);
    add_box(&fresh, -7, 5, -7, 1);
    scroll_place_as(&fresh, &t);
    scroll_settle(&fresh);
    scroll_require_equal(&t, &fresh, "without the roof");
    free(list);
    free(before);
    gi_test_close(&fresh);
    gi_test_close(&t);
}

/* Which cells have room changes with every step. */
static void without_room_for_all_the_first_are_those_of_a_fresh_start(void **state)
{
    (void)state;
    enum { ROOM = 900 };
    static struct gi_test t, fresh;
    const struct sdfgi_settings settings = relight_settings(32, 1);
    const double way[3][3] = { { 6.3, 0.2, -0.4 }, { 6.3, 0.2, 5.6 }, { 0.3, 0.2, 5.6 } };
    open_at(&t, &settings, home, ROOM);
    scroll_settle(&t);
    for (int i = 0; i < 3; i++) {
        scroll_stand(&t, way[i]);
        scroll_settle(&t);
        open_fresh(&fresh, &t, way[i], ROOM);
        uint32_t count, fresh_count;
        struct entry *list = read_list(&t, &count), *wanted = read_list(&fresh, &fresh_count);
        REQUIRE_CMP(count, ==, fresh_count);
        REQUIRE_CMP(count, >, ROOM + 500u);
        REQUIRE_BYTES(list, wanted, sizeof *list * ROOM);
        free(wanted);
        free(list);
        gi_test_close(&fresh);
    }
    gi_test_close(&t);
}

TEST_GROUP(relight)
{
    if (!gpu_test_available())
        return GPU_TEST_SKIP;
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(cells_that_stay_keep_direct_light_and_new_ones_get_theirs_at_once),
        cmocka_unit_test(a_walk_lights_cells_again_within_the_budget),
        cmocka_unit_test(a_change_while_cells_are_lit_again_starts_that_over),
        cmocka_unit_test(changes_in_every_frame_keep_nobody_waiting),
        cmocka_unit_test(without_room_for_all_the_first_are_those_of_a_fresh_start),
    };
    return cmocka_run_group_tests_name("scroll_relight", tests, NULL, NULL);
}
