/* SPDX-License-Identifier: MIT
 * Phases of light and sample cycles (volume/accumulation.h); which direct light is made again
 * (volume/relight.h). */
#include "require.h"
#include "test_memory.h"
#include "volume/accumulation.h"
#include "volume/relight.h"

/* ---- Phases */

enum { CYCLE = 4 };

static struct accumulation in_phase(enum lighting_phase phase)
{
    struct accumulation a;
    sdfgi_accumulation_init(&a);
    if (phase >= LIGHTING_FIRST_CYCLE)
        sdfgi_accumulation_show(&a, false);
    if (phase >= LIGHTING_RUNNING)
        sdfgi_accumulation_show(&a, true);
    if (phase == LIGHTING_CONVERGED) {
        sdfgi_accumulation_add_known(&a, 1, 0, 0);
        for (int i = 0; i < CYCLE; i++)
            sdfgi_accumulation_advance(&a, CYCLE, true);
    }
    REQUIRE_TRUE(a.phase == phase);
    return a;
}

enum event { SHOW, SHOW_END, GO_DARK, INVALIDATE, RESTART, CYCLE_ENDS, CYCLE_ENDS_CONVERGED, EVENTS };

static void apply(struct accumulation *a, enum event event)
{
    switch (event) {
    case SHOW:
    case SHOW_END:
        sdfgi_accumulation_show(a, event == SHOW_END);
        break;
    case GO_DARK:
        sdfgi_accumulation_go_dark(a);
        break;
    case INVALIDATE:
        sdfgi_accumulation_invalidate(a);
        break;
    case RESTART:
        sdfgi_accumulation_restart(a);
        break;
    default:
        a->frame = CYCLE - 1;
        if (event == CYCLE_ENDS_CONVERGED)
            sdfgi_convergence_add(&a->convergence, 0);
        sdfgi_accumulation_advance(a, CYCLE, true);
    }
}

/* Every phase and what may happen in it. Asserts forbid the others: light that has converged shows nothing,
 * and only what a completed cycle has shown converges. */
static void phases_follow_from_what_happens(void **state)
{
    (void)state;
    enum { NEVER = -1, DARK = LIGHTING_DARK, FIRST, RUNNING, CONVERGED };
    static const int next[4][EVENTS] = {
        [DARK] = { FIRST, RUNNING, DARK, DARK, DARK, DARK, NEVER },
        [FIRST] = { FIRST, RUNNING, DARK, FIRST, FIRST, FIRST, NEVER },
        [RUNNING] = { RUNNING, RUNNING, DARK, RUNNING, RUNNING, RUNNING, CONVERGED },
        [CONVERGED] = { NEVER, NEVER, DARK, RUNNING, RUNNING, CONVERGED, CONVERGED },
    };
    for (int phase = DARK; phase <= CONVERGED; phase++)
        for (int event = 0; event < EVENTS; event++) {
            if (next[phase][event] == NEVER)
                continue;
            struct accumulation a = in_phase((enum lighting_phase)phase);
            apply(&a, (enum event)event);
            if ((int)a.phase != next[phase][event])
                require_fail(__FILE__, __LINE__, "phase %d, event %d: phase %d, and not %d", phase, event,
                             (int)a.phase, next[phase][event]);
        }
}

static void a_cycle_ends_with_its_last_frame(void **state)
{
    (void)state;
    struct accumulation a = in_phase(LIGHTING_RUNNING);
    a.rays_missing = CYCLE + 1;
    for (uint32_t i = 0; i < 3 * CYCLE; i++) {
        REQUIRE_TRUE(a.frame == i % CYCLE && a.cycle == 1 + i / CYCLE);
        REQUIRE_TRUE(sdfgi_accumulation_cycle_ends(&a, CYCLE) == (i % CYCLE == CYCLE - 1));
        REQUIRE_CMP(a.rays_missing, ==, i < CYCLE + 1 ? CYCLE + 1 - i : 0);
        sdfgi_accumulation_advance(&a, CYCLE, true);
    }
    REQUIRE_TRUE(a.phase == LIGHTING_RUNNING);
}

