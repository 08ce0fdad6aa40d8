/* SPDX-License-Identifier: MIT
 * The window of `sdfgi view` and its panel, by key and by mouse: what is pressed shows. */
#include "require.h"
#include "x_window.h"

#include "cli/view_editor.h"

#include <editor.h>
#include <modules/gltf/gltf_scene.h>
#include <stdio.h>
#include <stdlib.h>

/* Frames from a picture that is recorded to one that is seen, and from an input to the frame that has it. */
enum { UNTIL_SEEN = 4, UNTIL_HEARD = 2 };
/* The panel covers the left; SCENE is the first column beside it. */
enum { WIDTH = 440, HEIGHT = 300, SCENE = 310, PANEL_X = 150, PANEL_Y = 250, SETTLES = 300 };

/* What a user does, one thing after another. */
enum action { SETTLE, KEY, SCROLL, CLICK, DRAG, TAKE };

struct step {
    enum action action;
    enum x_key key;
    int picture;
    const char *widget;
};

enum { PICTURES_MAX = 24, PROPERTIES_MAX = 64 };

struct tour {
    const struct step *steps;
    uint32_t count, at, waited;
    struct x_window x;
    bool opened;
    const char *missing; /* a widget that was not there */
    struct x_picture pictures[PICTURES_MAX];
    struct view_editor editor;
    struct host_overlay panel;
    struct host_overlay_frame seen[PICTURES_MAX]; /* of the frame when a picture was taken */
    struct host_overlay_frame now;
    bool listed[PROPERTIES_MAX]; /* properties that the panel has shown */
};

/* ---- Steps */

static void point_at(struct tour *tour, const char *name)
{
    float place[2];
    if (editor_find(tour->editor.editor, name, place))
        x_window_point(&tour->x, place[0], place[1]);
    else
        tour->missing = name;
}

/* Points, presses, lets go, and moves away, so that no tooltip stays. */
static void click(struct tour *tour, const char *widget)
{
    if (tour->waited == 1)
        point_at(tour, widget);
    else if (tour->waited == 1 + UNTIL_HEARD || tour->waited == 1 + 2 * UNTIL_HEARD)
        x_window_button(&tour->x, tour->waited == 1 + UNTIL_HEARD);
    else if (tour->waited == 1 + 3 * UNTIL_HEARD)
        x_window_point(&tour->x, WIDTH - 8, HEIGHT - 8);
}

/* Holds the button down from a widget, or from the scene, to somewhere else. */
static void drag(struct tour *tour, const char *widget)
{
    if (tour->waited == 1 && widget)
        point_at(tour, widget);
    else if (tour->waited == 1)
        x_window_point(&tour->x, WIDTH - 40, HEIGHT - 40);
    else if (tour->waited == 1 + UNTIL_HEARD || tour->waited == 1 + 3 * UNTIL_HEARD)
        x_window_button(&tour->x, tour->waited == 1 + UNTIL_HEARD);
    else if (tour->waited == 1 + 2 * UNTIL_HEARD)
        x_window_point(&tour->x, WIDTH - 8, HEIGHT - 8);
}

/* Turns the wheel over the panel until the widget is in sight. */
static bool scroll(struct tour *tour, const char *widget)
{
    float place[2];
    if (tour->waited == 1)
        x_window_point(&tour->x, PANEL_X, PANEL_Y);
    if (tour->waited <= UNTIL_HEARD)
        return false;
    if (editor_find(tour->editor.editor, widget, place))
        return true;
    if (tour->waited % UNTIL_HEARD == 0)
        x_window_wheel(&tour->x);
    return false;
}

