/* SPDX-License-Identifier: MIT
 * The window of `sdfgi view` and its panel, by key and by mouse: what is pressed shows. */
#include "tour.h"

#include "require.h"

#include <stdlib.h>

/* One window for all tests: a start of the program takes longer than what they do in it. */
enum picture {
    BEFORE,
    STOPPED,
    FIRST,
    FOG_SHOWN,
    PANEL_OPEN,
    NEXT_VIEW,
    VIEW_BACK,
    VIEW_BY_DIGIT,
    PICTURE_AGAIN,
    PART_OF_LIGHT,
    VIEW_CHOSEN,
    BOUNCES_OFF,
    BOUNCES_BACK,
    GI_OFF,
    GI_ON,
    PROPERTIES,
    BOX_CHECKED,
    ALL_REBUILT,
    SLIDER_MOVED,
    CHOICE_MADE,
    PASSES,
    HEALTH,
    MEMORY,
    PANEL_DRAGGED,
    SCENE_DRAGGED,
    PANEL_CLOSED,
    PICTURES
};

static const struct step steps[] = {
    { .action = KEY, .key = X_KEY_F1 },
    { .action = CLICK, .widget = "effect:Fog" }, /* frames take less time without */
    { .action = CLICK, .widget = "effect:Reflections" },
    { .action = TAKE, .picture = BEFORE },
    { .action = KEY, .key = X_KEY_G },
    { .action = KEY, .key = X_KEY_G },
    { .action = TAKE, .picture = STOPPED },
    { .action = KEY, .key = X_KEY_G },
    { .action = SETTLE },
    { .action = KEY, .key = X_KEY_F1 },
    { .action = TAKE, .picture = FIRST },
    { .action = KEY, .key = X_KEY_F1 },
    { .action = CLICK, .widget = "effect:Fog" },
    { .action = TAKE, .picture = FOG_SHOWN },
    { .action = CLICK, .widget = "effect:Fog" },
    { .action = TAKE, .picture = PANEL_OPEN },
    { .action = KEY, .key = X_KEY_V },
    { .action = TAKE, .picture = NEXT_VIEW },
    { .action = KEY, .key = X_KEY_V },
    { .action = KEY, .key = X_KEY_SHIFT_V },
    { .action = TAKE, .picture = VIEW_BACK },
    { .action = KEY, .key = X_KEY_3 },
    { .action = TAKE, .picture = VIEW_BY_DIGIT },
    { .action = KEY, .key = X_KEY_0 },
    { .action = TAKE, .picture = PICTURE_AGAIN },
    { .action = CLICK, .widget = "effect:Reflections" },
    { .action = KEY, .key = X_KEY_F2 },
    { .action = TAKE, .picture = PART_OF_LIGHT },
    { .action = CLICK, .widget = "effect:Reflections" },
    { .action = CLICK, .widget = "view:solid" },
    { .action = TAKE, .picture = VIEW_CHOSEN },
    { .action = CLICK, .widget = "view:picture" },
    { .action = CLICK, .widget = "effect:sdfgi_bounce_feedback" },
    { .action = TAKE, .picture = BOUNCES_OFF },
    { .action = CLICK, .widget = "effect:sdfgi_bounce_feedback" },
    { .action = TAKE, .picture = BOUNCES_BACK },
    { .action = CLICK, .widget = "effect:sdfgi_enabled" },
    { .action = TAKE, .picture = GI_OFF },
    { .action = KEY, .key = X_KEY_G },
    { .action = SETTLE },
    { .action = TAKE, .picture = GI_ON },
    { .action = CLICK, .widget = "tab:Properties" },
    { .action = TAKE, .picture = PROPERTIES },
    { .action = SCROLL, .widget = "property:sdfgi_read_sky_light" },
    { .action = CLICK, .widget = "property:sdfgi_read_sky_light" },
    { .action = TAKE, .picture = BOX_CHECKED },
    { .action = KEY, .key = X_KEY_G }, /* frames take less time without GI */
    { .action = SCROLL, .widget = "property:sdfgi_cascades" },
    { .action = CLICK, .widget = "property:sdfgi_cascades" },
    { .action = TAKE, .picture = ALL_REBUILT },
    { .action = SCROLL, .widget = "property:sdfgi_energy" },
    { .action = CLICK, .widget = "property:sdfgi_energy" },
    { .action = TAKE, .picture = SLIDER_MOVED },
    { .action = SCROLL, .widget = "property:sdfgi_voxelizer" },
    { .action = CLICK, .widget = "property:sdfgi_voxelizer" },
    { .action = CLICK, .widget = "choice:raster" },
    { .action = TAKE, .picture = CHOICE_MADE },
    { .action = KEY, .key = X_KEY_G },
    { .action = CLICK, .widget = "tab:Passes" },
    { .action = TAKE, .picture = PASSES },
    { .action = CLICK, .widget = "tab:Health" },
    { .action = TAKE, .picture = HEALTH },
    { .action = CLICK, .widget = "tab:Memory" },
    { .action = SETTLE },
    { .action = TAKE, .picture = MEMORY },
    { .action = DRAG, .widget = "tab:Memory" },
    { .action = TAKE, .picture = PANEL_DRAGGED },
    { .action = DRAG },
    { .action = TAKE, .picture = SCENE_DRAGGED },
    { .action = KEY, .key = X_KEY_F1 },
    { .action = TAKE, .picture = PANEL_CLOSED },
    { .action = KEY, .key = X_KEY_ESCAPE },
};

