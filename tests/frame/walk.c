/* SPDX-License-Identifier: MIT */
#include "walk.h"

#include "require.h"

/* True once in so many times. */
static bool once_in(struct walk *w, uint32_t times)
{
    return test_random_uint(&w->random) % times == 0;
}

static double spacing(const struct walk *w)
{
    return w->d.settings.min_cell_size_m * SDFGI_PROBE_SPACING;
}

void walk_begin(struct walk *walk, const struct sdfgi_settings *settings, uint32_t seed)
{
    memset(walk, 0, sizeof *walk);
    drive_begin(&walk->d, settings);
    walk->random.state = seed;
}

/* ---- Geometry */

/* Within a few widths of the finest cascade; one in four is flat. */
static void random_box(struct walk *w, double low[static 3], double high[static 3])
{
    const double width = w->d.settings.resolution * (double)w->d.settings.min_cell_size_m;
    for (int i = 0; i < 3; i++) {
        low[i] = w->d.desc.camera_position[i] + test_random_real(&w->random, -2, 2) * width;
        high[i] = low[i] + test_random_real(&w->random, 0.01, 0.5) * width;
    }
    if (once_in(w, 4))
        high[1] = low[1];
}

static void edit(struct walk *w)
{
    double low[3], high[3];
    const uint32_t which = w->box_count ? test_random_uint(&w->random) % w->box_count : 0;
    random_box(w, low, high);
    switch (test_random_uint(&w->random) % 4) {
    case 0:
        if (w->box_count < WALK_BOXES)
            w->boxes[w->box_count++] =
                drive_add_box(&w->d, low, high, once_in(w, 5) ? SDFGI_EXCLUDED : SDFGI_STATIC);
        break;
    case 1:
        if (w->box_count > 0)
            drive_move_box(&w->d, w->boxes[which], low, high);
        break;
    case 2:
        if (w->box_count > 0) {
            sdfgi_scene_instance_destroy(&w->d.scene, w->boxes[which]);
            w->boxes[which] = w->boxes[--w->box_count];
        }
        break;
    default:
        sdfgi_scene_invalidate_box(&w->d.scene, low, high);
    }
}

/* ---- Light */

static void change_light(struct walk *w)
{
    struct sdfgi_light_desc lamp = drive_lamp();
    const uint32_t which = w->light_count ? test_random_uint(&w->random) % w->light_count : 0;
    lamp.position[0] = test_random_real(&w->random, -5, 5);
    switch (test_random_uint(&w->random) % 3) {
    case 0:
        if (w->light_count < WALK_LIGHTS)
            w->lights[w->light_count++] = drive_add_light(&w->d, &lamp);
        break;
    case 1:
        if (w->light_count > 0)
            sdfgi_scene_light_update(&w->d.scene, w->lights[which], &lamp);
        break;
    default:
        if (w->light_count > 0) {
            sdfgi_scene_light_destroy(&w->d.scene, w->lights[which]);
            w->lights[which] = w->lights[--w->light_count];
        }
    }
}

static void change_surroundings(struct walk *w)
{
    const float value = (float)test_random_real(&w->random, 0.5, 2);
    const struct sdfgi_sky sky = { .zenith = { value, value, value } };
    switch (test_random_uint(&w->random) % 5) {
    case 0:
        sdfgi_scene_set_sky(&w->d.scene, &sky);
        break;
    case 1:
        w->d.desc.exposure = powf(value, 10);
        break;
    case 2:
        w->d.desc.seed++;
        break;
    case 3:
        w->d.desc.origin[0] += 10;
        break;
    default:
        drive_set_emission(&w->d, once_in(w, 2) ? value : 0);
    }
}

/* Surfaces come and go; now and then there are more than the list has room for, and it grows. */
static void change_lists(struct walk *w)
{
    struct drive *d = &w->d;
    for (uint32_t c = 0; c < d->settings.cascades; c++)
        d->light_cells[c] = test_random_uint(&w->random) % (uint32_t)d->extent.light_cells;
    if (once_in(w, 8)) {
        d->extent.light_cells += d->extent.light_cells / 8;
        d->list_grew = true;
    }
}

/* ---- The camera */

/* From a hundredth of a probe spacing a frame to two. */
static void turn(struct walk *w)
{
    const double speed = spacing(w) * exp(test_random_real(&w->random, log(0.01), log(2)));
    test_random_direction(&w->random, w->velocity);
    for (int i = 0; i < 3; i++)
        w->velocity[i] *= once_in(w, 3) ? 0 : speed;
}

static void move(struct walk *w)
{
    if (once_in(w, 40))
        turn(w);
    for (int i = 0; i < 3; i++)
        w->d.desc.camera_position[i] += w->velocity[i];
    if (!once_in(w, 150))
        return;
    for (int i = 0; i < 3; i++)
        w->d.desc.camera_position[i] += spacing(w) * test_random_real(&w->random, -60, 60);
    w->d.desc.cut = once_in(w, 2);
}

static void act(struct walk *w)
{
    move(w);
    if (once_in(w, 20))
        edit(w);
    if (once_in(w, 60))
        change_light(w);
    if (once_in(w, 90))
        change_surroundings(w);
    if (once_in(w, 30))
        change_lists(w);
    if (once_in(w, 80))
        w->rest = 60;
}

void walk_on(struct walk *walk)
{
    walk->d.desc.cut = false;
    if (walk->rest > 0)
        walk->rest--;
    else
        act(walk);
    walk->d.change = walk->rest > 0 ? 0 : 0.5f;
    drive_begin_frame(&walk->d);
}
