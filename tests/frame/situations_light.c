/* SPDX-License-Identifier: MIT
 * Light changes: lamps, sky, exposure, seed, and the length of light lists. */
#include "situations.h"

static void light_created(struct show *show)
{
    const struct sdfgi_settings settings = drive_settings(2, 32);
    const struct sdfgi_light_desc lamp = drive_lamp();
    show_begin_unlit(show, &settings);
    drive_converge(&show->d);
    drive_add_light(&show->d, &lamp);
    show_frames(show, 2);
}

/* Cells that it wakes send more rays for 20 frames. */
static void light_created_after_a_while(struct show *show)
{
    const struct sdfgi_settings settings = drive_settings(2, 32);
    const struct sdfgi_light_desc lamp = drive_lamp();
    show_begin_unlit(show, &settings);
    drive_converge(&show->d);
    drive_frames(&show->d, 130);
    drive_add_light(&show->d, &lamp);
    show_frames(show, 2);
    drive_frames(&show->d, 20);
    show_frames(show, 1);
}

static void light_updated_and_removed(struct show *show)
{
    const struct sdfgi_settings settings = drive_settings(2, 32);
    struct sdfgi_light_desc lamp = drive_lamp();
    show_begin_unlit(show, &settings);
    const sdfgi_light light = drive_add_light(&show->d, &lamp);
    drive_converge(&show->d);
    lamp.position[0] = 1;
    sdfgi_scene_light_update(&show->d.scene, light, &lamp);
    show_frames(show, 1);
    drive_converge(&show->d);
    sdfgi_scene_light_destroy(&show->d.scene, light);
    show_frames(show, 2);
}

/* How many cells a list has is not known in the frame after it was written: all that it has room for. */
static void light_updated_in_the_second_frame(struct show *show)
{
    show_begin(show);
    drive_frame(&show->d);
    const struct sdfgi_light_desc lamp = drive_lamp();
    drive_add_light(&show->d, &lamp);
    show_frames(show, 1);
}

/* Light cells that the scroll listed are lit twice, those before it once. */
static void light_updated_while_a_scroll_completes(struct show *show)
{
    const struct sdfgi_settings settings = drive_settings(1, 32);
    const struct sdfgi_light_desc lamp = drive_lamp();
    show_begin_with(show, &settings);
    drive_converge(&show->d);
    drive_move(&show->d, 2.25, 0, 0);
    drive_frames(&show->d, 3);
    drive_add_light(&show->d, &lamp);
    show_frames(show, 1);
}

/* As a day goes by: its cells are lit in turn, until it stands still. */
static void sun_turned_a_little(struct show *show)
{
    struct sdfgi_light_desc sun = { .type = SDFGI_LIGHT_DIRECTIONAL,
                                    .direction = { 0, -1, 0 },
                                    .intensity = { 3, 3, 3 },
                                    .casts_shadow = true };
    show_begin(show);
    const sdfgi_light light = drive_add_light(&show->d, &sun);
    drive_converge(&show->d);
    for (int frame = 0; frame < 2; frame++) {
        sun.direction[0] += 0.001f;
        sdfgi_scene_light_update(&show->d.scene, light, &sun);
        show_frames(show, 1);
    }
    show_frames(show, 1);
}

static void update_a_sun(struct show *show, const struct sdfgi_light_desc *before,
                         const struct sdfgi_light_desc *after)
{
    show_begin(show);
    const sdfgi_light light = drive_add_light(&show->d, before);
    drive_converge(&show->d);
    sdfgi_scene_light_update(&show->d.scene, light, after);
    show_frames(show, 1);
}

/* At night it goes on below the horizon. */
static void dark_sun_turned(struct show *show)
{
    const struct sdfgi_light_desc sun = { .type = SDFGI_LIGHT_DIRECTIONAL, .direction = { 0, -1, 0 } },
                                  turned = { .type = SDFGI_LIGHT_DIRECTIONAL, .direction = { 0, 1, 0 } };
    update_a_sun(show, &sun, &turned);
}

/* Its position, for instance. */
static void what_says_nothing_changed(struct show *show)
{
    const struct sdfgi_light_desc sun = { .type = SDFGI_LIGHT_DIRECTIONAL,
                                          .direction = { 0, -1, 0 },
                                          .intensity = { 1, 1, 1 } },
                                  moved = { .type = SDFGI_LIGHT_DIRECTIONAL,
                                            .position = { 1, 2, 3 },
                                            .direction = { 0, -2, 0 },
                                            .intensity = { 1, 1, 1 },
                                            .range_m = 4,
                                            .outer_angle_rad = 1 };
    update_a_sun(show, &sun, &moved);
}

