/* SPDX-License-Identifier: MIT
 * Which light cells gather in a frame, without a device. */
#include "volume/gathering.h"

#include "shaders/shared/constants.h"

#include "require.h"

enum { CASCADES = 3, ENTRIES = 1000, VISITS = 32, ROUGH = 8 };

struct scene {
    struct gathering gathering;
    struct relight relight;
    struct light_lists lists;
    struct gather_range ranges[SDFGI_MAX_CASCADES];
    uint32_t count;
};

/* Lists of ENTRIES cells, which the host has known for long. */
static void open_scene(struct scene *s)
{
    *s = (struct scene){ .lists = { .cascades = CASCADES,
                                    .room = 5000,
                                    .counted = { ENTRIES, ENTRIES, ENTRIES },
                                    .frame = 100,
                                    .frames_in_flight = 2 } };
    sdfgi_gathering_init(&s->gathering);
    sdfgi_relight_init(&s->relight);
}

static void take(struct scene *s, uint32_t cells)
{
    s->count = sdfgi_gathering_take(&s->gathering, &s->relight, &s->lists, cells, VISITS, s->ranges);
}

static uint32_t cells_of(const struct scene *s, uint32_t cascade)
{
    uint32_t cells = 0;
    for (uint32_t i = 0; i < s->count; i++)
        cells += s->ranges[i].cascade == cascade ? s->ranges[i].count : 0;
    return cells;
}

/* All cascades end a cycle in which the light of so many cells has changed by so much. */
static void end_cycles_of(struct scene *s, float change, uint32_t changing)
{
    const struct gather_change found = { .most = change, .changing = changing, .cells = ENTRIES };
    for (uint32_t c = 0; c < CASCADES; c++)
        sdfgi_gathering_add_known(&s->gathering, c, s->gathering.at[c].cycle, &found);
}

static void end_cycles(struct scene *s, float change)
{
    end_cycles_of(s, change, change >= SDFGI_SMALL_CHANGE ? 1 : 0);
}

static void near_cascades_get_most_of_the_budget(void **state)
{
    (void)state;
    struct scene s;
    open_scene(&s);
    take(&s, 400);
    REQUIRE_CMP(cells_of(&s, 0), ==, 200u);
    REQUIRE_CMP(cells_of(&s, 1), ==, 100u);
    REQUIRE_CMP(cells_of(&s, 2), ==, 100u);
}

static void a_sweep_visits_each_cell_once(void **state)
{
    (void)state;
    struct scene s;
    static uint32_t visits[CASCADES][ENTRIES];
    open_scene(&s);
    for (int frame = 0; frame < 200; frame++) {
        take(&s, 777);
        REQUIRE_CMP(s.count, <=, (uint32_t)CASCADES);
        for (uint32_t i = 0; i < s.count; i++)
            for (uint32_t k = 0; k < s.ranges[i].count; k++)
                visits[s.ranges[i].cascade][s.ranges[i].first + k]++;
    }
    for (uint32_t c = 0; c < CASCADES; c++)
        for (uint32_t i = 0; i + 1 < ENTRIES; i++)
            REQUIRE_TRUE(visits[c][i] == visits[c][i + 1] || visits[c][i] == visits[c][i + 1] + 1);
}

/* Frames in which new cells send more rays, of the next hundred. */
static uint32_t frames_of_many_rays(struct scene *s)
{
    uint32_t frames = 0;
    for (uint32_t i = 0; i < 100; i++) {
        take(s, 100);
        const uint32_t rays = sdfgi_gathering_new_rays(&s->gathering);
        REQUIRE_TRUE(rays == 1 || rays == SDFGI_NEW_RAYS);
        REQUIRE_TRUE(rays == 1 || frames == i);
        frames += rays > 1;
    }
    return frames;
}

/* At the start and after a teleport, for about as long as what is seen has a rough cycle. */
static void new_cells_send_more_rays_while_all_are_new(void **state)
{
    (void)state;
    struct scene s;
    open_scene(&s);
    const uint32_t frames = frames_of_many_rays(&s);
    REQUIRE_CMP(frames, >=, 2u * ROUGH);
    REQUIRE_CMP(frames, <=, 4u * ROUGH);
    REQUIRE_CMP(frames_of_many_rays(&s), ==, 0u);
    sdfgi_gathering_outdate(&s.gathering);
    sdfgi_gathering_begin(&s.gathering, 1);
    REQUIRE_CMP(frames_of_many_rays(&s), ==, 0u);
    sdfgi_gathering_restart(&s.gathering);
    REQUIRE_CMP(frames_of_many_rays(&s), ==, frames);
}

