/* SPDX-License-Identifier: MIT
 * A start within the budget, which a host gets that has called sdfgi_prepare: a cascade a frame here, the
 * coarsest first. It ends where a start at once does. */
#include "light_scene.h"
#include "require.h"
#include "test_group.h"
#include "scroll_scene.h"

#include <stdio.h>
#include <stdlib.h>

enum { RESOLUTION = 64, CASCADE_CELLS = 2 * RESOLUTION * RESOLUTION * RESOLUTION };

static const double home[3] = { 0.3, 0.2, -0.4 }, elsewhere[3] = { 900.3, 0.2, -0.4 };

static struct gi_test t, at_once;

static uint32_t cascades(void)
{
    return scroll_is_full() ? 3 : 2;
}

static int close_contexts(void **state)
{
    (void)state;
    gi_test_close(&t);
    if (at_once.gi)
        gi_test_close(&at_once);
    return 0;
}

/* More of everything at home than elsewhere. */
static void open_two_places(struct gi_test *context)
{
    struct sdfgi_settings settings = scroll_settings(RESOLUTION);
    settings.cascades = cascades();
    settings.max_scroll_cells = CASCADE_CELLS;
    gi_test_open(context, &settings);
    scroll_world(context, home, 20);
    const float white[3] = { 0.8f, 0.8f, 0.8f };
    light_add_box(context, (double[]){ 896, -2, -3 }, (double[]){ 904, -1, 3 }, white, 0);
    light_add_box(context, (double[]){ 898, 0, -1 }, (double[]){ 899, 1, 1 }, white, 2);
}

/* What is in force is prepared for, too. */
static void start_in_parts_from_now_on(void)
{
    const struct sdfgi_prepare_desc desc = { .settings = &t.gi->settings };
    REQUIRE_CMP((int)sdfgi_prepare(t.gi, &desc, NULL), ==, (int)SDFGI_OK);
}

static struct sdfgi_scroll_report update(void)
{
    static struct sdfgi_report report;
    gi_test_update(&t, 1);
    sdfgi_get_report(t.gi, &report);
    return report.scroll;
}

static void require_light_cells(bool any, uint32_t cascade)
{
    uint32_t *counters = gi_test_read(&t, RESOURCE_COUNTERS, NULL);
    REQUIRE_CMP((int)(counters[SDFGI_COUNTER_LIGHT_CELLS + cascade] > 0), ==, (int)any);
    free(counters);
}

/* The coarsest cascade comes first, and then the finest. One that has not come has no light cells. */
static void require_a_cascade_a_frame(void)
{
    const uint32_t coarsest = cascades() - 1;
    for (uint32_t frame = 0; frame <= coarsest; frame++) {
        const struct sdfgi_scroll_report scroll = update();
        REQUIRE_CMP(scroll.cells, ==, (uint64_t)CASCADE_CELLS);
        REQUIRE_CMP(scroll.cascades_changing, ==, coarsest - frame);
        for (uint32_t c = 0; c < coarsest; c++)
            require_light_cells(c < frame, c);
        require_light_cells(true, coarsest);
    }
    REQUIRE_CMP(update().cells, ==, 0ul);
    REQUIRE_CMP(t.gi->volume.state.scroll.blends_moving, ==, 0u);
}

static void require_same_light(const double place[static 3])
{
    enum { POINTS = 12 };
    struct gi_test_point points[POINTS];
    float found[POINTS][3], expected[POINTS][3];
    for (int i = 0; i < POINTS; i++)
        points[i] = (struct gi_test_point){ { (float)place[0] + (float)(i % 4) * 1.7f - 2.6f, -0.6f,
                                              (float)place[2] + (float)(i / 4) * 1.3f - 1.3f },
                                            { 0, 1, 0 } };
    gi_test_converge(&t, 600);
    gi_test_converge(&at_once, 600);
    gi_test_irradiance(&t, points, POINTS, found);
    gi_test_irradiance(&at_once, points, POINTS, expected);
    for (int i = 0; i < POINTS; i++)
        for (int k = 0; k < 3; k++)
            REQUIRE_NEAR(found[i][k], expected[i][k], 0.01 * (double)expected[i][k]);
}

/* A fresh context that makes all in one frame, where the cascades of the other are. */
static void require_as_at_once(const double place[static 3])
{
    open_two_places(&at_once);
    scroll_stand(&at_once, place);
    scroll_place_as(&at_once, &t);
    scroll_settle(&at_once);
    REQUIRE_CMP(at_once.gi->frame.scroll.cells, ==, (uint64_t)cascades() * CASCADE_CELLS);
    scroll_require_equal(&t, &at_once, "a start in parts");
    REQUIRE_CMP(t.gi->volume.resources->extent.light_cells, ==,
                at_once.gi->volume.resources->extent.light_cells);
    if (scroll_is_full())
        require_same_light(place);
}

static void the_first_start_takes_a_cascade_a_frame(void **state)
{
    (void)state;
    open_two_places(&t);
    scroll_stand(&t, home);
    start_in_parts_from_now_on();
    require_a_cascade_a_frame();
    require_as_at_once(home);
}

/* Nothing of the old place counts: neither its light cells nor its emitters. */
static void a_teleport_takes_a_cascade_a_frame(void **state)
{
    (void)state;
    open_two_places(&t);
    scroll_stand(&t, home);
    gi_test_update(&t, 8);
    start_in_parts_from_now_on();
    scroll_stand(&t, elsewhere);
    require_a_cascade_a_frame();
    require_as_at_once(elsewhere);
}

/* A host that has not prepared anything has all cascades after its first frame. */
static void without_sdfgi_prepare_a_start_is_one_frame(void **state)
{
    (void)state;
    open_two_places(&t);
    scroll_stand(&t, home);
    const struct sdfgi_scroll_report scroll = update();
    REQUIRE_CMP(scroll.cells, ==, (uint64_t)cascades() * CASCADE_CELLS);
    REQUIRE_CMP(scroll.cascades_changing, ==, 0u);
}

TEST_GROUP(start)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_teardown(the_first_start_takes_a_cascade_a_frame, close_contexts),
        cmocka_unit_test_teardown(a_teleport_takes_a_cascade_a_frame, close_contexts),
        cmocka_unit_test_teardown(without_sdfgi_prepare_a_start_is_one_frame, close_contexts),
    };
    return cmocka_run_group_tests_name("scroll_start", tests, NULL, NULL);
}
