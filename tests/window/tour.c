/* SPDX-License-Identifier: MIT */
#include "tour.h"

#include "require.h"

#include <editor.h>
#include <modules/gltf/gltf_scene.h>
#include <stdio.h>
#include <stdlib.h>

/* Frames from a picture that is recorded to one that is seen, and from an input to the frame that has it. */
enum { UNTIL_SEEN = 4, UNTIL_HEARD = 2 };

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
        tour->held[step->picture] = frame->report->memory.total_bytes;
        return true;
    }
    return false;
}

static bool follow(void *user, const struct host_frame *frame)
{
    struct tour *tour = user;
    if (frame->report->active && tour->made.total == 0)
        tour->made = frame->report->prepared;
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
    float place[2];
    tour->bars += editor_find(tour->editor.editor, "progress:GI", place);
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
    settings.resolution = 32;
    settings.cascades = 1;
    settings.surface_light = SDFGI_SURFACE_LIGHT_PROBES;
    settings.bounce_feedback = 0.75f;
    settings.ray_count = 125;
    settings.frames_to_converge = 1;
    return settings;
}

void tour_run(struct tour *tour, const struct step *steps, uint32_t count)
{
    char error[512] = "";
    struct host_view view;
    host_view_default(&view);
    /* Beside the floor, which begins about where the panel ends: sky takes less time. */
    view.camera = (struct host_camera){
        .position = { -2.3, 1, 1.6 }, .look_at = { -2.3, 0.2, 0 }, .up = { 0, 1, 0 }, .yfov_rad = 1.4f
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

void tour_save(const struct tour *tour)
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
