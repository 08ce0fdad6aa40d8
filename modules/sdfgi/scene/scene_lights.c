/* SPDX-License-Identifier: MIT
 * Lights and sky. */
#include "drift.h"
#include "same.h"
#include "scene.h"
#include "scene_check.h"

#include <math.h>

/* What zero stands for is filled in. */
static struct sdfgi_light_desc resolved(const struct sdfgi_light_desc *desc)
{
    struct sdfgi_light_desc light = *desc;
    light.indirect_energy = desc->indirect_energy > 0 ? desc->indirect_energy : 1;
    return light;
}

static float brightness(const struct sdfgi_light_desc *light)
{
    float power[3];
    sdfgi_light_power(light, power);
    return fmaxf(power[0], fmaxf(power[1], power[2]));
}

/* A light that was a thousand times dimmer may have been too dim to count. */
static bool lights_others(const struct sdfgi_light_desc *before, const struct sdfgi_light_desc *after)
{
    return !sdfgi_same_reach(before, after) || brightness(before) < brightness(after) / 1000;
}

static bool is_of_type(const struct sdfgi_light_desc *light, bool sun)
{
    return light && (light->type == SDFGI_LIGHT_DIRECTIONAL) == sun;
}

static bool is_dark(const struct sdfgi_light_desc *light)
{
    return !(brightness(light) > 0);
}

/* True if two descriptions of a light give the same light: both give none, or what they differ in says
 * nothing of a sun. */
static bool shine_alike(const struct sdfgi_light_desc *before, const struct sdfgi_light_desc *after)
{
    return (is_dark(before) && is_dark(after)) || sdfgi_drift_of_sun(before, after) == 0;
}

/* Notes that a light is another one: NULL before it was created, and after it has been destroyed. */
static void light_changed(struct scene *scene, uint32_t id, const struct sdfgi_light_desc *before,
                          const struct sdfgi_light_desc *after)
{
    struct light *light = sdfgi_pool_get(&scene->lights, id);
    if (before && after && shine_alike(before, after))
        return;
    const uint32_t bit = sdfgi_light_bit(sdfgi_pool_index(&scene->lights, id));
    const bool moves = after && (!before || lights_others(before, after));
    const struct light_bits bits = { bit, moves ? bit : 0 };
    if (is_of_type(before, true) || is_of_type(after, true))
        sdfgi_journal_note_sun(scene->journals, &bits,
                               before && after ? sdfgi_drift_of_sun(before, after) : 1);
    if (is_of_type(before, false) || is_of_type(after, false))
        sdfgi_journal_note_lamp(
            scene->journals, &bits,
            before && after ? sdfgi_habit_change(&light->habit, before, after, scene->backend->retired.frame)
                            : 1);
}

enum sdfgi_result sdfgi_scene_light_create(struct scene *scene, const struct sdfgi_light_desc *desc,
                                           sdfgi_light *out)
{
    const struct problem problem = sdfgi_check_light(desc);
    if (problem.text[0])
        return sdfgi_problem_report(&problem, &scene->backend->hooks, "sdfgi_light_create");
    uint32_t id;
    struct light *light = sdfgi_pool_add(&scene->lights, &scene->backend->hooks, &id);
    if (!light)
        return sdfgi_check_out_of_slots(scene, "sdfgi_light_create", SDFGI_MAX_LIGHTS);
    light->desc = resolved(desc);
    light->habit = sdfgi_habit_begin(&light->desc, scene->backend->retired.frame);
    light_changed(scene, id, NULL, &light->desc);
    out->id = id;
    return SDFGI_OK;
}

enum sdfgi_result sdfgi_scene_light_update(struct scene *scene, sdfgi_light handle,
                                           const struct sdfgi_light_desc *desc)
{
    struct light *light = sdfgi_pool_get(&scene->lights, handle.id);
    if (!light)
        return sdfgi_check_unknown_handle(scene, "sdfgi_light_update", handle.id);
    const struct problem problem = sdfgi_check_light(desc);
    if (problem.text[0])
        return sdfgi_problem_report_of(&problem, &scene->backend->hooks, "sdfgi_light_update", "light",
                                       handle.id);
    const struct sdfgi_light_desc new_desc = resolved(desc);
    if (sdfgi_same_light(&light->desc, &new_desc))
        return SDFGI_OK;
    light_changed(scene, handle.id, &light->desc, &new_desc);
    light->desc = new_desc;
    return SDFGI_OK;
}

enum sdfgi_result sdfgi_scene_light_destroy(struct scene *scene, sdfgi_light handle)
{
    const struct light *light = sdfgi_pool_get(&scene->lights, handle.id);
    if (!light)
        return sdfgi_check_unknown_handle(scene, "sdfgi_light_destroy", handle.id);
    light_changed(scene, handle.id, &light->desc, NULL);
    sdfgi_pool_remove(&scene->lights, handle.id);
    return SDFGI_OK;
}

enum sdfgi_result sdfgi_scene_set_sky(struct scene *scene, const struct sdfgi_sky *sky)
{
    const struct problem problem = sdfgi_check_sky(sky);
    if (problem.text[0])
        return sdfgi_problem_report(&problem, &scene->backend->hooks, "sdfgi_set_sky");
    if (sdfgi_same_sky(&scene->sky, sky))
        return SDFGI_OK;
    sdfgi_journal_note_sky(scene->journals, sdfgi_drift_of_sky(&scene->sky, sky));
    scene->sky = *sky;
    return SDFGI_OK;
}

enum sdfgi_result sdfgi_scene_set_harmonics(struct scene *scene, const struct sdfgi_sky_harmonics *harmonics)
{
    const struct problem problem = sdfgi_check_harmonics(harmonics);
    if (problem.text[0])
        return sdfgi_problem_report(&problem, &scene->backend->hooks, "sdfgi_set_sky_harmonics");
    if (sdfgi_same_harmonics(&scene->harmonics, harmonics))
        return SDFGI_OK;
    sdfgi_journal_note_sky(scene->journals, sdfgi_drift_of_harmonics(&scene->harmonics, harmonics));
    scene->harmonics = *harmonics;
    return SDFGI_OK;
}
