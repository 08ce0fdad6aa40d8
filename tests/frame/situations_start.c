/* SPDX-License-Identifier: MIT
 * From the first frame until light has converged. */
#include "situations.h"

static void first_frame(struct show *show)
{
    show_begin(show);
    show_frames(show, 1);
}

/* A host that has prepared: a cascade of 64^3 a frame, the coarser one first. */
static void start_in_parts(struct show *show)
{
    struct sdfgi_settings settings = drive_settings(2, 64);
    settings.max_scroll_cells = 524288;
    show_begin_with(show, &settings);
    show->d.starts_in_parts = true;
    show_frames(show, 3);
}

static void first_frame_without_instances(struct show *show)
{
    const struct sdfgi_settings settings = drive_settings(1, 32);
    const struct sdfgi_light_desc lamp = drive_lamp();
    show_begin_empty(show, &settings);
    drive_add_light(&show->d, &lamp);
    show_frames(show, 1);
}

static void first_frame_of_excluded_instances(struct show *show)
{
    const struct sdfgi_settings settings = drive_settings(1, 32);
    show_begin_empty(show, &settings);
    drive_add_box(&show->d, (double[]){ -1, -1, -1 }, (double[]){ 1, 1, 1 }, SDFGI_EXCLUDED);
    show_frames(show, 1);
}

static void first_frame_without_lights(struct show *show)
{
    const struct sdfgi_settings settings = drive_settings(1, 32);
    show_begin_unlit(show, &settings);
    show_frames(show, 1);
}

static void first_frames_with_the_sky_alone(struct show *show)
{
    const struct sdfgi_settings settings = drive_settings(1, 32);
    const struct sdfgi_sky sky = { .zenith = { 1, 1, 1 }, .horizon = { 1, 1, 1 }, .ground = { 1, 1, 1 } };
    show_begin_unlit(show, &settings);
    sdfgi_scene_set_sky(&show->d.scene, &sky);
    show_frames(show, 2);
}

static void second_frame(struct show *show)
{
    show_begin(show);
    drive_frame(&show->d);
    show_frames(show, 1);
    show_idle(show);
}

static void first_cycle_goes_on_and_ends(struct show *show)
{
    show_begin(show);
    drive_frames(&show->d, 2);
    show_frames(show, 3);
}

/* Once every ray of a cycle is cached, nothing is traced. */
static void second_cycle_reads_cached_rays(struct show *show)
{
    show_begin(show);
    drive_frames(&show->d, 5);
    show_frames(show, 3);
}

/* The first frame shows what it has; then every fourth does, and the last of a cycle. */
static void probes_show_every_fourth_frame(struct show *show)
{
    struct sdfgi_settings settings = drive_settings(1, 32);
    settings.frames_to_converge = 6;
    settings.frames_to_update_lights = 4;
    show_begin_with(show, &settings);
    drive_frame(&show->d);
    show_frames(show, 5);
}

/* A cycle without change comes back two frames late, and ends the work where the next cycle ends. */
static void light_converges(struct show *show)
{
    show_begin(show);
    drive_frames(&show->d, 8);
    show->d.change = 0;
    drive_frames(&show->d, 2);
    show_frames(show, 3);
}

static void converged_light_needs_nothing(struct show *show)
{
    show_begin(show);
    drive_converge(&show->d);
    show_frames(show, 2);
    show_idle(show);
}

/* Borders of blend regions move with the camera: parameters are all that changes. */
static void converged_light_and_a_small_step_need_nothing(struct show *show)
{
    show_begin(show);
    drive_converge(&show->d);
    show_move(show, 0.5, 0, 0);
    show_frames(show, 1);
}

static void the_coordinate_origin_moves(struct show *show)
{
    show_begin(show);
    drive_converge(&show->d);
    show->d.desc.origin[0] = 2;
    show_frames(show, 2);
}

static const struct situation_row rows[] = {
    { "the_first_frame_makes_everything", first_frame },
    { "a_start_in_parts_makes_a_cascade_a_frame", start_in_parts },
    { "the_first_frame_without_instances_voxelises_nothing", first_frame_without_instances },
    { "the_first_frame_of_excluded_instances_voxelises_nothing", first_frame_of_excluded_instances },
    { "the_first_frame_without_lights_writes_zeros", first_frame_without_lights },
    { "the_first_frames_with_the_sky_alone", first_frames_with_the_sky_alone },
    { "the_second_frame_traces_and_sums", second_frame },
    { "the_first_cycle_goes_on_and_ends", first_cycle_goes_on_and_ends },
    { "the_second_cycle_reads_cached_rays", second_cycle_reads_cached_rays },
    { "probes_show_every_fourth_frame", probes_show_every_fourth_frame },
    { "light_converges_at_the_end_of_a_cycle", light_converges },
    { "converged_light_needs_nothing", converged_light_needs_nothing },
    { "converged_light_and_a_small_step_need_nothing", converged_light_and_a_small_step_need_nothing },
    { "the_coordinate_origin_moves", the_coordinate_origin_moves },
};

const struct situation_table situations_start = SITUATIONS(rows);
