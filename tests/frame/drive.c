/* SPDX-License-Identifier: MIT */
#include "drive.h"

#include "require.h"

struct sdfgi_settings drive_settings(uint32_t cascades, uint32_t resolution)
{
    struct sdfgi_settings settings;
    sdfgi_settings_default(&settings);
    settings.enabled = true;
    settings.cascades = cascades;
    settings.resolution = resolution;
    settings.min_cell_size_m = 0.25f;
    settings.ray_count = 25;
    settings.frames_to_converge = 4;
    return settings;
}

/* ---- The scene */

static void add_mesh_and_material(struct drive *d)
{
    struct mesh *mesh = sdfgi_pool_add(&d->scene.meshes, &d->backend.hooks, &d->mesh);
    for (int i = 0; i < 3; i++)
        mesh->desc.bounds_max[i] = 1;
    const struct sdfgi_material_desc material = { .albedo = { 0.5f, 0.5f, 0.5f }, .alpha = 1 };
    REQUIRE_CMP(sdfgi_scene_material_create(&d->scene, &material, &d->material), ==, SDFGI_OK);
}

static struct sdfgi_transform transform_of(const double low[static 3], const double high[static 3])
{
    struct sdfgi_transform t = { .translation = { low[0], low[1], low[2] } };
    for (int i = 0; i < 3; i++)
        t.basis[4 * i] = (float)(high[i] - low[i]);
    return t;
}

sdfgi_instance drive_add_box(struct drive *d, const double low[static 3], const double high[static 3],
                             enum sdfgi_mobility mobility)
{
    const struct sdfgi_instance_desc desc = { .mesh = { d->mesh },
                                              .material = d->material,
                                              .transform = transform_of(low, high),
                                              .mobility = mobility };
    sdfgi_instance instance;
    REQUIRE_CMP(sdfgi_scene_instance_create(&d->scene, &desc, &instance), ==, SDFGI_OK);
    return instance;
}

void drive_move_box(struct drive *d, sdfgi_instance box, const double low[static 3],
                    const double high[static 3])
{
    const struct sdfgi_transform t = transform_of(low, high);
    REQUIRE_CMP(sdfgi_scene_instance_set_transform(&d->scene, box, &t), ==, SDFGI_OK);
}

struct sdfgi_light_desc drive_lamp(void)
{
    return (struct sdfgi_light_desc){ .type = SDFGI_LIGHT_POINT,
                                      .position = { 0, 1, 0 },
                                      .intensity = { 10, 10, 10 },
                                      .indirect_energy = 1,
                                      .casts_shadow = true };
}

sdfgi_light drive_add_light(struct drive *d, const struct sdfgi_light_desc *desc)
{
    sdfgi_light light;
    REQUIRE_CMP(sdfgi_scene_light_create(&d->scene, desc, &light), ==, SDFGI_OK);
    return light;
}

void drive_set_emission(struct drive *d, float radiance)
{
    const struct sdfgi_material_desc desc = { .emission = { radiance, radiance, radiance }, .alpha = 1 };
    sdfgi_material material;
    REQUIRE_CMP(sdfgi_scene_material_create(&d->scene, &desc, &material), ==, SDFGI_OK);
    const struct sdfgi_instance_desc shown = { .mesh = { d->mesh },
                                               .material = material,
                                               .transform = { .basis = { 1, 0, 0, 0, 1, 0, 0, 0, 1 } },
                                               .mobility = SDFGI_EXCLUDED };
    sdfgi_instance instance;
    REQUIRE_CMP(sdfgi_scene_instance_create(&d->scene, &shown, &instance), ==, SDFGI_OK);
}

/* ---- Frames */

void drive_begin(struct drive *d, const struct sdfgi_settings *settings)
{
    memset(d, 0, sizeof *d);
    d->settings = *settings;
    d->extent = sdfgi_extent_from_settings(settings);
    sdfgi_scene_init(&d->scene, &d->backend);
    add_mesh_and_material(d);
    sdfgi_scene_add_journal(&d->scene, &d->journal);
    sdfgi_cascades_init(&d->state.cascades, settings);
    sdfgi_scroll_init(&d->state.scroll);
    sdfgi_accumulation_init(&d->state.accumulation);
    sdfgi_relight_init(&d->state.relight);
    d->desc.exposure = 1;
    for (int i = 0; i < 3; i++)
        d->desc.camera_position[i] = 0.1;
    for (uint32_t c = 0; c < settings->cascades; c++)
        d->light_cells[c] = 600 >> c;
    d->change = 0.5f;
}