/* What a cycle tells that began before light changed does not count. */
static void only_cycles_after_a_change_tell_of_convergence(void **state)
{
    (void)state;
    struct accumulation a = in_phase(LIGHTING_RUNNING);
    for (int i = 0; i < CYCLE; i++)
        sdfgi_accumulation_advance(&a, CYCLE, true);
    sdfgi_accumulation_invalidate(&a);
    sdfgi_accumulation_add_known(&a, 1, 0, 0);
    sdfgi_accumulation_add_known(&a, 2, 0, 0);
    REQUIRE_TRUE(!sdfgi_convergence_done(&a.convergence));
    REQUIRE_TRUE(a.known_cycle == 2);
    for (int i = 0; i < CYCLE; i++)
        sdfgi_accumulation_advance(&a, CYCLE, true);
    sdfgi_accumulation_add_known(&a, 3, 0, 0);
    REQUIRE_TRUE(sdfgi_convergence_done(&a.convergence));
}

static void light_does_not_converge_while_there_is_other_work(void **state)
{
    (void)state;
    struct accumulation a = in_phase(LIGHTING_RUNNING);
    sdfgi_accumulation_add_known(&a, 1, 0, 0);
    for (int i = 0; i < 2 * CYCLE; i++) {
        sdfgi_accumulation_advance(&a, CYCLE, false);
        REQUIRE_TRUE(a.phase == LIGHTING_RUNNING);
    }
}

static void a_restart_begins_the_next_cycle(void **state)
{
    (void)state;
    struct accumulation a = in_phase(LIGHTING_RUNNING);
    sdfgi_accumulation_advance(&a, CYCLE, true);
    sdfgi_accumulation_restart(&a);
    REQUIRE_TRUE(a.cycle == 2 && a.frame == 0 && a.invalid_cycle == 1);
}

/* ---- Light cells that are lit again */

enum { ROOM = 100, BUDGET = 7, IN_FLIGHT = 2 };

/* How often each entry was lit. */
struct lit {
    uint32_t times[SDFGI_MAX_CASCADES][2 * ROOM];
};

static const struct sun_drift no_suns = { .most = 0 };

static struct relight small_relight(void)
{
    struct relight relight;
    sdfgi_relight_init(&relight);
    relight.budget = BUDGET;
    return relight;
}

static struct light_lists lists_of(uint32_t cascades, uint32_t counted)
{
    struct light_lists lists = {
        .cascades = cascades, .room = ROOM, .frame = 10, .frames_in_flight = IN_FLIGHT
    };
    for (uint32_t c = 0; c < cascades; c++)
        lists.counted[c] = counted;
    return lists;
}

/* One frame; returns the cells that it lights. */
static uint32_t frame(struct relight *relight, struct light_lists *lists, enum relist relist, uint32_t c,
                      struct lit *lit)
{
    enum relist relists[SDFGI_MAX_CASCADES] = { RELIST_NOT };
    struct relight_range ranges[SDFGI_MAX_CASCADES];
    uint32_t cells = 0;
    relists[c] = relist;
    sdfgi_relight_note(relight, lists, relists, &no_suns, false);
    const uint32_t count = sdfgi_relight_take(relight, lists, false, ranges);
    for (uint32_t i = 0; i < count; i++) {
        REQUIRE_TRUE(ranges[i].count > 0 && ranges[i].first + ranges[i].count <= lists->room);
        for (uint32_t k = 0; k < ranges[i].count; k++)
            lit->times[ranges[i].cascade][ranges[i].first + k]++;
        cells += ranges[i].count;
    }
    REQUIRE_CMP(cells, <=, relight->budget);
    lists->frame++;
    return cells;
}

static void go_on(struct relight *relight, struct light_lists *lists, struct lit *lit)
{
    for (uint32_t frames = 0; sdfgi_relight_is_due(relight); frames++) {
        REQUIRE_CMP(frames, <, 8u * ROOM);
        frame(relight, lists, RELIST_NOT, 0, lit);
    }
}

static void require_times(const struct lit *lit, uint32_t c, uint32_t end, uint32_t least, uint32_t most)
{
    for (uint32_t i = 0; i < end; i++)
        if (lit->times[c][i] < least || lit->times[c][i] > most)
            require_fail(__FILE__, __LINE__, "entry %u of cascade %u is lit %u times, and not %u to %u", i, c,
                         lit->times[c][i], least, most);
}

/* From wherever the pass before ended. The count of a list comes back frames later: until then it has as many
 * entries as there is room for. */
