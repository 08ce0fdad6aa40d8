/* SPDX-License-Identifier: MIT
 * Geometry and materials change. */
#include "situations.h"

static void edit_in_sight(struct show *show)
{
    show_begin(show);
    drive_converge(&show->d);
    drive_add_box(&show->d, (double[]){ 1, -0.5, 1 }, (double[]){ 1.5, 0.5, 1.5 }, SDFGI_STATIC);
    show_frames(show, 2);
}

static void edit_outside(struct show *show)
{
    show_begin(show);
    drive_converge(&show->d);
    drive_add_box(&show->d, (double[]){ 20, 0, 20 }, (double[]){ 21, 1, 21 }, SDFGI_STATIC);
    show_frames(show, 1);
}

/* In the coarser cascade alone. */
static void edit_far_off(struct show *show)
{
    show_begin(show);
    drive_converge(&show->d);
    drive_add_box(&show->d, (double[]){ 6, 0, 6 }, (double[]){ 7, 1, 7 }, SDFGI_STATIC);
    show_frames(show, 1);
}

static void box_moves(struct show *show)
{
    const struct sdfgi_settings settings = drive_settings(1, 32);
    show_begin_with(show, &settings);
    const double low[3] = { -3.5, 0.5, -3.5 }, high[3] = { -3, 1, -3 };
    const sdfgi_instance box = drive_add_box(&show->d, low, high, SDFGI_STATIC);
    drive_converge(&show->d);
    drive_move_box(&show->d, box, (double[]){ 2.5, 0.5, 2.5 }, (double[]){ 3, 1, 3 });
    show_frames(show, 1);
}

/* Nothing is left to draw where it was. */
static void last_box_goes(struct show *show)
{
    const struct sdfgi_settings settings = drive_settings(1, 32);
    show_begin_empty(show, &settings);
    const double low[3] = { -0.5, -0.5, -0.5 }, high[3] = { 0.5, 0.5, 0.5 };
    const sdfgi_instance box = drive_add_box(&show->d, low, high, SDFGI_STATIC);
    drive_converge(&show->d);
    sdfgi_scene_instance_destroy(&show->d.scene, box);
    show_frames(show, 1);
    show_idle(show);
}

/* Both lie in one plane: the box around them has no volume, and yet they are two. */
static void flat_boxes(struct show *show)
{
    const struct sdfgi_settings settings = drive_settings(1, 32);
    show_begin_empty(show, &settings);
    drive_converge(&show->d);
    drive_add_box(&show->d, (double[]){ -3, 1, -3 }, (double[]){ -2.5, 1, -2.5 }, SDFGI_STATIC);
    drive_add_box(&show->d, (double[]){ 2.5, 1, 2.5 }, (double[]){ 3, 1, 3 }, SDFGI_STATIC);
    show_frames(show, 1);
}

/* More than a change has boxes for: the nearest grow. */
static void many_boxes_at_once(struct show *show)
{
    const struct sdfgi_settings settings = drive_settings(1, 32);
    show_begin_with(show, &settings);
    drive_converge(&show->d);
    for (int i = 0; i < 9; i++) {
        const double x = -3.9 + 2 * (i % 3), z = -3.9 + 2 * (i / 3);
        drive_add_box(&show->d, (double[]){ x, 0.5, z }, (double[]){ x + 0.5, 1, z + 0.5 }, SDFGI_STATIC);
    }
    show_frames(show, 1);
}

/* A scroll is under way: the edit begins when it has completed. */
static void edit_during_a_scroll(struct show *show)
{
    const struct sdfgi_settings settings = drive_settings(1, 32);
    show_begin_with(show, &settings);
    drive_converge(&show->d);
    show_until(show, 0, CHANGE_DISTANCES, (double[]){ 0.125, 0, 0 });
    drive_add_box(&show->d, (double[]){ 1, -0.5, 1 }, (double[]){ 1.5, 0.5, 1.5 }, SDFGI_STATIC);
    show_until(show, 0, CHANGE_COMPLETES, (double[]){ 0.125, 0, 0 });
    show_move(show, 0.125, 0, 0);
}