/* True once the step is done. */
static bool take_step(struct tour *tour, const struct step *step, const struct host_frame *frame)
{
    tour->waited++;
    switch (step->action) {
    case SETTLE:
        return tour->waited > UNTIL_HEARD && frame->report->converged;
    case KEY:
        if (tour->waited == 1)
            x_window_press(&tour->x, step->key);
        return tour->waited > UNTIL_HEARD;
    case SCROLL:
        return scroll(tour, step->widget);
    case CLICK:
        click(tour, step->widget);
        return tour->waited > 3 * UNTIL_HEARD;
    case DRAG:
        drag(tour, step->widget);
        return tour->waited > 4 * UNTIL_HEARD;
    case TAKE:
        if (tour->waited <= UNTIL_SEEN)
            return false;
        tour->pictures[step->picture] = x_window_capture(&tour->x);
        tour->seen[step->picture] = tour->now;
        return true;
    }
    return false;
}

static bool follow(void *user, const struct host_frame *frame)
{
    struct tour *tour = user;
    if (!tour->opened)
        x_window_open(&tour->x);
    tour->opened = true;
    if (tour->at == tour->count)
        tour->waited++;
    else if (take_step(tour, &tour->steps[tour->at], frame)) {
        tour->at++;
        tour->waited = 0;
    }
    /* What fails is said once the window is closed: another one cannot be opened beside it. */
    return !tour->missing && tour->waited < SETTLES;
}

/* ---- The panel, and what it sees */

static void list_properties(struct tour *tour)
{
    const struct sdfgi_property_info *info;
    float place[2];
    for (uint32_t i = 0; i < PROPERTIES_MAX && (info = sdfgi_property_get_info(i)); i++) {
        char name[96];
        snprintf(name, sizeof name, "property:%s", info->name);
        tour->listed[i] = tour->listed[i] || editor_find(tour->editor.editor, name, place);
    }
}

static bool begin(void *user, struct GLFWwindow *window, const struct host_overlay_vulkan *vulkan,
                  char *error, size_t error_size)
{
    struct tour *tour = user;
    return tour->panel.begin(tour->panel.user, window, vulkan, error, error_size);
}

static void show(void *user, struct host_overlay_frame *frame)
{
    struct tour *tour = user;
    tour->panel.frame(tour->panel.user, frame);
    tour->now = *frame;
    list_properties(tour);
}

static void record(void *user, VkCommandBuffer cmd)
{
    struct tour *tour = user;
    tour->panel.record(tour->panel.user, cmd);
}

static void end(void *user)
{
    struct tour *tour = user;
    tour->panel.end(tour->panel.user);
}

/* ---- Tours */

static struct sdfgi_settings small_settings(void)
{
    struct sdfgi_settings settings;
    sdfgi_settings_default(&settings);
    settings.enabled = true;
    settings.resolution = 32;
    settings.cascades = 1;
    settings.surface_light = SDFGI_SURFACE_LIGHT_PROBES;
    settings.bounce_feedback = 0.75f;
    settings.ray_count = 125;
    settings.frames_to_converge = 4;
    return settings;
}

/* Opens a window and does all steps, of which the last closes it. */
static void run_tour(struct tour *tour, const struct step *steps, uint32_t count)
{
    char error[512] = "";
    struct host_view view;
    host_view_default(&view);
    view.camera = (struct host_camera){
        .position = { 0.4, 1, 1.6 }, .look_at = { 0.4, 0.2, 0 }, .up = { 0, 1, 0 }, .yfov_rad = 1.4f
    };
    view.emissive_scale = 0;
    for (int i = 0; i < 3; i++)
        view.sky.zenith[i] = view.sky.horizon[i] = view.sky.ground[i] = 1;
    view.fog = (struct host_fog){ .density = 0.3f, .albedo = { 0.9f, 0.9f, 0.9f } };
    const struct sdfgi_settings settings = small_settings();
    struct gltf_scene *scene = gltf_scene_load(SOURCE_ROOT "/tests/fault/room.gltf", error, sizeof error);
    REQUIRE_TRUE(scene != NULL);
    *tour = (struct tour){ .steps = steps, .count = count };
    tour->panel = view_editor_overlay(&tour->editor);
    const struct host_overlay overlay = { begin, show, record, end, tour };
    const struct host_window_desc desc = { .gltf = scene,
                                           .view = &view,
                                           .settings = &settings,
                                           .lookups = { HOST_LOOKUP_QUARTER, HOST_LOOKUP_QUARTER },
                                           .width = WIDTH,
                                           .height = HEIGHT,
                                           .overlay = &overlay,
                                           .progress = follow,
                                           .validation = true,
                                           .user = tour };
    const bool ran = host_window_run(&desc, error, sizeof error);
    if (!ran)
        require_fail(__FILE__, __LINE__, "the window: %s", error);
    if (tour->missing)
        require_fail(__FILE__, __LINE__, "no widget %s in the panel", tour->missing);
    gltf_scene_destroy(scene);
    x_window_close(&tour->x);
}

