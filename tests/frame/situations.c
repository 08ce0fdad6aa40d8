/* SPDX-License-Identifier: MIT */
#include "situations.h"

#include "require.h"

void show_begin_empty(struct show *show, const struct sdfgi_settings *settings)
{
    memset(show, 0, sizeof *show);
    drive_begin(&show->d, settings);
}

void show_begin_unlit(struct show *show, const struct sdfgi_settings *settings)
{
    show_begin_empty(show, settings);
    drive_add_box(&show->d, (double[]){ -20, -1.5, -20 }, (double[]){ 20, -0.5, 20 }, SDFGI_STATIC);
}

void show_begin_with(struct show *show, const struct sdfgi_settings *settings)
{
    const struct sdfgi_light_desc lamp = drive_lamp();
    show_begin_unlit(show, settings);
    drive_add_light(&show->d, &lamp);
}

void show_begin(struct show *show)
{
    const struct sdfgi_settings settings = drive_settings(2, 32);
    show_begin_with(show, &settings);
}

static void show_planned(struct show *show)
{
    plan_text_add(&show->text, &show->d.frame, sdfgi_settings_cycle_frames(&show->d.settings));
}

void show_frames(struct show *show, uint32_t count)
{
    for (uint32_t i = 0; i < count; i++) {
        drive_frame(&show->d);
        show_planned(show);
    }
}

void show_idle(struct show *show)
{
    plan_text_add_idle(&show->text, &show->d.frame);
}

void show_move(struct show *show, double x, double y, double z)
{
    drive_move(&show->d, x, y, z);
    show_planned(show);
}

/* A camera that moves at all comes to a scroll within so many frames. */
enum { MOST_FRAMES = 200 };

/* Fails where a camera has moved for so many frames in vain. */
static void move_on(struct show *show, const double step[static 3], uint32_t frame)
{
    if (frame == MOST_FRAMES)
        require_fail(__FILE__, __LINE__, "in %d frames nothing has happened", MOST_FRAMES);
    drive_move(&show->d, step[0], step[1], step[2]);
}

void show_until_begun(struct show *show, const double step[static 3])
{
    uint32_t frame = 0;
    do
        move_on(show, step, frame++);
    while (!show->d.frame.scroll.begun);
    show_planned(show);
}

void show_until(struct show *show, uint32_t c, enum change_stage stage, const double step[static 3])
{
    uint32_t frame = 0;
    do
        move_on(show, step, frame++);
    while (show->d.frame.next.cascades.at[c].change.stage != stage);
    show_planned(show);
}