static struct tour tour;

static int go_through_the_tour(void **state)
{
    (void)state;
    tour_run(&tour, steps, sizeof steps / sizeof *steps);
    tour_save(&tour);
    /* The last key may close the window before its step is done. */
    REQUIRE_CMP(tour.at + 1, >=, tour.count);
    REQUIRE_CMP(tour.waited, <, (uint32_t)SETTLES);
    return 0;
}

static int forget_the_tour(void **state)
{
    (void)state;
    for (int i = 0; i < PICTURES; i++)
        free(tour.pictures[i].pixels);
    return 0;
}

static double scene_differs(enum picture a, enum picture b)
{
    return x_picture_differ(&tour.pictures[a], &tour.pictures[b], SCENE, WIDTH);
}

static double panel_differs(enum picture a, enum picture b)
{
    return x_picture_differ(&tour.pictures[a], &tour.pictures[b], 8, SCENE - 24);
}

/* ---- Tests */

/* A frame at least comes between the key and the switch, and says how far it is. */
static void g_prepares_before_it_switches_on(void **state)
{
    (void)state;
    REQUIRE_TRUE(!tour.seen[BEFORE].settings.enabled && tour.seen[FIRST].settings.enabled);
    REQUIRE_CMP(tour.bars, >, 0u);
    REQUIRE_CMP(tour.made.total, >, 30u);
    REQUIRE_CMP(tour.made.made, ==, tour.made.total);
    REQUIRE_CMP(scene_differs(BEFORE, FIRST), >, 0.3);
}

static void gi_that_is_off_holds_nothing(void **state)
{
    (void)state;
    REQUIRE_CMP(tour.held[FIRST], >, tour.held[BEFORE] + (1u << 20));
    REQUIRE_CMP(tour.held[STOPPED], ==, tour.held[BEFORE]);
    REQUIRE_CMP(tour.held[GI_OFF], ==, tour.held[BEFORE]);
}

/* V walks on and Shift V back, a digit chooses, 0 is the picture, F2 a part of the light. The panel is open.
 */
static void keys_choose_what_is_shown(void **state)
{
    (void)state;
    const int views[] = { SDFGI_DEBUG_VIEW_COUNT, SDFGI_DEBUG_SOLID, SDFGI_DEBUG_SOLID,
                          SDFGI_DEBUG_DISTANCE_SLICE, SDFGI_DEBUG_VIEW_COUNT };
    for (int i = 0; i <= PICTURE_AGAIN - PANEL_OPEN; i++)
        REQUIRE_CMP((int)tour.seen[PANEL_OPEN + i].debug, ==, views[i]);
    REQUIRE_CMP(scene_differs(PANEL_OPEN, NEXT_VIEW), >, 0.3);
    REQUIRE_CMP(scene_differs(NEXT_VIEW, VIEW_BACK), ==, 0.0);
    REQUIRE_CMP(scene_differs(VIEW_BACK, VIEW_BY_DIGIT), >, 0.3);
    REQUIRE_CMP(scene_differs(PANEL_OPEN, PICTURE_AGAIN), ==, 0.0);
    REQUIRE_CMP(scene_differs(PICTURE_AGAIN, PART_OF_LIGHT), >, 0.3);
}

/* It covers the left, and the scene beside it stays. */
static void f1_opens_and_closes_the_panel(void **state)
{
    (void)state;
    REQUIRE_TRUE(!tour.seen[FIRST].open && tour.seen[PANEL_OPEN].open && !tour.seen[PANEL_CLOSED].open);
    REQUIRE_CMP(panel_differs(FIRST, PANEL_OPEN), >, 0.9);
    REQUIRE_CMP(scene_differs(FIRST, PANEL_OPEN), ==, 0.0);
    REQUIRE_CMP(panel_differs(SCENE_DRAGGED, PANEL_CLOSED), >, 0.9);
}

static void a_view_that_is_chosen_shows(void **state)
{
    (void)state;
    REQUIRE_CMP((int)tour.seen[VIEW_CHOSEN].debug, ==, (int)SDFGI_DEBUG_SOLID);
    REQUIRE_CMP(scene_differs(VIEW_CHOSEN, NEXT_VIEW), ==, 0.0);
    REQUIRE_CMP((int)tour.seen[GI_OFF].debug, ==, (int)SDFGI_DEBUG_VIEW_COUNT);
}