static void let_frames_pass(struct scene *s, int frames)
{
    for (int i = 0; i < frames; i++)
        sdfgi_gathering_begin(&s->gathering, s->gathering.invalidations);
}

/* Frames in which cells that change now send more rays. */
static uint32_t frames_of_change(struct scene *s, int calm, bool all, const struct box *edited)
{
    let_frames_pass(s, calm);
    if (all)
        sdfgi_gathering_outdate(&s->gathering);
    else
        sdfgi_gathering_change(&s->gathering, edited);
    let_frames_pass(s, 20);
    return frames_of_many_rays(s);
}

/* Not where lights change again and again, and not for geometry, which wakes few cells: lights are calm while
 * it moves. */
static void cells_send_more_rays_when_lights_change_after_a_while(void **state)
{
    (void)state;
    const struct box box = { { 0, 0, 0 }, { 4, 4, 4 } };
    struct scene s;
    open_scene(&s);
    const uint32_t frames = frames_of_many_rays(&s);
    REQUIRE_CMP(frames_of_change(&s, 0, true, NULL), ==, 0u);
    REQUIRE_CMP(frames_of_change(&s, 200, true, NULL), ==, frames);
    REQUIRE_CMP(frames_of_change(&s, 60, true, NULL), ==, 0u);
    REQUIRE_CMP(frames_of_change(&s, 200, false, NULL), ==, frames);
    REQUIRE_CMP(frames_of_change(&s, 200, false, &box), ==, 0u);
    REQUIRE_CMP(frames_of_change(&s, 0, false, NULL), ==, frames);
}

static void a_cycle_ends_with_its_last_visit(void **state)
{
    (void)state;
    struct scene s;
    open_scene(&s);
    uint32_t frames = 0;
    do {
        take(&s, 100 * ENTRIES);
        REQUIRE_TRUE(s.ranges[0].begins_cycle == (frames == 0));
        frames++;
    } while (s.ranges[0].ends_cycle == 0);
    REQUIRE_CMP(s.ranges[0].ends_cycle, ==, 1ul);
    REQUIRE_CMP(frames, ==, (uint32_t)ROUGH);
}

static void cycles_grow_long_when_light_changes_little(void **state)
{
    (void)state;
    struct scene s;
    open_scene(&s);
    end_cycles(&s, 0.5f);
    take(&s, 100);
    REQUIRE_CMP(s.ranges[0].visits, ==, (uint32_t)ROUGH);
    s.gathering.at[0].cycle++;
    end_cycles(&s, 0.01f);
    take(&s, 100);
    REQUIRE_CMP(s.ranges[0].visits, ==, (uint32_t)VISITS);
    REQUIRE_TRUE(!sdfgi_gathering_has_settled(&s.gathering, CASCADES));
}

/* Little change in a cycle, but to the same side for four: a white room that still fills. */
static void a_cascade_that_drifts_has_not_settled(void **state)
{
    (void)state;
    for (int drifts = 0; drifts < 2; drifts++) {
        struct scene s;
        open_scene(&s);
        for (int cycle = 0; cycle < 20; cycle++) {
            const struct gather_change found = { .most = 5e-4f,
                                                 .cells = ENTRIES,
                                                 .drift = drifts ? 2e-3f : 1e-3f };
            for (uint32_t c = 0; c < CASCADES; c++)
                sdfgi_gathering_add_known(&s.gathering, c, s.gathering.at[c].cycle++, &found);
        }
        REQUIRE_TRUE(sdfgi_gathering_has_settled(&s.gathering, CASCADES) == !drifts);
    }
}

/* Seen cells take seven twelfths of the rays, and never all: otherwise the others would not settle. */
static void seen_cells_take_most(void **state)
{
    (void)state;
    struct scene s;
    open_scene(&s);
    s.lists.seen[0] = 300;
    take(&s, 384);
    REQUIRE_CMP(cells_of(&s, 0), ==, 80u);
    REQUIRE_CMP(s.ranges[0].watched_count, ==, 224u);
    REQUIRE_CMP(s.ranges[0].watched_span, >=, (uint32_t)ENTRIES * 2 / 3);
    REQUIRE_CMP(s.ranges[1].watched_span, ==, 0u);
    /* Piece by piece all of the list has its turn. */
    const uint32_t first = s.gathering.at[0].watched_end;
    take(&s, 384);
    REQUIRE_CMP(s.gathering.at[0].watched_first, ==, first);
    REQUIRE_CMP(s.gathering.at[0].watched_end, ==, (uint32_t)ENTRIES);
    take(&s, 384);
    REQUIRE_CMP(s.gathering.at[0].watched_first, ==, 0u);
    for (uint32_t c = 0; c < CASCADES; c++)
        s.lists.seen[c] = ENTRIES;
    take(&s, 8);
    for (uint32_t c = 0; c < CASCADES; c++)
        REQUIRE_CMP(cells_of(&s, c), >=, 1u);
}