static void sky_changed(struct show *show)
{
    const struct sdfgi_sky sky = { .zenith = { 0, 0, 1 } };
    show_begin(show);
    drive_converge(&show->d);
    sdfgi_scene_set_sky(&show->d.scene, &sky);
    show_frames(show, 2);
}

static void exposure_changed(struct show *show)
{
    show_begin(show);
    drive_converge(&show->d);
    show->d.desc.exposure = 1024;
    show_frames(show, 2);
}

/* An engine that pushes its whole state in each frame. */
static void state_pushed_again(struct show *show)
{
    static const double low[3] = { -1, -1, -1 }, high[3] = { 0, 0, 0 };
    const struct sdfgi_light_desc lamp = drive_lamp();
    const struct sdfgi_sky sky = { .zenith = { 0, 0, 1 } };
    show_begin(show);
    const sdfgi_instance box = drive_add_box(&show->d, low, high, SDFGI_STATIC);
    const sdfgi_light light = drive_add_light(&show->d, &lamp);
    sdfgi_scene_set_sky(&show->d.scene, &sky);
    drive_converge(&show->d);
    for (int frame = 0; frame < 2; frame++) {
        drive_move_box(&show->d, box, low, high);
        sdfgi_scene_light_update(&show->d.scene, light, &lamp);
        sdfgi_scene_set_sky(&show->d.scene, &sky);
        show_frames(show, 1);
    }
}

static void exposure_drifted(struct show *show)
{
    show_begin(show);
    drive_converge(&show->d);
    show->d.desc.exposure = 200;
    show_frames(show, 2);
    show->d.desc.exposure = 0.005f;
    show_frames(show, 2);
}

static void seed_changed(struct show *show)
{
    show_begin(show);
    drive_converge(&show->d);
    for (int i = 0; i < 3; i++) {
        show->d.desc.seed++; /* in every frame: nothing happens */
        show_frames(show, 1);
    }
    show_frames(show, 2);
}

/* Energy enters lookups alone. */
static void energy_changed(struct show *show)
{
    show_begin(show);
    drive_converge(&show->d);
    show->d.settings.energy = 2;
    show_frames(show, 1);
}

static void list_grew(struct show *show)
{
    show_begin(show);
    drive_converge(&show->d);
    show->d.list_grew = true;
    show->d.extent.light_cells *= 2;
    show_frames(show, 2);
}

static void list_grew_in_the_dark(struct show *show)
{
    const struct sdfgi_settings settings = drive_settings(1, 32);
    show_begin_unlit(show, &settings);
    drive_frames(&show->d, 2);
    show->d.list_grew = true;
    show_frames(show, 1);
}

static void list_grew_while_a_scroll_completes(struct show *show)
{
    const struct sdfgi_settings settings = drive_settings(1, 32);
    show_begin_with(show, &settings);
    drive_converge(&show->d);
    drive_move(&show->d, 2.25, 0, 0);
    drive_frames(&show->d, 3);
    show->d.list_grew = true;
    show_frames(show, 2);
}

static const struct situation_row rows[] = {
    { "a_new_light_lights_all_cells", light_created },
    { "a_new_light_after_a_while_has_cells_send_more_rays", light_created_after_a_while },
    { "a_light_is_updated_and_removed", light_updated_and_removed },
    { "a_light_in_the_second_frame_lights_all_that_lists_have_room_for", light_updated_in_the_second_frame },
    { "a_light_while_a_scroll_completes", light_updated_while_a_scroll_completes },
    { "a_sun_that_turns_a_little_lights_cells_in_turn", sun_turned_a_little },
    { "a_sun_of_no_light_turns_and_costs_nothing", dark_sun_turned },
    { "what_says_nothing_of_a_sun_costs_nothing", what_says_nothing_changed },
    { "a_changed_sky_begins_to_converge_again", sky_changed },
    { "a_very_different_exposure_rescales_light", exposure_changed },
    { "another_exposure_costs_nothing", exposure_drifted },
    { "state_that_is_pushed_again_costs_nothing", state_pushed_again },
    { "a_changed_seed_rebuilds_everything", seed_changed },
    { "a_changed_energy_is_uploaded", energy_changed },
    { "a_longer_light_list_is_written_anew", list_grew },
    { "a_longer_light_list_in_the_first_cycle", list_grew_in_the_dark },
    { "a_longer_light_list_while_a_scroll_is_under_way", list_grew_while_a_scroll_completes },
};

const struct situation_table situations_light = SITUATIONS(rows);
