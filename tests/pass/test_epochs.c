/* SPDX-License-Identifier: MIT
 * Epochs of gathering: what has changed in one, and which light cells it wakes. Without a device. */
#include "volume/gathering.h"

#include "require.h"

static void lights_that_change_in_every_frame_begin_an_epoch_now_and_then(void **state)
{
    (void)state;
    struct gathering g;
    sdfgi_gathering_init(&g);
    for (uint64_t frame = 1; frame <= 160; frame++) {
        sdfgi_gathering_outdate(&g);
        sdfgi_gathering_begin(&g, frame);
    }
    REQUIRE_CMP(g.epoch, ==, 10u);
    /* A single change begins one at once. */
    sdfgi_gathering_init(&g);
    sdfgi_gathering_outdate(&g);
    sdfgi_gathering_begin(&g, 1);
    REQUIRE_CMP(g.epoch, ==, 1u);
}

/* Frames until an epoch begins, at most. */
static void begin_epoch(struct gathering *g)
{
    const uint32_t epoch = g->epoch;
    for (uint64_t frame = 0; g->epoch == epoch; frame++) {
        REQUIRE_CMP(frame, <=, UINT64_C(20));
        REQUIRE_CMP(sdfgi_gathering_next_epoch(g), ==, epoch + 1);
        sdfgi_gathering_begin(g, 0);
    }
    REQUIRE_CMP(sdfgi_gathering_next_epoch(g), ==, g->epoch);
}

static void a_local_change_begins_an_epoch_for_those_that_it_reaches(void **state)
{
    (void)state;
    struct gathering g;
    const struct box here = { { 0, 0, 0 }, { 1, 1, 1 } }, there = { { 4, 0, 0 }, { 5, 1, 1 } };
    sdfgi_gathering_init(&g);
    sdfgi_gathering_outdate(&g);
    begin_epoch(&g);
    REQUIRE_CMP(g.epoch_of_all, ==, 1u);
    sdfgi_gathering_change(&g, NULL);
    begin_epoch(&g);
    REQUIRE_CMP(g.epoch_of_all, ==, 1u);
    REQUIRE_CMP(g.edited_last.count, ==, 0u);
    sdfgi_gathering_change(&g, &here);
    sdfgi_gathering_change(&g, &there);
    begin_epoch(&g);
    REQUIRE_CMP(g.edited_last.count, ==, 2u);
    REQUIRE_BYTES(&g.edited_last.boxes[0], &here, sizeof here);
    REQUIRE_BYTES(&g.edited_last.boxes[1], &there, sizeof there);
    REQUIRE_CMP(g.epoch_of_all, ==, 1u);
    sdfgi_gathering_emitter(&g, &there);
    sdfgi_gathering_emitter(&g, &here);
    begin_epoch(&g);
    REQUIRE_CMP(g.epoch_of_all, ==, 1u);
    REQUIRE_CMP(g.edited_last.count, ==, 0u);
    REQUIRE_CMP(g.emitters_last.count, ==, 2u);
    REQUIRE_TRUE(sdfgi_gathering_changes_are_local(&g));
    sdfgi_gathering_change(&g, &here);
    sdfgi_gathering_outdate(&g);
    begin_epoch(&g);
    REQUIRE_CMP(g.epoch_of_all, ==, 5u);
    REQUIRE_CMP(g.emitters_last.count, ==, 0u);
    REQUIRE_CMP(g.edited_last.count, ==, 1u);
    REQUIRE_BYTES(&g.edited_last.boxes[0], &here, sizeof here);
}

/* As a day goes by: cells go on from what they know, and none has more rays than others. */
static void sun_and_sky_that_change_a_little_begin_an_epoch_of_drift(void **state)
{
    (void)state;
    struct gathering g;
    sdfgi_gathering_init(&g);
    sdfgi_gathering_drift(&g, 1);
    begin_epoch(&g);
    REQUIRE_CMP(g.epoch_of_all, ==, 1u);
    REQUIRE_CMP(g.epoch_of_drift, ==, 0u);
    for (uint32_t c = 0; c < SDFGI_MAX_CASCADES; c++)
        g.at[c].rough = false;
    for (uint32_t frame = 0; frame < 10; frame++)
        sdfgi_gathering_drift(&g, 0.001f);
    begin_epoch(&g);
    REQUIRE_CMP(g.epoch, ==, 2u);
    REQUIRE_CMP(g.epoch_of_all, ==, 1u);
    REQUIRE_CMP(g.epoch_of_drift, ==, 2u);
    REQUIRE_NEAR(g.drift, 0.01f, 1e-6);
    REQUIRE_TRUE(!g.at[0].rough);
    /* What was faster before is remembered for a while. */
    sdfgi_gathering_drift(&g, 0.001f);
    begin_epoch(&g);
    REQUIRE_NEAR(g.drift, 0.005f, 1e-6);
    sdfgi_gathering_change(&g, NULL);
    begin_epoch(&g);
    REQUIRE_CMP(g.epoch_of_drift, ==, 3u);
    REQUIRE_TRUE(g.at[0].rough);
    /* Much of it in an epoch outdates all. */
    for (uint32_t frame = 0; frame < 15; frame++)
        sdfgi_gathering_drift(&g, 0.01f);
    begin_epoch(&g);
    REQUIRE_CMP(g.epoch_of_all, ==, 5u);
    REQUIRE_CMP(g.epoch_of_drift, ==, 3u);
}