/* A view indoors sees near cells alone: those of other cascades get no visits for what is seen. */
static void seen_cells_count_by_how_near_they_are(void **state)
{
    (void)state;
    struct scene s;
    open_scene(&s);
    for (uint32_t c = 0; c < CASCADES; c++)
        s.lists.seen[c] = 600;
    take(&s, 600);
    REQUIRE_CMP(s.ranges[0].watched_count, ==, 200u);
    REQUIRE_CMP(s.ranges[1].watched_count, ==, 100u);
    REQUIRE_CMP(s.ranges[2].watched_count, ==, 50u);
    s.gathering.at[0].settled = true;
    take(&s, 720);
    REQUIRE_CMP(s.ranges[0].watched_count, ==, 280u);
    REQUIRE_CMP(s.ranges[1].watched_count, ==, 140u);
    /* Those of a cascade that has settled get none. */
    REQUIRE_CMP(s.gathering.at[0].watched_first, ==, s.gathering.at[0].watched_end);
    /* No cell gets two visits: the rest is for the sweep. */
    open_scene(&s);
    s.lists.seen[0] = 10;
    take(&s, 700);
    REQUIRE_CMP(s.ranges[0].watched_count, ==, 10u);
    REQUIRE_CMP(cells_of(&s, 0), ==, 345u);
}

enum { COLLECTED = 8 }; /* frames for which marks on what rays hit are collected */

/* Until what rays hit is read. */
static void take_until_read(struct scene *s, uint32_t cells)
{
    do
        take(s, cells);
    while (!sdfgi_gathering_forgets_hit(&s->gathering));
}

/* What rays of watched cells hit has visits in turn: half as many as what is seen. */
static void what_rays_hit_has_its_turn(void **state)
{
    (void)state;
    struct scene s;
    open_scene(&s);
    s.lists.seen[0] = 200;
    s.lists.hit[0] = 600;
    s.lists.hit[1] = 300;
    take(&s, 1200);
    REQUIRE_CMP(s.ranges[0].watched_count, ==, 200u);
    take_until_read(&s, 1200);
    REQUIRE_CMP(s.ranges[0].watched_count, ==, 200u + 600 / 16);
    REQUIRE_CMP(s.ranges[1].watched_count, ==, 300u / 16);
    const uint32_t part = sdfgi_gathering_hit_part(&s.gathering);
    uint32_t turns[SDFGI_SEEN_BITS] = { 0 };
    for (uint32_t frame = 0; frame < 16; frame++) {
        REQUIRE_CMP(sdfgi_gathering_hit_part(&s.gathering), ==, frame < COLLECTED ? part : 1 - part);
        for (uint32_t i = 0; i < SDFGI_SEEN_BITS; i++)
            turns[i] += sdfgi_gathering_hit_bits(&s.gathering, 0) >> i & 1;
        take(&s, 1200);
    }
    for (uint32_t i = 0; i < SDFGI_SEEN_BITS; i++)
        REQUIRE_CMP(turns[i], ==, 1u);
    sdfgi_gathering_forget_hit(&s.gathering, 0);
    take(&s, 1200);
    REQUIRE_CMP(s.ranges[0].watched_count, ==, 200u);
}

/* Where seen cells need all visits, what rays hit gets a quarter of them, and where nothing is seen, next to
 * none. */