static void every_cell_that_waits_is_lit_once(void **state)
{
    (void)state;
    for (uint32_t counted = 0; counted <= ROOM; counted++)
        for (uint32_t start = 0; start < ROOM; start += 9) {
            struct relight relight = small_relight();
            struct light_lists lists = lists_of(1, counted);
            struct lit lit = { 0 };
            relight.at[0].next = start;
            frame(&relight, &lists, RELIST_DIRTY, 0, &lit);
            go_on(&relight, &lists, &lit);
            require_times(&lit, 0, counted, 1, 1);
            require_times(&lit, 0, ROOM, 0, 1);
        }
}

static void every_frame_lights_as_many_cells_as_it_may(void **state)
{
    (void)state;
    struct relight relight = small_relight();
    struct light_lists lists = lists_of(3, 50);
    struct lit lit = { 0 };
    /* The list is written as the budget begins to be used: its count comes back two frames later. */
    uint32_t cells = frame(&relight, &lists, RELIST_DIRTY, 2, &lit);
    while (sdfgi_relight_is_due(&relight)) {
        REQUIRE_CMP(cells, ==, (uint32_t)BUDGET);
        cells = frame(&relight, &lists, RELIST_NOT, 0, &lit);
    }
    for (uint32_t c = 0; c < 3; c++)
        require_times(&lit, c, 50, 1, 1);
}

/* Cells move to other entries where a list changes: all of them are lit after it. */
static void a_list_that_changes_under_way_is_gone_through_again(void **state)
{
    (void)state;
    static const uint32_t counts[][2] = { { 40, 90 }, { 90, 40 }, { 90, 0 }, { 0, 90 }, { 60, 60 } };
    for (size_t i = 0; i < sizeof counts / sizeof *counts; i++)
        for (uint32_t before = 1; before < 12; before++) {
            struct relight relight = small_relight();
            struct light_lists lists = lists_of(1, counts[i][0]);
            struct lit lit = { 0 }, after = { 0 };
            frame(&relight, &lists, RELIST_DIRTY, 0, &lit);
            for (uint32_t k = 1; k < before; k++)
                frame(&relight, &lists, RELIST_NOT, 0, &lit);
            for (uint32_t k = 0; k < IN_FLIGHT; k++)
                frame(&relight, &lists, k == 0 ? RELIST_DIRTY : RELIST_NOT, 0, &after);
            lists.counted[0] = counts[i][1];
            go_on(&relight, &lists, &after);
            require_times(&after, 0, counts[i][1], 1, 1);
        }
}

/* The room of lists grows and they are written anew: all cells are lit in that frame, and none waits. */
static void a_list_written_anew_leaves_nothing_to_do(void **state)
{
    (void)state;
    struct relight relight = small_relight();
    struct light_lists lists = lists_of(2, ROOM);
    struct lit lit = { 0 };
    frame(&relight, &lists, RELIST_DIRTY, 1, &lit);
    frame(&relight, &lists, RELIST_NOT, 0, &lit);
    enum relist anew[SDFGI_MAX_CASCADES] = { RELIST_NEW, RELIST_NEW };
    lists.room = 2 * ROOM;
    sdfgi_relight_note(&relight, &lists, anew, &no_suns, false);
    REQUIRE_TRUE(!sdfgi_relight_is_due(&relight));
    REQUIRE_CMP(sdfgi_light_list_entries(&relight, &lists, 0), ==, 2u * ROOM);
    lit = (struct lit){ 0 };
    lists.frame++;
    frame(&relight, &lists, RELIST_DIRTY, 1, &lit);
    go_on(&relight, &lists, &lit);
    require_times(&lit, 0, ROOM, 1, 1);
    require_times(&lit, 1, ROOM, 1, 1);
}

/* A cascade and all finer ones: rays go on into coarser cascades. */
static void shadows_fall_on_finer_cascades(void **state)
{
    (void)state;
    for (uint32_t changed = 0; changed < 4; changed++) {
        struct relight relight = small_relight();
        struct light_lists lists = lists_of(4, 30);
        struct lit lit = { 0 };
        frame(&relight, &lists, RELIST_DIRTY, changed, &lit);
        go_on(&relight, &lists, &lit);
        for (uint32_t c = 0; c < 4; c++)
            require_times(&lit, c, 30, c <= changed, c <= changed);
    }
}

