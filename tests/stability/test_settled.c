/* SPDX-License-Identifier: MIT
 * Light that counts as settled is what it would be if the library went on: 30 further cycles change it by 1 %
 * at most, where walls are white, where light falls in from outside, and where a far brighter sun shines on
 * the same walls. */
#include "light_scene.h"
#include "require.h"
#include "test_group.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

enum { FURTHER_CYCLES = 30 };

static const struct gi_test_point points[] = {
    { { 0.1f, -1.0f, 0.2f }, { 0, 1, 0 } },  { { 0.1f, 1.0f, 0.2f }, { 0, -1, 0 } },
    { { -1.0f, 0.3f, 0.4f }, { 1, 0, 0 } },  { { 0.2f, 0.1f, 1.0f }, { 0, 0, -1 } },
    { { 1.0f, -0.6f, 0.5f }, { -1, 0, 0 } }, { { 0.6f, -1.0f, -0.5f }, { 0, 1, 0 } },
    { { 0.1f, 0.2f, 0.3f }, { 0, 1, 0 } },
};
enum { POINT_COUNT = sizeof points / sizeof points[0] };

/* Of the probes, or of the cells where these gather. */
static uint64_t cycles(const struct gi_test *t)
{
    const struct volume *volume = &t->gi->volume;
    return t->gi->settings.surface_light == SDFGI_SURFACE_LIGHT_CELLS ? volume->state.gathering.at[0].cycle
                                                                      : volume->state.accumulation.cycle;
}

/* The largest relative change of a point over FURTHER_CYCLES, which an invalidation of light that changes
 * nothing keeps going. */
static double further_change(struct gi_test *t)
{
    float settled[POINT_COUNT][3], later[POINT_COUNT][3];
    double worst = 0;
    gi_test_irradiance(t, points, POINT_COUNT, settled);
    for (const uint64_t last = cycles(t) + FURTHER_CYCLES; cycles(t) < last;) {
        sdfgi_volume_invalidate(&t->gi->volume);
        gi_test_update(t, 2);
    }
    gi_test_irradiance(t, points, POINT_COUNT, later);
    for (int i = 0; i < POINT_COUNT; i++)
        worst = fmax(worst, fabs((double)settled[i][1] / (double)later[i][1] - 1));
    return worst;
}

struct room {
    const char *name;
    float albedo, emission, lamp, sun;
    bool open, always;
};

static const struct room rooms[] = {
    { "furnace of 0.8", 0.8f, 1, 0, 0, false, false },
    { "furnace of 0.95", 0.95f, 1, 0, 0, false, true },
    { "furnace of 0.99", 0.99f, 1, 0, 0, false, false },
    { "lamp, albedo 0.9", 0.9f, 0, 1, 0, false, false },
    { "lamp, albedo 0.97", 0.97f, 0, 1, 0, false, false },
    { "dim lamp, sun outside", 0.8f, 0, 1, 6e4f, false, false },
    { "dim lamp, sun outside, 0.95", 0.95f, 0, 1, 6e4f, false, true },
    { "window, albedo 0.95", 0.95f, 0, 0, 1000, true, false },
};

static void add_room(struct gi_test *t, const struct room *room)
{
    const float a[3] = { room->albedo, room->albedo, room->albedo };
    const sdfgi_instance whole =
        light_add(t, test_mesh_room((double[]){ 0, 0, 0 }, (double[]){ 1, 1, 1 }, 0.2, test_rotation_none),
                  room->albedo, room->emission);
    if (!room->open)
        return;
    /* The same of boxes, with a window in the wall towards +X. */
    REQUIRE_CMP((int)sdfgi_instance_destroy(t->gi, whole), ==, (int)SDFGI_OK);
    static const double walls[][2][3] = {
        { { -1.2, -1.2, -1.2 }, { 1.2, -1, 1.2 } }, { { -1.2, 1, -1.2 }, { 1.2, 1.2, 1.2 } },
        { { -1.2, -1, -1.2 }, { -1, 1, 1.2 } },     { { -1, -1, -1.2 }, { 1.2, 1, -1 } },
        { { -1, -1, 1 }, { 1.2, 1, 1.2 } },         { { 1, -1, -1 }, { 1.2, -0.4, 1 } },
        { { 1, 0.4, -1 }, { 1.2, 1, 1 } },
    };
    for (size_t i = 0; i < sizeof walls / sizeof *walls; i++)
        light_add_box(t, walls[i][0], walls[i][1], a, 0);
    light_set_uniform_sky(t, 10);
}

static void start(struct gi_test *t, const struct room *room, bool cells)
{
    struct sdfgi_settings s = light_settings(32, 0.2f);
    s.surface_light = cells ? SDFGI_SURFACE_LIGHT_CELLS : SDFGI_SURFACE_LIGHT_PROBES;
    s.cell_rays = 16;
    s.cell_rays_per_frame = 1 << 17;
    gi_test_renew(t, &s);
    add_room(t, room);
    const struct sdfgi_light_desc sun = light_sun(-0.5f, -0.8f, 0.2f, room->sun),
                                  lamp = light_point(0.3, 0.2, -0.1, room->lamp);
    if (room->sun > 0)
        light_create(t, &sun);
    if (room->lamp > 0)
        light_create(t, &lamp);
}

static double settle(struct gi_test *t, const struct room *room, bool cells)
{
    start(t, room, cells);
    const uint32_t frames = gi_test_converge(t, 3000);
    const uint64_t count = cycles(t);
    const double change = further_change(t);
    printf("%s, %s: settled after %u frames, %lu cycles; %d cycles later %.4f\n", room->name,
           cells ? "cells" : "probes", frames, (unsigned long)count, FURTHER_CYCLES, change);
    return change;
}

/* In suite `full` all of them. */
static void rooms_settle(struct gi_test *t, bool cells)
{
    const bool full = getenv("SDFGI_TEST_FULL") != NULL;
    for (size_t i = 0; i < sizeof rooms / sizeof *rooms; i++)
        if (full || rooms[i].always)
            REQUIRE_CMP(settle(t, &rooms[i], cells), <=, 0.01);
}

static void probes_have_settled(void **state)
{
    rooms_settle(*state, false);
}

static void cells_have_settled(void **state)
{
    rooms_settle(*state, true);
}

/* ---- Marks */

static const struct room filling = { .name = "furnace of 0.95", .albedo = 0.95f, .emission = 1 };

static float pace(const struct gi_test *t, bool cells)
{
    const struct volume_state *state = &t->gi->volume.state;
    return cells ? state->gathering.at[0].convergence.pace : state->accumulation.convergence.pace;
}

/* When the first span has ended, a furnace still fills by more than 1 % in each cycle. */
static void marks_tell_that_light_fills(void **state)
{
    struct gi_test *t = *state;
    for (int cells = 0; cells < 2; cells++) {
        start(t, &filling, cells);
        for (int frame = 0; frame < 200 && !isfinite(pace(t, cells)); frame++)
            gi_test_update(t, 1);
        printf("%s: light fills by %.4f a cycle\n", cells ? "cells" : "probes", (double)pace(t, cells));
        REQUIRE_CMP(pace(t, cells), >=, 0.01f);
        REQUIRE_CMP(pace(t, cells), <=, 0.25f);
    }
}

TEST_GROUP(settled)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(probes_have_settled),
        cmocka_unit_test(cells_have_settled),
        cmocka_unit_test(marks_tell_that_light_fills),
    };
    return cmocka_run_group_tests(tests, light_open, light_close);
}
