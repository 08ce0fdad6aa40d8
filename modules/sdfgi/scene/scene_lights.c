/* SPDX-License-Identifier: MIT
 * Lights and sky. */
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

/* `moves`: the light may from now on light other surfaces than before. */
static void light_changed(struct scene *scene, uint32_t id, const struct sdfgi_light_desc *desc, bool moves)
{
    const uint32_t bit = sdfgi_light_bit(sdfgi_pool_index(&scene->lights, id));
    sdfgi_journal_note_light(scene->journals, &(struct light_bits){ bit, moves ? bit : 0 });
    if (desc->type == SDFGI_LIGHT_DIRECTIONAL)
        sdfgi_journal_note(scene->journals, JOURNAL_FAR);
}

static float brightness(const struct sdfgi_light_desc *light)
{
    const float *i = light->intensity;
    return light->indirect_energy * fmaxf(i[0], fmaxf(i[1], i[2]));
}

/* A light that was a thousand times dimmer may have been too dim to count. */
static bool lights_others(const struct sdfgi_light_desc *before, const struct sdfgi_light_desc *after)
{
    return !sdfgi_same_reach(before, after) || brightness(before) < brightness(after) / 1000;
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
    light_changed(scene, id, &light->desc, true);
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
    light_changed(scene, handle.id, &light->desc, false);
    light_changed(scene, handle.id, &new_desc, lights_others(&light->desc, &new_desc));
    light->desc = new_desc;
    return SDFGI_OK;
}

enum sdfgi_result sdfgi_scene_light_destroy(struct scene *scene, sdfgi_light handle)
{
    const struct light *light = sdfgi_pool_get(&scene->lights, handle.id);
    if (!light)
        return sdfgi_check_unknown_handle(scene, "sdfgi_light_destroy", handle.id);
    light_changed(scene, handle.id, &light->desc, false);
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
    scene->sky = *sky;
    sdfgi_journal_note(scene->journals, JOURNAL_SKY);
    return SDFGI_OK;
}

enum sdfgi_result sdfgi_scene_set_harmonics(struct scene *scene, const struct sdfgi_sky_harmonics *harmonics)
{
    const struct problem problem = sdfgi_check_harmonics(harmonics);
    if (problem.text[0])
        return sdfgi_problem_report(&problem, &scene->backend->hooks, "sdfgi_set_sky_harmonics");
    if (sdfgi_same_harmonics(&scene->harmonics, harmonics))
        return SDFGI_OK;
    scene->harmonics = *harmonics;
    sdfgi_journal_note(scene->journals, JOURNAL_SKY);
    return SDFGI_OK;
}