static void nothing_waits_where_all_cells_are_lit_anyway(void **state)
{
    (void)state;
    struct relight relight = small_relight();
    const struct light_lists lists = lists_of(2, 30);
    const enum relist relists[SDFGI_MAX_CASCADES] = { RELIST_DIRTY, RELIST_DIRTY };
    sdfgi_relight_note(&relight, &lists, relists, &no_suns, true);
    REQUIRE_TRUE(!sdfgi_relight_is_due(&relight));
}

static void a_count_is_known_once_its_frame_has_come_back(void **state)
{
    (void)state;
    struct relight relight = small_relight();
    struct light_lists lists = lists_of(1, 30);
    struct lit lit = { 0 };
    frame(&relight, &lists, RELIST_DIRTY, 0, &lit);
    REQUIRE_CMP(sdfgi_light_list_entries(&relight, &lists, 0), ==, (uint32_t)ROOM);
    lists.frame++;
    REQUIRE_CMP(sdfgi_light_list_entries(&relight, &lists, 0), ==, 30u);
    lists.counted[0] = ROOM + 1;
    REQUIRE_CMP(sdfgi_light_list_entries(&relight, &lists, 0), ==, (uint32_t)ROOM);
}

/* An edit in each frame: no count is that of the newest list. */
static void while_edits_go_on_a_list_is_expected_to_be_as_long_as_before(void **state)
{
    (void)state;
    struct relight relight = small_relight();
    struct light_lists lists = lists_of(1, 8000);
    struct lit lit = { 0 };
    enum relist anew[SDFGI_MAX_CASCADES] = { RELIST_NEW };
    lists.room = 50000;
    sdfgi_relight_note(&relight, &lists, anew, &no_suns, true);
    for (uint32_t i = 0; i < IN_FLIGHT; i++, lists.frame++)
        REQUIRE_CMP(sdfgi_light_list_expected(&relight, &lists, 0), ==, 50000u);
    for (uint32_t i = 0; i < 5; i++) {
        frame(&relight, &lists, RELIST_DIRTY, 0, &lit);
        REQUIRE_CMP(sdfgi_light_list_entries(&relight, &lists, 0), ==, 50000u);
        REQUIRE_CMP(sdfgi_light_list_expected(&relight, &lists, 0), ==, 8000u + 1000 + 1024);
    }
    lists.counted[0] = 49000;
    REQUIRE_CMP(sdfgi_light_list_expected(&relight, &lists, 0), ==, 50000u);
    lists.frame += IN_FLIGHT;
    REQUIRE_CMP(sdfgi_light_list_expected(&relight, &lists, 0), ==, 49000u);
}

static void of_busy_frames_every_fourth_lights_cells(void **state)
{
    (void)state;
    struct relight relight = small_relight();
    const struct light_lists lists = lists_of(1, ROOM);
    const enum relist relists[SDFGI_MAX_CASCADES] = { RELIST_DIRTY };
    struct relight_range ranges[SDFGI_MAX_CASCADES];
    for (uint32_t i = 1; i <= 12; i++) {
        sdfgi_relight_note(&relight, &lists, relists, &no_suns, false);
        REQUIRE_CMP(sdfgi_relight_take(&relight, &lists, true, ranges), ==, (uint32_t)(i % 4 == 0));
    }
    REQUIRE_CMP(sdfgi_relight_take(&relight, &lists, false, ranges), ==, 1u);
}

static uint32_t lit_by_sun(struct relight *relight, struct light_lists *lists, float drift, bool edit)
{
    const struct sun_drift suns = { { 4, 4 }, drift };
    const enum relist relists[SDFGI_MAX_CASCADES] = { edit ? RELIST_DIRTY : RELIST_NOT };
    struct relight_range ranges[SDFGI_MAX_CASCADES];
    uint32_t cells = 0;
    sdfgi_relight_note(relight, lists, relists, &suns, false);
    for (uint32_t count = sdfgi_relight_take(relight, lists, false, ranges); count > 0; count--)
        cells += ranges[count - 1].count;
    lists->frame++;
    return cells;
}

