/* SPDX-License-Identifier: MIT
 * Camera cuts: what lookups sample is at the new place as soon as it is made. */
#include "drive.h"
#include "require.h"

#include <stdio.h>

enum { MOST_FRAMES = 2000 };

static struct drive d;

static int clean_up(void **state)
{
    (void)state;
    drive_end(&d);
    return 0;
}

/* A floor and a lamp, settled. */
static void begin(uint32_t cascades, uint32_t resolution)
{
    const struct sdfgi_settings settings = drive_settings(cascades, resolution);
    const struct sdfgi_light_desc lamp = drive_lamp();
    drive_begin(&d, &settings);
    drive_add_box(&d, (double[]){ -50, -1, -50 }, (double[]){ 50, 0, 50 }, SDFGI_STATIC);
    drive_add_light(&d, &lamp);
    drive_converge(&d);
}

static void jump(double x, bool cut)
{
    d.desc.cut = cut;
    drive_move(&d, x, 0, 0);
    d.desc.cut = false;
}

static bool arrived(void)
{
    return d.state.scroll.blends_moving == 0 && sdfgi_cascades_rest(&d.state.cascades);
}

/* From the jump on, until lookups sample all that they will. */
static uint32_t frames_to_arrive(double x, bool cut)
{
    uint32_t frames = 1;
    for (jump(x, cut); !arrived() && frames < MOST_FRAMES; frames++)
        drive_frame(&d);
    return frames;
}

/* Cascades of 8 m and 16 m keep more than half of what they had. */
static void what_is_made_is_shown_at_once(void **state)
{
    (void)state;
    begin(2, 32);
    const uint32_t without = frames_to_arrive(3, false);
    drive_end(&d);
    begin(2, 32);
    const uint32_t with = frames_to_arrive(3, true);
    printf("after a jump: %u frames without a cut, %u with it\n", without, with);
    REQUIRE_CMP(without, >, 100u);
    REQUIRE_CMP(with, <=, 4u);
}

/* Those that need more than a frame are made as fast as the budget allows, and no faster. */
static void a_cut_keeps_to_the_budget(void **state)
{
    (void)state;
    begin(3, 128);
    const uint64_t most = d.settings.max_scroll_cells, side = 128, cells = side * side * side;
    uint64_t made = 0;
    uint32_t frames = 0;
    for (jump(20, true); !arrived() && frames < MOST_FRAMES; frames++) {
        REQUIRE_CMP(d.frame.scroll.cells, <=, most);
        made += d.frame.scroll.cells;
        drive_frame(&d);
    }
    printf("%llu cells in %u frames\n", (unsigned long long)made, frames);
    REQUIRE_CMP(made, >, 3 * cells);
    REQUIRE_CMP((uint64_t)frames, <=, made / most + 3 * 3);
}

/* Later scrolls are as smooth as ever. */
static void a_cut_ends(void **state)
{
    (void)state;
    begin(2, 32);
    frames_to_arrive(3, true);
    for (uint32_t c = 0; c < d.state.cascades.count; c++)
        REQUIRE_TRUE(!d.state.cascades.at[c].cut);
    const uint32_t without = frames_to_arrive(3, false);
    REQUIRE_CMP(without, >, 20u);
}

/* A walk leaves cells free behind the camera and expects it to go on. */
static void a_cut_forgets_the_way(void **state)
{
    (void)state;
    begin(2, 32);
    for (int i = 0; i < 40; i++)
        drive_move(&d, 0.125, 0, 0);
    REQUIRE_CMP(d.state.cascades.at[0].spare[0], >, 0.0);
    REQUIRE_CMP(d.state.scroll.pace, >, 0.0);
    jump(-2, true);
    REQUIRE_CMP(d.state.cascades.at[0].spare[0], ==, 0.0);
    REQUIRE_CMP(d.state.scroll.pace, ==, 0.0);
    REQUIRE_CMP(d.state.scroll.heading[0], ==, 0.0);
}

static void a_cut_on_the_spot_wakes_nothing(void **state)
{
    (void)state;
    begin(2, 32);
    jump(0, true);
    REQUIRE_TRUE(d.frame.situation.converged);
    REQUIRE_CMP(d.frame.work.count, ==, 0u);
    REQUIRE_TRUE(arrived() && !d.state.cascades.at[0].cut);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_teardown(what_is_made_is_shown_at_once, clean_up),
        cmocka_unit_test_teardown(a_cut_keeps_to_the_budget, clean_up),
        cmocka_unit_test_teardown(a_cut_ends, clean_up),
        cmocka_unit_test_teardown(a_cut_forgets_the_way, clean_up),
        cmocka_unit_test_teardown(a_cut_on_the_spot_wakes_nothing, clean_up),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