static void what_rays_hit_leaves_visits_to_what_is_seen(void **state)
{
    (void)state;
    struct scene s;
    open_scene(&s);
    s.lists.seen[0] = 900;
    s.lists.hit[0] = 800;
    take_until_read(&s, 960);
    REQUIRE_CMP(s.gathering.hit_turns_log2, ==, 3u); /* 100 of at most 140 */
    s.lists.seen[0] = 400;
    take_until_read(&s, 960);
    REQUIRE_CMP(s.gathering.hit_turns_log2, ==, 3u); /* of at most 160, which seen cells leave */
    s.lists.seen[0] = 300;
    take_until_read(&s, 960);
    REQUIRE_CMP(s.gathering.hit_turns_log2, ==, 3u); /* of at most 150, half as many as are seen */
    s.lists.seen[0] = 100;
    take_until_read(&s, 960);
    REQUIRE_CMP(s.gathering.hit_turns_log2, ==, 4u);
    s.lists.seen[0] = 0;
    take_until_read(&s, 960);
    REQUIRE_CMP(s.gathering.hit_turns_log2, ==, 5u);
}

static void where_all_cells_are_visited_none_come_first(void **state)
{
    (void)state;
    struct scene s;
    open_scene(&s);
    s.lists.seen[0] = 300;
    take(&s, 6 * ENTRIES);
    REQUIRE_CMP(cells_of(&s, 0), ==, (uint32_t)ENTRIES);
    REQUIRE_CMP(s.ranges[0].watched_span, ==, 0u);
    REQUIRE_CMP(s.gathering.at[0].watched_first, ==, s.gathering.at[0].watched_end);
}

/* A white room: all cells change, a little in each cycle. */
static void cycles_stay_rough_while_many_cells_change(void **state)
{
    (void)state;
    struct scene s;
    open_scene(&s);
    for (int i = 0; i < 256; i++) {
        take(&s, 100);
        REQUIRE_CMP(s.ranges[0].visits, ==, (uint32_t)ROUGH);
        s.gathering.at[0].cycle++;
        end_cycles_of(&s, 0.02f, ENTRIES / 8 + 1);
    }
    take(&s, 100);
    REQUIRE_CMP(s.ranges[0].visits, ==, (uint32_t)VISITS);
}

/* Rough cycles that change nothing do not settle: long ones must follow. */
static void settle(struct scene *s)
{
    for (int i = 0; i < 2; i++) {
        REQUIRE_TRUE(!sdfgi_gathering_has_settled(&s->gathering, CASCADES));
        for (uint32_t c = 0; c < CASCADES; c++)
            s->gathering.at[c].cycle++;
        end_cycles(s, 0.0002f);
    }
    REQUIRE_TRUE(sdfgi_gathering_has_settled(&s->gathering, CASCADES));
}

static void settled_cells_get_no_rays_until_light_changes(void **state)
{
    (void)state;
    struct scene s;
    open_scene(&s);
    settle(&s);
    take(&s, 100);
    REQUIRE_CMP(s.count, ==, 0u);
    sdfgi_gathering_begin(&s.gathering, 1);
    take(&s, 100);
    REQUIRE_CMP(s.count, ==, (uint32_t)CASCADES);
    /* What was gathered before the change comes back late, and counts for nothing. */
    end_cycles(&s, 0);
    REQUIRE_TRUE(!sdfgi_gathering_has_settled(&s.gathering, CASCADES));
}

static void one_cascade_that_has_settled_leaves_its_share_to_others(void **state)
{
    (void)state;
    struct scene s;
    open_scene(&s);
    s.gathering.at[0].settled = true;
    take(&s, 400);
    REQUIRE_CMP(cells_of(&s, 0), ==, 0u);
    REQUIRE_CMP(cells_of(&s, 1), ==, 200u);
    REQUIRE_CMP(cells_of(&s, 2), ==, 200u);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(near_cascades_get_most_of_the_budget),
        cmocka_unit_test(a_sweep_visits_each_cell_once),
        cmocka_unit_test(new_cells_send_more_rays_while_all_are_new),
        cmocka_unit_test(cells_send_more_rays_when_lights_change_after_a_while),
        cmocka_unit_test(a_cycle_ends_with_its_last_visit),
        cmocka_unit_test(cycles_grow_long_when_light_changes_little),
        cmocka_unit_test(a_cascade_that_drifts_has_not_settled),
        cmocka_unit_test(seen_cells_take_most),
        cmocka_unit_test(seen_cells_count_by_how_near_they_are),
        cmocka_unit_test(what_rays_hit_has_its_turn),
        cmocka_unit_test(what_rays_hit_leaves_visits_to_what_is_seen),
        cmocka_unit_test(where_all_cells_are_visited_none_come_first),
        cmocka_unit_test(cycles_stay_rough_while_many_cells_change),
        cmocka_unit_test(settled_cells_get_no_rays_until_light_changes),
        cmocka_unit_test(one_cascade_that_has_settled_leaves_its_share_to_others),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