/* Writes what the pictures of a tour show, where somebody wants to look at them. */
static void save_pictures(const struct tour *tour)
{
    const char *folder = getenv("SDFGI_TEST_PICTURES");
    for (int i = 0; folder && i < PICTURES_MAX; i++) {
        const struct x_picture *p = &tour->pictures[i];
        char path[512];
        snprintf(path, sizeof path, "%s/%02d.ppm", folder, i);
        FILE *file = p->pixels ? fopen(path, "wb") : NULL;
        if (!file)
            continue;
        fprintf(file, "P6 %u %u 255\n", p->width, p->height);
        for (uint32_t k = 0; k < p->width * p->height; k++)
            for (int shift = 16; shift >= 0; shift -= 8)
                fputc((int)(p->pixels[k] >> shift & 255), file);
        fclose(file);
    }
}

/* One window for all tests: a start of the program takes longer than what they do in it. */
enum picture {
    FIRST,
    PANEL_OPEN,
    FOG_LEFT_OUT,
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
    { .action = SETTLE },
    { .action = TAKE, .picture = FIRST },
    { .action = KEY, .key = X_KEY_F1 },
    { .action = TAKE, .picture = PANEL_OPEN },
    { .action = CLICK, .widget = "effect:Fog" },
    { .action = TAKE, .picture = FOG_LEFT_OUT },
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
    run_tour(&tour, steps, sizeof steps / sizeof *steps);
    save_pictures(&tour);
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
    return x_picture_differ(&tour.pictures[a], &tour.pictures[b], 8, 280);
}

/* ---- Tests */

/* V walks on and Shift V back, a digit chooses, 0 is the picture, F2 a part of the light. The panel is open.
 */
static void keys_choose_what_is_shown(void **state)
{
    (void)state;
    const int views[] = { SDFGI_DEBUG_VIEW_COUNT, SDFGI_DEBUG_SOLID, SDFGI_DEBUG_SOLID,
                          SDFGI_DEBUG_DISTANCE_SLICE, SDFGI_DEBUG_VIEW_COUNT };
    for (int i = 0; i <= PICTURE_AGAIN - FOG_LEFT_OUT; i++)
        REQUIRE_CMP((int)tour.seen[FOG_LEFT_OUT + i].debug, ==, views[i]);
    REQUIRE_CMP(scene_differs(FOG_LEFT_OUT, NEXT_VIEW), >, 0.3);
    REQUIRE_CMP(scene_differs(NEXT_VIEW, VIEW_BACK), ==, 0.0);
    REQUIRE_CMP(scene_differs(VIEW_BACK, VIEW_BY_DIGIT), >, 0.3);
    REQUIRE_CMP(scene_differs(FOG_LEFT_OUT, PICTURE_AGAIN), ==, 0.0);
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
    const struct host_overlay_frame *before = &tour.seen[PANEL_OPEN], *without = &tour.seen[FOG_LEFT_OUT];
    REQUIRE_TRUE(before->possible.fog && !before->left_out.fog);
    REQUIRE_TRUE(without->left_out.fog && !without->left_out.reflections);
    REQUIRE_TRUE(tour.seen[PART_OF_LIGHT].left_out.reflections);
    REQUIRE_CMP(scene_differs(PANEL_OPEN, FOG_LEFT_OUT), >, 0.3);
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