void drive_end(struct drive *d)
{
    sdfgi_scene_finish(&d->scene);
}

static void read_back(struct drive *d)
{
    struct drive_slot *slot = &d->slots[d->frames % DRIVE_FRAMES_IN_FLIGHT];
    if (slot->feedback.content == FEEDBACK_TIMES_AND_COUNTERS)
        memcpy(d->counters, slot->counters, sizeof d->counters);
    if (slot->feedback.ended_cycle > 0)
        sdfgi_accumulation_add_known(&d->state.accumulation, slot->feedback.ended_cycle, d->change,
                                     d->change);
    for (uint32_t c = 0; c < d->state.cascades.count; c++)
        if (slot->feedback.ended_gathers[c] > 0)
            sdfgi_gathering_add_known(&d->state.gathering, c, slot->feedback.ended_gathers[c],
                                      &(struct gather_change){ .most = d->change });
    memset(slot, 0, sizeof *slot);
}

static struct light_lists lists_of(const struct drive *d)
{
    struct light_lists lists = { .cascades = d->settings.cascades,
                                 .room = (uint32_t)d->extent.light_cells,
                                 .frame = d->frames,
                                 .frames_in_flight = DRIVE_FRAMES_IN_FLIGHT };
    memcpy(lists.counted, d->counters + SDFGI_COUNTER_LIGHT_CELLS, sizeof lists.counted);
    return lists;
}

void drive_plan(const struct drive *d, struct frame *frame)
{
    const struct frame_input input = { .state = &d->state,
                                       .desc = &d->desc,
                                       .settings = &d->settings,
                                       .scene = &d->scene,
                                       .journal = &d->journal,
                                       .extent = d->extent,
                                       .counters = d->counters,
                                       .lists = lists_of(d),
                                       .gaps = { d->list_grew, d->emitters_added },
                                       .starts_in_parts = d->starts_in_parts,
                                       .threads_per_ray = SDFGI_GROUP_SURFACES,
                                       .software = false };
    sdfgi_frame_plan(frame, &input);
}

void drive_commit(struct drive *d)
{
    struct drive_slot *slot = &d->slots[d->frames % DRIVE_FRAMES_IN_FLIGHT];
    sdfgi_frame_next_state(&d->frame, &d->settings, &d->state);
    slot->feedback = sdfgi_frame_feedback(&d->frame);
    memcpy(slot->counters + SDFGI_COUNTER_LIGHT_CELLS, d->light_cells, sizeof d->light_cells);
    sdfgi_journal_clear(&d->journal);
    if (!d->frame.situation.converged)
        d->list_grew = d->emitters_added = false;
}

void drive_begin_frame(struct drive *d)
{
    d->frames++;
    read_back(d);
    d->emitters_added = d->emitters_added || (d->scene.emissive > 0 && !d->extent.emits);
    if (d->emitters_added)
        sdfgi_extent_set_emits(&d->extent);
}

void drive_frame(struct drive *d)
{
    drive_begin_frame(d);
    drive_plan(d, &d->frame);
    drive_commit(d);
}

void drive_frames(struct drive *d, uint32_t count)
{
    for (uint32_t i = 0; i < count; i++)
        drive_frame(d);
}

void drive_move(struct drive *d, double x, double y, double z)
{
    d->desc.camera_position[0] += x;
    d->desc.camera_position[1] += y;
    d->desc.camera_position[2] += z;
    drive_frame(d);
}

/* Borders that are far off arrive in so many frames. */
enum { MOST_FRAMES = 2000 };

void drive_converge(struct drive *d)
{
    const float change = d->change;
    d->change = 0;
    for (uint32_t i = 0; i < MOST_FRAMES; i++) {
        drive_frame(d);
        if (d->frame.situation.converged && d->state.scroll.blends_moving == 0)
            break;
    }
    REQUIRE_TRUE(d->frame.situation.converged && d->state.scroll.blends_moving == 0);
    d->change = change;
    drive_frame(d);
}
