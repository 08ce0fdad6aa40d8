/* SPDX-License-Identifier: MIT
 * The camera moves: cascades scroll, wait, or are rebuilt. */
#include "situations.h"

/* Sixteen frames for a probe spacing of the finest cascade. */
static const double slow[3] = { 0.125, 0, 0 };

static void slow_scroll(struct show *show)
{
    show_begin(show);
    drive_converge(&show->d);
    show_until_begun(show, slow);
    show_until(show, 0, CHANGE_DISTANCES, slow);
    show_until(show, 0, CHANGE_DISTANCES, slow);
    show_until(show, 0, CHANGE_COMPLETES, slow);
    show_move(show, 0.125, 0, 0);
}

/* The floor ends before the slab that enters. */
static void scroll_into_the_air(struct show *show)
{
    show_begin(show);
    drive_converge(&show->d);
    show_until_begun(show, (double[]){ 0, 0.125, 0 });
}

static void scroll_along_z(struct show *show)
{
    show_begin(show);
    drive_converge(&show->d);
    show_until_begun(show, (double[]){ 0, 0, -0.125 });
}

/* One axis is due, and takes the other along. */
static void scroll_on_two_axes(struct show *show)
{
    show_begin(show);
    drive_converge(&show->d);
    show_until_begun(show, (double[]){ 0.125, 0, 0.12 });
    show_until(show, 0, CHANGE_COMPLETES, (double[]){ 0.125, 0, 0.12 });
}

/* The finer cascade begins while the coarser one is being made, goes first, and completes shortly before it.
 * Three frames pass between the two. */
static void two_cascades_keep_apart(struct show *show)
{
    const struct change *coarse = &show->d.frame.next.cascades.at[1].change;
    show_begin(show);
    drive_converge(&show->d);
    for (int i = 0; i < 60 && coarse->layer < 2; i++)
        drive_move(&show->d, 0, 0, 0.125);
    drive_move(&show->d, 2.25, 0, 0);
    show_until(show, 0, CHANGE_COMPLETES, (double[]){ 0, 0, 0.125 });
    show_until(show, 1, CHANGE_READY, (double[]){ 0, 0, 0.125 });
    show_idle(show);
    show_until(show, 1, CHANGE_COMPLETES, (double[]){ 0, 0, 0.125 });
}

/* Shadows of what a cascade gained fall on light cells that stay: so many a frame are lit again. */
static void light_cells_are_lit_again(struct show *show)
{
    struct sdfgi_settings settings = drive_settings(2, 64);
    show_begin_with(show, &settings);
    show->d.light_cells[0] = 20000;
    show->d.light_cells[1] = 9000;
    drive_converge(&show->d);
    show_until(show, 0, CHANGE_COMPLETES, (double[]){ 0.03125, 0, 0 });
    show_frames(show, 4);
}

/* The budget is too small for the finest cascade: it waits, and the coarser one scrolls. */
static void fast_flight(struct show *show)
{
    struct sdfgi_settings settings = drive_settings(2, 32);
    settings.max_scroll_cells = 32768;
    show_begin_with(show, &settings);
    drive_converge(&show->d);
    for (uint32_t i = 0; i < 8; i++)
        drive_move(&show->d, 2.5, 0, 0);
    show_move(show, 2.5, 0, 0);
    show_move(show, 2.5, 0, 0);
}

/* Scrolls follow each other so closely that rays go on, and every fourth such frame lights cells again. */
static void busy_flight(struct show *show)
{
    show_begin(show);
    drive_converge(&show->d);
    for (uint32_t i = 0; i < 12; i++)
        drive_move(&show->d, 1.5, 0, 0);
    for (uint32_t i = 0; i < 4; i++)
        show_move(show, 1.5, 0, 0);
}

/* The pace falls slowly, and when it is low enough the finest cascade is rebuilt. */
static void stop_after_a_flight(struct show *show)
{
    struct sdfgi_settings settings = drive_settings(2, 32);
    settings.max_scroll_cells = 32768;
    show_begin_with(show, &settings);
    drive_converge(&show->d);
    for (uint32_t i = 0; i < 12; i++)
        drive_move(&show->d, 2.5, 0, 0);
    show_frames(show, 1);
    show_until(show, 0, CHANGE_COMPLETES, (double[]){ 0, 0, 0 });
}

static void teleport(struct show *show)
{
    show_begin(show);
    drive_converge(&show->d);
    show_move(show, 1000, -50, 1000);
    show_move(show, 0, 0, 0);
}

/* The coarser cascade still holds something: the finer one is rebuilt within the budget. */
static void jump_within_the_coarser_cascade(struct show *show)
{
    show_begin(show);
    drive_converge(&show->d);
    show_move(show, 9, 0, 0);
    show_frames(show, 2);
}

static void small_budget(struct show *show)
{
    struct sdfgi_settings settings = drive_settings(1, 32);
    settings.max_scroll_cells = 8192;
    show_begin_with(show, &settings);
    drive_converge(&show->d);
    show_move(show, 2.25, 0, 0);
    show_frames(show, 6);
}

static const struct situation_row rows[] = {
    { "a_slow_scroll_begins_goes_on_and_completes", slow_scroll },
    { "a_scroll_into_the_air_voxelises_nothing", scroll_into_the_air },
    { "a_scroll_along_z_has_strips_across_x", scroll_along_z },
    { "a_scroll_on_two_axes_is_one_change", scroll_on_two_axes },
    { "two_cascades_complete_some_frames_apart", two_cascades_keep_apart },
    { "light_cells_are_lit_again_after_a_scroll", light_cells_are_lit_again },
    { "a_fast_flight_leaves_the_fine_cascade_waiting", fast_flight },
    { "a_busy_flight_goes_on_with_light", busy_flight },
    { "a_stop_after_a_flight_brings_the_fine_cascade_back", stop_after_a_flight },
    { "a_teleport_is_a_start_from_nothing", teleport },
    { "a_jump_within_the_coarser_cascade_rebuilds_the_finer_one", jump_within_the_coarser_cascade },
    { "a_small_budget_spreads_a_scroll_over_frames", small_budget },
};

const struct situation_table situations_scroll = SITUATIONS(rows);