/* Otherwise cells would wake each other by noise for as long as the sun turns. */
static void cells_look_for_local_changes_for_some_epochs(void **state)
{
    (void)state;
    struct gathering g;
    sdfgi_gathering_init(&g);
    sdfgi_gathering_drift(&g, 1);
    begin_epoch(&g);
    sdfgi_gathering_drift(&g, 0.001f);
    begin_epoch(&g);
    REQUIRE_TRUE(!sdfgi_gathering_changes_are_local(&g));
    sdfgi_gathering_change(&g, NULL);
    REQUIRE_TRUE(sdfgi_gathering_changes_are_local(&g));
    begin_epoch(&g);
    uint32_t epochs = 1;
    for (; sdfgi_gathering_changes_are_local(&g); epochs++) {
        REQUIRE_CMP(epochs, <, 20u);
        sdfgi_gathering_drift(&g, 0.001f);
        begin_epoch(&g);
    }
    REQUIRE_CMP(epochs, ==, 16u);
    /* While nothing else changes there is time for all that one change has begun. */
    sdfgi_gathering_change(&g, NULL);
    begin_epoch(&g);
    for (uint64_t frame = 0; frame < 1000; frame++)
        sdfgi_gathering_begin(&g, 0);
    REQUIRE_TRUE(sdfgi_gathering_changes_are_local(&g));
}

/* Cells that they reach go on from what they know, and no cycle is rough for it. */
static void lamps_that_flicker_outdate_nothing(void **state)
{
    (void)state;
    struct gathering g;
    sdfgi_gathering_init(&g);
    sdfgi_gathering_change(&g, NULL);
    begin_epoch(&g);
    REQUIRE_CMP(g.epoch_of_local, ==, 1u);
    for (uint32_t c = 0; c < SDFGI_MAX_CASCADES; c++)
        g.at[c].rough = false;
    sdfgi_gathering_flicker(&g, 0.02f);
    sdfgi_gathering_flicker(&g, 0.01f);
    begin_epoch(&g);
    REQUIRE_CMP(g.epoch, ==, 2u);
    REQUIRE_CMP(g.epoch_of_local, ==, 1u);
    REQUIRE_NEAR(g.flicker, 0.02f, 0);
    REQUIRE_TRUE(!g.at[0].rough && sdfgi_gathering_changes_are_local(&g));
    sdfgi_gathering_flicker(&g, 0.004f);
    begin_epoch(&g);
    REQUIRE_NEAR(g.flicker, 0.01f, 0);
    const struct box box = { { 0, 0, 0 }, { 1, 1, 1 } };
    sdfgi_gathering_flicker(&g, 0.004f);
    sdfgi_gathering_change(&g, &box);
    begin_epoch(&g);
    REQUIRE_CMP(g.epoch_of_local, ==, 4u);
    REQUIRE_TRUE(g.at[0].rough);
}

/* A lamp goes off while another one flickers, and then something moves. */
static void what_outdates_light_does_not_wait_for_flicker(void **state)
{
    (void)state;
    struct gathering g;
    sdfgi_gathering_init(&g);
    sdfgi_gathering_flicker(&g, 0.01f);
    begin_epoch(&g);
    for (uint64_t frame = 0; frame < 3; frame++) {
        sdfgi_gathering_flicker(&g, 0.01f);
        sdfgi_gathering_begin(&g, 0);
    }
    REQUIRE_CMP(g.epoch, ==, 1u);
    sdfgi_gathering_change(&g, NULL);
    sdfgi_gathering_begin(&g, 0);
    REQUIRE_CMP(g.epoch, ==, 2u);
    for (uint64_t frame = 1; frame < SDFGI_EPOCH_FRAMES; frame++) {
        const struct box box = { { 0, 0, 0 }, { 1, 1, 1 } };
        sdfgi_gathering_change(&g, &box);
        sdfgi_gathering_begin(&g, 0);
        REQUIRE_CMP(g.epoch, ==, 2u);
    }
    sdfgi_gathering_begin(&g, 0);
    REQUIRE_CMP(g.epoch, ==, 3u);
}

static bool holds(const struct box *box, const struct box *other)
{
    const struct box both = sdfgi_box_around(box, other);
    return memcmp(&both, box, sizeof both) == 0;
}

/* Three things move in small steps, far from each other; the last one is flat, and comes late. */
static void boxes_of_what_moves_stay_apart(void **state)
{
    (void)state;
    enum { STEPS = 40, THINGS = 3 };
    struct edited_places places = { .count = 0 };
    for (int step = 0; step < STEPS; step++)
        for (int i = 0; i < (step < STEPS / 2 ? THINGS - 1 : THINGS); i++) {
            const double x = 20 * i, z = 0.1 * step;
            const struct box box = { { x, 0, z }, { x + 1, i < 2 ? 2 : 0, z + 1 } };
            bool held = false;
            sdfgi_edited_places_add(&places, &box);
            for (uint32_t k = 0; k < places.count; k++)
                held = held || holds(&places.boxes[k], &box);
            REQUIRE_TRUE(held);
        }
    REQUIRE_CMP(places.count, ==, (uint32_t)SDFGI_EDITED_BOXES);
    for (uint32_t k = 0; k < places.count; k++)
        REQUIRE_CMP(places.boxes[k].max[0] - places.boxes[k].min[0], ==, 1.0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(lights_that_change_in_every_frame_begin_an_epoch_now_and_then),
        cmocka_unit_test(a_local_change_begins_an_epoch_for_those_that_it_reaches),
        cmocka_unit_test(sun_and_sky_that_change_a_little_begin_an_epoch_of_drift),
        cmocka_unit_test(cells_look_for_local_changes_for_some_epochs),
        cmocka_unit_test(lamps_that_flicker_outdate_nothing),
        cmocka_unit_test(what_outdates_light_does_not_wait_for_flicker),
        cmocka_unit_test(boxes_of_what_moves_stay_apart),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