/* Geometry changes in every frame while the camera moves: edits and scrolls take turns. */
static void edits_and_scrolls(struct show *show)
{
    const struct sdfgi_settings settings = drive_settings(1, 32);
    show_begin_with(show, &settings);
    drive_converge(&show->d);
    for (uint32_t i = 0; i < 4; i++) {
        const double x = show->d.desc.camera_position[0];
        sdfgi_scene_invalidate_box(&show->d.scene, (double[]){ x, 0, 0 }, (double[]){ x + 1, 1, 1 });
        show_move(show, 2, 0, 0);
    }
}

/* A budget that does not suffice: an edit takes two frames, and light goes on meanwhile. */
static void large_edit(struct show *show)
{
    struct sdfgi_settings settings = drive_settings(1, 32);
    settings.max_scroll_cells = 32768;
    show_begin_with(show, &settings);
    drive_converge(&show->d);
    sdfgi_scene_invalidate_box(&show->d.scene, (double[]){ -3, -2, -3 }, (double[]){ 3, 0, 3 });
    show_frames(show, 3);
}

static void material_changes(struct show *show)
{
    show_begin(show);
    drive_converge(&show->d);
    drive_set_emission(&show->d, 0);
    show_frames(show, 1);
}

/* The lists of emitters are there from then on, and emptied in the first frame that has work to do. */
static void first_emission(struct show *show)
{
    const struct sdfgi_light_desc lamp = drive_lamp();
    show_begin(show);
    drive_converge(&show->d);
    drive_set_emission(&show->d, 5);
    show_frames(show, 1);
    drive_add_light(&show->d, &lamp);
    show_frames(show, 2);
}

static void brighter_emission(struct show *show)
{
    show_begin(show);
    drive_set_emission(&show->d, 1);
    drive_converge(&show->d);
    drive_set_emission(&show->d, 5);
    show_frames(show, 2);
}

/* It does not fit the unit of stored emission: all of it is voxelised again. */
static void blinding_emission(struct show *show)
{
    show_begin(show);
    drive_converge(&show->d);
    drive_set_emission(&show->d, 1e9f);
    show_frames(show, 2);
}

/* What is half made is out of date: the scroll is given up, and nothing is read that was stored before. */
static void blinding_emission_during_a_scroll(struct show *show)
{
    show_begin(show);
    drive_converge(&show->d);
    show_until(show, 0, CHANGE_DISTANCES, (double[]){ 0.125, 0, 0 });
    drive_set_emission(&show->d, 1e9f);
    show_frames(show, 2);
}

static const struct situation_row rows[] = {
    { "an_edit_in_sight_is_made_at_once", edit_in_sight },
    { "an_edit_outside_all_cascades_is_nothing", edit_outside },
    { "an_edit_far_off_is_for_the_coarser_cascade", edit_far_off },
    { "a_box_that_moves_is_made_again_in_both_places", box_moves },
    { "the_last_box_goes_and_nothing_is_voxelised", last_box_goes },
    { "flat_boxes_in_one_plane_are_two", flat_boxes },
    { "many_boxes_at_once_are_joined", many_boxes_at_once },
    { "an_edit_during_a_scroll_begins_after_it", edit_during_a_scroll },
    { "edits_and_scrolls_take_turns", edits_and_scrolls },
    { "a_large_edit_takes_several_frames", large_edit },
    { "a_changed_material_is_uploaded", material_changes },
    { "a_first_emission_empties_the_lists_once", first_emission },
    { "a_brighter_emission_is_uploaded", brighter_emission },
    { "a_blinding_emission_rebuilds_everything", blinding_emission },
    { "a_blinding_emission_gives_up_a_scroll", blinding_emission_during_a_scroll },
};

const struct situation_table situations_edit = SITUATIONS(rows);
