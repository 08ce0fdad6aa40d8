/* SPDX-License-Identifier: MIT
 * Methods that settings choose, each in its first frame and in a scroll. */
#include "situations.h"

static void start_and_scroll(struct show *show, const struct sdfgi_settings *settings)
{
    show_begin_with(show, settings);
    show_frames(show, 1);
    drive_converge(&show->d);
    drive_move(&show->d, 2.25, 0, 0);
    show_until(show, 0, CHANGE_COMPLETES, (double[]){ 0, 0, 0 });
}

static void raster(struct show *show)
{
    struct sdfgi_settings settings = drive_settings(1, 32);
    settings.voxelizer = SDFGI_VOXELIZER_RASTER;
    start_and_scroll(show, &settings);
}

/* A flood cannot be cut: it takes all layers, whatever the budget. */
static void flood(struct show *show)
{
    struct sdfgi_settings settings = drive_settings(1, 32);
    settings.sdf_method = SDFGI_SDF_FLOOD;
    settings.max_scroll_cells = 8192;
    start_and_scroll(show, &settings);
}

static void probe_depth(struct show *show)
{
    struct sdfgi_settings settings = drive_settings(1, 32);
    settings.visibility = SDFGI_VISIBILITY_PROBE_DEPTH;
    start_and_scroll(show, &settings);
}

static void without_occlusion(struct show *show)
{
    struct sdfgi_settings settings = drive_settings(1, 32);
    settings.use_occlusion = false;
    start_and_scroll(show, &settings);
}

/* Nothing is read of the depths, and nothing of the masks. */
static void probe_depth_without_occlusion(struct show *show)
{
    struct sdfgi_settings settings = drive_settings(1, 32);
    settings.visibility = SDFGI_VISIBILITY_PROBE_DEPTH;
    settings.use_occlusion = false;
    show_begin_with(show, &settings);
    show_frames(show, 1);
}

/* A cycle of one frame ends in every frame. */
static void cycle_of_one_frame(struct show *show)
{
    struct sdfgi_settings settings = drive_settings(1, 32);
    settings.frames_to_converge = 1;
    show_begin_with(show, &settings);
    show_frames(show, 2);
}

static const struct situation_row rows[] = {
    { "raster_voxelises_by_drawing", raster },
    { "flood_makes_distances_by_jumps", flood },
    { "probe_depth_traces_depths", probe_depth },
    { "without_occlusion_nothing_is_traced_for_visibility", without_occlusion },
    { "probe_depth_without_occlusion_traces_no_depths", probe_depth_without_occlusion },
    { "a_cycle_of_one_frame_ends_in_every_frame", cycle_of_one_frame },
};

const struct situation_table situations_settings = SITUATIONS(rows);