/* Surfaces follow a sun that goes on slowly in turn, and the more of them in a frame the faster it goes. */
static void all_cells_follow_a_sun_in_turn(void **state)
{
    (void)state;
    struct relight relight = small_relight();
    struct light_lists lists = lists_of(2, 80);
    struct lit lit = { 0 };
    for (int i = 0; i < 5; i++) {
        REQUIRE_CMP(lit_by_sun(&relight, &lists, 1e-4f, false), ==, (uint32_t)BUDGET);
        REQUIRE_CMP(sdfgi_relight_lights(&relight).changed, ==, 4u);
        REQUIRE_CMP(sdfgi_relight_lights(&relight).moved, ==, 4u);
    }
    REQUIRE_CMP(lit_by_sun(&relight, &lists, 1.0f / 128, false), ==, 80u);
    /* Nothing waits for more than the last step. */
    go_on(&relight, &lists, &lit);
    for (uint32_t c = 0; c < 2; c++)
        require_times(&lit, c, 80, 0, 1);
    relight = small_relight();
    REQUIRE_CMP(lit_by_sun(&relight, &lists, 1, false), ==, 160u);
    REQUIRE_TRUE(!sdfgi_relight_is_due(&relight));
}

/* Where geometry changes all lights are asked, until all cells have had their turn. */
static void new_shadows_end_while_a_sun_goes_on(void **state)
{
    (void)state;
    struct relight relight = small_relight();
    struct light_lists lists = lists_of(1, ROOM);
    lit_by_sun(&relight, &lists, 1e-4f, true);
    uint32_t cells = BUDGET;
    for (; sdfgi_relight_lights(&relight).changed == SDFGI_LIGHT_ALL; cells += BUDGET) {
        REQUIRE_CMP(cells, <, (uint32_t)ROOM);
        lit_by_sun(&relight, &lists, 1e-4f, false);
    }
    REQUIRE_CMP(cells, >=, (uint32_t)ROOM);
    REQUIRE_CMP(sdfgi_relight_lights(&relight).changed, ==, 4u);
}

/* Lists change frame after frame, at random, and all cells of all cascades are lit in the end: none waits for
 * ever. */
static void lists_that_change_at_random_are_lit_in_the_end(void **state)
{
    (void)state;
    struct test_random random = { 3 };
    struct relight relight = small_relight();
    struct light_lists lists = lists_of(3, ROOM);
    for (int trial = 0; trial < 200; trial++) {
        struct lit lit = { 0 };
        for (uint32_t i = 0; i < test_random_uint(&random) % 20; i++) {
            for (uint32_t c = 0; c < 3; c++)
                lists.counted[c] = test_random_uint(&random) % (ROOM + 1);
            frame(&relight, &lists, RELIST_DIRTY, test_random_uint(&random) % 3, &lit);
        }
        lit = (struct lit){ 0 };
        frame(&relight, &lists, RELIST_DIRTY, 2, &lit);
        go_on(&relight, &lists, &lit);
        for (uint32_t c = 0; c < 3; c++)
            require_times(&lit, c, lists.counted[c], 1, 1);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(phases_follow_from_what_happens),
        cmocka_unit_test(a_cycle_ends_with_its_last_frame),
        cmocka_unit_test(only_cycles_after_a_change_tell_of_convergence),
        cmocka_unit_test(light_does_not_converge_while_there_is_other_work),
        cmocka_unit_test(a_restart_begins_the_next_cycle),
        cmocka_unit_test(every_cell_that_waits_is_lit_once),
        cmocka_unit_test(every_frame_lights_as_many_cells_as_it_may),
        cmocka_unit_test(a_list_that_changes_under_way_is_gone_through_again),
        cmocka_unit_test(a_list_written_anew_leaves_nothing_to_do),
        cmocka_unit_test(shadows_fall_on_finer_cascades),
        cmocka_unit_test(nothing_waits_where_all_cells_are_lit_anyway),
        cmocka_unit_test(a_count_is_known_once_its_frame_has_come_back),
        cmocka_unit_test(while_edits_go_on_a_list_is_expected_to_be_as_long_as_before),
        cmocka_unit_test(all_cells_follow_a_sun_in_turn),
        cmocka_unit_test(new_shadows_end_while_a_sun_goes_on),
        cmocka_unit_test(of_busy_frames_every_fourth_lights_cells),
        cmocka_unit_test(lists_that_change_at_random_are_lit_in_the_end),
    };
    return cmocka_run_group_tests_name("light", tests, NULL, NULL);
}