static void effects_of_the_host_can_be_left_out(void **state)
{
    (void)state;
    const struct host_overlay_frame *before = &tour.seen[FOG_SHOWN], *without = &tour.seen[PANEL_OPEN];
    REQUIRE_TRUE(before->possible.fog && !before->left_out.fog);
    REQUIRE_TRUE(without->left_out.fog && without->left_out.reflections);
    REQUIRE_TRUE(!tour.seen[PART_OF_LIGHT].left_out.reflections);
    REQUIRE_CMP(scene_differs(FOG_SHOWN, PANEL_OPEN), >, 0.3);
}

/* By its button, and on again by its key. */
static void an_effect_that_is_switched_shows(void **state)
{
    (void)state;
    REQUIRE_TRUE(!tour.seen[GI_OFF].settings.enabled && tour.seen[GI_ON].settings.enabled);
    REQUIRE_CMP(scene_differs(PART_OF_LIGHT, GI_OFF), >, 0.3);
    REQUIRE_CMP(scene_differs(PART_OF_LIGHT, GI_ON), <, 0.05);
}

static void an_effect_comes_back_as_it_was(void **state)
{
    (void)state;
    const float before = tour.seen[FIRST].settings.bounce_feedback;
    REQUIRE_TRUE(before > 0 && before < 1);
    REQUIRE_NEAR(tour.seen[BOUNCES_OFF].settings.bounce_feedback, 0, 0);
    REQUIRE_NEAR(tour.seen[BOUNCES_BACK].settings.bounce_feedback, before, 0);
}

static void every_property_is_listed(void **state)
{
    (void)state;
    const struct sdfgi_property_info *info;
    for (uint32_t i = 0; (info = sdfgi_property_get_info(i)); i++) {
        REQUIRE_CMP(i, <, (uint32_t)PROPERTIES_MAX);
        if (!tour.listed[i])
            require_fail(__FILE__, __LINE__, "%s is not in the panel", info->name);
    }
}

/* A check box, a slider that rebuilds everything once it is let go, one that is live, and a choice. */
static void properties_follow_their_widgets(void **state)
{
    (void)state;
    const struct sdfgi_settings *before = &tour.seen[PROPERTIES].settings,
                                *checked = &tour.seen[BOX_CHECKED].settings,
                                *moved = &tour.seen[SLIDER_MOVED].settings,
                                *rebuilt = &tour.seen[ALL_REBUILT].settings;
    REQUIRE_TRUE(before->read_sky_light && !checked->read_sky_light);
    REQUIRE_CMP(checked->cascades, ==, 1u);
    REQUIRE_CMP(rebuilt->cascades, >, 1u);
    REQUIRE_NEAR(rebuilt->energy, 1, 0);
    REQUIRE_CMP(moved->energy, >, 2.0f);
    REQUIRE_CMP((int)moved->voxelizer, ==, (int)SDFGI_VOXELIZER_COMPUTE);
    REQUIRE_CMP((int)tour.seen[CHOICE_MADE].settings.voxelizer, ==, (int)SDFGI_VOXELIZER_RASTER);
    REQUIRE_CMP(scene_differs(PROPERTIES, BOX_CHECKED), >, 0.3); /* the sky was the only light */
}

static void tabs_show_different_things(void **state)
{
    (void)state;
    for (int i = PASSES; i <= MEMORY; i++)
        REQUIRE_CMP(panel_differs((enum picture)(i - 1), (enum picture)i), >, 0.02);
}

static void the_mouse_turns_the_camera_beside_the_panel_alone(void **state)
{
    (void)state;
    REQUIRE_CMP(scene_differs(MEMORY, PANEL_DRAGGED), ==, 0.0);
    REQUIRE_CMP(scene_differs(PANEL_DRAGGED, SCENE_DRAGGED), >, 0.3);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(g_prepares_before_it_switches_on),
        cmocka_unit_test(gi_that_is_off_holds_nothing),
        cmocka_unit_test(keys_choose_what_is_shown),
        cmocka_unit_test(f1_opens_and_closes_the_panel),
        cmocka_unit_test(a_view_that_is_chosen_shows),
        cmocka_unit_test(effects_of_the_host_can_be_left_out),
        cmocka_unit_test(an_effect_that_is_switched_shows),
        cmocka_unit_test(an_effect_comes_back_as_it_was),
        cmocka_unit_test(every_property_is_listed),
        cmocka_unit_test(properties_follow_their_widgets),
        cmocka_unit_test(tabs_show_different_things),
        cmocka_unit_test(the_mouse_turns_the_camera_beside_the_panel_alone),
    };
    return cmocka_run_group_tests_name("window", tests, go_through_the_tour, forget_the_tour);
}
